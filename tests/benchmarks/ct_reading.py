"""Time and memory of reading a CT of 512 x 512 x 400 voxels, each run in its own process.

python -m tests.benchmarks.ct_reading FOLDER_OR_ZIP reads one and prints what it took, as JSON.
"""

import copy
import json
import resource
import subprocess
import sys
import tempfile
import time
import zipfile
from pathlib import Path

import numpy as np
from pydicom import uid
from scipy import ndimage

from server.imaging.ct_reader import read_ct
from tests.benchmarks.tables import Table
from tests.server.imaging.made_ct import compressed, file_of, made_ct
from tracker.plan.slices import Slice, patient_slice

SIZE_WH, SLICES, DIFFERENT = (512, 512), 400, 20
KINDS = {
    "uncompressed": uid.ExplicitVRLittleEndian,
    "JPEG-LS": uid.JPEGLSLossless,
    "JPEG 2000": uid.JPEG2000Lossless,
}
KIB_PER_MIB = 1024.0


def measure_ct_reading() -> list[Table]:
    """Table of each compression, and of the uncompressed series as a zip."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, syntax in KINDS.items():
            made = Path(folder) / name
            write_series(made, syntax)
            rows.append(_row(name, made))
            if name == "uncompressed":
                rows.append(_row("zip", zipped(made)))
    return [
        Table(
            title="",
            columns=["slices", "first slice s", "all s", "sagittal slice ms", "memory / volume"],
            rows=rows,
            note="Memory is the most that the reading process held over the 200 MiB of the voxels, Python "
            "and libraries (160 MiB) included; a decoding process holds 75 MiB more while it runs. Times "
            "begin with the call.",
        )
    ]


def write_series(folder: Path, syntax: uid.UID) -> None:
    """Write a synthetic series: soft tissue, a spine and scanner noise; slices repeat periodically."""
    folder.mkdir()
    template = made_ct(count=1, size_wh=SIZE_WH).slices[0]
    template.PixelSpacing = [0.742, 0.742]
    noise = np.random.default_rng(7)
    y, x = np.mgrid[0:512, 0:512]
    body = (np.hypot((x - 256) / 1.4, y - 256) < 180) * 1050 + (np.hypot(x - 256, y - 300) < 40) * 500
    pixels = [
        np.clip(body + ndimage.gaussian_filter(noise.normal(0, 120, body.shape), 0.8), 0, 4000).astype(
            np.uint16
        )
        for _ in range(DIFFERENT)
    ]
    contents = []
    for one in pixels:
        template.PixelData = one.tobytes()
        contents.append(compressed(template, syntax) if syntax.is_encapsulated else template.PixelData)
    for k in range(SLICES):
        one_slice = copy.copy(template)
        one_slice.ImagePositionPatient = [-190, -190, 300 + 0.75 * k]
        one_slice.SOPInstanceUID = uid.generate_uid()
        (folder / f"{k:04d}.dcm").write_bytes(file_of(one_slice, syntax, content=contents[k % DIFFERENT]))


def zipped(folder: Path) -> Path:
    path = folder.with_suffix(".zip")
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for file in sorted(folder.iterdir()):
            archive.write(file, file.name)
    return path


def _row(name: str, path: Path) -> list[str]:
    answer = subprocess.run(
        [sys.executable, "-m", "tests.benchmarks.ct_reading", str(path)],
        capture_output=True,
        check=True,
        text=True,
    )
    took = json.loads(answer.stdout)
    return [
        name,
        f"{took['first_s']:.1f}",
        f"{took['all_s']:.1f}",
        f"{took['sagittal_ms']:.0f}",
        f"{took['peak_mib'] / took['volume_mib']:.2f}",
    ]


def read_one(path: Path) -> dict[str, float]:
    """Read a series as the server does, and return time and memory."""
    seen_s: list[float] = []

    def first(_: Slice) -> None:
        seen_s.append(time.perf_counter() - start)

    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        ct = read_ct(path, into=Path(folder) / "voxels.npy", first=first)
        all_s = time.perf_counter() - start
        start = time.perf_counter()
        patient_slice(ct.volume, "sagittal", 0.1)
        sagittal_ms = 1000.0 * (time.perf_counter() - start)
        return {
            "first_s": seen_s[0],
            "all_s": all_s,
            "sagittal_ms": sagittal_ms,
            "peak_mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / KIB_PER_MIB,
            "volume_mib": ct.volume.hu.nbytes / 2**20,
        }


if __name__ == "__main__":
    sys.stdout.write(json.dumps(read_one(Path(sys.argv[1]))) + "\n")
