"""From where on something is an alarm. The values come from the settings; here they have names and units."""

from dataclasses import dataclass

MAX_PAUSE_S = 120.0


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmLimits:
    """Each limit raises; the hysteresis beside it is how much better it must be to clear.

    Attributes:
        warning_distance_mm: less bone than this beside the drill.
        hysteresis_mm: of clearance, depth and uncertainty.
        breach_ratio: probability of being through the wall.
        breach_hysteresis_ratio: of that probability.
        again_after_mm: an acknowledged breach that gets deeper by this sounds again.
        drill_unseen_after_s: the drill's marker.
        reference_unseen_after_s: the patient's marker.
        camera_silent_after_s: no image.
        check_due_after_s: the last check on anatomy.
        min_free_disk_mb: room where cases are kept; clear with a tenth more.
    """

    warning_distance_mm: float = 1.0
    hysteresis_mm: float = 0.3
    breach_ratio: float = 0.05
    breach_hysteresis_ratio: float = 0.02
    again_after_mm: float = 1.0
    drill_unseen_after_s: float = 1.0
    reference_unseen_after_s: float = 1.0
    camera_silent_after_s: float = 0.5
    check_due_after_s: float = 1800.0
    min_free_disk_mb: float = 2000.0
