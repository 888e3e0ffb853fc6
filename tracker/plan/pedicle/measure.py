"""Measurement of a pedicle from one click."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.errors import Remark
from tracker.geometry import Array
from tracker.plan.pedicle import rejections, tube_model
from tracker.plan.pedicle.course import Course, course_through, middle_of_bone
from tracker.plan.pedicle.fit import FittedBar, fit_bar, imaging_of, voxel_across_mm
from tracker.plan.pedicle.length import MIN_FACED_RATIO, WallAhead, back_wall, front_wall
from tracker.plan.pedicle.neighbourhood import Neighbourhood, neighbourhood_of
from tracker.plan.pedicle.outlines import planes_across
from tracker.plan.pedicle.plausibility import (
    agrees,
    beyond_medial_wall_mm,
    coarsest_mm,
    is_beside_canal,
    max_beyond_mm,
    medial_wall_mm,
    usual_beyond_mm,
    with_widened_uncertainty,
)
from tracker.plan.pedicle.record import (
    MIN_AHEAD_MM,
    PedicleMeasure,
    PedicleSpread,
    Side,
    axis_from_angles,
    checked_side,
    sagittal_deg_of,
    transverse_deg_of,
)
from tracker.plan.pedicle.remarks import (
    FEW_VOXELS,
    canal_remarks,
    fit_remarks,
    front_remarks,
    length_remarks,
)
from tracker.plan.pedicle.search import Bar, bar_along, find_bar
from tracker.plan.pedicle.section import Isthmus, isthmus_of
from tracker.plan.pedicle.sides import body_side, canal_side
from tracker.plan.pedicle.solid import Solid, solid_around
from tracker.plan.volume import Volume

# A smaller rotation of the axis does not change a section.
TURNED_DEG = 1.0
MAX_OFF_COURSE_DEG, MAX_TURN_DEG = 32.0, 25.0
MIN_ASIDE_MM = 1.0
MAX_MOVE_MM, MAX_GROWTH = 3.0, 1.25
# A body's outline is convex to this depth.
MAX_DENT_MM = 4.0
# Offset of the second start if the first is already at the isthmus.
AGAIN_MM = -2.0


def measure_pedicle(volume: Volume, seed_lps_mm: npt.ArrayLike, side: str) -> PedicleMeasure:
    """Measure the pedicle at a click: width, height, angles, length and their standard deviations.

    The click may lie anywhere in the pedicle. Sections in all plausible directions are outlined around it;
    the smallest closed one starts a line that is refitted through the section centres. Around the narrowest
    section a bar of cortex, marrow and surroundings, blurred by voxel and scanner, is fitted to the voxels,
    which gives sub-voxel walls. No scanner parameter and no threshold is assumed: the HU of cortex, marrow
    and outside are fitted locally. The result is verified by independent evidence: the canal beside it, and
    for few voxels a second start.

    Args:
        volume: the CT.
        seed_lps_mm: (3,), the click, LPS in mm.
        side: `left` or `right` of the patient.

    Raises:
        InvalidInput: SIDE_INVALID, SEED_INVALID.
        PlanError: SEED_OUTSIDE_CT, SEED_IN_AIR, SEED_NOT_IN_BONE, PEDICLE_NOT_FOUND, SEED_NOT_IN_PEDICLE,
            PEDICLE_CUT, SEED_ON_OTHER_SIDE, PEDICLE_DOUBTFUL.
    """
    named = checked_side(side)
    seed = rejections.checked_seed(volume, seed_lps_mm)
    near = neighbourhood_of(volume, seed)
    rejections.reject_air(near, seed)
    solid = solid_around(near, seed)
    found = _found_from(near, solid, seed, named)
    if found is None:
        raise rejections.not_found(near, seed)
    bar, fitted, isthmus = found
    rejections.reject_cut(near, bar)
    rejections.reject_outside(near, bar, fitted, seed)
    rejections.reject_no_isthmus(near, bar, isthmus)
    warnings = _side_warnings(near, isthmus, fitted, named)
    wall_mm = medial_wall_mm(isthmus, named)
    beyond_mm = beyond_medial_wall_mm(solid, isthmus.centre_mm, isthmus.axis, wall_mm, named)
    rejections.reject_without_canal(isthmus, beyond_mm, max_beyond_mm(near))
    warnings += canal_remarks(beyond_mm, usual_beyond_mm(near))
    min_mm = min(isthmus.width_mm, isthmus.height_mm)
    if min_mm < FEW_VOXELS * voxel_across_mm(near, fitted)[0] or not fitted.fitted:
        isthmus = _agreed(near, solid, seed, named, isthmus)
    return _record(near, solid, seed, named, bar, fitted, isthmus, warnings)


def _found_from(
    near: Neighbourhood, solid: Solid, at: Array, side: Side
) -> tuple[Bar, FittedBar, Isthmus] | None:
    """Return bar, fit and isthmus from a start point, or None if no section around it is closed."""
    bar = _bar_at(near, solid, at, side)
    if bar is None:
        return None
    fitted = _fitted(near, bar)
    isthmus = isthmus_of(fitted, voxel_across_mm(near, fitted))
    course = course_through(solid, isthmus.centre_mm, side)
    isthmus, fitted = _along_course(near, bar, fitted, isthmus, course, side)
    return bar, fitted, isthmus


def _agreed(near: Neighbourhood, solid: Solid, seed: Array, side: Side, isthmus: Isthmus) -> Isthmus:
    """Return the isthmus with the uncertainty of a second start; reject it if that finds another place.

    With few voxels, the covariance of a fit does not include other sections nearby that fit equally well.
    """
    again = 0.5 * (seed + isthmus.centre_mm)
    if np.linalg.norm(again - seed) < MIN_ASIDE_MM:
        again = seed + AGAIN_MM * isthmus.axis
    found = _found_from(near, solid, again, side)
    if found is None:
        raise rejections.disagreeing(isthmus, None)
    other = found[2]
    if not agrees(isthmus, other):
        raise rejections.disagreeing(isthmus, other)
    return with_widened_uncertainty(isthmus, other)


def _bar_at(near: Neighbourhood, solid: Solid, seed: Array, side: Side) -> Bar | None:
    """Return the bar at the click; if ambiguous, the one at the centre of the bone around the click."""
    bars: list[tuple[bool, bool, float, Bar]] = []
    course = course_through(solid, seed, side)
    middle = middle_of_bone(solid, seed, course.axis(side))
    elsewhere = float(solid.depth_at(seed[None])[0]) > 0.0 and np.linalg.norm(middle - seed) >= MIN_ASIDE_MM
    for at in (seed, middle) if elsewhere else (seed,):
        bar = find_bar(near, at, side, course)
        if bar is None:
            continue
        off_deg = float(np.linalg.norm(course.off_deg(bar.axis[None], side)))
        beside = is_beside_canal(near, solid, bar, side)
        if beside and bar.is_clear and off_deg <= MAX_OFF_COURSE_DEG and bar.contains(seed):
            return bar
        score = min(bar.behind_mm, bar.ahead_mm) - 0.1 * off_deg
        bars.append((beside, bar.contains(seed), score, bar))
    return max(bars, key=lambda one: one[:3])[3] if bars else None


def _fitted(near: Neighbourhood, bar: Bar) -> FittedBar:
    """Return the fit to the voxels; repeat it with fixed slopes if it rotated away from its sections."""
    fitted = fit_bar(near, bar)
    if fitted.axis @ bar.axis >= np.cos(np.radians(MAX_TURN_DEG)):
        return fitted
    return replace(fit_bar(near, bar, fixed_axis=True), misfit_ratio=1.0)


def _along_course(
    near: Neighbourhood, bar: Bar, fitted: FittedBar, isthmus: Isthmus, course: Course, side: Side
) -> tuple[Isthmus, FittedBar]:
    """Return the isthmus across the combined axis of walls and surroundings, weighted by precision."""
    own = np.array([transverse_deg_of(isthmus.axis, side), sagittal_deg_of(isthmus.axis)])
    expected = np.array([course.transverse_deg, course.sagittal_deg])
    own_weight = 1.0 / np.square(isthmus.slope_sd_deg)
    course_weight = 1.0 / np.square([course.transverse_sd_deg, course.sagittal_sd_deg])
    both = (own_weight * own + course_weight * expected) / (own_weight + course_weight)
    own_share = own_weight / (own_weight + course_weight)
    spread = np.hypot(1.0 / np.sqrt(own_weight + course_weight), own_share * isthmus.bent_sd_deg)
    axis = axis_from_angles(side, transverse_deg=float(both[0]), sagittal_deg=float(both[1]))
    turned_deg = float(np.degrees(np.arccos(np.clip(axis @ isthmus.axis, -1.0, 1.0))))
    if turned_deg >= TURNED_DEG:
        refitted = fit_bar(near, bar_along(near, bar, isthmus.centre_mm, axis), fixed_axis=True)
        across = isthmus_of(refitted, voxel_across_mm(near, refitted))
        if _is_same(isthmus, across):
            isthmus, fitted = _narrower(across, isthmus), refitted
    return replace(
        isthmus,
        axis=axis,
        slope_sd_deg=(float(spread[0]), float(spread[1])),
        usual_ratio=float(1.0 - own_share[0]) * course.usual_ratio,
    ), fitted


def _narrower(one: Isthmus, other: Isthmus) -> Isthmus:
    """Return the first section with the smaller width and height; the difference adds uncertainty.

    The direction is uncertain, and a rib at the wall can widen one of the sections: an underestimate
    leads to a thinner screw, an overestimate to a breach.
    """
    return replace(
        one,
        width_mm=min(one.width_mm, other.width_mm),
        height_mm=min(one.height_mm, other.height_mm),
        width_sd_mm=float(np.hypot(one.width_sd_mm, 0.5 * (one.width_mm - other.width_mm))),
        height_sd_mm=float(np.hypot(one.height_sd_mm, 0.5 * (one.height_mm - other.height_mm))),
    )


def _is_same(one: Isthmus, other: Isthmus) -> bool:
    """Return whether two sections across different axes belong to one pedicle."""
    moved_mm = float(np.linalg.norm(one.centre_mm - other.centre_mm))
    ratios = np.array([other.width_mm / one.width_mm, other.height_mm / one.height_mm])
    return moved_mm <= MAX_MOVE_MM and bool((np.abs(np.log(ratios)) <= np.log(MAX_GROWTH)).all())


def _record(
    near: Neighbourhood,
    solid: Solid,
    seed: Array,
    side: Side,
    bar: Bar,
    fitted: FittedBar,
    isthmus: Isthmus,
    warnings: list[Remark],
) -> PedicleMeasure:
    imaging = imaging_of(near, fitted, isthmus.axis)
    front = front_wall(near, solid, imaging, isthmus.centre_mm, isthmus.axis)
    back = back_wall(near, solid, imaging, isthmus.centre_mm, isthmus.axis)
    rejections.reject_implausible_length(front, back, MAX_DENT_MM + coarsest_mm(near))
    warnings += fit_remarks(near, solid, bar, fitted, isthmus) + length_remarks(front, back)
    warnings += front_remarks(front)
    return PedicleMeasure(
        side=side,
        width_mm=isthmus.width_mm,
        height_mm=isthmus.height_mm,
        transverse_deg=transverse_deg_of(isthmus.axis, side),
        sagittal_deg=sagittal_deg_of(isthmus.axis),
        length_mm=front.distance_mm + back.distance_mm,
        isthmus_lps_mm=isthmus.centre_mm,
        axis_lps=isthmus.axis,
        entry_lps_mm=isthmus.centre_mm - back.distance_mm * isthmus.axis,
        front_lps_mm=isthmus.centre_mm + front.distance_mm * isthmus.axis,
        outline_lps_mm=isthmus.outline_mm,
        seed_lps_mm=seed,
        cortex_mm=float(np.exp(fitted.parameters[tube_model.THICKNESS])),
        sd=PedicleSpread(
            width_mm=isthmus.width_sd_mm,
            height_mm=isthmus.height_sd_mm,
            transverse_deg=isthmus.slope_sd_deg[0],
            sagittal_deg=isthmus.slope_sd_deg[1],
            length_mm=_length_sd_mm(front, back, isthmus),
            isthmus_mm=isthmus.centre_sd_mm,
        ),
        opens_ahead_mm=_opens_ahead_mm(bar, isthmus),
        warnings=tuple(warnings),
    )


def _opens_ahead_mm(bar: Bar, isthmus: Isthmus) -> float:
    """Return the distance from the isthmus to where the bar opens, or to where tracing ended."""
    ahead = float((bar.centre_mm - isthmus.centre_mm) @ isthmus.axis) + bar.ahead_mm
    return max(ahead, MIN_AHEAD_MM)


def _side_warnings(near: Neighbourhood, isthmus: Isthmus, fitted: FittedBar, side: Side) -> list[Remark]:
    """Return warnings if canal or body contradicts the given side; reject the side if both do."""
    expected = -1 if side == "left" else 1
    canal = canal_side(near, isthmus.centre_mm, fitted.left, 0.5 * isthmus.width_mm, fitted.up)
    body = body_side(near, isthmus.centre_mm, isthmus.axis, fitted.left)
    if canal == body == -expected:
        raise rejections.other_side(side)
    if canal == -expected or (body == -expected and canal == 0):
        part = "canal" if canal else "body"
        return [
            Remark(
                code="PEDICLE_SIDE_UNSURE",
                message=f"the {part} lies as if this were not the {side} side",
                remedy="Check the side.",
                context={"vertebra_part": part, "side_name": side},
            )
        ]
    return []


def _length_sd_mm(front: WallAhead, back: WallAhead, isthmus: Isthmus) -> float:
    """Return the sd of the length: from each wall, and from the axis where a wall is met obliquely."""
    (left,), (up,) = planes_across(isthmus.axis[None])
    slope_mm = np.zeros(3)
    for wall, way in ((front, -1.0), (back, 1.0)):
        slope_mm += way * wall.distance_mm / max(abs(wall.faced_ratio), MIN_FACED_RATIO) * wall.outwards
    of_axis = np.array([slope_mm @ left, slope_mm @ up]) * np.radians(isthmus.slope_sd_deg)
    return float(np.linalg.norm([front.sd_mm, back.sd_mm, *of_axis]))
