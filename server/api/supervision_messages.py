"""Messages of the room and of signatures, and commands of a client in the room."""

from collections.abc import Sequence
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from server.api.case_messages import ImportedMessage, imported_message
from server.procedure.state.cosignatures import CosignTarget
from server.security import Role
from server.stream.message import Message
from server.supervision.hold_storage import HoldRequest
from server.supervision.marks import CutPlane, Drawing, Pointer, Shape, Vector
from server.supervision.participants import (
    ConnectionState,
    Freshness,
    Look,
    PageLook,
    Participant,
    Picture,
    RoomSession,
    View,
    ViewPart,
)
from server.supervision.room_updates import DrawingExtension, RoomUpdate
from server.supervision.signatures import Requirement, Signable
from server.texts import requested_language

Coordinate = Annotated[float, Field(ge=-200.0, le=8192.0, allow_inf_nan=False)]
MarkPointMessage = Annotated[list[Coordinate], Field(min_length=2, max_length=2)]
# A scanner's origin may be far from the patient.
PatientCoordinate = Annotated[float, Field(ge=-1e4, le=1e4, allow_inf_nan=False)]
Position = Annotated[list[PatientCoordinate], Field(min_length=3, max_length=3)]
Direction = Annotated[
    list[Annotated[float, Field(ge=-1.0, le=1.0, allow_inf_nan=False)]], Field(min_length=3, max_length=3)
]
# The page rounds directions to 5 digits.
MAX_DIRECTION_ERROR = 1e-3
Seconds = Annotated[float, Field(ge=0.0, le=1e10, allow_inf_nan=False)]
Number = Annotated[int, Field(ge=0, le=2**53)]
MAX_POINTS_A_MESSAGE = 60
Points = Annotated[list[MarkPointMessage], Field(min_length=1, max_length=MAX_POINTS_A_MESSAGE)]


class PageMessage(Message):
    """An open page of a person, and what it shows."""

    view: View
    part: ViewPart | None
    """Layout, or page of the operator's view; null where the view has none or has not reported it."""
    pictures: list[Picture]
    """Visible pictures, the largest first."""
    freshness: Freshness
    """old: picture and figures are covered; hidden: page in the background; unknown: no report or answer."""
    max_age_ms: float | None
    """Upper limit of the age on this page in the last second, in steps; null if it is not live."""


class PersonMessage(Message):
    """A person in the room, listed once for all their pages."""

    name: str
    role: Role
    pages: list[PageMessage]
    """Pages that show the same are listed once."""
    since: str
    """UTC, ISO 8601."""
    line: ConnectionState
    """slow: answers take more than 0.5 s; silent: more than 2 s."""
    is_you: bool


class CutPlaneMessage(Message):
    """The plane of a cut of the CT."""

    ct_id: Annotated[str, Field(min_length=1, max_length=64)]
    """Of the CT in whose frame the plane is stated, as in the channel of the live message."""
    origin_in_vertebra_mm: Position
    """The plane's point (0, 0)."""
    right_in_vertebra: Direction
    down_in_vertebra: Direction
    """Orthogonal unit directions of x and y."""

    @model_validator(mode="after")
    def _orthonormal(self) -> Self:
        right, down = self.right_in_vertebra, self.down_in_vertebra
        products = (_dot(right, right) - 1.0, _dot(down, down) - 1.0, _dot(right, down))
        if max(map(abs, products)) > MAX_DIRECTION_ERROR:
            raise ValueError("the directions of a plane must be orthogonal unit vectors")
        return self


class PointerMessage(Message):
    """A pointer; it disappears 2 s after its last move."""

    seat: int
    """Number of the page that it comes from."""
    name: str
    role: Role
    at: list[float]
    """x, y in pixels of the full-size image; with a plane, in mm on it."""
    plane: CutPlaneMessage | None
    """Plane of the cut that it is on; null on the video."""
    image_number: int
    """Number of the image it refers to."""
    captured_at_s: float
    still_ms: float
    """Time since its last move."""


class DrawingMessage(Message):
    """New points of a drawing."""

    key: str
    seat: int
    name: str
    role: Role
    is_yours: bool
    shape: Shape
    image_number: int
    """Number of the image on which it was started."""
    captured_at_s: float
    left_s: float
    """Remaining display time."""
    from_point: int
    """Index of the first point in this message; earlier ones were sent before."""
    points: list[list[float]]
    """x, y in pixels of the full-size image; with a plane, in mm on it."""
    plane: CutPlaneMessage | None
    """Plane of the cut that it was drawn on; null on the video."""


class SignatureMessage(Message):
    """A valid signature."""

    id: str
    by: str
    at: str
    is_yours: bool
    second_person: bool
    """Whether author and signer are known to differ; false if sign-in is off."""
    invited_by: str
    """Who invited the signer; empty if unknown."""
    invited_by_maker: bool
    """The author of the document invited the signer, and may be the same person."""


class SignableMessage(Message):
    """The plan, or the registration of the active vertebra, with its signatures."""

    what: CosignTarget
    requirement: Requirement
    document_id: str | None
    """Id of the newest version; null if there is none."""
    title: str
    made_by: str
    """Author; for imported documents a text that states the import."""
    made_at: str
    imported: ImportedMessage | None
    """Import of the document; null if it was made on this server."""
    sha256: str
    """SHA-256 of the signed content."""
    out_of_date: str
    """Why it is not valid; empty if it is."""
    signatures: list[SignatureMessage]
    """Signatures of exactly this version."""
    is_cosigned: bool
    was_signed: bool
    """An earlier version was signed, but not this one."""


class SignaturesMessage(Message):
    """Plan and registration of the open case."""

    signable: list[SignableMessage]


class HoldMessage(Message):
    """Hold requests."""

    requested_by: list[str]
    since: str | None
    """Time of the first request, UTC, ISO 8601; null if there is none or it is unknown."""
    is_yours: bool
    """You are one of them."""


class YouMessage(Message):
    """The identity of the receiver in the room."""

    seat: int
    """0 without a page."""
    name: str
    role: Role


class RoomMessage(Message):
    """State of the room, or the changes since the previous message."""

    you: YouMessage
    fades_after_s: float
    """Display time of drawings, from the capture time of their image."""
    people: list[PersonMessage] | None
    """null: unchanged."""
    pointers: list[PointerMessage]
    """All of them."""
    drawings: list[str]
    """Keys of all present drawings."""
    grown: list[DrawingMessage]
    """New points of drawings."""
    hold: HoldMessage
    signable: list[SignableMessage] | None
    """null: unchanged, or without a case store."""


class SignatureRequest(Message):
    """The version to sign."""

    what: CosignTarget
    document_id: Annotated[str, Field(min_length=1, max_length=64)]


class PointCommand(Message):
    """Move your pointer."""

    at: MarkPointMessage
    """x, y in pixels of the full-size image; with a plane, in mm on it."""
    plane: CutPlaneMessage | None = None
    image_number: Number
    captured_at_s: Seconds


class DrawCommand(Message):
    """Start a drawing."""

    key: Number
    """Chosen by the client, unique for each drawing."""
    shape: Shape
    points: Points
    """x, y in pixels of the full-size image; with a plane, in mm on it."""
    plane: CutPlaneMessage | None = None
    image_number: Number
    captured_at_s: Seconds


class ExtendCommand(Message):
    """Add points to a drawing."""

    key: Number
    points: Points
    """On what it was started on."""


class LookCommand(Message):
    """Report what your page shows, at most twice a second; for any role."""

    part: ViewPart | None
    pictures: Annotated[list[Picture], Field(max_length=len(Picture))]
    freshness: Freshness
    max_age_ms: Annotated[float, Field(ge=0.0, le=1e6, allow_inf_nan=False)] | None


class ClientMessage(Message):
    """One command of a client in the room."""

    next: Literal[True] | None = None
    """The last message was processed; the next one may be sent."""
    point: PointCommand | None = None
    lift: Literal[True] | None = None
    """Remove your pointer."""
    draw: DrawCommand | None = None
    extend: ExtendCommand | None = None
    undo: Literal[True] | None = None
    clear: Literal["own", "all"] | None = None
    look: LookCommand | None = None

    @model_validator(mode="after")
    def _one_thing(self) -> Self:
        if sum(getattr(self, name) is not None for name in type(self).model_fields) != 1:
            raise ValueError("send one command per message")
        return self


def room_message(update: RoomUpdate, *, session: RoomSession) -> RoomMessage:
    """Return the next message to a page."""
    picture, you = update.state, session.person
    return RoomMessage(
        you=YouMessage(seat=session.number, name=you.name, role=you.role),
        fades_after_s=picture.fades_after_s,
        people=None if update.people is None else [_person(one, you.id) for one in update.people],
        pointers=[_pointer(one, picture.now_s) for one in picture.pointers],
        drawings=[one.key for one in picture.drawings],
        grown=[_drawing(one, you.id, left_s=_left_s(one.drawing, update)) for one in update.extensions],
        hold=_hold(picture.holds, you.id),
        signable=None
        if update.signable is None
        else [signable_message(one, you.id) for one in update.signable],
    )


def signable_message(signable: Signable, your_id: str) -> SignableMessage:
    """Return the message of a plan or registration with its signatures."""
    return SignableMessage(
        what=signable.what,
        requirement=signable.requirement,
        document_id=signable.document_id or None,
        title=signable.title[requested_language()],
        made_by=signable.made_by,
        made_at=signable.made_at,
        imported=imported_message(signable.imported, claimed_maker=signable.claimed_maker),
        sha256=signable.sha256,
        out_of_date=signable.out_of_date[requested_language()],
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


def cut_plane(message: CutPlaneMessage | None) -> CutPlane | None:
    """Return the plane of a command."""
    if message is None:
        return None
    return CutPlane(
        ct_id=message.ct_id,
        origin_in_vertebra_mm=_vector(message.origin_in_vertebra_mm),
        right_in_vertebra=_vector(message.right_in_vertebra),
        down_in_vertebra=_vector(message.down_in_vertebra),
    )


def _vector(values: Sequence[float]) -> Vector:
    x, y, z = values
    return x, y, z


def _dot(first: Sequence[float], second: Sequence[float]) -> float:
    return sum(a * b for a, b in zip(first, second, strict=True))


def _plane(plane: CutPlane | None) -> CutPlaneMessage | None:
    if plane is None:
        return None
    return CutPlaneMessage(
        ct_id=plane.ct_id,
        origin_in_vertebra_mm=list(plane.origin_in_vertebra_mm),
        right_in_vertebra=list(plane.right_in_vertebra),
        down_in_vertebra=list(plane.down_in_vertebra),
    )


def look_of(command: LookCommand) -> Look:
    """Return what a page shows."""
    return Look(
        part=command.part,
        pictures=tuple(command.pictures),
        freshness=command.freshness,
        max_age_ms=command.max_age_ms,
    )


def _page(page: PageLook) -> PageMessage:
    look = page.look
    return PageMessage(
        view=page.view,
        part=look.part,
        pictures=list(look.pictures),
        freshness=look.freshness,
        max_age_ms=look.max_age_ms,
    )


def _hold(asking: tuple[HoldRequest, ...], your_id: str) -> HoldMessage:
    return HoldMessage(
        requested_by=[one.name for one in asking],
        since=asking[0].at or None if asking else None,
        is_yours=any(one.person_id == your_id for one in asking),
    )


def _person(one: Participant, your_id: str) -> PersonMessage:
    return PersonMessage(
        name=one.name,
        role=one.role,
        pages=[_page(page) for page in one.pages],
        since=one.since,
        line=one.connection,
        is_you=one.person_id == your_id,
    )


def _pointer(one: Pointer, now_s: float) -> PointerMessage:
    return PointerMessage(
        seat=one.session,
        name=one.person.name,
        role=one.person.role,
        at=list(one.at),
        plane=_plane(one.plane),
        image_number=one.moment.image_number,
        captured_at_s=one.moment.captured_at_s,
        still_ms=1000.0 * (now_s - one.moved_at_s),
    )


def _left_s(drawing: Drawing, update: RoomUpdate) -> float:
    return drawing.moment.captured_at_s + update.state.fades_after_s - update.state.now_s


def _drawing(grown: DrawingExtension, your_id: str, *, left_s: float) -> DrawingMessage:
    one = grown.drawing
    return DrawingMessage(
        key=one.key,
        seat=one.session,
        name=one.person.name,
        role=one.person.role,
        is_yours=one.person.id == your_id,
        shape=one.shape,
        image_number=one.moment.image_number,
        captured_at_s=one.moment.captured_at_s,
        left_s=left_s,
        from_point=grown.from_point,
        points=[list(point) for point in grown.points],
        plane=_plane(one.plane),
    )
