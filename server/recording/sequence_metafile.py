"""Export of images with the poses of each as a sequence metafile (.igs.mha), for 3D Slicer and Plus.

The file is a MetaImage of w x h x n whose header has the poses of each image as `XToTrackerTransform`: the
matrix, row by row, that converts mm of X to mm of the tracker frame, which is the camera frame here. X is a
tool, a marker, or the vertebra, whose frame is RAS in this file, as 3D Slicer displays its CT; recordings and
other files of Coaxial have it in LPS. A pose that is absent, and the vertebra while figures are withheld, has
the status INVALID and the identity as matrix.

The pixels are not compressed: Plus decompresses all images at once and only up to 4 GB.
"""

import re
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, TypeAlias

import numpy as np

from server.disk import RESERVED_BYTES, named_when_complete
from server.errors import RecordingError
from server.recording.timeline import PACKINGS, RecordingIndex, Report, make_index, stored_index
from server.recording_file import OTHER_CONTENT, PackedImage, Packing, unpacked
from server.recording_file.locations import read_content
from server.recording_file.packing import Image
from server.recording_file.reader import parsed_json
from tracker.geometry import Array

SUFFIX = ".igs.mha"
# Converts LPS to RAS, and is its own inverse.
LPS_RAS = np.diag([-1.0, -1.0, 1.0, 1.0])
TRACKER, VERTEBRA = "Tracker", "Vertebra"
# Tolerance for image times: a float resolves Unix time to a quarter of a microsecond.
ROUNDING_S = 1e-6
# Of equal length: which images cannot be decoded is known only after the header was written.
IMAGE_OK, IMAGE_INVALID = "ImageStatus = OK     ", "ImageStatus = INVALID"

Json: TypeAlias = Any


@dataclass(frozen=True, slots=True, kw_only=True)
class SequenceSummary:
    """Summary of a sequence.

    Attributes:
        images: Number of images.
        invalid_images: Number of images that cannot be decoded; they are black, with the status INVALID.
        from_s, to_s: Times of the first and the last image, since the first image of the recording.
        frames: Coordinate frame of each tool, marker and vertebra, as in the names of the transforms.
    """

    images: int
    invalid_images: int
    from_s: float
    to_s: float
    frames: dict[str, str]


def write_sequence(
    recording: Path,
    target: Path,
    *,
    from_s: float = 0.0,
    to_s: float = float("inf"),
    report: Report = lambda _ratio, _doing: None,
) -> SequenceSummary:
    """Write the images between two times, with their poses, up to the end of an incomplete file.

    Args:
        recording: File of the recording.
        target: The sequence (.igs.mha); overwritten when it is complete.
        from_s: Start, since the first image of the recording.
        to_s: End, since the first image of the recording.
        report: Called with the completed share (0 to 1) and the present activity.

    Raises:
        RecordingError: SEQUENCE_EMPTY, SEQUENCE_SIZES_DIFFER, SEQUENCE_TOO_LARGE, SEQUENCE_NOT_WRITTEN,
            RECORDING_NOT_READABLE.
    """
    index = stored_index(recording) or make_index(recording)
    numbers = np.flatnonzero((index.at_s >= from_s - ROUNDING_S) & (index.at_s <= to_s + ROUNDING_S)).tolist()
    _validate(recording, index, numbers)
    try:
        with recording.open("rb") as file, named_when_complete(target) as unfinished:
            sequence = _Sequence(file, index, numbers)
            _require_space(target.parent, sequence.size_bytes)
            with unfinished.open("wb") as written:
                invalid = sequence.write(written, report)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()[:200]
        raise RecordingError(
            "SEQUENCE_NOT_WRITTEN",
            f"the sequence {target.name} cannot be written: {reason}",
            "Check that its folder exists and its disk has free space, then export again.",
            {"name": target.name, "reason": reason},
        ) from error
    return SequenceSummary(
        images=len(numbers),
        invalid_images=invalid,
        from_s=float(index.at_s[numbers[0]]),
        to_s=float(index.at_s[numbers[-1]]),
        frames=sequence.frames,
    )


def _validate(recording: Path, index: RecordingIndex, numbers: list[int]) -> None:
    if not numbers:
        raise RecordingError(
            "SEQUENCE_EMPTY",
            f"{recording.name} has no image in this period",
            "Give a period with images, and a start before its end.",
            {"name": recording.name},
        )
    sizes = {tuple(size) for size in index.sizes_px[numbers].tolist()}
    if len(sizes) > 1:
        text = ", ".join(f"{width}x{height}" for width, height in sorted(sizes)[:3])
        raise RecordingError(
            "SEQUENCE_SIZES_DIFFER",
            f"the images in this period have {len(sizes)} sizes ({text}), a sequence has one",
            "Choose a section in which the size of the images does not change.",
            {"count": len(sizes), "sizes": text},
        )


def _require_space(folder: Path, needed_bytes: int) -> None:
    free_bytes = shutil.disk_usage(folder).free
    if needed_bytes + RESERVED_BYTES > free_bytes:
        needed_gb, free_gb = needed_bytes / 1e9, free_bytes / 1e9
        raise RecordingError(
            "SEQUENCE_TOO_LARGE",
            f"the uncompressed images need {needed_gb:.1f} GB, and {free_gb:.1f} GB are free",
            "Choose a shorter section, or free disk space.",
            {"needed_gb": needed_gb, "free_gb": free_gb},
        )


class _Sequence:
    def __init__(self, file: IO[bytes], index: RecordingIndex, numbers: list[int]) -> None:
        self._file, self._index, self._numbers = file, index, numbers
        width, height = (int(one) for one in index.sizes_px[numbers[0]])
        self._size_wh_px = width, height
        grey = PACKINGS.index(Packing.ZSTD_GREY)
        self._channels = 1 if bool((index.packings[numbers] == grey).all()) else 3
        found = [key for number in numbers for key in self._snapshot(number)[1]]
        self.frames = _frames(dict.fromkeys(found))

    @property
    def size_bytes(self) -> int:
        """Size of the pixels."""
        width, height = self._size_wh_px
        return width * height * self._channels * len(self._numbers)

    def write(self, written: IO[bytes], report: Report) -> int:
        """Write header and pixels; return the number of images that cannot be decoded."""
        status_ends = []
        for line in self._header():
            written.write(line.encode() + b"\n")
            if line.endswith(IMAGE_OK):
                status_ends.append(written.tell() - 1)
        width, height = self._size_wh_px
        black = np.zeros((height, width, 3), dtype=np.uint8)
        damaged = []
        for place, number in enumerate(self._numbers):
            image = self._decoded(number)
            if image is None:
                damaged.append(place)
            pixels = black if image is None else image
            rows = np.ascontiguousarray(pixels[..., ::-1] if self._channels == 3 else pixels[..., 0])
            written.write(rows.data)
            report((place + 1) / len(self._numbers), "writing the sequence")
        for place in damaged:
            written.seek(status_ends[place] - len(IMAGE_INVALID))
            written.write(IMAGE_INVALID.encode())
        return len(damaged)

    def _header(self) -> Iterator[str]:
        width, height = self._size_wh_px
        yield "ObjectType = Image"
        yield "NDims = 3"
        yield "AnatomicalOrientation = RAI"
        yield "BinaryData = True"
        yield "BinaryDataByteOrderMSB = False"
        yield "CompressedData = False"
        yield f"DimSize = {width} {height} {len(self._numbers)}"
        yield "ElementSpacing = 1 1 1"
        yield "Offset = 0 0 0"
        yield "TransformMatrix = 1 0 0 0 1 0 0 0 1"
        yield "Kinds = domain domain list"
        yield f"ElementNumberOfChannels = {self._channels}"
        yield "ElementType = MET_UCHAR"
        # x to the right and y down in the image, as 3D Slicer stores it.
        yield "UltrasoundImageOrientation = MF"
        yield f"UltrasoundImageType = {'RGB_COLOR' if self._channels == 3 else 'BRIGHTNESS'}"
        for place, number in enumerate(self._numbers):
            image_number, poses = self._snapshot(number)
            prefix = f"Seq_Frame{place:04d}_"
            yield f"{prefix}Timestamp = {float(self._index.at_s[number])!r}"
            yield f"{prefix}FrameNumber = {image_number}"
            yield f"{prefix}{IMAGE_OK}"
            for key, frame in self.frames.items():
                matrix = poses.get(key)
                values = (np.eye(4) if matrix is None else matrix).ravel().tolist()
                yield f"{prefix}{frame}To{TRACKER}Transform = {' '.join(map(repr, values))}"
                yield f"{prefix}{frame}To{TRACKER}TransformStatus = {'INVALID' if matrix is None else 'OK'}"
        yield "ElementDataFile = LOCAL"

    def _snapshot(self, number: int) -> tuple[int, dict[str, Array | None]]:
        """Return the number of the camera image, and the poses by object; None where absent."""
        offset, length = (int(one) for one in self._index.snapshots[number])
        try:
            snapshot = parsed_json(read_content(self._file, offset, length))
            return int(snapshot["image_number"]), dict(_poses(snapshot))
        except OTHER_CONTENT:
            # The results of this image are damaged.
            return -1, {}

    def _decoded(self, number: int) -> Image | None:
        offset, length = (int(one) for one in self._index.images[number])
        return unpacked(
            PackedImage(
                packing=PACKINGS[int(self._index.packings[number])],
                size_wh_px=self._size_wh_px,
                content=read_content(self._file, offset, length),
            )
        )


def _poses(snapshot: Json) -> Iterator[tuple[str, Array | None]]:
    """Yield each object, as "tool drill", with its matrix to the camera frame, or None."""
    for tool in snapshot["tools"]:
        yield f"tool {tool['name']}", _matrix(tool["pose"].get("camera_from_tool"))
    for marker in snapshot["markers"]:
        yield f"marker {marker['name']}", _matrix(marker["sighting"].get("camera_from_marker"))
    # The page withholds figures of an unchecked registration; its pose must not look valid elsewhere.
    pose = None if snapshot["withheld"] is not None else snapshot["vertebra"].get("camera_from_vertebra")
    camera_from_vertebra = _matrix(pose)
    yield "vertebra ", None if camera_from_vertebra is None else camera_from_vertebra @ LPS_RAS


def _matrix(pose: Json | None) -> Array | None:
    if pose is None:
        return None
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = pose["rotation"], pose["translation_mm"]
    return matrix


def _frames(objects: Iterable[str]) -> dict[str, str]:
    """Return a unique frame name for each object: letters and digits, the first one a capital."""
    frames: dict[str, str] = {}
    for one in objects:
        kind, _, name = one.partition(" ")
        words = re.findall(r"[A-Za-z0-9]+", name)
        base = "".join(word[0].upper() + word[1:] for word in words)
        # Plus splits the name of a transform at "To" before a capital letter.
        base = re.sub(r"To(?=[A-Z]|$)", "TO", base)
        if kind == "vertebra":
            frames[one] = VERTEBRA
            continue
        if kind == "marker" or not base[:1].isalpha():
            base = f"{kind.capitalize()}{base}"
        frame, count = base, 2
        while frame in {*frames.values(), TRACKER, VERTEBRA}:
            frame, count = f"{base}{count}", count + 1
        frames[one] = frame
    return frames
