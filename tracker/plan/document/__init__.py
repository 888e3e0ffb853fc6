"""The plan document: records, validation and conversion to and from JSON-compatible mappings."""

from tracker.plan.document.corrections import CORRECTABLE, PedicleRecord, corrected_measure
from tracker.plan.document.mapping import (
    channel_from_mapping,
    measure_from_mapping,
    plain,
    plan_from_mapping,
    plan_to_mapping,
)
from tracker.plan.document.records import FORMAT_VERSION, PlanDocument, PlannedChannel, VertebraPlan
from tracker.plan.document.validation import validate_plan

__all__ = [
    "CORRECTABLE",
    "FORMAT_VERSION",
    "PedicleRecord",
    "PlanDocument",
    "PlannedChannel",
    "VertebraPlan",
    "channel_from_mapping",
    "corrected_measure",
    "measure_from_mapping",
    "plain",
    "plan_from_mapping",
    "plan_to_mapping",
    "validate_plan",
]
