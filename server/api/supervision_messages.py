"""What is told of the room and of signatures, and what a page may say in the room."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from server.api.case_messages import ImportedMessage, imported_message
from server.procedure.state.cosigned import Signed
from server.security import Role
from server.stream.message import Message
from server.supervision.asked import Asked
from server.supervision.marks import Drawing, Pointer, Shape
from server.supervision.people import LineState, Present, Seat, View
from server.supervision.signatures import Requirement, Signable
from server.supervision.told import Grown, News

Coordinate = Annotated[float, Field(ge=-1.0, le=8192.0, allow_inf_nan=False)]
PixelMessage = Annotated[list[Coordinate], Field(min_length=2, max_length=2)]
Seconds = Annotated[float, Field(ge=0.0, le=1e10, allow_inf_nan=False)]
Number = Annotated[int, Field(ge=0, le=2**53)]
MAX_POINTS_A_MESSAGE = 60
Points = Annotated[list[PixelMessage], Field(min_length=1, max_length=MAX_POINTS_A_MESSAGE)]


class PersonMessage(Message):
    """Somebody who is here, once, however many pages they have open."""

    name: str
    role: Role
    views: list[View]
    since: str
    """UTC, ISO 8601."""
    line: LineState
    """slow: answers take more than 0.5 s; silent: more than 2 s."""
    is_you: bool


class PointerMessage(Message):
    """Where somebody points; 2 s after its last move it is gone."""

    seat: int
    """The page that it comes from."""
    name: str
    role: Role
    at_px: list[float]
    """x, y in pixels of the whole image."""
    image_number: int
    """Of the image that they saw."""
    captured_at_s: float
    still_ms: float
    """Since its last move."""


class DrawingMessage(Message):
    """What is new of a drawing."""

    key: str
    seat: int
    name: str
    role: Role
    is_yours: bool
    shape: Shape
    image_number: int
    """Of the image that it was begun on."""
    captured_at_s: float
    left_s: float
    """How long it still stays."""
    from_point: int
    """The first of its points that is in this message; the ones before were told."""
    points_px: list[list[float]]
    """x, y in pixels of the whole image."""


class SignatureMessage(Message):
    """One signature that holds."""

    id: str
    by: str
    at: str
    is_yours: bool
    second_person: bool
    """Whether it is known that somebody else made what was signed; false where nobody signs in."""
    invited_by: str
    """Who had invited the signer; empty where that is not known."""
    invited_by_maker: bool
    """Who made what was signed had invited the signer, and may have invited themselves."""


class SignableMessage(Message):
    """The plan, or the registration of the vertebra that is to be drilled, with its signatures."""

    what: Signed
    requirement: Requirement
    document_id: str | None
    """Of the newest version; null where there is none."""
    title: str
    made_by: str
    """Who made it; of what came in with an archive, in words that say so."""
    made_at: str
    imported: ImportedMessage | None
    """That it came in with an archive; null where it was made here."""
    sha256: str
    """Of the content that a signature is bound to."""
    out_of_date: str
    """Why it does not hold; empty where it does."""
    signatures: list[SignatureMessage]
    """Of exactly this version."""
    is_cosigned: bool
    was_signed: bool
    """An earlier version was signed, this one is not."""


class SignaturesMessage(Message):
    """Plan and registration of the open case."""

    signable: list[SignableMessage]


class HoldMessage(Message):
    """Who asks to hold."""

    asked_by: list[str]
    since: str | None
    """When the first of them asked, UTC, ISO 8601; null where nobody does, or it is not known."""
    is_yours: bool
    """You are one of them."""


class YouMessage(Message):
    """Who you are in the room."""

    seat: int
    """0 where you have none."""
    name: str
    role: Role


class RoomMessage(Message):
    """The room, or what is new of it since the message before."""

    you: YouMessage
    fades_after_s: float
    """How long drawings stay, counted from the image that they were made on."""
    people: list[PersonMessage] | None
    """Null: as told before."""
    pointers: list[PointerMessage]
    """All of them."""
    drawings: list[str]
    """The keys of all drawings that are there."""
    grown: list[DrawingMessage]
    """What is new of them."""
    hold: HoldMessage
    signable: list[SignableMessage] | None
    """Null: as told before, or nothing is kept here."""


class SignatureRequest(Message):
    """Which version is signed."""

    what: Signed
    document_id: Annotated[str, Field(min_length=1, max_length=64)]


class PointSaid(Message):
    """Where you point."""

    at_px: PixelMessage
    image_number: Number
    captured_at_s: Seconds


class DrawSaid(Message):
    """A drawing that you begin."""

    key: Number
    """Chosen by you, another one for each drawing."""
    shape: Shape
    points_px: Points
    image_number: Number
    captured_at_s: Seconds


class ExtendSaid(Message):
    """More points of the pen."""

    key: Number
    points_px: Points


class Said(Message):
    """One thing that a page says in the room."""

    next: Literal[True] | None = None
    """The last message is dealt with: more may come."""
    point: PointSaid | None = None
    lift: Literal[True] | None = None
    """You point at nothing any more."""
    draw: DrawSaid | None = None
    extend: ExtendSaid | None = None
    undo: Literal[True] | None = None
    clear: Literal["own", "all"] | None = None

    @model_validator(mode="after")
    def _one_thing(self) -> Self:
        if sum(getattr(self, name) is not None for name in type(self).model_fields) != 1:
            raise ValueError("say one thing at a time")
        return self


def room_message(news: News, *, seat: Seat) -> RoomMessage:
    """What a page is told next."""
    picture, you = news.picture, seat.person
    return RoomMessage(
        you=YouMessage(seat=seat.number, name=you.name, role=you.role),
        fades_after_s=picture.fades_after_s,
        people=None if news.people is None else [_person(one, you.id) for one in news.people],
        pointers=[_pointer(one, picture.now_s) for one in picture.pointers],
        drawings=[one.key for one in picture.drawings],
        grown=[_drawing(one, you.id, left_s=_left_s(one.drawing, news)) for one in news.grown],
        hold=_hold(picture.holding, you.id),
        signable=None if news.signable is None else [signable_message(one, you.id) for one in news.signable],
    )


def signable_message(signable: Signable, your_id: str) -> SignableMessage:
    """Plan or registration with its signatures, as it is told."""
    return SignableMessage(
        what=signable.what,
        requirement=signable.requirement,
        document_id=signable.document_id or None,
        title=signable.title,
        made_by=signable.made_by,
        made_at=signable.made_at,
        imported=imported_message(signable.imported, said_maker=signable.said_maker),
        sha256=signable.sha256,
        out_of_date=signable.out_of_date,
        signatures=[
            SignatureMessage(
                id=one.id,
                by=one.by,
                at=one.at,
                is_yours=one.signer_id == your_id,
                second_person=one.second_person,
                invited_by=one.invited_by,
                invited_by_maker=one.invited_by_maker,
            )
            for one in signable.signatures
        ],
        is_cosigned=signable.is_cosigned,
        was_signed=signable.was_signed,
    )


def _hold(asking: tuple[Asked, ...], your_id: str) -> HoldMessage:
    return HoldMessage(
        asked_by=[one.name for one in asking],
        since=asking[0].at or None if asking else None,
        is_yours=any(one.person_id == your_id for one in asking),
    )


def _person(one: Present, your_id: str) -> PersonMessage:
    return PersonMessage(
        name=one.name,
        role=one.role,
        views=list(one.views),
        since=one.since,
        line=one.line,
        is_you=one.person_id == your_id,
    )


def _pointer(one: Pointer, now_s: float) -> PointerMessage:
    return PointerMessage(
        seat=one.seat,
        name=one.person.name,
        role=one.person.role,
        at_px=list(one.at_px),
        image_number=one.moment.image_number,
        captured_at_s=one.moment.captured_at_s,
        still_ms=1000.0 * (now_s - one.moved_at_s),
    )


def _left_s(drawing: Drawing, news: News) -> float:
    return drawing.moment.captured_at_s + news.picture.fades_after_s - news.picture.now_s


def _drawing(grown: Grown, your_id: str, *, left_s: float) -> DrawingMessage:
    one = grown.drawing
    return DrawingMessage(
        key=one.key,
        seat=one.seat,
        name=one.person.name,
        role=one.person.role,
        is_yours=one.person.id == your_id,
        shape=one.shape,
        image_number=one.moment.image_number,
        captured_at_s=one.moment.captured_at_s,
        left_s=left_s,
        from_point=grown.from_point,
        points_px=[list(point) for point in grown.points_px],
    )
