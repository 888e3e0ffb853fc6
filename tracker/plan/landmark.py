"""Named landmarks of a vertebra, defined on the CT and located again on the patient."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan.volume import Volume


@dataclass(frozen=True, slots=True, kw_only=True)
class Landmark:
    """A point on the bone that can be found on the CT and on the patient.

    A needle is inserted at it, or the tool's tip touches it.

    Attributes:
        name: display name ("right superior articular process").
        point_lps_mm: (3,), on the bone's surface.

    Raises:
        PlanError: LANDMARK_INVALID, it has no name, or its place is not three finite numbers.
    """

    name: str
    point_lps_mm: Array

    def __post_init__(self) -> None:
        point = np.array(self.point_lps_mm, dtype=np.float64)
        if not self.name.strip() or point.shape != (3,) or not np.isfinite(point).all():
            raise PlanError(
                "LANDMARK_INVALID",
                f"landmark '{self.name[:40]}' has a place of shape {point.shape}, needed a name and three "
                "finite numbers",
                "Give it a name and set it on the CT in LPS mm.",
                {"name": self.name[:40], "shape": point.shape},
            )
        point.setflags(write=False)
        object.__setattr__(self, "point_lps_mm", point)


def reject_duplicate_names(landmarks: Sequence[Landmark]) -> None:
    """Reject landmarks whose names are equal up to case and whitespace.

    Raises:
        PlanError: LANDMARK_TWICE.
    """
    names = [" ".join(one.name.casefold().split()) for one in landmarks]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise PlanError(
            "LANDMARK_TWICE",
            f"{len(landmarks)} landmarks have only {len(set(names))} different names; "
            f"'{twice[0][:40]}' is there {names.count(twice[0])} times",
            "Give each landmark its own name.",
            {
                "name": twice[0][:40],
                "landmarks": len(landmarks),
                "different": len(set(names)),
                "times": names.count(twice[0]),
            },
        )


def reject_landmarks_outside(landmarks: Sequence[Landmark], volume: Volume) -> None:
    """Reject a landmark outside the CT: it was set on another one.

    Raises:
        PlanError: LANDMARK_OUTSIDE_CT.
    """
    for one in landmarks:
        if not volume.contains(one.point_lps_mm):
            formatted = ", ".join(f"{value:.1f}" for value in one.point_lps_mm)
            raise PlanError(
                "LANDMARK_OUTSIDE_CT",
                f"landmark '{one.name[:40]}' was set at ({formatted}) mm, which is not within the CT",
                "Set it on this CT, in LPS mm.",
                {"name": one.name[:40], "point_lps_mm": one.point_lps_mm.tolist(), "point": formatted},
            )
