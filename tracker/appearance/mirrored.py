"""The planar solution that was asked for, where every fit has ended at the other one.

A single remaining solution is no proof. While blur is unknown both starts can slip to one solution, which
then stands alone with an infinite cost difference: a nearly frontal marker in motion was off by 11 degrees
with half a degree stated in 8 of 1,000 scenes. So the mirror image is started again from a few pixels, and
from more where blur is wide. Tracking treats an infinite difference by edges as undecided.
`tests/tracker/test_sure_of_a_tilt.py` holds it. Cost: a hundredth of a search.
"""

import numpy as np

from tracker.appearance.fit import Fitted, cost_of, fitted
from tracker.appearance.samples import Samples
from tracker.geometry import Array
from tracker.geometry.kernels import mirror, turn_between

# Nearer to each other, the two are one.
MIN_APART_RAD = float(np.radians(0.5))


def with_mirrored(seen: Samples, fits: list[Fitted], starts: list[Array]) -> list[Fitted]:
    """The same fits, and one from the mirror image of the best where a start was there and no fit is.

    While blur or light are not explained yet, a fit may slip from one side of facing the camera to the other.

    Args:
        seen: the pixels.
        fits: in the light that explains them.
        starts: rotations (3, 3) that were begun from.
    """
    scale = min(one.scale_grey for one in fits)
    best = min(fits, key=lambda one: cost_of(seen, one, scale))
    there = np.empty((3, 3))
    mirror(best.rotation, best.translation_mm, there)

    def is_there(rotation: Array) -> bool:
        return bool(turn_between(rotation, there) < turn_between(rotation, best.rotation))

    is_asked_for = turn_between(best.rotation, there) > MIN_APART_RAD and any(map(is_there, starts))
    if not is_asked_for or any(is_there(one.rotation) for one in fits):
        return fits
    mirrored = fitted(
        seen, there, best.translation_mm, best.numbers, light=best.light, scale_grey=best.scale_grey
    )
    return fits if mirrored is None else [*fits, mirrored]
