"""Labels of vertebrae from a segmentation of the CT: levels, counting, and start points for the pedicles."""

from tracker.plan.labels.counting import check_channel, check_levels
from tracker.plan.labels.label_volume import Labels, LabelVolume, VertebraLabel, measure_labels
from tracker.plan.labels.levels import (
    CLASS_OF_LEVEL,
    LEVEL_OF_CLASS,
    LEVELS,
    MAX_CLASS,
    level_from_name,
)

__all__ = [
    "CLASS_OF_LEVEL",
    "LEVELS",
    "LEVEL_OF_CLASS",
    "MAX_CLASS",
    "LabelVolume",
    "Labels",
    "VertebraLabel",
    "check_channel",
    "check_levels",
    "level_from_name",
    "measure_labels",
]
