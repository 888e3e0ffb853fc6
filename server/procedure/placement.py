"""Placed screws: where the drill stood in the bone when a person stated that the screw was placed.

A placement is a statement of a person about the newest image. It changes no limit and no alarm. It depends on
the registration of its vertebra: after a new one it is out of date, because both need not agree.
"""

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import structlog

from server.config import Point, Section
from server.errors import SetupOrderError
from server.live import LiveHub
from server.number_format import finite
from server.procedure.documents import parse_document
from server.procedure.open_case import require_open_case
from server.procedure.plan import ActiveChannel, PlanRepository, is_same_channel
from server.procedure.registration import RegistrationRepository
from server.store import CaseStore, Document, DocumentKind, Validity
from server.texts import WITHDRAWALS
from tracker.errors import NavigationError
from tracker.navigation import (
    Absent,
    Assessment,
    FigureName,
    NavigationSnapshot,
    PlacedScrew,
    ScrewSize,
    Status,
    Verdict,
)
from tracker.navigation.clearance import NearestWall
from tracker.navigation.directions import Wall
from tracker.navigation.figures import rounded_down
from tracker.plan import Channel
from tracker.plan.document import PlannedChannel
from tracker.plan.document.changes import channel_name, channel_of, vertebra_named
from tracker.plan.pedicle import Side
from tracker.plan.screw import GertzbeinRobbins

REMEDY = "Withdraw it, and state it again with the drill in place."
WAIT = "Wait until the video runs, then touch again."

log = structlog.get_logger(__name__)


class PlacedFigure(Section):
    """A figure as it was displayed; see `tracker.navigation.Figure`. None where it does not exist."""

    value: float | None
    limit: float | None
    error_95: float | None
    status: Status


class PlacementRecord(Section):
    """A placement as stored in a case."""

    vertebra: str
    side: Side
    run: str
    """Server run in which it was stated."""
    image_number: int
    tool: str
    tip_in_vertebra_mm: Point
    """Tip of the drill, LPS of the CT."""
    direction_in_vertebra: Point
    """Drilling direction, a unit vector."""
    head_in_vertebra_mm: Point
    """Where the axis of the drill meets the entry plane."""
    screw_tip_in_vertebra_mm: Point
    """End of the screw from there."""
    diameter_mm: float
    length_mm: float
    tip_ellipsoid_mm: list[Point] | None
    """3 half axes of the 95 % ellipsoid of the tip; None without a pedicle."""
    cone_95_deg: float | None
    verdict: Verdict
    wall: Wall | None
    """Wall nearest to the screw at the planned depth in this direction; None if unknown."""
    clearance_mm: float | None
    """From the screw's surface to it, rounded down; negative for a breach."""
    grade: GertzbeinRobbins | None
    figures: dict[FigureName, PlacedFigure]

    @property
    def screw(self) -> PlacedScrew:
        """The screw in the vertebra frame."""
        return PlacedScrew(
            name=channel_name(self.vertebra, self.side),
            head_in_vertebra_mm=np.array(self.head_in_vertebra_mm),
            tip_in_vertebra_mm=np.array(self.screw_tip_in_vertebra_mm),
            radius_mm=0.5 * self.diameter_mm,
        )


def placement_from_document(document: Document) -> PlacementRecord:
    """Parse the placement in a case document.

    Raises:
        InvalidInput: PLACEMENT_DOCUMENT_INVALID.
    """
    return parse_document(PlacementRecord, document, code="PLACEMENT_DOCUMENT_INVALID", remedy=REMEDY)


def placed_screws(documents: Iterable[Document], vertebra: str) -> tuple[PlacedScrew, ...]:
    """Return the screws that these documents place in a vertebra; unreadable ones are logged."""
    return tuple(record.screw for _, record in _readable(documents) if record.vertebra == vertebra)


def _readable(documents: Iterable[Document]) -> Iterator[tuple[Document, PlacementRecord]]:
    """Yield documents with their records, without those that cannot be read, which are logged."""
    for document in documents:
        try:
            yield document, placement_from_document(document)
        except NavigationError as error:
            log.warning(error.message, code=error.code, remedy=error.remedy, document=document.title)


@dataclass(frozen=True, slots=True, kw_only=True)
class Placement:
    """A placement with its document and validity."""

    record: PlacementRecord
    document: Document
    validity: Validity


@dataclass(frozen=True, slots=True, kw_only=True)
class ChannelState:
    """A planned channel, and how far it is.

    Attributes:
        vertebra, side: of the channel.
        channel: as planned.
        screw: the planned one; None if none is planned.
        is_active: whether it is the active channel.
        is_registered: whether its vertebra has a valid registration.
        placement: the screw placed in it; None if none is.
    """

    vertebra: str
    side: Side
    channel: Channel
    screw: ScrewSize | None
    is_active: bool
    is_registered: bool
    placement: Placement | None


class PlacementStep:
    """Stores placements in the open case. Thread-safe.

    Args:
        hub: the live images.
        store: the case store.
        plans: the plan of the open case.
        registrations: the registrations of the open case.
        run: name of this run of the server.
        max_age_s: an older image is not used.
        clock: the clock of the images' time stamps.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        store: CaseStore,
        plans: PlanRepository,
        registrations: RegistrationRepository,
        run: str,
        max_age_s: float,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._hub = hub
        self._store = store
        self._plans = plans
        self._registrations = registrations
        self._run = run
        self._max_age_s = max_age_s
        self._clock = clock

    def channels(self) -> tuple[ChannelState, ...]:
        """Return all planned channels of the open case in the order of the plan.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
            PlanError: PLAN_INVALID.
        """
        stored = self._plans.latest()
        case_id, active = stored.document.case_id, stored.active
        placed = {
            document.name: Placement(
                record=record, document=document, validity=self._store.validity(document)
            )
            for document, record in _readable(self._store.all(case_id, DocumentKind.PLACEMENT))
        }
        registered = {one.name for one in self._store.all_current(case_id, DocumentKind.REGISTRATION)}
        return tuple(
            ChannelState(
                vertebra=vertebra.name,
                side=channel.side,
                channel=channel.channel,
                screw=_planned_screw(channel),
                is_active=active is not None
                and (active.vertebra, active.side) == (vertebra.name, channel.side),
                is_registered=vertebra.name in registered,
                placement=placed.get(channel_name(vertebra.name, channel.side)),
            )
            for vertebra in stored.plan.vertebrae
            for channel in vertebra.channels
        )

    def place(self, vertebra: str, side: Side, *, made_by: str, size: ScrewSize | None = None) -> Document:
        """Store that the screw of the active channel stands where the drill is in the newest image.

        Args:
            vertebra: of the channel that the person was shown as active.
            side: of that channel.
            made_by: name of the person.
            size: of the screw; None for the planned one.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING, REGISTER_MISSING, PLACEMENT_NO_CHANNEL,
                PLACEMENT_OTHER_CHANNEL, PLACEMENT_NO_SCREW, PLACEMENT_NO_IMAGE, PLACEMENT_NO_NUMBERS,
                PLACEMENT_SETUP_CHANGED.
            OutOfDateError: the registration is out of date.
            RegistrationError: DRILL_NOT_IN_BONE, DRILL_NOT_IN_CHANNEL.
        """
        stored = self._plans.latest_valid()
        active = stored.active
        if active is None:
            raise SetupOrderError(
                "PLACEMENT_NO_CHANNEL",
                "no channel is active, so it is not known which screw was placed",
                "Select the channel that was drilled.",
            )
        if (active.vertebra, active.side) != (vertebra, side):
            raise SetupOrderError(
                "PLACEMENT_OTHER_CHANNEL",
                f"{active.channel.name} is the active channel now, not {channel_name(vertebra, side)}",
                "Select the channel that was drilled.",
                {"channel": active.channel.name, "stated_channel": channel_name(vertebra, side)},
            )
        registration = self._registrations.current(active.vertebra)
        planned = _planned_screw(channel_of(vertebra_named(stored.plan, active.vertebra), active.side))
        screw = size or planned
        if screw is None:
            raise SetupOrderError(
                "PLACEMENT_NO_SCREW",
                f"no screw is planned for {active.channel.name}, so its size is not known",
                "State diameter and length of the screw.",
                {"channel": active.channel.name},
            )
        snapshot = self._snapshot(active)
        shown = snapshot.setup.registration
        expected = registration.record.registration
        if isinstance(shown, Absent) or not np.array_equal(
            shown.anchor_from_vertebra.matrix, expected.anchor_from_vertebra.matrix
        ):
            raise _changed()
        record = self._record(snapshot, active, screw, is_planned=screw == planned)
        return self._store.put(
            stored.document.case_id,
            DocumentKind.PLACEMENT,
            channel_name(active.vertebra, active.side),
            record.model_dump(mode="json"),
            made_by=made_by,
            depends_on=[registration.document.id],
        )

    def withdraw(self, document_id: str, *, made_by: str) -> None:
        """Withdraw a placement.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLACEMENT_UNKNOWN.
            NotFound: DOCUMENT_UNKNOWN.
        """
        case = require_open_case(self._store)
        document = self._store.document(case.id, document_id)
        if document.kind is not DocumentKind.PLACEMENT:
            raise SetupOrderError(
                "PLACEMENT_UNKNOWN",
                f"{document.title} is not a placed screw",
                "GET /api/navigation/placements lists the placed screws.",
                {"title": document.title_text},
            )
        self._store.withdraw(document, by=made_by, reason=WITHDRAWALS["SCREW_NOT_PLACED"]["en"])

    def _snapshot(self, active: ActiveChannel) -> NavigationSnapshot:
        """Return the newest snapshot, which must be fresh and of this channel."""
        instant = self._hub.newest
        snapshot = None if instant is None else instant.snapshot
        if snapshot is None:
            raise SetupOrderError(
                "PLACEMENT_NO_IMAGE", "there is no image, so the position of the drill is not known", WAIT
            )
        age_s = self._clock() - snapshot.captured_at_s
        if age_s > self._max_age_s:
            raise SetupOrderError(
                "PLACEMENT_NO_IMAGE",
                f"the newest image is {age_s:.1f} s old, so the position of the drill is not known",
                WAIT,
                {"age_s": age_s},
            )
        channel = snapshot.setup.channel
        if isinstance(channel, Absent) or not is_same_channel(channel, active.channel):
            raise _changed()
        return snapshot

    def _record(
        self, snapshot: NavigationSnapshot, active: ActiveChannel, screw: ScrewSize, *, is_planned: bool
    ) -> PlacementRecord:
        tool = snapshot.displayed_tool
        pose = snapshot.vertebra_from_tool(tool) if tool else None
        assessment = snapshot.assessments.get(tool)
        if pose is None or isinstance(pose, Absent) or not isinstance(assessment, Assessment):
            reason = _reason(snapshot)
            raise SetupOrderError(
                "PLACEMENT_NO_NUMBERS",
                f"the newest image does not show where the drill is in the bone ({reason})",
                "Complete the steps that are due, hold drill and markers in view, then touch again.",
                {"reason": reason},
            )
        placed = PlacedScrew.on_drill(active.channel, pose, screw)
        analysis = snapshot.analyses[tool]
        spread = None if isinstance(analysis, Absent) else analysis.spread
        # Computed for the planned screw only.
        end = None if isinstance(analysis, Absent) or not is_planned else analysis.clearance.at_end
        wall = end if isinstance(end, NearestWall) else None
        return PlacementRecord(
            vertebra=active.vertebra,
            side=active.side,
            run=self._run,
            image_number=snapshot.image_number,
            tool=tool,
            tip_in_vertebra_mm=pose.translation_mm.tolist(),
            direction_in_vertebra=pose.rotate_directions([0.0, 0.0, 1.0]).tolist(),
            head_in_vertebra_mm=placed.head_in_vertebra_mm.tolist(),
            screw_tip_in_vertebra_mm=placed.tip_in_vertebra_mm.tolist(),
            diameter_mm=2.0 * screw.radius_mm,
            length_mm=screw.length_mm,
            tip_ellipsoid_mm=None if spread is None else spread.tip_ellipsoid_mm.tolist(),
            cone_95_deg=None if spread is None else spread.cone_95_deg,
            verdict=assessment.verdict,
            wall=None if wall is None else wall.wall,
            clearance_mm=None if wall is None else rounded_down(wall.clearance_mm),
            grade=None if wall is None else wall.grade,
            figures={
                name: PlacedFigure(
                    value=finite(one.value),
                    limit=finite(one.limit),
                    error_95=finite(one.error_95),
                    status=one.status,
                )
                for name, one in assessment.figures.items()
            },
        )


def _planned_screw(planned: PlannedChannel) -> ScrewSize | None:
    if not planned.screws:
        return None
    screw = planned.screws[0]
    return ScrewSize.of(diameter_mm=screw.diameter_mm, length_mm=screw.length_mm)


def _reason(snapshot: NavigationSnapshot) -> str:
    """Return the reasons why no tool has figures."""
    absent = {one.reason for one in snapshot.deviations.values() if isinstance(one, Absent)}
    return ", ".join(sorted(absent)) or "no tool"


def _changed() -> SetupOrderError:
    return SetupOrderError(
        "PLACEMENT_SETUP_CHANGED",
        "the newest image was computed with another channel or registration than the case has now",
        WAIT,
    )
