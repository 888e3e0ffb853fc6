"""Start the mirrored planar solution again where every fit has converged to the other one.

A single remaining solution is no evidence that the other is wrong. While blur is unknown both starts can
converge to the same solution, and the delta chi-square is then infinite: the rotation of a nearly frontal
marker in motion was wrong by 11 degrees at a stated sd of half a degree in 8 of 1,000 scenes. The mirrored
pose is therefore fitted again to a few pixels, and to more where blur is wide. Tracking by edges treats an
infinite difference as undecided. `tests/tracker/test_tilt_uncertainty.py` tests it. It takes a hundredth of
the time of a search.
"""

import numpy as np

from tracker.geometry import Array
from tracker.geometry.geometry_kernels import mirror, rotation_angle_between
from tracker.photometric.fit import FitResult, fit_pose, robust_chi2_of
from tracker.photometric.samples import Samples

# Below this angle the two solutions are identical.
MIN_APART_RAD = float(np.radians(0.5))


def with_mirror_solution(samples: Samples, fits: list[FitResult], starts: list[Array]) -> list[FitResult]:
    """Return the fits, plus one that starts from the mirrored best pose if a start but no fit was near it.

    Args:
        samples: the pixels.
        fits: fits of the pixels under the selected illumination model.
        starts: rotations (3, 3) of the starts.
    """
    scale = min(one.residual_sd_grey for one in fits)
    best = min(fits, key=lambda one: robust_chi2_of(samples, one, scale))
    there = np.empty((3, 3))
    mirror(best.rotation, best.translation_mm, there)

    def is_there(rotation: Array) -> bool:
        return bool(rotation_angle_between(rotation, there) < rotation_angle_between(rotation, best.rotation))

    was_started_from = rotation_angle_between(best.rotation, there) > MIN_APART_RAD and any(
        map(is_there, starts)
    )
    if not was_started_from or any(is_there(one.rotation) for one in fits):
        return fits
    mirrored = fit_pose(
        samples,
        there,
        best.translation_mm,
        best.parameters,
        illumination=best.illumination,
        residual_sd_grey=best.residual_sd_grey,
    )
    return fits if mirrored is None else [*fits, mirrored]
