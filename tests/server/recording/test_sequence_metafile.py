"""The sequence of a recording, read by SimpleITK: pixels, poses and their status."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import SimpleITK

from server.errors import RecordingError
from server.recording.sequence_metafile import SequenceSummary, _frames, write_sequence
from server.recording.timeline import make_index
from server.recording_file import ImagePacker, RecordingReader, Topic
from tests.server.recording.reviewed import DRILLED, HEIGHT, WIDTH, drawn, write_drilling
from tests.server.recording_file.written import made_writer

FIRST, LAST = 8, 19


@pytest.fixture(scope="module")
def drilling(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_drilling(tmp_path_factory.mktemp("drilling") / "case.mcap")


def written(recording: Path, target: Path) -> tuple[SequenceSummary, SimpleITK.Image, dict[str, str]]:
    """Write the images from FIRST to LAST, which include some with a hidden drill."""
    summary = write_sequence(recording, target, from_s=FIRST / 10.0, to_s=LAST / 10.0)
    reader = SimpleITK.ImageFileReader()
    reader.SetFileName(str(target))
    reader.ReadImageInformation()
    fields = {key: reader.GetMetaData(key).strip() for key in reader.GetMetaDataKeys()}
    return summary, reader.Execute(), fields


def matrix(text: str) -> np.ndarray:
    return np.array([float(one) for one in text.split()]).reshape(4, 4)


def test_images_and_poses_are_those_of_the_recording(drilling: Path, tmp_path: Path) -> None:
    summary, image, fields = written(drilling, tmp_path / "case.igs.mha")
    assert (summary.images, summary.invalid_images) == (LAST - FIRST + 1, 0)
    assert summary.frames == {"tool drill": "Drill", "marker drill": "MarkerDrill", "vertebra ": "Vertebra"}
    pixels = SimpleITK.GetArrayFromImage(image)
    assert pixels.shape == (LAST - FIRST + 1, HEIGHT, WIDTH, 3)
    snapshots = [one.json() for one in RecordingReader(drilling).messages() if one.topic is Topic.SNAPSHOT]
    for place, number in enumerate(range(FIRST, LAST + 1)):
        np.testing.assert_array_equal(pixels[place][..., ::-1], drawn(number)[0])
        prefix = f"Seq_Frame{place:04d}_"
        assert float(fields[f"{prefix}Timestamp"]) == pytest.approx(number / 10.0, abs=1e-5)
        assert int(fields[f"{prefix}FrameNumber"]) == 1000 + number
        assert fields[f"{prefix}ImageStatus"] == "OK"
        tool_to_tracker = matrix(fields[f"{prefix}DrillToTrackerTransform"])
        status = fields[f"{prefix}DrillToTrackerTransformStatus"]
        if DRILLED[number] == "hidden":
            # Neither its last pose nor a valid one.
            assert status == "INVALID"
            np.testing.assert_array_equal(tool_to_tracker, np.eye(4))
            continue
        assert status == "OK"
        pose = snapshots[number]["tools"][0]["pose"]["camera_from_tool"]
        # The tip, which is the tool's origin, in the camera's frame.
        np.testing.assert_array_equal(tool_to_tracker @ [0, 0, 0, 1], [*pose["translation_mm"], 1.0])
        np.testing.assert_array_equal(tool_to_tracker[:3, :3], pose["rotation"])


def test_the_vertebra_is_in_ras_and_invalid_while_figures_are_withheld(
    drilling: Path, tmp_path: Path
) -> None:
    _, _, fields = written(drilling, tmp_path / "case.igs.mha")
    snapshot = next(one.json() for one in RecordingReader(drilling).messages() if one.topic is Topic.SNAPSHOT)
    entry_lps = np.array(snapshot["channel"]["entry_in_vertebra_mm"])
    pose = snapshot["vertebra"]["camera_from_vertebra"]
    in_camera = np.array(pose["rotation"]) @ entry_lps + pose["translation_mm"]
    entry_ras = entry_lps * [-1.0, -1.0, 1.0]
    found = matrix(fields["Seq_Frame0000_VertebraToTrackerTransform"]) @ [*entry_ras, 1.0]
    np.testing.assert_allclose(found[:3], in_camera, atol=1e-9)
    withheld = tmp_path / "withheld.mcap"
    content = drilling.read_bytes()
    # Of equal length, so that no position in the file changes.
    changed = content.replace(b'"withheld":null', b'"withheld":1   ')
    assert changed != content
    withheld.write_bytes(changed)
    _, _, fields = written(withheld, tmp_path / "withheld.igs.mha")
    assert fields["Seq_Frame0000_VertebraToTrackerTransformStatus"] == "INVALID"
    assert fields["Seq_Frame0000_DrillToTrackerTransformStatus"] == "OK"


def test_an_image_that_cannot_be_decoded_is_black_and_invalid(drilling: Path, tmp_path: Path) -> None:
    index = make_index(drilling)
    damaged = tmp_path / "case.mcap"
    content = bytearray(drilling.read_bytes())
    offset, length = index.images[FIRST + 3]
    content[offset : offset + length] = bytes(length)
    damaged.write_bytes(content)
    summary, image, fields = written(damaged, tmp_path / "case.igs.mha")
    assert summary.invalid_images == 1
    statuses = [fields[f"Seq_Frame{place:04d}_ImageStatus"] for place in range(summary.images)]
    assert statuses == ["INVALID" if place == 3 else "OK" for place in range(summary.images)]
    assert not SimpleITK.GetArrayFromImage(image)[3].any()


def painted(path: Path, *images: np.ndarray) -> Path:
    """Write a recording of these images (h, w, 3), BGR, with results that know nothing."""
    writer = made_writer(path)
    writer.register(Topic.SNAPSHOT)
    absent = {"kind": "absent", "reason": "NO_PLAN"}
    for number, image in enumerate(images):
        snapshot: dict[str, object] = {
            "image_number": number,
            "withheld": None,
            "tools": [],
            "markers": [],
            "vertebra": absent,
        }
        writer.add_image(ImagePacker().pack(image), number=number, at_s=float(number))
        writer.add_json(Topic.SNAPSHOT, float(number), json.dumps(snapshot), sequence=number)
    writer.close()
    return path


def test_red_stays_red_and_grey_images_have_one_channel(tmp_path: Path) -> None:
    grey = np.arange(24, dtype=np.uint8).reshape(4, 6, 1).repeat(3, axis=2)
    red = grey * np.array([0, 0, 5], dtype=np.uint8)
    target = tmp_path / "case.igs.mha"
    write_sequence(painted(tmp_path / "red.mcap", grey, red), target)
    found = SimpleITK.GetArrayFromImage(SimpleITK.ReadImage(str(target)))
    np.testing.assert_array_equal(found[0], grey)
    np.testing.assert_array_equal(found[1][..., 0], red[..., 2])
    assert not found[1][..., 1:].any()
    write_sequence(painted(tmp_path / "grey.mcap", grey, grey), target)
    np.testing.assert_array_equal(
        SimpleITK.GetArrayFromImage(SimpleITK.ReadImage(str(target))), [grey[..., 0]] * 2
    )


def test_images_of_two_sizes_are_rejected(tmp_path: Path) -> None:
    sizes = painted(tmp_path / "a.mcap", np.zeros((4, 6, 3), np.uint8), np.zeros((6, 4, 3), np.uint8))
    with pytest.raises(RecordingError, match="2 sizes \\(4x6, 6x4\\)") as found:
        write_sequence(sizes, tmp_path / "case.igs.mha")
    assert found.value.code == "SEQUENCE_SIZES_DIFFER"
    assert write_sequence(sizes, tmp_path / "case.igs.mha", to_s=0.5).images == 1


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"from_s": 99.0}, "SEQUENCE_EMPTY"),
        ({"from_s": 2.0, "to_s": 1.0}, "SEQUENCE_EMPTY"),
        ({}, "SEQUENCE_TOO_LARGE"),
    ],
)
def test_what_cannot_be_a_sequence_is_rejected_and_leaves_no_file(
    drilling: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, change: dict[str, Any], code: str
) -> None:
    monkeypatch.setattr("server.recording.sequence_metafile.RESERVED_BYTES", 10**18)
    with pytest.raises(RecordingError) as found:
        write_sequence(drilling, tmp_path / "case.igs.mha", **change)
    assert found.value.code == code
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("objects", "frames"),
    [
        (["tool drill", "marker drill", "vertebra "], ["Drill", "MarkerDrill", "Vertebra"]),
        (["tool awl 2.0 mm", "tool awl-2.0-mm"], ["Awl20Mm", "Awl20Mm2"]),
        (["tool 5 mm", "tool Ahle groß", "tool 钻"], ["Tool5Mm", "AhleGro", "Tool"]),
        (["tool toTheBone", "tool goTo", "tool tracker"], ["TOTheBone", "GoTO", "Tracker2"]),
        (["tool vertebra", "vertebra "], ["Vertebra2", "Vertebra"]),
    ],
)
def test_frame_names_are_those_that_plus_reads(objects: Sequence[str], frames: Sequence[str]) -> None:
    found = _frames(objects)
    assert list(found.values()) == list(frames)
