"""Plausibility of a section as a pedicle, from the solid bone around it and independent of the fit.

The canal is medial to a pedicle. A section around the lateral wall of the body, where a transverse process
joins it, is as narrow and closed as an isthmus, but medial to it is the body.
"""

from dataclasses import replace

import numpy as np

from tracker.geometry import Array
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.outlines import planes_across
from tracker.plan.pedicle.record import Side
from tracker.plan.pedicle.search import Bar
from tracker.plan.pedicle.section import Isthmus
from tracker.plan.pedicle.solid import Solid

MAX_DISTANCE_MM, STEP_MM = 30.0, 0.25
LIFTS_MM = (-2.5, 0.0, 2.5)
# The solid closes gaps narrower than one or two voxels, which narrows its canal by this much.
USUAL_BEYOND_MM = 4.0
# Two starts agree if they differ by less than this many standard deviations, or than these limits.
MAX_SDS, SIMILAR_MM, SIMILAR_PLACE_MM, SIMILAR_DEG = 3.0, 2.0, 5.0, 10.0


def usual_beyond_mm(near: Neighbourhood) -> float:
    """Return the bone depth beyond the medial wall above which a warning is given."""
    return USUAL_BEYOND_MM + coarsest_mm(near)


def max_beyond_mm(near: Neighbourhood) -> float:
    """Return the bone depth beyond the medial wall above which the section is rejected."""
    return USUAL_BEYOND_MM + 2.0 * coarsest_mm(near)


def coarsest_mm(near: Neighbourhood) -> float:
    """Return the longest side of a voxel."""
    return float(np.linalg.norm(near.lps_from_index[:3, :3], axis=0).max())


def beyond_medial_wall_mm(solid: Solid, centre_mm: Array, axis: Array, wall_mm: float, side: Side) -> float:
    """Return the bone depth beyond a section's medial wall, `wall_mm` from its centre."""
    (left,), (up,) = planes_across(axis[None])
    medial = -left if side == "left" else left
    along = np.arange(0.0, MAX_DISTANCE_MM, STEP_MM)
    reach = []
    for lift in LIFTS_MM:
        outside = np.flatnonzero(solid.depth_at(centre_mm + lift * up + along[:, None] * medial) < 0.0)
        reach.append(float(along[outside[0]]) if len(outside) else MAX_DISTANCE_MM)
    return float(np.median(reach)) - wall_mm


def medial_wall_mm(isthmus: Isthmus, side: Side) -> float:
    """Return the medial extent of a section's outline from its centre, also for an oblique section."""
    (left,), _ = planes_across(isthmus.axis[None])
    reach = (isthmus.outline_mm - isthmus.centre_mm) @ left
    return float(-reach.min() if side == "left" else reach.max())


def is_beside_canal(near: Neighbourhood, solid: Solid, bar: Bar, side: Side) -> bool:
    """Return whether bone ends at the medial wall of a bar's narrowest section."""
    smooth = bar.sections.smooth_mm[int(np.argmin(np.abs(bar.along_mm)))]
    # The first ray leads to the patient's left.
    medial_mm = float(smooth[len(smooth) // 2 if side == "left" else 0])
    return beyond_medial_wall_mm(solid, bar.centre_mm, bar.axis, medial_mm, side) <= usual_beyond_mm(near)


def agrees(one: Isthmus, other: Isthmus) -> bool:
    """Return whether size, place and axis of two sections agree within their standard deviations."""
    sizes = np.abs([one.width_mm - other.width_mm, one.height_mm - other.height_mm])
    size_sds = np.hypot([one.width_sd_mm, one.height_sd_mm], [other.width_sd_mm, other.height_sd_mm])
    apart_mm = float(np.linalg.norm(one.centre_mm - other.centre_mm))
    turned_deg = float(np.degrees(np.arccos(np.clip(one.axis @ other.axis, -1.0, 1.0))))
    turn_sd = float(np.linalg.norm([*one.slope_sd_deg, *other.slope_sd_deg]))
    return bool(
        (sizes <= np.maximum(MAX_SDS * size_sds, SIMILAR_MM)).all()
        and apart_mm <= SIMILAR_PLACE_MM
        and turned_deg <= max(MAX_SDS * turn_sd, SIMILAR_DEG)
    )


def with_widened_uncertainty(one: Isthmus, other: Isthmus) -> Isthmus:
    """Return the first section with its sds enlarged by the difference to the second.

    If they disagree on which extent is the width, the section is oblique, and the smaller extent is used.
    """
    offset = one.centre_mm - other.centre_mm
    turned = np.degrees(one.axis - other.axis)
    share = 1.0 / np.sqrt(2.0)
    (left,), (up,) = planes_across(one.axis[None])
    widened = replace(
        one,
        width_sd_mm=float(np.hypot(one.width_sd_mm, share * (one.width_mm - other.width_mm))),
        height_sd_mm=float(np.hypot(one.height_sd_mm, share * (one.height_mm - other.height_mm))),
        centre_sd_mm=float(np.hypot(one.centre_sd_mm, share * np.linalg.norm(offset))),
        slope_sd_deg=(
            float(np.hypot(one.slope_sd_deg[0], share * (turned @ left))),
            float(np.hypot(one.slope_sd_deg[1], share * (turned @ up))),
        ),
    )
    if one.width_mm > one.height_mm and other.width_mm < other.height_mm:
        return replace(
            widened,
            width_mm=one.height_mm,
            height_mm=one.width_mm,
            width_sd_mm=widened.height_sd_mm,
            height_sd_mm=widened.width_sd_mm,
            other_way_ratio=0.5,
        )
    return widened
