"""What the program said of one image, held against what is true in it."""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.navigation import deviation_from_channel
from tracker.pose import FoundBy, side_px_of
from tracker.rehearsal import Phase, Theatre, Truth

# A claim whose corners are farther off than this shows something else than the marker.
FALSE_PX, FALSE_SIDE_RATIO = 3.0, 0.15
# Three degrees of freedom, 95 %.
ELLIPSOID_95 = 7.815


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """What was said of the drill in one image.

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
    """How far a claim is off; all of them estimate minus truth, sizes where no sign is named.

    Attributes:
        corner_px: root mean square over the four corners.
        across_mm: of the marker's centre, across the line of sight.
        along_mm: signed, of the marker's centre along the line of sight; positive is too far away.
        rotation_deg: angle between both poses.
        tip_mm: distance of the tips.
        tip_squared_sd: squared distance of the tips by the stated covariance, nan if none was stated.
        entry_offset_mm, angle_deg, depth_mm: of the numbers on the surgeon's screen.
    """

    corner_px: float
    across_mm: float
    along_mm: float
    rotation_deg: float
    tip_mm: float
    tip_squared_sd: float
    entry_offset_mm: float
    angle_deg: float
    depth_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RightClaim:
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


Outcome: TypeAlias = RightClaim | FalseClaim | NoClaim


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """One image: what was true, and what was said."""

    at_s: float
    phase: Phase
    in_view: bool
    outcome: Outcome


def judge(theatre: Theatre, at_s: float, said: Claim | str) -> Judgement:
    """Hold a claim, or the reason why there is none, against the truth of this time.

    A claim of a marker that is only partly in view is right when its corners are.
    """
    truth = theatre.truth_at(at_s)
    return Judgement(
        at_s=at_s, phase=truth.phase, in_view=truth.marker_in_view, outcome=_outcome(theatre, truth, said)
    )


def _outcome(theatre: Theatre, truth: Truth, said: Claim | str) -> Outcome:
    if isinstance(said, str):
        return NoClaim(reason=said)
    off = np.linalg.norm(said.corners_px - truth.corners_px, axis=1)
    if float(off.max()) > max(FALSE_PX, FALSE_SIDE_RATIO * side_px_of(truth.corners_px)):
        return FalseClaim(corner_px=float(off.max()))
    return RightClaim(found_by=said.found_by, error=_error(theatre, truth, said))


def _error(theatre: Theatre, truth: Truth, said: Claim) -> Error:
    centre = truth.camera_from_marker.translation_mm
    sight = centre / np.linalg.norm(centre)
    off = said.camera_from_marker.translation_mm - centre
    along = float(off @ sight)
    turned = said.camera_from_marker.rotation @ truth.camera_from_marker.rotation.T
    tip = said.tip_in_camera_mm - truth.camera_from_tool.translation_mm
    squared = np.nan
    if said.tip_covariance_mm2 is not None:
        squared = float(tip @ np.linalg.solve(said.tip_covariance_mm2, tip))
    deviation = deviation_from_channel(
        truth.camera_from_vertebra.inverse @ truth.camera_from_tool, theatre.channels[0]
    )
    return Error(
        corner_px=float(np.sqrt(np.mean(np.sum((said.corners_px - truth.corners_px) ** 2, axis=1)))),
        across_mm=float(np.linalg.norm(off - along * sight)),
        along_mm=along,
        rotation_deg=float(np.degrees(np.linalg.norm(vector_from_rotation(turned)))),
        tip_mm=float(np.linalg.norm(tip)),
        tip_squared_sd=squared,
        entry_offset_mm=abs(said.entry_offset_mm - deviation.entry_offset_mm),
        angle_deg=abs(said.angle_deg - deviation.angle_deg),
        depth_mm=abs(said.depth_mm - deviation.depth_mm),
    )
