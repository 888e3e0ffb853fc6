"""Scans of a vertebra whose pedicles are implicit solids with a cortical shell around marrow."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.plan import Volume
from tracker.rehearsal.ct import ScanGrid, VertebraPhantom, pedicle_tube, scan, usual_bones

WAIST_MM = np.array([15.0, 0.0, 3.0])


@dataclass(frozen=True, kw_only=True)
class Scan:
    """A scan of the left pedicle with its surroundings."""

    cortex_mm: float
    marrow_hu: float
    spacing_mm: tuple[float, float, float]
    cortex_hu: float = 900.0

    @property
    def phantom(self) -> VertebraPhantom:
        pedicle = pedicle_tube(
            "left",
            width_mm=8.0,
            height_mm=13.0,
            transverse_deg=14.0,
            sagittal_deg=-6.0,
            waist_mm=(15.0, 0.0, 3.0),
            widening_per_mm2=0.003,
        )
        return VertebraPhantom(
            pedicles={"left": pedicle},
            bones=usual_bones(),
            cortex_mm=self.cortex_mm,
            cortex_hu=self.cortex_hu,
            marrow_hu=self.marrow_hu,
        )

    @property
    def volume(self) -> Volume:
        return _scanned(self)

    def signed_mm(self, points_mm: Array) -> tuple[Array, Array]:
        """Signed distance (n,) of points near the true wall, positive outside, and its direction (n, 3)."""
        step = 0.05
        field = self.phantom.bone_distance_mm
        slopes = [(field(points_mm + step * way) - field(points_mm - step * way)) for way in np.eye(3)]
        gradient = np.stack(slopes, axis=1) / (2.0 * step)
        steepness = np.maximum(np.linalg.norm(gradient, axis=1), 0.2)
        return field(points_mm) / steepness, gradient / steepness[:, None]


@cache
def _scanned(one: Scan) -> Volume:
    grid = ScanGrid.around(
        (14.0, -4.0, 2.0),
        size_mm=(36.0, 60.0, 36.0),
        spacing_mm=one.spacing_mm,
        blur_mm=0.4,
        noise_hu=25.0,
        seed=3,
    )
    return scan(one.phantom.hu_at, grid)


SCANS = {
    "usual-cortex": Scan(cortex_mm=1.2, marrow_hu=160.0, spacing_mm=(0.6, 0.6, 1.0)),
    "thin-cortex": Scan(cortex_mm=0.6, marrow_hu=60.0, spacing_mm=(0.6, 0.6, 1.0)),
    "coarse-voxels": Scan(cortex_mm=1.2, marrow_hu=160.0, spacing_mm=(1.0, 1.0, 1.0)),
    "thin-cortex-in-coarse-voxels": Scan(cortex_mm=0.6, marrow_hu=160.0, spacing_mm=(1.0, 1.0, 1.0)),
}


def around_the_isthmus(points_mm: Array) -> npt.NDArray[np.bool_]:
    """Which points (n,) lie within 6 mm of the isthmus along the body and in reach of the pedicle's wall."""
    away = np.abs(points_mm - WAIST_MM)
    return np.asarray((away < [8.0, 6.0, 9.0]).all(axis=1))
