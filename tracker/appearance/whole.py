"""The pose that explains every pixel of a marker: pose, blur, camera response and light fitted together.

Few pixels bring the pose near, all of them end the fit. The covariance comes from the residuals themselves,
summed block by block of the marker, because in shadow and in compressed images the errors of neighbouring
pixels are correlated: white noise alone is too narrow, and a flat factor that covers it four times too wide
in plain light. There are seven blocks a side, and five where blur is wide or something covers the marker,
where neighbouring blocks of seven are still correlated. The factor above it stands for what the marker
model leaves out; it falls to 1 where noise dominates the residuals, and is larger in bent light and out of
focus. Errors common to the whole marker are not seen.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tracker.appearance.equations.kernels import EVEN
from tracker.appearance.fit import CUT, PIXEL_PX2, Fitted, all_again, cost_of, fitted, in_question
from tracker.appearance.inside import by_inside
from tracker.appearance.kernels import scores_spread
from tracker.appearance.light.fields.kernels import PLAIN, band_of, fields_first, typical_contrast
from tracker.appearance.light.kernels import BLUR, RESPONSE
from tracker.appearance.mirrored import with_mirrored
from tracker.appearance.samples import CoveredAt, Samples, samples_of, some_of
from tracker.appearance.texture import Textures
from tracker.appearance.uneven import (
    KnownLight,
    in_known_light,
    in_light_that_explains,
    is_uneven,
    known_from,
    leaves_much,
)
from tracker.camera.blur.kernels import smear_of
from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid, nearest_rotation
from tracker.geometry.kernels import mean_ratio, pose_rows

# Wider markers are averaged first: their edges are sharper than the sharpest picture, and pixels abound.
WIDEST_PX = 110.0
# sd 0.6 px: a camera in focus.
FOCUS_PX2 = 0.36
# A blur over so many times that of a camera in focus spreads what tells of the pose: pixels are chosen anew.
WIDE_BLUR_RATIO = 4.0
# So many pixels bring a pose near, some more nearer; all of them then make it exact.
FEW_PIXELS, SOME_PIXELS = 200, 800
# The other planar solution is let go when those few pixels speak against it by so much.
OUT_OF_QUESTION_SD2 = 60.0
# Errors within one of so many parts a side are taken to be alike: those of a wide blur, or of a shade that
# something casts beside what it covers, are so over larger parts.
BLOCKS, LARGE_BLOCKS = 7, 5
# What a net of light cannot follow is in the pose: measured on rendered scenes, where the truth is known.
UNEVEN_FACTOR = 1.4
# So is what a wide blur brings in from beyond the paper; what is smeared has sharp edges along the smear.
OUT_OF_FOCUS_FACTOR = 1.5


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
        smear_px: length along which motion smeared the marker while the shutter was open; 0 where it did not.
        light: the uneven light that it was found in; None where it is even.
        other: the pose that may as well be true, where the outline must not be believed; else None.
        other_gap_sd2: by how much the inside speaks against that one.
    """

    camera_from_marker: Rigid[Camera, Marker]
    covariance: Array
    alike_ratio: float
    scale_grey: float
    contrast_grey: float
    explained_ratio: float
    response: float
    cost_sd2: float
    smear_px: float
    light: KnownLight | None = None
    other: Rigid[Camera, Marker] | None = None
    other_gap_sd2: float = 0.0


def whole_fits(
    image: GreyImage,
    lens: Array,
    textures: Textures,
    starts: list[Rigid[Camera, Marker]],
    *,
    side_mm: float,
    side_px: float,
    noise_grey: float,
    covered_at: CoveredAt | None = None,
    known: KnownLight | None = None,
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
        covered_at: what of the marker something covers, if any does.
        known: the uneven light of the image before, if it is known.
    """

    def chosen(blur_px2: Array) -> Samples:
        return samples_of(
            image,
            lens,
            textures,
            starts[0],
            side_mm=side_mm,
            step=step,
            blur_px2=blur_px2,
            covered_at=covered_at,
        )

    step = max(1, int(np.ceil(side_px / WIDEST_PX)))
    focus = np.array([1.0, 1.0, 0.0]) * (FOCUS_PX2 + step * step * PIXEL_PX2)
    before = _in_light_before(chosen, starts, focus, known)
    seen, done = before or _anew(chosen, starts, focus, noise_grey)
    if not done:
        return []
    rotations = [start.rotation for start in starts]
    inside = by_inside(seen, done, rotations, side_px=side_px, noise_grey=noise_grey)
    if inside is not None:
        seen, done = inside.seen, inside.fits
    scale = min(one.scale_grey for one in done)
    costs = [cost_of(seen, one, scale) for one in done] if len(done) > 1 else [0.0]
    is_wide = _wide(done[0].numbers, focus) is not None
    of_all = (is_wide, covered_at is not None, None if before is None else known)
    records = (_record(seen, one, cost, *of_all) for one, cost in zip(done, costs, strict=True))
    fits = [one for one in records if one is not None]
    if inside is None:
        return fits
    other = _pose_of(inside.other)
    return [replace(one, other=other, other_gap_sd2=inside.gap_sd2) for one in fits]


def _in_light_before(
    chosen: Callable[[Array], Samples],
    starts: list[Rigid[Camera, Marker]],
    focus_px2: Array,
    known: KnownLight | None,
) -> tuple[Samples, list[Fitted]] | None:
    """Pixels and the fit to them in the uneven light of the image before; None where it does not serve."""
    # It is the light of one pose: of two, it would speak for that one.
    if known is None or len(starts) != 1:
        return None
    wide = _wide(known.numbers, focus_px2)
    seen = chosen(focus_px2 if wide is None else wide)
    one = in_known_light(seen, starts[0].rotation, starts[0].translation_mm, known)
    return None if one is None else (seen, [one])


def _anew(
    chosen: Callable[[Array], Samples],
    starts: list[Rigid[Camera, Marker]],
    focus_px2: Array,
    noise_grey: float,
) -> tuple[Samples, list[Fitted]]:
    """Pixels, chosen at a blur (3,), and the fits to them from each start, whatever the light is."""
    rotations = [start.rotation for start in starts]
    seen = chosen(focus_px2)
    few = some_of(seen, FEW_PIXELS)
    near = [one for one in (_near(few, start, focus_px2) for start in starts) if one is not None]
    if not near:
        return seen, []
    sharp = min(near, key=lambda one: one.scale_grey)
    if (blur := _wide(sharp.numbers, focus_px2)) is not None:
        seen = chosen(blur)
        few = some_of(seen, FEW_PIXELS)
        near = all_again(few, near)
        if not near:
            return seen, []
    # Where even light leaves much, it has not been asked yet which of them is better.
    if not (much := leaves_much(near, noise_grey)):
        near = in_question(few, with_mirrored(few, near, rotations), OUT_OF_QUESTION_SD2)
    done = _at_all(seen, near, noise_grey, much)
    if done and done[0].light[0] != PLAIN:
        done = with_mirrored(seen, done, rotations)
    elif done and blur is not None:
        # Few may have slipped while the blur was not known yet; some tell whether all are worth asking.
        some = some_of(seen, SOME_PIXELS)
        asked = in_question(some, with_mirrored(some, done, rotations), OUT_OF_QUESTION_SD2)
        known = {id(one) for one in done}
        done += all_again(seen, [one for one in asked if id(one) not in known])
    return seen, done


def _wide(numbers: Array, focus_px2: Array) -> Array | None:
    """The blur (3,) of a fit where it is wide; None where it is about a camera's in focus."""
    blur = numbers[BLUR : BLUR + 3]
    return blur if float(blur[:2].sum()) > WIDE_BLUR_RATIO * float(focus_px2[:2].sum()) else None


def _near(few: Samples, start: Rigid[Camera, Marker], blur_px2: Array) -> Fitted | None:
    """The pose near a start in even light, by a few pixels."""
    numbers = np.zeros(EVEN)
    numbers[BLUR : BLUR + 3] = blur_px2
    return fitted(few, start.rotation, start.translation_mm, numbers, light=(PLAIN, 0))


def _at_all(seen: Samples, near: list[Fitted], noise_grey: float, much: bool) -> list[Fitted]:
    """The same by all pixels, in the light that explains them; `much`: whether even light leaves much."""
    some = some_of(seen, SOME_PIXELS)
    done = all_again(some, near)
    if not (much and done and is_uneven(some, done)):
        done = done if some is seen else all_again(seen, done)
        if not done or not is_uneven(seen, done):
            return done
    return in_light_that_explains(seen, done, noise_grey)


def _record(
    seen: Samples, one: Fitted, cost_sd2: float, is_wide: bool, is_covered: bool, known: KnownLight | None
) -> WholeFit | None:
    """What the fit says of the pose; None where it says nothing.

    `is_wide`: whether blur is; `is_covered`: whether part of the marker is; `known`: the light it came from.
    """
    # What is known beforehand is in the matrix: it needs no ridge.
    rows, is_told = pose_rows(one.matrix, fields_first(one.light), band_of(one.light), 0.0)
    if not is_told:
        return None
    alone = np.ascontiguousarray(rows[:, :6]) * one.scale_grey**2
    together = scores_spread(
        seen.values,
        one.looked,
        one.numbers,
        one.light,
        one.scale_grey,
        CUT,
        rows,
        LARGE_BLOCKS if is_wide or is_covered else BLOCKS,
    )
    alike = max(float(mean_ratio(alone, together)), 1.0)
    by_light = 1.0 if one.light[0] == PLAIN else UNEVEN_FACTOR
    smear_px = float(np.sqrt(12.0 * smear_of(one.numbers[BLUR : BLUR + 3])[0]))
    by_blur = OUT_OF_FOCUS_FACTOR if is_wide and smear_px == 0.0 else 1.0
    return WholeFit(
        camera_from_marker=_pose_of(one),
        covariance=alone * alike * by_light * by_blur,
        alike_ratio=alike,
        scale_grey=one.scale_grey,
        contrast_grey=float(typical_contrast(one.numbers, one.light)),
        explained_ratio=one.explained_ratio,
        response=float(one.numbers[RESPONSE]),
        cost_sd2=cost_sd2,
        smear_px=smear_px,
        light=known_from(one, known),
    )


def _pose_of(one: Fitted) -> Rigid[Camera, Marker]:
    return Rigid(rotation=nearest_rotation(one.rotation), translation_mm=one.translation_mm)
