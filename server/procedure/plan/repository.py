"""Repository of the plan in the open case: read with its validity, and changed by new versions."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import structlog

from server.errors import SetupOrderError
from server.procedure.ct import CtProvider, MappedCt
from server.procedure.labels import LabelProvider
from server.procedure.open_case import require_open_case
from server.procedure.plan.active_channel import (
    ACTIVE_CHANNEL,
    ActiveChannel,
    active_channel_document,
    active_channel_from_document,
)
from server.store import CaseStore, Current, Document, DocumentKind, NewDocument, OutOfDateError, Validity
from server.texts import WITHDRAWALS
from tracker.errors import NavigationError, PlanError
from tracker.plan import Channel, PlanDocument, plan_from_mapping, plan_to_mapping
from tracker.plan.document import plain
from tracker.plan.document.changes import channel_of, vertebra_named
from tracker.plan.labels import check_channel, check_measure
from tracker.plan.pedicle import PedicleMeasure, Side

# A case has one plan, of all vertebrae; its document has this name.
MAIN_PLAN = "main"
log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredPlan:
    """A plan with its document.

    Attributes:
        plan: the plan.
        document: the stored document.
        validity: whether it is still valid.
        active: the active channel, if one is chosen and the choice is valid.
    """

    plan: PlanDocument
    document: Document
    validity: Validity
    active: ActiveChannel | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ChannelLevel:
    """In the label of which level a planned channel lies.

    Attributes:
        vertebra: name of the vertebra in the plan.
        side: of the patient.
        level: the level, which is that of the vertebra; empty if nothing can be compared.
        problem: LEVEL_DOUBTFUL, if it lies in the label of another level; else None.
    """

    vertebra: str
    side: Side
    level: str
    problem: PlanError | None


class PlanRepository:
    """Reads and stores the plan of the open case. Thread-safe.

    Args:
        store: the case store.
        ct_provider: the CT that the plan depends on.
        labels: the labels that channels are compared with.
    """

    def __init__(self, store: CaseStore, ct_provider: CtProvider, labels: LabelProvider) -> None:
        self._store = store
        self._ct_provider = ct_provider
        self._labels = labels

    def latest(self) -> StoredPlan:
        """Return the newest plan of the open case.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
            PlanError: PLAN_INVALID.
        """
        case_id = require_open_case(self._store).id
        document = self._store.latest(case_id, DocumentKind.PLAN, MAIN_PLAN)
        if document is None:
            raise SetupOrderError(
                "PLAN_MISSING",
                "the open case has no plan",
                "Add a vertebra to start a plan, or import a plan from a file.",
                {"case_id": case_id},
            )
        return StoredPlan(
            plan=plan_from_mapping(document.content),
            document=document,
            validity=self._store.validity(document),
            active=self._active(case_id),
        )

    def latest_valid(self) -> StoredPlan:
        """Return the newest plan, if it depends on the current CT.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
        """
        stored = self.latest()
        self._store.current(stored.document.case_id, DocumentKind.PLAN, MAIN_PLAN)
        return stored

    def for_editing(self) -> tuple[PlanDocument, int, MappedCt]:
        """Return the plan to change, its version, and the CT; an empty plan if there is none.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CT_MISSING.
            OutOfDateError: PLAN_OUT_OF_DATE.
        """
        ct = self._ct_provider.current()
        newest = self._store.newest_heading(ct.document.case_id, DocumentKind.PLAN, MAIN_PLAN)
        if newest is None or not newest.is_usable:
            return PlanDocument(), 0 if newest is None else newest.version, ct
        document = self._store.document(newest.case_id, newest.id)
        validity = self._store.validity(document)
        if not isinstance(validity, Current):
            raise OutOfDateError(
                "PLAN_OUT_OF_DATE",
                f"the plan is out of date: {validity.reason}",
                "Review the plan on this CT and store it again completely, or store an empty plan.",
                {"version": document.version, "reason": validity.why.message},
            )
        return plan_from_mapping(document.content), document.version, ct

    def change(
        self,
        made_by: str,
        expected_version: int | None,
        change: Callable[[PlanDocument, MappedCt], PlanDocument],
    ) -> StoredPlan:
        """Apply a change to the plan, and store the result as its next version.

        Args:
            made_by: author of the change.
            expected_version: version of the plan that the change was made for; the newest if None.
            change: returns the changed plan.

        Raises:
            StoreConflict: VERSION_CONFLICT.
        """
        plan, version, ct = self.for_editing()
        if expected_version is not None and expected_version != version:
            version = expected_version  # The store raises the conflict.
        return self.put(change(plan, ct), ct, made_by=made_by, expected_version=version)

    def put(
        self, plan: PlanDocument, ct: MappedCt, *, made_by: str, expected_version: int | None
    ) -> StoredPlan:
        """Store a plan as the next version; the active channel stays active if it is unchanged in it.

        Raises:
            StoreConflict: VERSION_CONFLICT.
            PlanError: LEVEL_DOUBTFUL, a new channel lies in the label of another level.
        """
        case_id = ct.document.case_id
        self._check_new_channels(case_id, plan)
        before = self._active(case_id)
        stays = before if before is not None and _has(plan, before) else None
        document = self._store.put(
            case_id,
            DocumentKind.PLAN,
            MAIN_PLAN,
            plan_to_mapping(plan),
            made_by=made_by,
            depends_on=[ct.document.id],
            expected_version=expected_version,
            # In one transaction: a plan without its active channel would interrupt navigation.
            companions=lambda stored: [] if stays is None else [_new_active(stored, stays, made_by=made_by)],
        )
        return StoredPlan(plan=plan, document=document, validity=Current(), active=self._active(case_id))

    def activate(self, vertebra: str, side: Side, *, made_by: str) -> StoredPlan:
        """Make this the active channel, which is to be drilled now.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
            PlanError: VERTEBRA_UNKNOWN, CHANNEL_MISSING; LEVEL_DOUBTFUL, it lies in another level.
        """
        stored = self.latest_valid()
        channel = channel_of(vertebra_named(stored.plan, vertebra), side).channel
        labels = self._labels.current()
        if labels is not None:
            check_channel(labels.volume, vertebra, channel)
        self._store.put(
            stored.document.case_id,
            DocumentKind.PLAN,
            ACTIVE_CHANNEL,
            _active_content(ActiveChannel(vertebra=vertebra, side=side, channel=channel)),
            made_by=made_by,
            depends_on=[stored.document.id],
        )
        return self.latest()

    def deactivate(self, *, made_by: str) -> StoredPlan:
        """Unset the active channel.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
        """
        stored = self.latest()
        document = self._store.latest(stored.document.case_id, DocumentKind.PLAN, ACTIVE_CHANNEL)
        if document is not None:
            self._store.withdraw(document, by=made_by, reason=WITHDRAWALS["CHANNEL_UNSET"]["en"])
        return self.latest()

    def check_measure(self, vertebra: str, measure: PedicleMeasure) -> None:
        """Reject a measured pedicle that contradicts the labels, if the case has any.

        Raises:
            PlanError: LEVEL_DOUBTFUL, PEDICLE_DOUBTFUL.
        """
        labels = self._labels.current()
        if labels is not None:
            check_measure(labels.volume, vertebra, measure)

    def channel_levels(self) -> tuple[ChannelLevel, ...]:
        """Return for each channel of the newest plan in the label of which level it lies.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
        """
        plan, labels = self.latest().plan, self._labels.current()
        found = []
        for vertebra in plan.vertebrae:
            for planned in vertebra.channels:
                level, problem = "", None
                try:
                    if labels is not None:
                        level = check_channel(labels.volume, vertebra.name, planned.channel)
                except PlanError as error:
                    problem = error
                found.append(
                    ChannelLevel(vertebra=vertebra.name, side=planned.side, level=level, problem=problem)
                )
        return tuple(found)

    def _check_new_channels(self, case_id: str, plan: PlanDocument) -> None:
        """Reject channels in the label of another level; others may be corrected one after the other."""
        labels = self._labels.current()
        if labels is None:
            return
        before = self._store.latest(case_id, DocumentKind.PLAN, MAIN_PLAN)
        known = [] if before is None else _channels(plan_from_mapping(before.content))
        for name, channel in _channels(plan):
            if not any(name == one and is_same_channel(channel, other) for one, other in known):
                check_channel(labels.volume, name, channel)

    def _active(self, case_id: str) -> ActiveChannel | None:
        document = active_channel_document(self._store, case_id)
        if document is None:
            return None
        try:
            return active_channel_from_document(document)
        except NavigationError as error:
            log.warning(error.message, code=error.code, remedy=error.remedy, document=document.title)
            return None


def _new_active(plan: Document, active: ActiveChannel, *, made_by: str) -> NewDocument:
    """Return a document that makes the channel active on this version of the plan."""
    return NewDocument.validated(
        DocumentKind.PLAN, ACTIVE_CHANNEL, _active_content(active), made_by=made_by, depends_on=[plan.id]
    )


def _active_content(active: ActiveChannel) -> dict[str, object]:
    return {"vertebra": active.vertebra, "side": active.side, "channel": plain(active.channel)}


def _has(plan: PlanDocument, active: ActiveChannel) -> bool:
    """Return whether the plan contains exactly the same channel."""
    try:
        channel = channel_of(vertebra_named(plan, active.vertebra), active.side).channel
    except PlanError:
        return False
    return is_same_channel(channel, active.channel)


def _channels(plan: PlanDocument) -> list[tuple[str, Channel]]:
    """Return all channels with the names of their vertebrae."""
    return [(one.name, planned.channel) for one in plan.vertebrae for planned in one.channels]


def is_same_channel(one: Channel, other: Channel) -> bool:
    """Return whether two channels are equal to the last digit."""
    return (
        one.name == other.name
        and one.radius_mm == other.radius_mm
        and np.array_equal(one.entry_in_vertebra_mm, other.entry_in_vertebra_mm)
        and np.array_equal(one.target_in_vertebra_mm, other.target_in_vertebra_mm)
    )
