"""Viewers are counted one by one, also those that saw the same."""

from contextlib import ExitStack

import pytest

from server.security import Person, Role
from server.stream.errors import TooManyViewers
from server.stream.viewers import ViewerKind, Viewers


def test_two_who_saw_the_same_go_one_by_one() -> None:
    viewers = Viewers()
    with viewers.watching(ViewerKind.LIVE) as stays:
        with viewers.watching(ViewerKind.LIVE) as goes:
            stays.took(7)
            goes.took(7)
        # What the other one saw and missed since is its own.
        stays.took(9)
        assert viewers.count(ViewerKind.LIVE) == 1
        assert viewers.dropped(ViewerKind.LIVE) == 1
    assert viewers.count(ViewerKind.LIVE) == 0
    assert viewers.dropped(ViewerKind.LIVE) == 1


def person(number: int, role: Role = Role.VIEWER) -> Person:
    return Person(id=f"p{number}", name=f"Somebody {number}", role=role)


def test_the_place_is_taken_where_it_is_looked_for() -> None:
    viewers = Viewers(most=1)
    with viewers.watching(ViewerKind.LIVE):
        with pytest.raises(TooManyViewers), viewers.watching(ViewerKind.VIEW):
            pass
        assert viewers.count(ViewerKind.VIEW) == 0
        # Who sits in the room takes no picture from anybody, and nobody who watches a seat; so the scene.
        with viewers.watching(ViewerKind.ROOM), viewers.watching(ViewerKind.SCENE):
            pass
    with viewers.watching(ViewerKind.VIEW):
        pass


@pytest.mark.parametrize("kind", [ViewerKind.LIVE, ViewerKind.ROOM, ViewerKind.SCENE])
def test_one_person_has_eight_places_by_all_ways_together(kind: ViewerKind) -> None:
    viewers = Viewers(most=64)
    with ExitStack() as here:
        for _ in range(8):
            here.enter_context(viewers.watching(kind, person=person(1)))
        with pytest.raises(TooManyViewers, match="Somebody 1 has 8 lines open already"):
            here.enter_context(viewers.watching(kind, person=person(1)))
        here.enter_context(viewers.watching(kind, person=person(2)))
    with viewers.watching(kind, person=person(1)):
        pass


def test_without_sign_in_all_places_are_anybodys() -> None:
    viewers = Viewers(most=12)
    with ExitStack() as here:
        for _ in range(12):
            here.enter_context(viewers.watching(ViewerKind.VIEW))
        with pytest.raises(TooManyViewers):
            here.enter_context(viewers.watching(ViewerKind.VIEW))


def test_eight_of_all_places_are_kept_for_operator_and_screen() -> None:
    viewers = Viewers(most=64)
    with ExitStack() as here:
        for number in range(56):
            here.enter_context(viewers.watching(ViewerKind.VIEW, person=person(number)))
        for role in (Role.VIEWER, Role.SUPERVISOR):
            with pytest.raises(TooManyViewers, match="56 viewers watch already, at most 56 may"):
                here.enter_context(viewers.watching(ViewerKind.LIVE, person=person(99, role)))
        for number in range(4):
            here.enter_context(viewers.watching(ViewerKind.VIEW, person=person(100, Role.OPERATOR)))
            here.enter_context(viewers.watching(ViewerKind.VIEW, person=person(200 + number, Role.SCREEN)))
        with pytest.raises(TooManyViewers, match="64 viewers"):
            here.enter_context(viewers.watching(ViewerKind.VIEW, person=person(300, Role.SCREEN)))
