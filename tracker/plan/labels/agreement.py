"""Comparison of a measured pedicle with the label of its vertebra: two independent views of one bone."""

import numpy as np

from tracker.errors import PlanError
from tracker.plan.labels.counting import CHECK_LEVEL
from tracker.plan.labels.label_volume import LabelVolume
from tracker.plan.labels.levels import LEVELS, level_from_name
from tracker.plan.pedicle import PedicleMeasure

# A label is exact to about a voxel, and programs place its border inside or outside of the cortex.
LIMIT_VOXELS, MIN_LIMIT_MM = 2.0, 3.0
BY_HAND = "Look at the label and the pedicle on the CT; measure again, or give its numbers by hand."


def check_measure(labels: LabelVolume, vertebra: str, measure: PedicleMeasure) -> None:
    """Reject a measured pedicle that contradicts the label of its vertebra.

    Nothing is compared if the name of the vertebra is no level, or has no label.

    Args:
        labels: labels in the CT.
        vertebra: name of the vertebra in the plan.
        measure: the measured pedicle.

    Raises:
        PlanError: LEVEL_DOUBTFUL, its isthmus lies in the label of another level; PEDICLE_DOUBTFUL, an end of
            its axis, or the wall at the isthmus, is too far from the surface of the label.
    """
    level = level_from_name(vertebra)
    if level is None or level not in labels.levels:
        return
    (here,) = labels.level_at(measure.isthmus_lps_mm)
    if here and here != level:
        raise PlanError(
            "LEVEL_DOUBTFUL",
            f"the pedicle is measured for {level}, but its isthmus lies in the label {here}, "
            f"{abs(LEVELS.index(here) - LEVELS.index(level))} levels away",
            CHECK_LEVEL,
            {
                "planned": level,
                "prevailing": here,
                "steps": abs(LEVELS.index(here) - LEVELS.index(level)),
            },
        )
    limit_mm = max(MIN_LIMIT_MM, LIMIT_VOXELS * labels.voxel_mm)
    points = np.vstack([measure.entry_lps_mm, measure.front_lps_mm, measure.outline_lps_mm])
    distances = labels.distance_mm(level, points)
    entry_mm, front_mm = float(distances[0]), float(distances[1])
    wall_mm = float(np.median(distances[2:]))
    # The entry may lie inside of the bone: at the base of a process that the axis runs through.
    _check("the entry", entry_mm, level, limit_mm, is_doubtful=entry_mm > limit_mm)
    _check("the front wall", front_mm, level, limit_mm, is_doubtful=abs(front_mm) > limit_mm)
    _check("the wall at the isthmus", wall_mm, level, limit_mm, is_doubtful=abs(wall_mm) > limit_mm)


def _check(what: str, off_mm: float, level: str, limit_mm: float, *, is_doubtful: bool) -> None:
    if not is_doubtful:
        return
    place = "outside" if off_mm > 0.0 else "inside"
    raise PlanError(
        "PEDICLE_DOUBTFUL",
        f"{what} lies {abs(off_mm):.1f} mm {place} of the surface of the label {level}, allowed "
        f"{limit_mm:.1f} mm",
        BY_HAND,
        {
            "pedicle_part": what,
            "label_side": place,
            "off_mm": abs(off_mm),
            "level": level,
            "limit_mm": limit_mm,
        },
    )
