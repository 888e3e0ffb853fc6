"""Rejections of a pedicle measurement, each with what was found and a remedy."""

import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput, PlanError
from tracker.geometry import Array
from tracker.plan.pedicle import tube_model
from tracker.plan.pedicle.fit import FittedBar
from tracker.plan.pedicle.length import WallAhead
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.outlines import angles
from tracker.plan.pedicle.search import Bar
from tracker.plan.pedicle.section import Isthmus
from tracker.plan.volume import Volume

AIR_HU = -300.0
MAX_BESIDE_MM = 1.0
MAX_ASPECT = 3.5
WIDTH_MM, HEIGHT_MM = (1.5, 26.0), (2.0, 32.0)
LENGTH_MM = (25.0, 75.0)
BY_HAND = "Click again, nearer to the middle of the pedicle; or give its numbers by hand."
CLICK = "Click into the middle of the pedicle, on a slice that shows it joined to body and arch."


def checked_seed(volume: Volume, seed_lps_mm: npt.ArrayLike) -> Array:
    """Return the click as three finite numbers in the CT.

    Raises:
        InvalidInput: SEED_INVALID.
        PlanError: SEED_OUTSIDE_CT.
    """
    seed = np.asarray(seed_lps_mm, dtype=np.float64)
    if seed.shape != (3,) or not np.isfinite(seed).all():
        raise InvalidInput(
            "SEED_INVALID",
            "the click is not three finite numbers",
            "Give x, y, z in mm of the patient's LPS coordinates.",
            {"shape": list(seed.shape)},
        )
    if not bool(volume.contains(seed)):
        last = np.array(volume.shape_ijk) - 1.0
        corners = np.array([[a, b, c] for a in (0, last[0]) for b in (0, last[1]) for c in (0, last[2])])
        box = volume.lps_from_index(corners)
        low, high = box.min(axis=0), box.max(axis=0)
        raise PlanError(
            "SEED_OUTSIDE_CT",
            f"the click at {_formatted(seed)} mm lies outside the CT, which reaches from {_formatted(low)} "
            f"to {_formatted(high)} mm (LPS)",
            "Give a point inside the CT, in LPS mm (x to the patient's left, y backwards).",
            {
                "seed_lps_mm": seed.tolist(),
                "low_lps_mm": low.tolist(),
                "high_lps_mm": high.tolist(),
                "seed": _formatted(seed),
                "low": _formatted(low),
                "high": _formatted(high),
            },
        )
    return seed


def reject_air(near: Neighbourhood, seed: Array) -> None:
    """Reject a click in air or lung: SEED_IN_AIR."""
    hu = _hu_around(near, seed)
    if hu < AIR_HU:
        raise PlanError(
            "SEED_IN_AIR",
            f"the click lies in air or lung: {hu:.0f} HU, bone begins far above {AIR_HU:.0f} HU",
            CLICK,
            {"seed_hu": hu, "air_hu": AIR_HU},
        )


def not_found(near: Neighbourhood, seed: Array) -> PlanError:
    """Return the error for a click without a closed section: soft tissue, or bone that is open everywhere."""
    hu, limit = _hu_around(near, seed), near.soft_below_hu
    if hu < limit:
        return PlanError(
            "SEED_NOT_IN_BONE",
            f"the click lies in {hu:.0f} HU and no wall of bone closes around it, "
            f"bone here is above {limit:.0f} HU",
            CLICK,
            {"seed_hu": hu, "limit_hu": limit},
        )
    return PlanError(
        "PEDICLE_NOT_FOUND",
        f"the bone at the click ({hu:.0f} HU) is open on all sides: no section of it within 7 mm is closed",
        CLICK,
        {"seed_hu": hu},
    )


def reject_cut(near: Neighbourhood, bar: Bar) -> None:
    """Reject a pedicle that the CT cuts: PEDICLE_CUT."""
    cut = bar.sections
    rows = np.abs(bar.along_mm) <= max(2.0, 0.5 * bar.length_mm)
    angle = angles(cut.smooth_mm.shape[1])
    direction = np.cos(angle)[:, None] * cut.across[:, None, :] + np.sin(angle)[:, None] * cut.up[:, None, :]
    wall = cut.centre_mm[:, None, :] + cut.smooth_mm[..., None] * direction
    outside = float(1.0 - near.contains(wall[rows]).mean())
    if outside > 0.02:
        raise PlanError(
            "PEDICLE_CUT",
            f"the CT ends within the pedicle: {100.0 * outside:.0f} % of its wall lie outside, none may",
            "Use a series that contains the whole vertebra.",
            {"outside_ratio": outside, "outside_percent": 100.0 * outside},
        )


def reject_outside(near: Neighbourhood, bar: Bar, fitted: FittedBar, seed: Array) -> None:
    """Reject a bar that does not contain the click: SEED_NOT_IN_PEDICLE."""
    local = seed - fitted.origin_mm
    along = float(local @ fitted.axis)
    if (
        -bar.behind_mm - 0.5 <= along <= bar.ahead_mm + 0.5
        and abs(along) > fitted.half_mm
        and bar.contains(seed)
    ):
        return
    across = np.array([[local @ fitted.left, local @ fitted.up]])
    place = np.array([np.clip(along / fitted.half_mm, -1.0, 1.0)])
    distance = float(tube_model.wall_distance_mm(fitted.parameters, place, across)[0][0])
    voxel = float(np.linalg.norm(near.lps_from_index[:3, :2], axis=0).mean())
    allowed = MAX_BESIDE_MM + 0.5 * voxel
    beyond = max(-bar.behind_mm - along, along - bar.ahead_mm, 0.0)
    if distance > allowed + 0.35 * beyond or beyond > 9.0:
        raise PlanError(
            "SEED_NOT_IN_PEDICLE",
            "the nearest bar of bone does not contain the click: it lies "
            f"{max(distance, 0.0):.1f} mm beside its wall (allowed {allowed:.1f} mm) "
            f"and {beyond:.1f} mm beyond its end (allowed 9 mm)",
            CLICK,
            {
                "beside_mm": distance,
                "beyond_mm": beyond,
                "outside_mm": max(distance, 0.0),
                "allowed_mm": float(allowed),
            },
        )


def reject_no_isthmus(near: Neighbourhood, bar: Bar, isthmus: Isthmus) -> None:
    """Reject a fit without the shape of a pedicle: PEDICLE_NOT_FOUND."""
    aspect = max(isthmus.width_mm, isthmus.height_mm) / max(min(isthmus.width_mm, isthmus.height_mm), 1e-6)
    shaped = (
        WIDTH_MM[0] <= isthmus.width_mm <= WIDTH_MM[1]
        and HEIGHT_MM[0] <= isthmus.height_mm <= HEIGHT_MM[1]
        and aspect <= MAX_ASPECT
    )
    if shaped and (bar.opens_ahead or bar.opens_behind):
        return
    what = (
        f"it is {isthmus.width_mm:.1f} x {isthmus.height_mm:.1f} mm"
        if not shaped
        else f"it is equally thick for {bar.length_mm:.0f} mm and joins neither body nor arch"
    )
    raise PlanError(
        "PEDICLE_NOT_FOUND",
        f"the bone around the click is not a pedicle: {what} (noise {near.noise_hu:.0f} HU)",
        CLICK,
        {
            "width_mm": isthmus.width_mm,
            "height_mm": isthmus.height_mm,
            "length_mm": bar.length_mm,
            "bone_shape": what,
            "noise_hu": float(near.noise_hu),
        },
    )


def reject_without_canal(isthmus: Isthmus, beyond_mm: float, allowed_mm: float) -> None:
    """Reject a section without a canal beside it: PEDICLE_DOUBTFUL."""
    if beyond_mm <= allowed_mm:
        return
    raise PlanError(
        "PEDICLE_DOUBTFUL",
        f"the narrowest section that was found, {isthmus.width_mm:.1f} x {isthmus.height_mm:.1f} mm at "
        f"{_formatted(isthmus.centre_mm)} mm, is hardly the pedicle's: beyond its medial wall bone "
        f"goes on for {beyond_mm:.0f} mm (allowed {allowed_mm:.0f} mm), where the canal should begin",
        "Click nearer to the canal, into the middle of the pedicle; or give its numbers by hand.",
        {
            "beyond_mm": beyond_mm,
            "allowed_mm": allowed_mm,
            "isthmus_lps_mm": isthmus.centre_mm.tolist(),
            "width_mm": isthmus.width_mm,
            "height_mm": isthmus.height_mm,
            "centre": _formatted(isthmus.centre_mm),
        },
    )


def reject_implausible_length(front: WallAhead, back: WallAhead, allowed_dent_mm: float) -> None:
    """Reject a length that the vertebra's shape contradicts: PEDICLE_DOUBTFUL.

    A front wall far behind the outline on both sides of the axis is a gap in weak trabeculae.
    """
    if front.found and front.distance_mm < front.chord_mm - allowed_dent_mm:
        raise PlanError(
            "PEDICLE_DOUBTFUL",
            f"on the axis bone seems to end {front.distance_mm:.0f} mm in front of the isthmus, but beside "
            f"the axis the body reaches {front.chord_mm:.0f} mm (allowed difference {allowed_dent_mm:.0f} mm)"
            ": the front wall was not found",
            BY_HAND,
            {"front_mm": front.distance_mm, "chord_mm": front.chord_mm, "allowed_mm": allowed_dent_mm},
        )
    length_mm = front.distance_mm + back.distance_mm
    if front.found and back.found and not LENGTH_MM[0] <= length_mm <= LENGTH_MM[1]:
        raise PlanError(
            "PEDICLE_DOUBTFUL",
            f"from entry to front wall the axis runs {length_mm:.1f} mm in bone ({LENGTH_MM[0]:.0f} to "
            f"{LENGTH_MM[1]:.0f} mm are possible): entry, front wall or direction are mistaken",
            BY_HAND,
            {"length_mm": length_mm, "min_mm": LENGTH_MM[0], "max_mm": LENGTH_MM[1]},
        )


def disagreeing(one: Isthmus, other: Isthmus | None) -> PlanError:
    """Return the error for two starts whose sections differ by more than their sds allow."""
    distance_mm = 0.0 if other is None else float(np.linalg.norm(one.centre_mm - other.centre_mm))
    second = (
        "from 2 mm aside none is found"
        if other is None
        else f"from a few mm aside it is {other.width_mm:.1f} x {other.height_mm:.1f} mm, "
        f"{distance_mm:.1f} mm away"
    )
    return PlanError(
        "PEDICLE_DOUBTFUL",
        f"the narrowest section from the click is {one.width_mm:.1f} x {one.height_mm:.1f} mm, and {second}; "
        "they should be one",
        "Click into the pedicle's middle; use finer slices if there are any; or give its numbers by hand.",
        {
            "width_mm": one.width_mm,
            "height_mm": one.height_mm,
            "apart_mm": distance_mm,
            "second": second,
            "other_mm": None if other is None else [other.width_mm, other.height_mm],
        },
    )


def other_side(side: str) -> PlanError:
    """Return the error for a click on the other side, by canal and body."""
    other = "right" if side == "left" else "left"
    return PlanError(
        "SEED_ON_OTHER_SIDE",
        f"side is {side}, but canal and body lie as they do beside the patient's {other} pedicle",
        f"Click into the {side} pedicle, or measure this one as the {other} one.",
        {"side": side, "other_side": other},
    )


def _hu_around(near: Neighbourhood, seed: Array) -> float:
    offsets = np.array([[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
    return float(np.median(near.smooth_hu(seed + offsets)))


def _formatted(point: Array) -> str:
    return ", ".join(f"{value:.1f}" for value in point)
