"""The pose that explains every pixel of a marker: pose, blur, camera response and light fitted together."""

from dataclasses import dataclass, replace

import numpy as np

from tracker.appearance.equations.kernels import EVEN
from tracker.appearance.kernels import robust_cost, scores_spread, whole_fit
from tracker.appearance.light.kernels import BLUR, LIGHT, RESPONSE, nodes_of_plane, typical_contrast
from tracker.appearance.pixels.kernels import collect
from tracker.appearance.texture import Textures
from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid, nearest_rotation
from tracker.geometry.kernels import mean_ratio, pose_rows

# Half of the part of the plane that is looked at, in sides: the outline's blurred outer half lies on the
# white paper, and what lies beyond the paper must not come in.
REACH_RATIO = 0.6
# Wider markers are averaged first: their edges are sharper than the sharpest picture, and pixels abound.
WIDEST_PX = 110.0
# A blur over so many times that of a camera in focus spreads what tells of the pose: pixels are chosen anew.
WIDE_BLUR_RATIO = 4.0
# sd 0.6 px, and the pixel's own square: a camera in focus.
FOCUS_PX2, PIXEL_PX2, LEAST_BLUR_PX2 = 0.36, 1.0 / 12.0, 0.07
ROUNDS = 14
MOST_MOVE_PX = 0.7
# Residuals over so many sd lose their say.
CUT = 4.0
# Where the picture is this much flatter than at its steepest a pixel says little of the pose: few are enough.
# Where pixels are averaged, edges cover few of them, and all of those are asked.
LEAST_SLOPE_RATIO, LEAST_SLOPE_RATIO_AVERAGED, FLAT_STRIDE = 0.25, 0.12, 10
# So many pixels bring a pose near, some more nearer; all of them then make it exact.
FEW_PIXELS, SOME_PIXELS = 200, 800
# A fit is at its end when a step promises less, in units of the residuals' variance. From near its end, by
# some of the pixels, a longer straight step may end it.
SETTLED_SD2, STRAIGHT_SD2 = 0.04, 5.0
# The other planar solution is let go when those few pixels speak against it by so much.
OUT_OF_QUESTION_SD2 = 30.0
MOST_PIXELS = 30_000
# Uneven light is a net of so many nodes a side: a shadow's edge is a fifth of the marker wide, a highlight
# less.
NODES = 10
# What even light leaves unexplained, in units of the noise and of the contrast, before light may vary.
EVEN_LEAVES_NOISES, EVEN_LEAVES_CONTRAST_RATIO = 1.4, 0.02
# Light varies where that explains this much more; a compressed picture's blocks it does not explain.
UNEVEN_LEAVES_RATIO = 0.75
# Errors within one of so many parts a side are taken to be alike.
BLOCKS = 7


@dataclass(frozen=True, slots=True, kw_only=True)
class WholeFit:
    """One pose that explains the pixels.

    Attributes:
        camera_from_marker: the pose.
        covariance: (6, 6) [mm, rad] by what is left unexplained: translation, then turn, left-multiplied.
        alike_ratio: by how much the variance is larger than if each pixel erred alone.
        scale_grey: sd of what is not explained, in grey levels.
        contrast_grey: bright less dark, at the marker's centre.
        explained_ratio: mean weight of the pixels, 0..1: what is covered has none.
        response: bend of the camera's response, 0 where grey levels are proportional to light.
        cost_sd2: robust sum of squared residuals in units of the smaller scale of both; 0 of one alone.
    """

    camera_from_marker: Rigid[Camera, Marker]
    covariance: Array
    alike_ratio: float
    scale_grey: float
    contrast_grey: float
    explained_ratio: float
    response: float
    cost_sd2: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Pixels (n,) with their rays (n, 2), and what they are a picture of."""

    rays: Array
    values: Array
    lens: Array
    textures: Textures
    side_mm: float
    step: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitted:
    """Where a fit ended: as `whole_fit` gives it."""

    rotation: Array
    translation_mm: Array
    numbers: Array
    nodes: int
    matrix: Array
    scale_grey: float
    explained_ratio: float
    looked: tuple[Array, ...]


def whole_fits(
    image: GreyImage,
    lens: Array,
    textures: Textures,
    starts: list[Rigid[Camera, Marker]],
    *,
    side_mm: float,
    side_px: float,
    noise_grey: float,
) -> list[WholeFit]:
    """The whole shape fitted from each start within half a pixel or so; those that fail are left out.

    All are fitted to the same pixels, so that their costs can be compared.

    Args:
        image: the whole grey image (h, w).
        lens: `CameraModel.lens`.
        textures: of the marker.
        starts: poses, the likeliest first; the pixels are taken by it.
        side_mm: side of the marker.
        side_px: about how wide it is in the image.
        noise_grey: sd of the image's noise.
    """
    step = max(1, int(np.ceil(side_px / WIDEST_PX)))
    focus = np.array([1.0, 1.0, 0.0]) * (FOCUS_PX2 + step * step * PIXEL_PX2)
    seen = _samples(image, lens, textures, starts[0], side_mm=side_mm, step=step, blur_px2=focus)
    near = _near_all(seen, starts, focus)
    if near and (blur := _widest(near)) is not None:
        seen = _samples(image, lens, textures, starts[0], side_mm=side_mm, step=step, blur_px2=blur)
        near = [one for one in (_on(_some(seen, FEW_PIXELS), one) for one in near) if one is not None]
    # Where even light leaves much, it has not been asked yet which of them is better.
    if near and not _leaves_much(near, noise_grey):
        near = _in_question(_some(seen, FEW_PIXELS), near)
    done = [one for one in (_at_all(seen, one) for one in near) if one is not None]
    if not done:
        return []
    if _leaves_much(done[:1], noise_grey):
        uneven = [one for one in (_in_uneven_light(seen, one) for one in done) if one is not None]
        if uneven and uneven[0].scale_grey < UNEVEN_LEAVES_RATIO * done[0].scale_grey:
            done = uneven
    scale = min(one.scale_grey for one in done)
    costs = [_cost(seen, one, scale) for one in done] if len(done) > 1 else [0.0]
    records = [_record(seen, one, cost) for one, cost in zip(done, costs, strict=True)]
    return [one for one in records if one is not None]


def _samples(
    image: GreyImage,
    lens: Array,
    textures: Textures,
    start: Rigid[Camera, Marker],
    *,
    side_mm: float,
    step: int,
    blur_px2: Array,
) -> Samples:
    """The pixels that tell of the pose, as seen from a start at this blur (3,)."""
    rays, values = np.empty((MOST_PIXELS, 2)), np.empty(MOST_PIXELS)
    count = collect(
        image,
        step,
        lens,
        start.rotation,
        start.translation_mm,
        side_mm,
        REACH_RATIO,
        textures.arrays,
        blur_px2,
        LEAST_SLOPE_RATIO if step == 1 else LEAST_SLOPE_RATIO_AVERAGED,
        FLAT_STRIDE,
        rays,
        values,
    )
    return Samples(
        rays=rays[:count], values=values[:count], lens=lens, textures=textures, side_mm=side_mm, step=step
    )


def _some(seen: Samples, count: int) -> Samples:
    """About so many of the pixels, from everywhere."""
    every = max(len(seen.values) // count, 1)
    if every == 1:
        return seen
    return replace(
        seen,
        rays=np.ascontiguousarray(seen.rays[::every]),
        values=np.ascontiguousarray(seen.values[::every]),
    )


def _leaves_much(fits: list[Fitted], noise_grey: float) -> bool:
    """Whether the best of some fits in even light leaves more than noise."""
    best = min(fits, key=lambda one: one.scale_grey)
    contrast = float(typical_contrast(best.numbers, 0))
    return best.scale_grey > max(EVEN_LEAVES_NOISES * noise_grey, EVEN_LEAVES_CONTRAST_RATIO * contrast)


def _in_question(few: Samples, near: list[Fitted]) -> list[Fitted]:
    """Those fits to the same few pixels that may be the best of all."""
    scale = min(one.scale_grey for one in near)
    costs = [_cost(few, one, scale) for one in near]
    return [one for one, cost in zip(near, costs, strict=True) if cost < min(costs) + OUT_OF_QUESTION_SD2]


def _near_all(seen: Samples, starts: list[Rigid[Camera, Marker]], blur_px2: Array) -> list[Fitted]:
    """The poses near some starts."""
    few = _some(seen, FEW_PIXELS)
    return [one for one in (_near(few, start, blur_px2) for start in starts) if one is not None]


def _widest(near: list[Fitted]) -> Array | None:
    """The blur (3,) of the best of some fits where it is wide; None where it is about a camera's in focus."""
    best = min(near, key=lambda one: one.scale_grey)
    blur = best.numbers[BLUR : BLUR + 3]
    is_wide = float(blur[0] + blur[1]) > WIDE_BLUR_RATIO * 2.0 * FOCUS_PX2
    return blur if is_wide else None


def _near(few: Samples, start: Rigid[Camera, Marker], blur_px2: Array) -> Fitted | None:
    """The pose near a start in even light, by a few pixels."""
    numbers = np.zeros(EVEN)
    numbers[BLUR : BLUR + 3] = blur_px2
    return _from(few, start.rotation, start.translation_mm, numbers, nodes=0)


def _at_all(seen: Samples, near: Fitted) -> Fitted | None:
    """The same by all pixels."""
    some = _some(seen, SOME_PIXELS)
    nearer = near if some is seen else _on(some, near)
    return None if nearer is None else _on(seen, nearer)


def _on(seen: Samples, near: Fitted) -> Fitted | None:
    """The same from near its end."""
    return _from(
        seen,
        near.rotation,
        near.translation_mm,
        near.numbers,
        nodes=near.nodes,
        scale_grey=near.scale_grey,
        settled=STRAIGHT_SD2,
    )


def _in_uneven_light(seen: Samples, even: Fitted) -> Fitted | None:
    """The same pose where light may vary over the marker."""
    numbers = np.zeros(LIGHT + 2 * NODES * NODES)
    nodes_of_plane(even.numbers, NODES, numbers)
    return _from(seen, even.rotation, even.translation_mm, numbers, nodes=NODES, settled=STRAIGHT_SD2)


def _from(
    seen: Samples,
    rotation: Array,
    translation_mm: Array,
    numbers: Array,
    *,
    nodes: int,
    scale_grey: float = 0.0,
    settled: float = SETTLED_SD2,
) -> Fitted | None:
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
        nodes,
        scale_grey,
        LEAST_BLUR_PX2 + seen.step * seen.step * PIXEL_PX2,
        ROUNDS,
        CUT,
        MOST_MOVE_PX * seen.step,
        settled,
    )
    if not good:
        return None
    return Fitted(
        rotation=rotation,
        translation_mm=translation_mm,
        numbers=numbers,
        nodes=nodes,
        matrix=matrix,
        scale_grey=float(scale),
        explained_ratio=float(weight),
        looked=looked,
    )


def _cost(seen: Samples, one: Fitted, scale_grey: float) -> float:
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
            one.nodes,
            scale_grey,
            CUT,
        )
    )


def _record(seen: Samples, one: Fitted, cost_sd2: float) -> WholeFit | None:
    """What the fit says of the pose; None where it says nothing."""
    # What is known beforehand is in the matrix: it needs no ridge.
    rows, is_told = pose_rows(one.matrix, 0.0)
    if not is_told:
        return None
    alone = np.ascontiguousarray(rows[:, :6]) * one.scale_grey**2
    together = scores_spread(
        seen.values,
        one.looked,
        float(one.numbers[RESPONSE]),
        one.nodes,
        one.scale_grey,
        CUT,
        rows,
        BLOCKS,
    )
    alike = max(float(mean_ratio(alone, together)), 1.0)
    return WholeFit(
        camera_from_marker=Rigid(rotation=nearest_rotation(one.rotation), translation_mm=one.translation_mm),
        covariance=alone * alike,
        alike_ratio=alike,
        scale_grey=one.scale_grey,
        contrast_grey=float(typical_contrast(one.numbers, one.nodes)),
        explained_ratio=one.explained_ratio,
        response=float(one.numbers[RESPONSE]),
        cost_sd2=cost_sd2,
    )
