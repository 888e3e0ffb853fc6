"""Rigid fit of a plate to the captures of each of its placements."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.accuracy.capture import DivotCapture
from tracker.accuracy.plate import DivotPlate
from tracker.errors import InvalidInput
from tracker.geometry import Array, Camera, Pattern, Rigid, skew

MIN_DIVOTS_PER_PLACEMENT = 4
MIN_AGAIN_PER_PLACEMENT = 4
POSE_PARAMETERS = 6


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateFit:
    """Plate and captures in the camera's frame, with the plate's pose at each placement as nuisance.

    Attributes:
        captures: n captures.
        placement_index: (n,), index of the placement of each capture.
        group_index: (n,), index of placement and divot of each capture.
        poses: pose of the plate at each placement.
        arms_mm: (n, 3), divot of each capture from the centroid of its placement, in the camera's frame.
        residuals_mm: (n, 3), tip minus divot, in the camera's frame.
    """

    captures: tuple[DivotCapture, ...]
    placement_index: npt.NDArray[np.int_]
    group_index: npt.NDArray[np.int_]
    poses: tuple[Rigid[Camera, Pattern], ...]
    arms_mm: Array
    residuals_mm: Array

    @property
    def groups(self) -> int:
        """Return the number of divots over all placements."""
        return int(self.group_index.max()) + 1

    @property
    def pose_jacobian(self) -> Array:
        """Return the Jacobian (n, 3, 6 placements) of the divots to the pose of the plate."""
        jacobian = np.zeros((len(self.captures), 3, POSE_PARAMETERS * len(self.poses)))
        for number, placement in enumerate(self.placement_index):
            first = POSE_PARAMETERS * int(placement)
            jacobian[number, :, first : first + 3] = np.eye(3)
            jacobian[number, :, first + 3 : first + 6] = -skew(self.arms_mm[number])
        return jacobian

    @property
    def residual_maker(self) -> Array:
        """Return the matrix (3 n, 3 n) that maps errors of the captures to residuals."""
        design = self.pose_jacobian.reshape(3 * len(self.captures), -1)
        return np.eye(len(design)) - design @ np.linalg.pinv(design)


def fit_plate(plate: DivotPlate, captures: Sequence[DivotCapture]) -> PlateFit:
    """Fit the plate to its captures, placement by placement, with equal weights and without a scale.

    No capture is dropped: an accuracy without its worst samples is not one.

    Raises:
        InvalidInput: DIVOT_UNKNOWN, ACCURACY_PLACEMENT_SMALL, or ACCURACY_WRONG_DIVOT.
    """
    placements = list(dict.fromkeys(one.placement for one in captures))
    groups = {group: number for number, group in enumerate(dict.fromkeys(one.group for one in captures))}
    placement_index = np.array([placements.index(one.placement) for one in captures])
    divots = plate.points_of([one.divot for one in captures])
    tips = np.array([one.tip_in_camera_mm for one in captures])
    arms, residuals = np.zeros_like(tips), np.zeros_like(tips)
    poses = []
    for number, placement in enumerate(placements):
        chosen = placement_index == number
        _reject_small(placement, [one for one in captures if one.placement == placement])
        pose = _procrustes(divots[chosen], tips[chosen])
        at = pose.move_points(divots[chosen])
        arms[chosen], residuals[chosen] = at - at.mean(axis=0), tips[chosen] - at
        poses.append(pose)
    fit = PlateFit(
        captures=tuple(captures),
        placement_index=placement_index,
        group_index=np.array([groups[one.group] for one in captures]),
        poses=tuple(poses),
        arms_mm=arms,
        residuals_mm=residuals,
    )
    _reject_wrong_divot(fit, plate)
    return fit


def reject_wrong_divot(plate: DivotPlate, captures: Sequence[DivotCapture]) -> None:
    """Reject captures of one placement with a tip that is nearer to another divot; too few are accepted.

    Raises:
        InvalidInput: DIVOT_UNKNOWN or ACCURACY_WRONG_DIVOT.
    """
    if not _is_small(captures):
        fit_plate(plate, captures)


def _procrustes(plate_mm: Array, tips_mm: Array) -> Rigid[Camera, Pattern]:
    """Return the rigid motion of least squares (Arun, Huang and Blostein 1987; without reflection)."""
    middle, centre = plate_mm.mean(axis=0), tips_mm.mean(axis=0)
    u, _, vt = np.linalg.svd((tips_mm - centre).T @ (plate_mm - middle))
    rotation = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt
    return Rigid(rotation=rotation, translation_mm=centre - rotation @ middle)


def _is_small(captures: Sequence[DivotCapture]) -> bool:
    divots = {one.divot for one in captures}
    return len(divots) < MIN_DIVOTS_PER_PLACEMENT or len(captures) - len(divots) < MIN_AGAIN_PER_PLACEMENT


def _reject_small(placement: str, captures: Sequence[DivotCapture]) -> None:
    divots = {one.divot for one in captures}
    if _is_small(captures):
        raise InvalidInput(
            "ACCURACY_PLACEMENT_SMALL",
            f"the placement '{placement[:20]}' has {len(captures)} captures of {len(divots)} divots, needed "
            f"{MIN_DIVOTS_PER_PLACEMENT} divots and {MIN_AGAIN_PER_PLACEMENT} captures more than divots",
            "Capture more divots of the plate before it is moved, each upright, tilted and turned.",
            {
                "placement": placement[:20],
                "captures": len(captures),
                "divots": len(divots),
                "needed": MIN_DIVOTS_PER_PLACEMENT,
                "needed_more": MIN_AGAIN_PER_PLACEMENT,
            },
        )


def _reject_wrong_divot(fit: PlateFit, plate: DivotPlate) -> None:
    """Reject a test with a capture that is nearer to another divot than to its own.

    One wrong name turns the plate, so that other captures may seem wrong, too: the largest residual is named.
    """
    off_mm = np.linalg.norm(fit.residuals_mm, axis=1)
    worst = int(off_mm.argmax())
    if off_mm[worst] <= plate.min_distance_mm / 2.0:
        return
    capture = fit.captures[worst]
    pose = fit.poses[int(fit.placement_index[worst])]
    here = pose.inverse.move_points(capture.tip_in_camera_mm)
    names: Mapping[str, float] = {
        name: float(np.linalg.norm(here - np.asarray(point))) for name, point in plate.points_mm.items()
    }
    nearest = min(names, key=lambda name: names[name])
    raise InvalidInput(
        "ACCURACY_WRONG_DIVOT",
        f"the tip is {off_mm[worst]:.1f} mm from its divot in the capture {capture.title}; the nearest divot "
        f"is '{nearest[:20]}'",
        "Correct the name of the divot. If the plate moved, record its captures again as another placement.",
        {"capture": capture.title, "off_mm": float(off_mm[worst]), "nearest": nearest[:20]},
    )
