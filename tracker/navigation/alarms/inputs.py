"""Inputs of the alarm engine: values and flags of one step."""

from dataclasses import dataclass, field
from typing import TypeAlias

from tracker.camera import ControlChange
from tracker.navigation.clearance import WallSource
from tracker.navigation.directions import Wall
from tracker.photometric import FocalLengthError


@dataclass(frozen=True, slots=True)
class NotKnown:
    """A value that is not known at this step."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Site:
    """Where in the bone a value was measured.

    Attributes:
        depth_mm: displayed depth of the tip past the entry plane.
        wall: the nearest wall; None if the value does not concern a wall.
        against: what the wall distance was measured against; None if the value does not concern a wall.
        tool: its name if there are several; else empty.
    """

    depth_mm: float
    wall: Wall | None = None
    against: WallSource | None = None
    tool: str = ""


Reading: TypeAlias = float | NotKnown
NOT_KNOWN = NotKnown()


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmInputs:
    """One step of the alarm engine, with or without a new image; defaults mean normal or not known.

    Attributes:
        navigating: navigation is active: plan, registration and drill were present and it has not been ended.
            Stays True when one of them is lost. Most conditions are not evaluated before it.
        image_number: of the newest image; -1 before the first. A changed number means a new image.
        captured_at_s: of that image, on the clock of the step.
        clearance_mm: from the drill's cylinder to the pedicle's wall, negative through it.
        breach_ratio: probability of a breach, now or within the look-ahead.
        wall_site: site of that clearance; None if not known.
        risk_site: site of the tool with that probability; None if not known.
        unseen_tools: tools without figures, if there are several tools.
        past_depth_mm: depth of the tip past the planned end; negative before it.
        depth_site: site of the deepest tip; None if not known.
        tip_sd_mm: uncertainty of the tip.
        max_tip_sd_mm: its limit in this pedicle.
        setup_sufficient: registration and tool allow an uncertainty within that limit.
        drill_unseen_s: time since the drill was seen, up to the newest image; 0 while it is seen.
        drill_put_away: the drill was unseen for longer than `put_away_after_s`.
        reference_unseen_s: as for the drill; 0 without a patient reference.
        markers_unique: no second print of the drill's or the patient's marker is in view.
        camera_silent_s: age of the newest image.
        image_current: the newest image is within its age limit, and camera and tracker work.
        camera_works: the source runs, or its state is unknown because nothing tracks.
        tracker_works: the tracking process runs.
        pose_certain: the uncertainty of the tip permits displaying it.
        pose_steady: the pose did not jump and is not ambiguous.
        camera_in_place: the camera did not move since the registration.
        reference_in_place: the reference did not move since the registration.
        camera_change: the camera control that invalidates the calibration; None if none does.
        focal_length_error: of the camera by the perspective of the markers; None if not known.
        registration_current: the registration is up to date.
        calibration_current: the calibration is up to date.
        check_age_s: time since the last check on anatomy.
        armed_screens: number of screens with armed sound.
        lost_screens: number of those that disconnected without notice.
        free_disk_mb: free space on the disk of the cases.
        recording_runs: all recordings are being written.
        hold_requested_by: name of the person who requests a hold; empty for none.
    """

    navigating: bool
    image_number: int = -1
    captured_at_s: float = 0.0
    clearance_mm: Reading = NOT_KNOWN
    breach_ratio: Reading = NOT_KNOWN
    wall_site: Site | None = None
    risk_site: Site | None = None
    unseen_tools: frozenset[str] = frozenset()
    past_depth_mm: Reading = NOT_KNOWN
    depth_site: Site | None = None
    tip_sd_mm: Reading = NOT_KNOWN
    max_tip_sd_mm: Reading = NOT_KNOWN
    setup_sufficient: bool = True
    drill_unseen_s: float = 0.0
    drill_put_away: bool = False
    reference_unseen_s: float = 0.0
    markers_unique: bool = True
    camera_silent_s: float = 0.0
    image_current: bool = True
    camera_works: bool = True
    tracker_works: bool = True
    pose_certain: bool = True
    pose_steady: bool = True
    camera_in_place: bool = True
    reference_in_place: bool = True
    camera_change: ControlChange | None = None
    focal_length_error: FocalLengthError | None = None
    registration_current: bool = True
    calibration_current: bool = True
    check_age_s: Reading = NOT_KNOWN
    armed_screens: int = 0
    lost_screens: int = 0
    free_disk_mb: Reading = NOT_KNOWN
    recording_runs: bool = True
    hold_requested_by: str = field(default="")
