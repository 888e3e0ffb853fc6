"""Planning of channels and screws on the CT of the open case."""

from server.procedure.plan.active_channel import (
    ACTIVE_CHANNEL,
    ActiveChannel,
    active_channel_document,
    active_channel_from_document,
    planned_ct_id,
)
from server.procedure.plan.clearance import ActiveBone, NoClearance, PlannedClearance
from server.procedure.plan.exchange import export_plan, import_plan
from server.procedure.plan.picture import reference_picture, reference_slice
from server.procedure.plan.repository import PlanRepository, StoredPlan, is_same_channel
from server.procedure.plan.step import Author, PlanStep, Proposal

__all__ = [
    "ACTIVE_CHANNEL",
    "ActiveBone",
    "ActiveChannel",
    "Author",
    "NoClearance",
    "PlanRepository",
    "PlanStep",
    "PlannedClearance",
    "Proposal",
    "StoredPlan",
    "active_channel_document",
    "active_channel_from_document",
    "export_plan",
    "import_plan",
    "is_same_channel",
    "planned_ct_id",
    "reference_picture",
    "reference_slice",
]
