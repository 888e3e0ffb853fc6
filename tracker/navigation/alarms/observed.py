"""What the alarms look at: a few numbers and flags of one moment, whatever they came from."""

from dataclasses import dataclass, field
from typing import TypeAlias

from tracker.camera import ControlChange
from tracker.navigation.clearance import MeasuredAgainst
from tracker.navigation.directions import Wall


@dataclass(frozen=True, slots=True)
class NotKnown:
    """A number that this moment does not say."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Site:
    """Where in the bone a number was measured.

    Attributes:
        wall: the nearest one; None where it is no matter of a wall.
        depth_mm: of the tip past the entry plane, as it is shown.
        against: what the wall was measured against; None where it is no matter of a wall.
        tool: which one, where there are several; else empty.
    """

    depth_mm: float
    wall: Wall | None = None
    against: MeasuredAgainst | None = None
    tool: str = ""


Reading: TypeAlias = float | NotKnown
NOT_KNOWN = NotKnown()


@dataclass(frozen=True, slots=True, kw_only=True)
class Observed:
    """One moment, with or without a new image. What is not said is well, or not known.

    Attributes:
        navigating: somebody navigates: plan, registration and drill were there and nobody has ended it. Most
            conditions say nothing before that. It stays so when one of them is lost.
        image_number: of the newest image; -1 before the first. A number that was not there before is a new
            image.
        captured_at_s: of that image, the same clock as the time of the step.
        clearance_mm: from the drill's cylinder to the pedicle's wall, negative through it.
        breach_ratio: probability that it is through the wall, now or within its look-ahead.
        wall_site: where that clearance was measured; None where it is not known.
        risk_site: where the tool is that the probability is of; None where that is not known.
        unseen_tools: that have no figures now, where there are several.
        past_depth_mm: how far the tip is past the planned end; negative before it.
        depth_site: where the tip is that is deepest; None where that is not known.
        tip_sd_mm: how unsure the tip is.
        max_tip_sd_mm: how unsure it may be, in this pedicle.
        drill_unseen_s: for how long the drill was not seen, up to the newest image; 0 while it is seen.
        drill_put_away: not seen for so long that it lies somewhere on purpose.
        reference_unseen_s: as for the drill; 0 when there is no patient reference.
        camera_silent_s: how old the newest image is.
        image_current: the newest image is not older than its limit, and camera and tracker work.
        camera_works: the source runs, or nobody knows while nothing tracks.
        tracker_works: what tracks in its images runs.
        pose_certain: the tip's uncertainty is small enough to be shown.
        pose_steady: the pose did not jump, and no second one explains the image as well.
        camera_in_place: it did not move since the registration.
        reference_in_place: it did not move since the registration.
        camera_change: the control of the camera that voids its calibration; None while none does.
        registration_current: it is not out of date.
        calibration_current: it is not out of date.
        check_age_s: since the last check on anatomy.
        armed_screens: how many screens would be heard.
        lost_screens: how many of those went without saying so.
        free_disk_mb: room where cases are kept.
        recording_runs: what should be written is written.
        hold_asked_by: who asks to hold; empty when nobody does.
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
    drill_unseen_s: float = 0.0
    drill_put_away: bool = False
    reference_unseen_s: float = 0.0
    camera_silent_s: float = 0.0
    image_current: bool = True
    camera_works: bool = True
    tracker_works: bool = True
    pose_certain: bool = True
    pose_steady: bool = True
    camera_in_place: bool = True
    reference_in_place: bool = True
    camera_change: ControlChange | None = None
    registration_current: bool = True
    calibration_current: bool = True
    check_age_s: Reading = NOT_KNOWN
    armed_screens: int = 0
    lost_screens: int = 0
    free_disk_mb: Reading = NOT_KNOWN
    recording_runs: bool = True
    hold_asked_by: str = field(default="")
