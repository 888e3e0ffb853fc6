"""Incremental updates of the room: the state already sent to one page, so that only changes are sent."""

from collections.abc import Sequence
from dataclasses import dataclass

from server.supervision.hold_storage import HoldRequest
from server.supervision.marks import Drawing, MarkPoint, Pointer
from server.supervision.participants import Participant
from server.supervision.signatures import Signable


@dataclass(frozen=True, slots=True, kw_only=True)
class RoomState:
    """State of the room at one moment.

    Attributes:
        now_s: that moment, monotonic.
        fades_after_s: lifetime of a drawing.
        people: participants.
        pointers: current pointers.
        drawings: drawings that have not expired.
        holds: open hold requests.
        signable: plan and registration with their signatures; None without a store.
    """

    now_s: float
    fades_after_s: float
    people: tuple[Participant, ...]
    pointers: tuple[Pointer, ...]
    drawings: tuple[Drawing, ...]
    holds: tuple[HoldRequest, ...] = ()
    signable: tuple[Signable, ...] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawingExtension:
    """New points of a drawing.

    Attributes:
        drawing: the drawing.
        from_point: index of the first new point.
        points: the new points.
    """

    drawing: Drawing
    from_point: int
    points: Sequence[MarkPoint]


@dataclass(frozen=True, slots=True, kw_only=True)
class RoomUpdate:
    """The next message to one page.

    Attributes:
        state: the whole state.
        people: None when unchanged since the last message.
        signable: None when unchanged.
        grown: drawings that are new to it, or longer.
    """

    state: RoomState
    people: tuple[Participant, ...] | None
    signable: tuple[Signable, ...] | None
    extensions: tuple[DrawingExtension, ...]


class SentState:
    """The state that was sent to one page. Messages are ordered and none is lost, so it is exact."""

    def __init__(self) -> None:
        self._people: tuple[Participant, ...] | None = None
        self._signable: tuple[Signable, ...] | None = None
        self._points_of: dict[str, int] = {}

    def update(self, state: RoomState) -> RoomUpdate:
        """Return the changes since the last call."""
        extensions = tuple(
            DrawingExtension(
                drawing=one,
                from_point=self._points_of.get(one.key, 0),
                points=one.points[self._points_of.get(one.key, 0) :],
            )
            for one in state.drawings
            if self._points_of.get(one.key, 0) < len(one.points)
        )
        self._points_of = {one.key: len(one.points) for one in state.drawings}
        people = None if state.people == self._people else state.people
        signable = None if state.signable == self._signable else state.signable
        self._people, self._signable = state.people, state.signable
        return RoomUpdate(state=state, people=people, signable=signable, extensions=extensions)
