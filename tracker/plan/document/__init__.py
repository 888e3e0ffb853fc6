"""The plan as one document: plain records, to and from what JSON can hold."""

from tracker.plan.document.checks import reject_odd
from tracker.plan.document.corrections import CORRECTABLE, PedicleRecord, corrected_measure
from tracker.plan.document.mapping import (
    channel_from_mapping,
    measure_from_mapping,
    plain,
    plan_from_mapping,
    plan_to_mapping,
)
from tracker.plan.document.records import FORMAT_VERSION, PlanDocument, PlannedChannel, VertebraPlan

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
    "reject_odd",
]
