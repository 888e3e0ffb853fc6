"""Repeatability of pedicle measurements in CTs of patients, over clicks beside one another.

python -m tests.benchmarks.real_pedicles: the true sizes are not known. Clicks in one pedicle must agree
within what each states, and a click that does not must be rejected. The CTs are those of `real_data.py`.
"""

import sys
import time
from collections import Counter

import numpy as np

from server.imaging.ct_reader import read_ct
from tests.benchmarks.tables import Table
from tests.real_data import real_data_file
from tracker.errors import NavigationError
from tracker.plan import PedicleMeasure, Volume, measure_pedicle

PEDICLES = (
    ("thoracic, 1 x 1 x 2 mm", ("thoracic-dicom",), "left", (9.7, -90.6, -787.0)),
    ("thoracic, 1 x 1 x 2 mm", ("thoracic-dicom",), "right", (-23.6, -90.3, -788.0)),
    ("L1, 3 mm voxels", ("lumbar-3mm", "ct.nii.gz"), "right", (-10.5, -104.5, 385.0)),
    ("L5, 3 mm voxels", ("lumbar-3mm", "ct.nii.gz"), "left", (25.5, -122.0, 251.0)),
)
SHIFTS_MM = 1.5 * np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])


def main() -> None:
    """Print a row for each pedicle."""
    volumes = {parts: read_ct(real_data_file("ct", *parts)).volume for _, parts, _, _ in PEDICLES}
    rows = [_row(name, volumes[parts], side, click) for name, parts, side, click in PEDICLES]
    columns = ["pedicle", "measured", "width mm", "height mm", "length mm", "transverse deg", "sagittal deg"]
    note = (
        f"Median, spread over {len(SHIFTS_MM)} clicks 1.5 mm beside one another (sd), and median stated sd. "
        "Times are those of the processor."
    )
    table = Table(title="", columns=[*columns, "slowest click s", "rejected"], rows=rows, note=note)
    sys.stdout.write(table.markdown)


def _row(name: str, volume: Volume, side: str, click: tuple[float, float, float]) -> list[str]:
    found: list[PedicleMeasure] = []
    rejected: Counter[str] = Counter()
    slowest_s = 0.0
    for shift in SHIFTS_MM:
        start = time.process_time()
        try:
            found.append(measure_pedicle(volume, click + shift, side))
        except NavigationError as rejection:
            rejected[rejection.code] += 1
        slowest_s = max(slowest_s, time.process_time() - start)
    cells = []
    for quantity in ("width_mm", "height_mm", "length_mm", "transverse_deg", "sagittal_deg"):
        values = [getattr(one, quantity) for one in found]
        stated = np.median([getattr(one.sd, quantity) for one in found])
        cells.append(f"{np.median(values):.1f}, {np.std(values, ddof=1):.1f} ({stated:.1f})")
    codes = ", ".join(f"{count} {code}" for code, count in rejected.items())
    return [f"{name}, {side}", f"{len(found)}/{len(SHIFTS_MM)}", *cells, f"{slowest_s:.1f}", codes or "0"]


if __name__ == "__main__":
    main()
