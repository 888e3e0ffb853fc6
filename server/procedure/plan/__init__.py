"""The step in which channels and screws are planned on the CT of the open case."""

from server.procedure.plan.active import ACTIVE_CHANNEL, ActiveChannel, kept_channel
from server.procedure.plan.exchange import plan_in, plan_out
from server.procedure.plan.kept import KeptPlan, PlanRepository
from server.procedure.plan.picture import reference_picture, reference_slice
from server.procedure.plan.step import Author, PlanStep, Proposal

__all__ = [
    "ACTIVE_CHANNEL",
    "ActiveChannel",
    "Author",
    "KeptPlan",
    "PlanRepository",
    "PlanStep",
    "Proposal",
    "kept_channel",
    "plan_in",
    "plan_out",
    "reference_picture",
    "reference_slice",
]
