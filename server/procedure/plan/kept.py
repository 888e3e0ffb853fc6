"""The plan as the open case keeps it: read with its standing, and changed version by version."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import structlog

from server.errors import SetupOrderError
from server.procedure.ct import CtInUse, OpenedCt
from server.procedure.opened import opened_case
from server.procedure.plan.active import ACTIVE_CHANNEL, ActiveChannel, kept_channel
from server.store import CaseStore, Current, Document, DocumentKind, NewDocument, OutOfDateError, Standing
from tracker.errors import NavigationError, PlanError
from tracker.plan import Channel, PlanDocument, plan_from_mapping, plan_to_mapping
from tracker.plan.document import plain
from tracker.plan.document.changes import channel_of, vertebra_named
from tracker.plan.pedicle import Side

# A case has one plan, of all vertebrae; its document has this name.
MAIN_PLAN = "main"
log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class KeptPlan:
    """A plan with its document.

    Attributes:
        plan: what is planned.
        document: as it is stored.
        standing: whether it still holds.
        active: the channel that is to be drilled now, if one is chosen and the choice holds.
    """

    plan: PlanDocument
    document: Document
    standing: Standing
    active: ActiveChannel | None


class PlanRepository:
    """Where the plan of the open case lies; safe to use from any thread.

    Args:
        store: where it is kept.
        opened: the CT that it stands on.
    """

    def __init__(self, store: CaseStore, opened: OpenedCt) -> None:
        self._store = store
        self._opened = opened

    def latest(self) -> KeptPlan:
        """The newest plan of the open case.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
            PlanError: PLAN_INVALID.
        """
        case_id = opened_case(self._store).id
        document = self._store.latest(case_id, DocumentKind.PLAN, MAIN_PLAN)
        if document is None:
            raise SetupOrderError(
                "PLAN_MISSING",
                "the open case has no plan",
                "Begin one with a vertebra, or bring one as a file.",
                {"case_id": case_id},
            )
        return KeptPlan(
            plan=plan_from_mapping(document.content),
            document=document,
            standing=self._store.standing(document),
            active=self._active(case_id),
        )

    def latest_that_holds(self) -> KeptPlan:
        """The newest plan, if it stands on the CT that is there now.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
        """
        kept = self.latest()
        self._store.current(kept.document.case_id, DocumentKind.PLAN, MAIN_PLAN)
        return kept

    def to_change(self) -> tuple[PlanDocument, int, CtInUse]:
        """The plan that a change is made on, its version, and the CT; an empty plan where there is none.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CT_MISSING.
            OutOfDateError: PLAN_OUT_OF_DATE.
        """
        ct = self._opened.current()
        history = self._store.history(ct.document.case_id, DocumentKind.PLAN, MAIN_PLAN)
        if not history or history[-1].withdrawn is not None:
            return PlanDocument(), len(history), ct
        document = history[-1]
        standing = self._store.standing(document)
        if not isinstance(standing, Current):
            raise OutOfDateError(
                "PLAN_OUT_OF_DATE",
                f"the plan is out of date: {standing.reason}",
                "Send the whole plan again, after looking at it on this CT, or an empty one to begin anew.",
                {"version": document.version},
            )
        return plan_from_mapping(document.content), document.version, ct

    def change(
        self,
        made_by: str,
        expected_version: int | None,
        change: Callable[[PlanDocument, CtInUse], PlanDocument],
    ) -> KeptPlan:
        """Store what becomes of the plan by a change, as its next version.

        Args:
            made_by: who makes it.
            expected_version: of the plan that the change was thought for; the newest if None.
            change: gives the changed plan.

        Raises:
            StoreConflict: VERSION_CONFLICT.
        """
        plan, version, ct = self.to_change()
        if expected_version is not None and expected_version != version:
            version = expected_version  # The store tells the conflict.
        return self.put(change(plan, ct), ct, made_by=made_by, expected_version=version)

    def put(self, plan: PlanDocument, ct: CtInUse, *, made_by: str, expected_version: int | None) -> KeptPlan:
        """Store a plan as the next version; a channel that was active and is the same in it stays so.

        Raises:
            StoreConflict: VERSION_CONFLICT.
        """
        case_id = ct.document.case_id
        before = self._active(case_id)
        stays = before if before is not None and _has(plan, before) else None
        document = self._store.put(
            case_id,
            DocumentKind.PLAN,
            MAIN_PLAN,
            plan_to_mapping(plan),
            made_by=made_by,
            stands_on=[ct.document.id],
            expected_version=expected_version,
            # In one transaction: a plan that is seen without its channel stops navigation for a moment.
            with_it=lambda stored: [] if stays is None else [_new_active(stored, stays, made_by=made_by)],
        )
        return KeptPlan(plan=plan, document=document, standing=Current(), active=self._active(case_id))

    def activate(self, vertebra: str, side: Side, *, made_by: str) -> KeptPlan:
        """Make this the channel that is to be drilled now.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
            PlanError: VERTEBRA_UNKNOWN, CHANNEL_MISSING.
        """
        kept = self.latest_that_holds()
        channel = channel_of(vertebra_named(kept.plan, vertebra), side).channel
        self._store.put(
            kept.document.case_id,
            DocumentKind.PLAN,
            ACTIVE_CHANNEL,
            _active_content(ActiveChannel(vertebra=vertebra, side=side, channel=channel)),
            made_by=made_by,
            stands_on=[kept.document.id],
        )
        return self.latest()

    def deactivate(self, *, made_by: str) -> KeptPlan:
        """Have no channel to be drilled now.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
        """
        kept = self.latest()
        document = self._store.latest(kept.document.case_id, DocumentKind.PLAN, ACTIVE_CHANNEL)
        if document is not None:
            self._store.withdraw(document, by=made_by, reason="no channel is to be drilled now")
        return self.latest()

    def _active(self, case_id: str) -> ActiveChannel | None:
        document = self._store.latest(case_id, DocumentKind.PLAN, ACTIVE_CHANNEL)
        if document is None or not isinstance(self._store.standing(document), Current):
            return None
        try:
            return kept_channel(document)
        except NavigationError as error:
            log.warning(error.message, code=error.code, remedy=error.remedy, document=document.title)
            return None


def _new_active(plan: Document, active: ActiveChannel, *, made_by: str) -> NewDocument:
    """The choice of a channel, made again on this plan."""
    return NewDocument.checked(
        DocumentKind.PLAN, ACTIVE_CHANNEL, _active_content(active), made_by=made_by, stands_on=[plan.id]
    )


def _active_content(active: ActiveChannel) -> dict[str, object]:
    return {"vertebra": active.vertebra, "side": active.side, "channel": plain(active.channel)}


def _has(plan: PlanDocument, active: ActiveChannel) -> bool:
    """Whether the plan has the very same channel."""
    try:
        channel = channel_of(vertebra_named(plan, active.vertebra), active.side).channel
    except PlanError:
        return False
    return _is_same(channel, active.channel)


def _is_same(one: Channel, other: Channel) -> bool:
    return (
        one.name == other.name
        and one.radius_mm == other.radius_mm
        and np.array_equal(one.entry_in_vertebra_mm, other.entry_in_vertebra_mm)
        and np.array_equal(one.target_in_vertebra_mm, other.target_in_vertebra_mm)
    )
