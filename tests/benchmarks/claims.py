"""Evaluation of one claimed drill pose against the ground truth."""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.navigation import deviation_from_channel
from tracker.pose import FoundBy, side_px_of
from tracker.rehearsal import Phase, Theatre, Truth

# A claim whose corners are further off than this is of something else.
FALSE_PX, FALSE_SIDE_RATIO = 3.0, 0.15
# Three degrees of freedom, 95 %.
ELLIPSOID_95 = 7.815


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """The drill pose claimed for one image.

    Attributes:
        camera_from_marker: the marker's pose.
        corners_px: (4, 2).
        found_by: "search" or "track".
        tip_in_camera_mm: (3,).
        entry_offset_mm, angle_deg, depth_mm: the deviation from the channel.
        tip_covariance_mm2: (3, 3), None where it was not told.
    """

    camera_from_marker: Rigid[Camera, Marker]
    corners_px: Array
    found_by: FoundBy
    tip_in_camera_mm: Array
    entry_offset_mm: float
    angle_deg: float
    depth_mm: float
    tip_covariance_mm2: Array | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Error:
    """Error of a claim: estimate minus truth, absolute where no sign is named.

    Attributes:
        corner_px: root mean square over the four corners.
        across_mm: of the marker's centre, across the line of sight.
        along_mm: signed, of the marker's centre along the line of sight; positive is too far away.
        rotation_deg: angle between both poses.
        tip_mm: distance of the tips.
        tip_mahalanobis_squared: squared Mahalanobis distance of the tips, NaN without covariance.
        entry_offset_mm, angle_deg, depth_mm: of the numbers on the surgeon's screen.
    """

    corner_px: float
    across_mm: float
    along_mm: float
    rotation_deg: float
    tip_mm: float
    tip_mahalanobis_squared: float
    entry_offset_mm: float
    angle_deg: float
    depth_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class CorrectClaim:
    """The marker was found where it is."""

    found_by: FoundBy
    error: Error


@dataclass(frozen=True, slots=True, kw_only=True)
class FalseClaim:
    """Something else was taken for the marker."""

    corner_px: float


@dataclass(frozen=True, slots=True, kw_only=True)
class NoClaim:
    """The marker was not found."""

    reason: str


Outcome: TypeAlias = CorrectClaim | FalseClaim | NoClaim


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """Ground truth and outcome of one image."""

    at_s: float
    phase: Phase
    in_view: bool
    outcome: Outcome


def judge(theatre: Theatre, at_s: float, claimed: Claim | str) -> Judgement:
    """Evaluate a claim, or the reason why there is none, against the truth at this time.

    A claim of a marker that is only partly in view is right when its corners are.
    """
    truth = theatre.truth_at(at_s)
    return Judgement(
        at_s=at_s, phase=truth.phase, in_view=truth.marker_in_view, outcome=_outcome(theatre, truth, claimed)
    )


def _outcome(theatre: Theatre, truth: Truth, claimed: Claim | str) -> Outcome:
    if isinstance(claimed, str):
        return NoClaim(reason=claimed)
    off = np.linalg.norm(claimed.corners_px - truth.corners_px, axis=1)
    if float(off.max()) > max(FALSE_PX, FALSE_SIDE_RATIO * side_px_of(truth.corners_px)):
        return FalseClaim(corner_px=float(off.max()))
    return CorrectClaim(found_by=claimed.found_by, error=_error(theatre, truth, claimed))


def _error(theatre: Theatre, truth: Truth, claimed: Claim) -> Error:
    centre = truth.camera_from_marker.translation_mm
    sight = centre / np.linalg.norm(centre)
    off = claimed.camera_from_marker.translation_mm - centre
    along = float(off @ sight)
    turned = claimed.camera_from_marker.rotation @ truth.camera_from_marker.rotation.T
    tip = claimed.tip_in_camera_mm - truth.camera_from_tool.translation_mm
    squared = np.nan
    if claimed.tip_covariance_mm2 is not None:
        squared = float(tip @ np.linalg.solve(claimed.tip_covariance_mm2, tip))
    deviation = deviation_from_channel(
        truth.camera_from_vertebra.inverse @ truth.camera_from_tool, theatre.channels[0]
    )
    return Error(
        corner_px=float(np.sqrt(np.mean(np.sum((claimed.corners_px - truth.corners_px) ** 2, axis=1)))),
        across_mm=float(np.linalg.norm(off - along * sight)),
        along_mm=along,
        rotation_deg=float(np.degrees(np.linalg.norm(vector_from_rotation(turned)))),
        tip_mm=float(np.linalg.norm(tip)),
        tip_mahalanobis_squared=squared,
        entry_offset_mm=abs(claimed.entry_offset_mm - deviation.entry_offset_mm),
        angle_deg=abs(claimed.angle_deg - deviation.angle_deg),
        depth_mm=abs(claimed.depth_mm - deviation.depth_mm),
    )
