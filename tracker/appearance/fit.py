"""One fit of pose, blur, camera response and light to some pixels, and where it ended."""

from collections.abc import Iterable
from dataclasses import dataclass

from tracker.appearance.kernels import robust_cost, whole_fit
from tracker.appearance.samples import Samples
from tracker.geometry import Array

PIXEL_PX2, MIN_BLUR_PX2 = 1.0 / 12.0, 0.07
ROUNDS = 14
MAX_MOVE_PX = 0.7
# Residuals over so many sd lose their say.
CUT = 4.0
# A fit is at its end when a step promises less, in units of the residuals' variance. From near its end, by
# some of the pixels, a longer straight step may end it.
SETTLED_SD2, STRAIGHT_SD2 = 0.04, 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitted:
    """Where a fit ended: as `whole_fit` gives it."""

    rotation: Array
    translation_mm: Array
    numbers: Array
    light: tuple[int, int]
    matrix: Array
    scale_grey: float
    explained_ratio: float
    looked: tuple[Array, ...]


def fitted(
    seen: Samples,
    rotation: Array,
    translation_mm: Array,
    numbers: Array,
    *,
    light: tuple[int, int],
    scale_grey: float = 0.0,
    settled: float = SETTLED_SD2,
    rounds: int = ROUNDS,
) -> Fitted | None:
    """A fit from a start; None where it fails.

    Args:
        seen: the pixels.
        rotation: (3, 3) of the start.
        translation_mm: (3,) of the start.
        numbers: of blur, response and light to start with, as `whole_fit` has them.
        light: its kind, and the nodes of its net.
        scale_grey: of the residuals, where it is known; even light is found first where it is 0.
        settled: a step that promises less ends it.
        rounds: of steps, at most.
    """
    rotation, translation_mm, numbers = rotation.copy(), translation_mm.copy(), numbers.copy()
    matrix, scale, weight, good, looked = whole_fit(
        seen.rays,
        seen.values,
        seen.lens,
        rotation,
        translation_mm,
        seen.side_mm,
        seen.textures.arrays,
        numbers,
        light,
        scale_grey,
        MIN_BLUR_PX2 + seen.step * seen.step * PIXEL_PX2,
        rounds,
        CUT,
        MAX_MOVE_PX * seen.step,
        settled,
    )
    if not good:
        return None
    return Fitted(
        rotation=rotation,
        translation_mm=translation_mm,
        numbers=numbers,
        light=light,
        matrix=matrix,
        scale_grey=float(scale),
        explained_ratio=float(weight),
        looked=looked,
    )


def again(seen: Samples, near: Fitted) -> Fitted | None:
    """The same by these pixels, from near its end."""
    return fitted(
        seen,
        near.rotation,
        near.translation_mm,
        near.numbers,
        light=near.light,
        scale_grey=near.scale_grey,
        settled=STRAIGHT_SD2,
    )


def all_again(seen: Samples, near: Iterable[Fitted | None]) -> list[Fitted]:
    """The same of some; those that failed, or fail now, are left out."""
    fits = (None if one is None else again(seen, one) for one in near)
    return [one for one in fits if one is not None]


def cost_of(seen: Samples, one: Fitted, scale_grey: float) -> float:
    """The robust sum of squared residuals of a fit, in units of this sd."""
    return float(
        robust_cost(
            seen.rays,
            seen.values,
            seen.lens,
            one.rotation,
            one.translation_mm,
            seen.side_mm,
            seen.textures.arrays,
            one.numbers,
            one.light,
            scale_grey,
            CUT,
        )
    )


def in_question(seen: Samples, fits: list[Fitted], within_sd2: float) -> list[Fitted]:
    """Those fits to the same pixels whose cost is within so much of the least.

    Where even the best leaves more than one a pixel, what no fit explains costs too: so much more is allowed.
    """
    if len(fits) < 2:
        return fits
    scale = min(one.scale_grey for one in fits)
    costs = [cost_of(seen, one, scale) for one in fits]
    within_sd2 *= max(1.0, min(costs) / len(seen.values))
    return [one for one, cost in zip(fits, costs, strict=True) if cost < min(costs) + within_sd2]
