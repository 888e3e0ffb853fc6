"""Evaluation of one claim against the ground truth of its scene."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from tests.benchmarks.claims import ELLIPSOID_95, FALSE_PX, FALSE_SIDE_RATIO
from tests.benchmarks.scenes.bound import PARAMETERS, TIP_IN_MARKER_MM, pose_errors
from tests.benchmarks.scenes.scene import Pose, Scene
from tracker import Seen, Sighting
from tracker.geometry import Array, vector_from_rotation
from tracker.pose import marker_point_covariance_mm2

# Below this angle between both planar solutions they are one.
APART_DEG = 10.0
COVERED = ("translation", "rotation", "tip")


class Outcome(Enum):
    """Outcome of one image."""

    CORRECT = "right"
    MISSED = "missed"
    WRONG = "wrong"


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A claimed marker pose.

    Attributes:
        pose: camera_from_marker.
        corners_px: (4, 2).
        covariance: (6, 6) as `Seen.pose_covariance`; None from who states none.
        found_by: "search" or "track".
    """

    pose: Pose
    corners_px: Array
    covariance: Array | None = None
    found_by: str = "search"


@dataclass(frozen=True, slots=True, kw_only=True)
class Evaluation:
    """Result of one detector for one image.

    Attributes:
        outcome: wrong is a marker claimed where it is not.
        errors: sizes by parameter, empty unless right.
        is_mirrored: nearer to the wrong one of the two planar solutions than to the right one.
        mahalanobis_squared: squared errors of translation, rotation and tip in units of what is stated; empty
            where none is stated.
        found_by: "search", "track" or "".
    """

    outcome: Outcome
    errors: Mapping[str, float]
    is_mirrored: bool = False
    mahalanobis_squared: tuple[float, ...] = ()
    found_by: str = ""

    @property
    def covered(self) -> tuple[bool, ...]:
        """Return whether translation, rotation and tip are inside the stated 95 % ellipsoid."""
        return tuple(one <= ELLIPSOID_95 for one in self.mahalanobis_squared)


def claim_of(sighting: Sighting) -> Claim | None:
    """Return the tracker's claim; None if the marker was not seen."""
    if not isinstance(sighting, Seen):
        return None
    return Claim(
        pose=sighting.camera_from_marker,
        corners_px=sighting.corners_px,
        covariance=sighting.pose_covariance,
        found_by=sighting.found_by,
    )


def evaluate(scene: Scene, claim: Claim | None) -> Evaluation:
    """Evaluate a claim against the first marker of the scene."""
    if claim is None:
        return Evaluation(outcome=Outcome.MISSED, errors={})
    if not scene.boards or _is_elsewhere(scene, claim):
        return Evaluation(outcome=Outcome.WRONG, errors={}, found_by=claim.found_by)
    return Evaluation(
        outcome=Outcome.CORRECT,
        errors=_errors(scene.pose, claim.pose),
        is_mirrored=_is_mirrored(scene.pose, claim.pose),
        mahalanobis_squared=_mahalanobis_squared(scene.pose, claim),
        found_by=claim.found_by,
    )


def _is_elsewhere(scene: Scene, claim: Claim) -> bool:
    off = float(np.abs(claim.corners_px - scene.corners_px).max())
    return not off <= max(FALSE_PX, FALSE_SIDE_RATIO * scene.side_px)


def _errors(truth: Pose, claimed: Pose) -> dict[str, float]:
    turned = vector_from_rotation(claimed.rotation @ truth.rotation.T)
    sizes = pose_errors(truth, (claimed.translation_mm - truth.translation_mm)[None], turned[None])
    errors = {name: float(getattr(sizes, name)[0]) for name in PARAMETERS}
    # Not to first order, because a mirrored pose is turned by tens of degrees.
    tips = [pose.move_points(TIP_IN_MARKER_MM) for pose in (truth, claimed)]
    return errors | {"tip_mm": float(np.linalg.norm(tips[1] - tips[0]))}


def _is_mirrored(truth: Pose, claimed: Pose) -> bool:
    """Return whether the pose is nearer to the second planar solution, mirrored at the line of sight."""
    sight = truth.translation_mm / np.linalg.norm(truth.translation_mm)
    normal = truth.rotation[:, 2]
    mirrored = 2.0 * float(normal @ sight) * sight - normal
    if float(normal @ mirrored) > np.cos(np.radians(APART_DEG)):
        return False
    found = claimed.rotation[:, 2]
    return bool(found @ mirrored > found @ normal)


def _mahalanobis_squared(truth: Pose, claim: Claim) -> tuple[float, ...]:
    if claim.covariance is None:
        return ()
    claimed, covariance = claim.pose, claim.covariance
    off = (
        truth.translation_mm - claimed.translation_mm,
        vector_from_rotation(truth.rotation @ claimed.rotation.T),
        truth.move_points(TIP_IN_MARKER_MM) - claimed.move_points(TIP_IN_MARKER_MM),
    )
    stated = (
        covariance[:3, :3],
        covariance[3:, 3:],
        marker_point_covariance_mm2(claimed, covariance, TIP_IN_MARKER_MM),
    )
    return tuple(float(e @ np.linalg.solve(c, e)) for e, c in zip(off, stated, strict=True))
