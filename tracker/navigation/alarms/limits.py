"""Alarm limits, with names and units; the values come from the settings."""

from dataclasses import dataclass

MAX_PAUSE_S = 120.0


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmLimits:
    """Limits that raise an alarm, and the hysteresis for clearing it.

    Attributes:
        warning_distance_mm: minimum clearance of the drill.
        hysteresis_mm: of clearance, depth and uncertainty.
        breach_ratio: maximum probability of a breach.
        breach_hysteresis_ratio: of that probability.
        realarm_after_mm: an acknowledged breach sounds again when it gets deeper by this.
        drill_unseen_after_s: maximum time without the drill's marker.
        reference_unseen_after_s: maximum time without the patient's marker.
        camera_silent_after_s: maximum time without an image.
        check_due_after_s: maximum age of the last check on anatomy.
        min_free_disk_mb: minimum free space on the disk of the cases; clears at 10 % more.
    """

    warning_distance_mm: float = 1.0
    hysteresis_mm: float = 0.3
    breach_ratio: float = 0.05
    breach_hysteresis_ratio: float = 0.02
    realarm_after_mm: float = 1.0
    drill_unseen_after_s: float = 1.0
    reference_unseen_after_s: float = 1.0
    camera_silent_after_s: float = 0.5
    check_due_after_s: float = 1800.0
    min_free_disk_mb: float = 2000.0
