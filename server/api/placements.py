"""Placed screws: the planned channels with their state, and where the screws were placed."""

from typing import Annotated

from fastapi import APIRouter
from pydantic import Field

from server.api.errors import rejections
from server.api.requester import MadeBy, MadeByQuery
from server.procedure.placement import ChannelState, Placement, PlacementStep
from server.store import OutOfDate
from server.stream.message import Message
from server.stream.snapshot_messages import ScrewMessage, screw_message
from server.texts import requested_language
from tracker.errors import InvalidInput
from tracker.navigation import FigureName, ScrewSize, Status, Verdict
from tracker.navigation.directions import Wall
from tracker.plan.pedicle import Side
from tracker.plan.screw import GertzbeinRobbins

Millimetres = Annotated[float, Field(gt=0.0, le=200.0)]


class PlacedFigureMessage(Message):
    """A figure as it was displayed; null where it did not exist."""

    value: float | None
    limit: float | None
    error_95: float | None
    status: Status


class PlacementMessage(Message):
    """A placed screw, and the figures of the drill at that moment."""

    document_id: str
    placed_at: str
    """UTC, ISO 8601."""
    placed_by: str
    out_of_date: str | None
    """Why it does not agree with the present registration; null if it does."""
    tool: str
    image_number: int
    screw: ScrewMessage
    verdict: Verdict
    wall: Wall | None
    """Wall nearest to the screw; null if unknown, as for another size than the planned one."""
    clearance_mm: float | None
    """From the screw's surface to it; negative for a breach."""
    grade: GertzbeinRobbins | None
    figures: dict[FigureName, PlacedFigureMessage]


class ChannelStateMessage(Message):
    """A planned channel, and how far it is."""

    vertebra: str
    side: Side
    screw: ScrewMessage | None
    """The planned one; null if none is planned."""
    is_active: bool
    is_registered: bool
    """Whether its vertebra has a valid registration."""
    placement: PlacementMessage | None
    """Null while no screw is placed."""


class PlacementsMessage(Message):
    """All planned channels in the order of the plan."""

    channels: list[ChannelStateMessage]


class PlaceRequest(Message):
    """The screw of the active channel is placed where the drill is now."""

    made_by: MadeBy
    vertebra: str
    """Of the channel that is meant; rejected if another one is active by now."""
    side: Side
    diameter_mm: Millimetres | None = None
    """Of the screw; default: the planned one."""
    length_mm: Millimetres | None = None


def placements_router(step: PlacementStep) -> APIRouter:
    """Return the router of `/api/navigation/placements`; synchronous because it waits for the disk."""
    router = APIRouter(prefix="/api/navigation/placements", tags=["navigation"])

    def message() -> PlacementsMessage:
        return PlacementsMessage(channels=[_channel(one) for one in step.channels()])

    @router.get("", responses=rejections(409, 422, 503))
    def placements() -> PlacementsMessage:
        """Return the planned channels with their state and the screws placed in them."""
        return message()

    @router.post("", status_code=201, responses=rejections(409, 422, 503, 507))
    def place(requested: PlaceRequest) -> PlacementsMessage:
        """Store that the screw of the active channel stands where the drill is in the newest image."""
        step.place(requested.vertebra, requested.side, made_by=requested.made_by, size=_size(requested))
        return message()

    @router.delete("/{document_id}", responses=rejections(404, 409, 422, 503, 507))
    def withdraw(document_id: str, made_by: MadeByQuery) -> PlacementsMessage:
        """Withdraw a placement."""
        step.withdraw(document_id, made_by=made_by)
        return message()

    return router


def _size(requested: PlaceRequest) -> ScrewSize | None:
    if (requested.diameter_mm is None) != (requested.length_mm is None):
        raise InvalidInput(
            "SCREW_INCOMPLETE",
            "only one of diameter_mm and length_mm was given",
            "Give both, or none for the planned screw.",
        )
    if requested.diameter_mm is None or requested.length_mm is None:
        return None
    return ScrewSize.of(diameter_mm=requested.diameter_mm, length_mm=requested.length_mm)


def _channel(state: ChannelState) -> ChannelStateMessage:
    return ChannelStateMessage(
        vertebra=state.vertebra,
        side=state.side,
        screw=screw_message(state.screw),
        is_active=state.is_active,
        is_registered=state.is_registered,
        placement=None if state.placement is None else _placement(state.placement),
    )


def _placement(placement: Placement) -> PlacementMessage:
    record, document, validity = placement.record, placement.document, placement.validity
    return PlacementMessage(
        document_id=document.id,
        placed_at=document.made_at,
        placed_by=document.maker,
        out_of_date=validity.why.message[requested_language()] if isinstance(validity, OutOfDate) else None,
        tool=record.tool,
        image_number=record.image_number,
        screw=ScrewMessage(diameter_mm=record.diameter_mm, length_mm=record.length_mm),
        verdict=record.verdict,
        wall=record.wall,
        clearance_mm=record.clearance_mm,
        grade=record.grade,
        figures={
            name: PlacedFigureMessage.model_validate(one, from_attributes=True)
            for name, one in record.figures.items()
        },
    )
