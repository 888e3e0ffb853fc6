"""The active channel: the planned channel that is to be drilled now. Its document depends on the plan.

Changing from the left to the right pedicle must not invalidate the registration; a changed channel must.
A change of the plan that leaves the channel as it is renews the choice in the same transaction.
"""

from dataclasses import dataclass
from typing import cast

from server.store import CaseStore, Document, DocumentKind
from tracker.plan import Channel
from tracker.plan.document import channel_from_mapping
from tracker.plan.pedicle import Side, checked_side

# Name of the document; its kind is PLAN, like the plan itself.
ACTIVE_CHANNEL = "active channel"


@dataclass(frozen=True, slots=True, kw_only=True)
class ActiveChannel:
    """The channel that is to be drilled now.

    Attributes:
        vertebra: Name of the vertebra in the plan.
        side: Side of the patient.
        channel: The channel of the plan at the time of the selection.
    """

    vertebra: str
    side: Side
    channel: Channel


def active_channel_document(store: CaseStore, case_id: str) -> Document | None:
    """Return the document of the active channel; None without one, or if it is out of date."""
    return store.find_current(case_id, DocumentKind.PLAN, ACTIVE_CHANNEL)


def active_channel_from_document(document: Document) -> ActiveChannel:
    """Parse the active channel in a case document.

    Raises:
        PlanError: PLAN_INVALID, CHANNEL_INVALID.
        InvalidInput: SIDE_INVALID.
    """
    content = document.content
    return ActiveChannel(
        vertebra=str(content.get("vertebra")),
        side=checked_side(cast("str", content.get("side"))),
        channel=channel_from_mapping(content.get("channel")),
    )


def planned_ct_id(store: CaseStore, active: Document) -> str:
    """Return the id of the CT on which the active channel was planned; empty if its plan has none."""
    plan = store.document(active.case_id, active.depends_on[0])
    return plan.depends_on[0] if plan.depends_on else ""
