"""CT of the rehearsal's vertebra, for planning a rehearsed procedure."""

import numpy as np

from tracker.geometry import Array
from tracker.plan import Volume
from tracker.rehearsal.anatomy import bone_field
from tracker.rehearsal.ct.scanner import ScanGrid, scan

CORTEX_MM, CORTEX_HU, MARROW_HU, TISSUE_HU = 1.4, 850.0, 170.0, 40.0
SIZE_MM, CENTRE_MM = (104.0, 116.0, 76.0), (0.0, 5.0, -2.0)


def rehearsal_hu(points_lps_mm: Array) -> Array:
    """Return Hounsfield units (n,) of the rehearsal's vertebra at points (n, 3) in its frame."""
    field = bone_field(points_lps_mm)
    hu = np.full(len(points_lps_mm), TISSUE_HU)
    hu[field < 0.0] = CORTEX_HU
    hu[field < -CORTEX_MM] = MARROW_HU
    return hu


def rehearsal_ct(
    *,
    spacing_mm: tuple[float, float, float] = (0.6, 0.6, 1.0),
    size_mm: tuple[float, float, float] = SIZE_MM,
    noise_hu: float = 15.0,
    seed: int = 1,
) -> Volume:
    """Return the CT of the rehearsal's vertebra in the same frame (LPS, mm, origin in the canal)."""
    grid = ScanGrid.around(
        CENTRE_MM, size_mm=size_mm, spacing_mm=spacing_mm, blur_mm=0.3, noise_hu=noise_hu, seed=seed
    )
    return scan(rehearsal_hu, grid)
