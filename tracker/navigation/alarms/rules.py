"""Alarm conditions and their rules: priority, confirmation and clearing, in one table.

A breach is confirmed by the second consecutive image with a breach, or after 80 ms without another image, and
is therefore raised within 250 ms (at most 175 ms from the capture with 20 to 80 ms of tracking). Missing data
does
not clear it: if the drill leaves the view, the alarm remains until it is acknowledged.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from types import MappingProxyType


class Priority(StrEnum):
    """Priority of an alarm."""

    HIGH = "high"
    MEDIUM = "medium"
    LOW = "low"

    @property
    def rank(self) -> int:
        """Return 3 for high, 2 for medium, 1 for low."""
        return _RANKS[self]


_RANKS = {Priority.HIGH: 3, Priority.MEDIUM: 2, Priority.LOW: 1}


class Kind(StrEnum):
    """Category of an alarm."""

    PHYSIOLOGICAL = "physiological"  # the drill in the bone
    TECHNICAL = "technical"  # the system itself
    ADVISORY = "advisory"  # a person asks for something; nothing is stopped or changed by it


class Condition(StrEnum):
    """Conditions that raise an alarm."""

    BREACH = "BREACH"  # some point of the drill's cylinder is through the pedicle wall
    PAST_DEPTH = "PAST_DEPTH"  # the tip is past the planned end
    BREACH_LIKELY = "BREACH_LIKELY"  # the probability of being through the wall is over its limit
    CLEARANCE_LOW = "CLEARANCE_LOW"  # less bone is left beside the drill than the warning distance
    DRILL_UNSEEN = "DRILL_UNSEEN"  # the drill's marker is not seen for longer than its limit
    REFERENCE_UNSEEN = "REFERENCE_UNSEEN"  # the patient's marker is not seen for longer than its limit
    MARKER_TWICE = "MARKER_TWICE"  # two prints of the drill's or the patient's marker are in view
    CAMERA_STALLED = "CAMERA_STALLED"  # no image arrived for longer than its limit
    CAMERA_GONE = "CAMERA_GONE"  # the camera is known to deliver no images
    TRACKING_STOPPED = "TRACKING_STOPPED"  # the process that tracks is known not to run
    POSE_UNCERTAIN = "POSE_UNCERTAIN"  # the uncertainty of the tip exceeds the tolerance of the pedicle
    SETUP_INSUFFICIENT = "SETUP_INSUFFICIENT"  # it does in every image with this registration and tool
    POSE_JUMPED = "POSE_JUMPED"  # the pose is ambiguous, or moved faster than a hand
    CAMERA_MOVED = "CAMERA_MOVED"  # since the registration
    REFERENCE_MOVED = "REFERENCE_MOVED"  # since the registration
    CAMERA_CHANGED = "CAMERA_CHANGED"  # focus or zoom, since the calibration in use
    FOCAL_LENGTH_DOUBTFUL = "FOCAL_LENGTH_DOUBTFUL"  # the perspective of the markers contradicts it
    REGISTRATION_OUT_OF_DATE = "REGISTRATION_OUT_OF_DATE"
    CALIBRATION_OUT_OF_DATE = "CALIBRATION_OUT_OF_DATE"
    CHECK_DUE = "CHECK_DUE"  # the check on anatomy is older than its limit
    NO_ARMED_SCREEN = "NO_ARMED_SCREEN"  # no screen would be heard
    DISK_NEARLY_FULL = "DISK_NEARLY_FULL"
    VIEWER_LOST = "VIEWER_LOST"  # a screen with armed sound disconnected without notice
    RECORDING_STOPPED = "RECORDING_STOPPED"  # a recording, or the alarm log itself, is not written
    HOLD_REQUESTED = "HOLD_REQUESTED"  # a supervising clinician asks to hold


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmRule:
    """Rule by which a condition is raised and cleared.

    Attributes:
        priority: priority of the alarm.
        kind: category of the alarm.
        latches: once raised, the alarm stays displayed until acknowledged, even if cleared.
        confirm_s: minimum uninterrupted presence before the alarm is raised; 0 raises it at once.
        confirm_images: number of consecutive images that raise it before that time; 0 uses the time only.
        clear_s: minimum uninterrupted absence before the alarm is cleared, and therefore the minimum time
            between two alarms of one condition.
        persists_when_unknown: an unknown state does not clear the alarm. Otherwise unknown counts as absent,
            because another alarm reports it.
        outside_navigation: evaluated outside navigation too.
        needs_current_image: the condition is evaluated on the newest image, and unknown while that is old.
    """

    priority: Priority
    kind: Kind
    latches: bool = False
    confirm_s: float = 0.0
    confirm_images: int = 0
    clear_s: float = 1.0
    persists_when_unknown: bool = False
    outside_navigation: bool = False
    needs_current_image: bool = False


def _in_the_bone() -> AlarmRule:
    # Raised within 250 ms of the image, but not by a single image with a reflection: by the second image, 33
    # ms later at 30 Hz, or after this time without one.
    return AlarmRule(
        priority=Priority.HIGH,
        kind=Kind.PHYSIOLOGICAL,
        latches=True,
        confirm_s=0.08,
        confirm_images=2,
        persists_when_unknown=True,
    )


def _nearly() -> AlarmRule:
    # Noise of a good pose near the limit does not exceed it for half a second without interruption.
    return AlarmRule(priority=Priority.MEDIUM, kind=Kind.PHYSIOLOGICAL, confirm_s=0.5, clear_s=2.0)


def _technical(
    priority: Priority, *, confirm_s: float = 0.0, clear_s: float = 1.0, outside_navigation: bool = False
) -> AlarmRule:
    return AlarmRule(
        priority=priority,
        kind=Kind.TECHNICAL,
        confirm_s=confirm_s,
        clear_s=clear_s,
        outside_navigation=outside_navigation,
    )


def _of_newest_image(*, confirm_s: float = 0.0, clear_s: float = 1.0) -> AlarmRule:
    """Return a rule on the visibility or pose of a marker: unknown while no new image is tracked."""
    trait = _technical(Priority.MEDIUM, confirm_s=confirm_s, clear_s=clear_s)
    return replace(trait, needs_current_image=True)


ALARM_RULES: Mapping[Condition, AlarmRule] = MappingProxyType(
    {
        Condition.BREACH: _in_the_bone(),
        Condition.PAST_DEPTH: _in_the_bone(),
        Condition.BREACH_LIKELY: _nearly(),
        Condition.CLEARANCE_LOW: _nearly(),
        # No confirmation time, because the limits are themselves times.
        Condition.DRILL_UNSEEN: _of_newest_image(),
        Condition.REFERENCE_UNSEEN: _of_newest_image(),
        Condition.MARKER_TWICE: _of_newest_image(),
        Condition.CAMERA_STALLED: _technical(Priority.MEDIUM),
        Condition.CAMERA_GONE: _technical(Priority.MEDIUM),
        Condition.TRACKING_STOPPED: _technical(Priority.MEDIUM),
        Condition.POSE_UNCERTAIN: _of_newest_image(confirm_s=0.5, clear_s=2.0),
        # Evaluated before navigation too, because it does not depend on the view of the marker.
        Condition.SETUP_INSUFFICIENT: _of_newest_image(confirm_s=0.5, clear_s=2.0),
        Condition.POSE_JUMPED: _of_newest_image(clear_s=2.0),
        Condition.CAMERA_MOVED: _technical(Priority.HIGH),
        Condition.REFERENCE_MOVED: _technical(Priority.HIGH),
        Condition.CAMERA_CHANGED: _technical(Priority.HIGH),
        # During set-up too, where the camera can still be calibrated again before anything depends on it.
        Condition.FOCAL_LENGTH_DOUBTFUL: _technical(Priority.MEDIUM, outside_navigation=True),
        Condition.REGISTRATION_OUT_OF_DATE: _technical(Priority.HIGH),
        Condition.CALIBRATION_OUT_OF_DATE: _technical(Priority.HIGH),
        Condition.CHECK_DUE: _technical(Priority.LOW),
        # A page that is reloaded reconnects within this time.
        Condition.NO_ARMED_SCREEN: _technical(Priority.LOW, confirm_s=5.0),
        Condition.DISK_NEARLY_FULL: _technical(Priority.LOW, clear_s=10.0, outside_navigation=True),
        Condition.VIEWER_LOST: _technical(Priority.LOW),
        Condition.RECORDING_STOPPED: _technical(Priority.LOW, outside_navigation=True),
        Condition.HOLD_REQUESTED: AlarmRule(
            priority=Priority.MEDIUM, kind=Kind.ADVISORY, clear_s=0.0, outside_navigation=True
        ),
    }
)
