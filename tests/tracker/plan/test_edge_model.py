"""The fitted wall is at the outside of the cortex, whatever the threshold and the thickness of the cortex."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.special import ndtr

from tracker.geometry import Array
from tracker.plan.edge_model import EdgeFit, fit_walls

SPACING_MM, WALL_MM = 0.6, 12.2
TISSUE_HU, CORTEX_HU, MARROW_HU = 40.0, 900.0, 160.0
AFFINE = np.diag([SPACING_MM, SPACING_MM, SPACING_MM, 1.0])
# A voxel's box and a scanner's blur of 0.3 mm.
SIGMA_MM = float(np.hypot(SPACING_MM / np.sqrt(12.0), 0.3))
SHAPE = (24, 24, 48)


def plate(cortex_mm: float, *, noise_hu: float = 15.0, next_mm: float | None = None) -> Array:
    """Bone from x = 0 to `WALL_MM`, the last `cortex_mm` of it cortex; perhaps metal from `next_mm` on."""
    x = SPACING_MM * np.arange(SHAPE[2])
    hu = TISSUE_HU + (CORTEX_HU - TISSUE_HU) * ndtr((WALL_MM - x) / SIGMA_MM)
    hu += (MARROW_HU - CORTEX_HU) * ndtr((WALL_MM - cortex_mm - x) / SIGMA_MM)
    if next_mm is not None:
        hu += 3000.0 * ndtr((x - next_mm) / SIGMA_MM)
    return np.asarray(hu + np.random.default_rng(2).normal(0.0, noise_hu, SHAPE))


def fitted(hu: npt.NDArray[Any], off_mm: float) -> EdgeFit:
    """Points on a plane at this distance outside of the wall."""
    y, z = np.meshgrid(np.linspace(2.0, 11.0, 20), np.linspace(2.0, 11.0, 20))
    points = np.stack([np.full(y.size, WALL_MM + off_mm), y.ravel(), z.ravel()], axis=1)
    normals = np.tile([1.0, 0.0, 0.0], (len(points), 1))
    return fit_walls(hu.astype(np.float32), AFFINE, points, normals, tissue_hu=TISSUE_HU)


@pytest.mark.parametrize("off_mm", [-0.3, 0.0, 0.4])
@pytest.mark.parametrize("cortex_mm", [0.5, 0.8, 1.5])
def test_the_wall_does_not_depend_on_where_the_surface_was_cut(cortex_mm: float, off_mm: float) -> None:
    found = fitted(plate(cortex_mm), off_mm)
    assert np.median(found.wall_mm) + off_mm == pytest.approx(0.0, abs=0.06)
    assert np.sqrt(np.mean((found.wall_mm + off_mm) ** 2)) < 1.5 * np.sqrt(np.mean(found.sd_mm**2))


def test_thick_cortex_shows_its_own_hu_and_the_blur() -> None:
    imaging = fitted(plate(1.8), 0.2).imaging
    assert imaging.cortex_hu == pytest.approx(CORTEX_HU, abs=30.0)
    assert imaging.blur_mm == pytest.approx(0.3, abs=0.08)


def test_where_no_cortex_is_thick_the_wall_is_less_sure() -> None:
    thin, thick = fitted(plate(0.5), 0.2), fitted(plate(1.8), 0.2)
    assert thin.imaging.cortex_sd_hu > 2.0 * thick.imaging.cortex_sd_hu
    assert np.median(thin.sd_mm) > 1.5 * np.median(thick.sd_mm)


def test_metal_beside_the_bone_does_not_pull_the_wall() -> None:
    found = fitted(plate(1.2, next_mm=WALL_MM + 1.8), 0.2)
    assert np.median(found.wall_mm) + 0.2 == pytest.approx(0.0, abs=0.1)


def test_where_no_wall_is_seen_nothing_is_claimed() -> None:
    found = fitted(np.full(SHAPE, TISSUE_HU), 0.0)
    assert np.abs(found.wall_mm).max() < 0.1
    assert found.sd_mm.min() > 0.4
