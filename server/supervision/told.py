"""What one page has been told of the room, so that over a thin line it is told only what is new."""

from collections.abc import Sequence
from dataclasses import dataclass

from server.supervision.asked import Asked
from server.supervision.marks import Drawing, Pixel, Pointer
from server.supervision.people import Present
from server.supervision.signatures import Signable


@dataclass(frozen=True, slots=True, kw_only=True)
class RoomPicture:
    """All that there is to tell at one moment.

    Attributes:
        now_s: that moment.
        fades_after_s: how long drawings stay.
        people: who is here.
        pointers: that moved lately.
        drawings: whose moment is not over.
        holding: those who ask to hold.
        signable: plan and registration with their signatures; None where nothing is kept.
    """

    now_s: float
    fades_after_s: float
    people: tuple[Present, ...]
    pointers: tuple[Pointer, ...]
    drawings: tuple[Drawing, ...]
    holding: tuple[Asked, ...] = ()
    signable: tuple[Signable, ...] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Grown:
    """What is new of a drawing.

    Attributes:
        drawing: which one.
        from_point: the first of its points that is new.
        points_px: the new ones.
    """

    drawing: Drawing
    from_point: int
    points_px: Sequence[Pixel]


@dataclass(frozen=True, slots=True, kw_only=True)
class News:
    """What one page is told next.

    Attributes:
        picture: the whole.
        people: None where nothing changed since it was told.
        signable: None where nothing changed.
        grown: drawings that are new to it, or longer.
    """

    picture: RoomPicture
    people: tuple[Present, ...] | None
    signable: tuple[Signable, ...] | None
    grown: tuple[Grown, ...]


class Told:
    """What one page knows. Its messages come in their order and none is lost, so this is exact."""

    def __init__(self) -> None:
        self._people: tuple[Present, ...] | None = None
        self._signable: tuple[Signable, ...] | None = None
        self._points_of: dict[str, int] = {}

    def news(self, picture: RoomPicture) -> News:
        """What is new to it; from here on it is told."""
        grown = tuple(
            Grown(
                drawing=one,
                from_point=self._points_of.get(one.key, 0),
                points_px=one.points_px[self._points_of.get(one.key, 0) :],
            )
            for one in picture.drawings
            if self._points_of.get(one.key, 0) < len(one.points_px)
        )
        self._points_of = {one.key: len(one.points_px) for one in picture.drawings}
        people = None if picture.people == self._people else picture.people
        signable = None if picture.signable == self._signable else picture.signable
        self._people, self._signable = picture.people, picture.signable
        return News(picture=picture, people=people, signable=signable, grown=grown)
