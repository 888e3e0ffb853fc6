"""Labels of vertebrae from a segmentation of the CT: levels, counting, and start points for the pedicles."""

from tracker.plan.labels.agreement import check_measure
from tracker.plan.labels.counting import check_channel, check_levels
from tracker.plan.labels.label_volume import Labels, LabelVolume, VertebraLabel, measure_labels
from tracker.plan.labels.levels import (
    CLASS_OF_LEVEL,
    LEVEL_OF_CLASS,
    LEVELS,
    MAX_CLASS,
    level_from_name,
)
from tracker.plan.labels.outlines import LabelOutline, label_outlines
from tracker.plan.labels.start_points import StartPoint, pedicle_start_points

__all__ = [
    "CLASS_OF_LEVEL",
    "LEVELS",
    "LEVEL_OF_CLASS",
    "MAX_CLASS",
    "LabelOutline",
    "LabelVolume",
    "Labels",
    "StartPoint",
    "VertebraLabel",
    "check_channel",
    "check_levels",
    "check_measure",
    "label_outlines",
    "level_from_name",
    "measure_labels",
    "pedicle_start_points",
]
