"""Viewers are counted individually, even if they saw the same."""

from contextlib import ExitStack

import pytest

from server.security import Person, Role
from server.stream.errors import TooManyViewers
from server.stream.viewers import ViewerKind, Viewers


def test_two_who_saw_the_same_go_one_by_one() -> None:
    viewers = Viewers()
    with viewers.register(ViewerKind.LIVE) as stays:
        with viewers.register(ViewerKind.LIVE) as goes:
            stays.mark_taken(7)
            goes.mark_taken(7)
        # The other viewer's counts are its own.
        stays.mark_taken(9)
        assert viewers.count(ViewerKind.LIVE) == 1
        assert viewers.dropped(ViewerKind.LIVE) == 1
    assert viewers.count(ViewerKind.LIVE) == 0
    assert viewers.dropped(ViewerKind.LIVE) == 1


def person(number: int, role: Role = Role.VIEWER) -> Person:
    return Person(id=f"p{number}", name=f"Somebody {number}", role=role)


def test_the_place_is_taken_where_it_is_looked_for() -> None:
    viewers = Viewers(maximum=1)
    with viewers.register(ViewerKind.MJPEG):
        with pytest.raises(TooManyViewers), viewers.register(ViewerKind.VIEW):
            pass
        assert viewers.count(ViewerKind.VIEW) == 0
        # A page has one of each of these beside its video.
        with (
            viewers.register(ViewerKind.LIVE),
            viewers.register(ViewerKind.ROOM),
            viewers.register(ViewerKind.SCENE),
        ):
            pass
    with viewers.register(ViewerKind.VIEW):
        pass


@pytest.mark.parametrize("kind", [ViewerKind.LIVE, ViewerKind.ROOM, ViewerKind.SCENE])
def test_one_person_has_eight_places_by_all_ways_together(kind: ViewerKind) -> None:
    viewers = Viewers(maximum=64)
    with ExitStack() as here:
        for _ in range(8):
            here.enter_context(viewers.register(kind, person=person(1)))
        with pytest.raises(TooManyViewers, match="Somebody 1 has 8 open connections"):
            here.enter_context(viewers.register(kind, person=person(1)))
        here.enter_context(viewers.register(kind, person=person(2)))
    with viewers.register(kind, person=person(1)):
        pass


def test_without_sign_in_all_places_are_anybodys() -> None:
    viewers = Viewers(maximum=12)
    with ExitStack() as here:
        for _ in range(12):
            here.enter_context(viewers.register(ViewerKind.VIEW))
        with pytest.raises(TooManyViewers):
            here.enter_context(viewers.register(ViewerKind.VIEW))


def test_eight_of_all_places_are_reserved_for_operator_and_screen() -> None:
    viewers = Viewers(maximum=64)
    with ExitStack() as here:
        for number in range(56):
            here.enter_context(viewers.register(ViewerKind.VIEW, person=person(number)))
        for role in (Role.VIEWER, Role.SUPERVISOR):
            with pytest.raises(TooManyViewers, match="56 viewers are connected, the maximum is 56"):
                here.enter_context(viewers.register(ViewerKind.MJPEG, person=person(99, role)))
        for number in range(4):
            here.enter_context(viewers.register(ViewerKind.VIEW, person=person(100, Role.OPERATOR)))
            here.enter_context(viewers.register(ViewerKind.VIEW, person=person(200 + number, Role.SCREEN)))
        with pytest.raises(TooManyViewers, match="64 viewers"):
            here.enter_context(viewers.register(ViewerKind.VIEW, person=person(300, Role.SCREEN)))
