"""The room without a network: unique users, marks that expire with their image or CT, rate limits."""

from dataclasses import dataclass, field, replace

import pytest

from server.security import Person, Role
from server.supervision.marks import MAX_DRAWINGS_PER_PERSON, MAX_POINTS_PER_DRAWING, CutPlane, Moment, Shape
from server.supervision.participants import (
    SILENT_AFTER_S,
    ConnectionState,
    Freshness,
    Look,
    PageLook,
    Picture,
    RoomSession,
    View,
    ViewPart,
)
from server.supervision.room import (
    LOOKS_AT_ONCE,
    MARKS_AT_ONCE,
    Room,
    RoomFull,
    RoomPolicyViolation,
    ShownImage,
)
from server.supervision.room_updates import RoomState, RoomUpdate, SentState

SATO = Person(id="s1", name="Dr Sato", role=Role.SUPERVISOR)
ITO = Person(id="o1", name="M. Ito", role=Role.OPERATOR)
GUEST = Person(id="v1", name="Guest", role=Role.VIEWER)
SCREEN = Person(id="t1", name="Theatre 3", role=Role.SCREEN)
FADES_S = 20.0
AXIAL = CutPlane(
    ct_id="ct-1",
    origin_in_vertebra_mm=(-20.0, -30.0, 5.0),
    right_in_vertebra=(1.0, 0.0, 0.0),
    down_in_vertebra=(0.0, 1.0, 0.0),
)


@dataclass(slots=True)
class Scene:
    """A room with a clock and a camera set by the test."""

    room: Room = field(default_factory=lambda: Room(fades_after_s=FADES_S))
    now_s: float = 100.0

    @property
    def moment(self) -> Moment:
        return Moment(image_number=int(self.now_s * 10), captured_at_s=self.now_s)

    @property
    def shown(self) -> ShownImage:
        return ShownImage(moment=self.moment, size_wh_px=(1280, 720), ct_id=AXIAL.ct_id)

    def enter(self, person: Person, view: View = View.SUPERVISOR) -> RoomSession:
        return self.room.enter(person, view, now_s=self.now_s, at=f"at {self.now_s:g}")

    def point(self, session: RoomSession, at: tuple[float, float] = (10.0, 20.0)) -> None:
        self.room.point(session, at, self.moment, self.shown, now_s=self.now_s)

    def draw(self, session: RoomSession, key: int = 1, shape: Shape = Shape.PEN, points: int = 2) -> bool:
        line = [(10.0 + n, 20.0) for n in range(points)]
        return self.room.draw(session, key, shape, line, self.moment, self.shown, now_s=self.now_s)

    @property
    def drawn(self) -> list[str]:
        return [one.key for one in self.room.marks.drawings(self.now_s)]

    def update(self, sent: SentState) -> RoomUpdate:
        marks = self.room.marks
        return sent.update(
            RoomState(
                now_s=self.now_s,
                fades_after_s=FADES_S,
                people=self.room.participants(self.now_s),
                pointers=marks.pointers(self.now_s),
                drawings=marks.drawings(self.now_s),
            )
        )


@pytest.fixture
def scene() -> Scene:
    return Scene()


def test_somebody_with_several_pages_is_here_once(scene: Scene) -> None:
    first = scene.enter(SATO, View.SUPERVISOR)
    scene.enter(GUEST, View.THEATRE)
    scene.now_s += 60
    scene.enter(SATO, View.THEATRE)
    reported = [
        (one.name, one.role, [page.view for page in one.pages], one.since)
        for one in scene.room.participants(scene.now_s)
    ]
    assert reported == [
        ("Dr Sato", Role.SUPERVISOR, [View.SUPERVISOR, View.THEATRE], "at 100"),
        ("Guest", Role.VIEWER, [View.THEATRE], "at 100"),
    ]
    scene.room.leave(first)
    assert [page.view for page in scene.room.participants(scene.now_s)[1].pages] == [View.THEATRE]


DRILLING = Look(part=ViewPart.DRILL, pictures=(Picture.AXIAL,), freshness=Freshness.LIVE, max_age_ms=200.0)


def test_what_a_page_shows_is_listed_with_its_person(scene: Scene) -> None:
    guest = scene.enter(GUEST, View.THEATRE)
    first = [page.look.freshness for one in scene.room.participants(scene.now_s) for page in one.pages]
    assert first == [Freshness.UNKNOWN]
    assert scene.room.look(guest, DRILLING, now_s=scene.now_s)
    assert not scene.room.look(guest, DRILLING, now_s=scene.now_s), "nothing has changed"
    # A second page that shows the same is not listed, another one is.
    second = scene.enter(GUEST, View.THEATRE)
    scene.room.look(second, DRILLING, now_s=scene.now_s)
    (person,) = scene.room.participants(scene.now_s)
    assert person.pages == (PageLook(view=View.THEATRE, look=DRILLING),)
    scene.room.look(second, replace(DRILLING, freshness=Freshness.HIDDEN), now_s=scene.now_s)
    assert len(scene.room.participants(scene.now_s)[0].pages) == 2


def test_a_page_that_does_not_answer_is_not_listed_as_live(scene: Scene) -> None:
    frozen, other = scene.enter(GUEST, View.THEATRE), scene.enter(GUEST, View.SUPERVISOR)
    for session in (frozen, other):
        scene.room.look(session, DRILLING, now_s=scene.now_s)
    frozen.sent_at_s = scene.now_s
    scene.now_s += SILENT_AFTER_S
    (person,) = scene.room.participants(scene.now_s)
    assert person.connection is ConnectionState.GOOD, "the other page answers"
    unknown = replace(DRILLING, freshness=Freshness.UNKNOWN, max_age_ms=None)
    assert person.pages == (
        PageLook(view=View.THEATRE, look=unknown),
        PageLook(view=View.SUPERVISOR, look=DRILLING),
    )
    frozen.answered(scene.now_s)
    frozen.round_trip_s = 0.1
    assert scene.room.participants(scene.now_s)[0].pages[0].look == DRILLING


def test_a_page_that_reports_too_often_is_cut_off(scene: Scene) -> None:
    session = scene.enter(GUEST, View.THEATRE)
    for _ in range(60):
        scene.now_s += 1.0
        scene.room.look(session, DRILLING, now_s=scene.now_s)
    scene.now_s += 60.0
    for _ in range(int(LOOKS_AT_ONCE)):
        scene.room.look(session, DRILLING, now_s=scene.now_s)
    with pytest.raises(RoomPolicyViolation, match="looks per second"):
        scene.room.look(session, DRILLING, now_s=scene.now_s)


@pytest.mark.parametrize(
    ("took_s", "waiting_s", "line"),
    [
        pytest.param(0.1, 0.0, ConnectionState.GOOD, id="answers-at-once"),
        pytest.param(0.7, 0.0, ConnectionState.SLOW, id="answered-late"),
        pytest.param(0.1, 0.9, ConnectionState.SLOW, id="is-late-now"),
        pytest.param(0.1, 3.0, ConnectionState.SILENT, id="says-nothing"),
    ],
)
def test_a_connection_is_judged_by_its_answers(
    scene: Scene, took_s: float, waiting_s: float, line: ConnectionState
) -> None:
    session = scene.enter(SATO)
    session.sent_at_s = scene.now_s
    scene.now_s += took_s
    session.answered(scene.now_s)
    if waiting_s:
        session.sent_at_s = scene.now_s
        scene.now_s += waiting_s
    assert scene.room.participants(scene.now_s)[0].connection is line


def test_the_best_of_several_connections_counts(scene: Scene) -> None:
    bad, good = scene.enter(SATO), scene.enter(SATO)
    bad.round_trip_s, good.round_trip_s = 5.0, 0.1
    assert scene.room.participants(scene.now_s)[0].connection is ConnectionState.GOOD


def test_a_pointer_goes_two_seconds_after_its_last_move(scene: Scene) -> None:
    session = scene.enter(SATO)
    scene.point(session)
    scene.now_s += 1.9
    scene.point(session, (30.0, 40.0))
    scene.now_s += 1.9
    assert [one.at for one in scene.room.marks.pointers(scene.now_s)] == [(30.0, 40.0)]
    scene.now_s += 0.2
    assert scene.room.marks.pointers(scene.now_s) == ()


def test_a_pointer_goes_with_its_page_but_drawings_stay_their_time(scene: Scene) -> None:
    session = scene.enter(SATO)
    scene.point(session)
    scene.draw(session)
    scene.room.leave(session)
    assert scene.room.marks.pointers(scene.now_s) == ()
    assert scene.drawn == ["1-1"]


def test_a_drawing_goes_with_the_image_that_it_was_made_on(scene: Scene) -> None:
    session = scene.enter(SATO)
    seen = scene.moment
    scene.now_s += 5  # drawn on an old image over a slow connection
    scene.room.draw(session, 1, Shape.PEN, [(1.0, 1.0)], seen, scene.shown, now_s=scene.now_s)
    scene.now_s += 14.9
    assert scene.drawn == ["1-1"]
    scene.now_s += 0.2
    assert scene.drawn == []


def test_marks_on_a_cut_have_their_plane_and_expire_like_those_on_the_video(scene: Scene) -> None:
    session = scene.enter(SATO)
    # Also left of and above the origin of the plane, where no pixel of an image is.
    assert scene.room.draw(
        session, 1, Shape.PEN, [(-3.0, -4.5)], scene.moment, scene.shown, plane=AXIAL, now_s=scene.now_s
    )
    scene.room.extend(session, 1, [(-3.0, 5.0)], scene.shown, now_s=scene.now_s)
    scene.room.point(session, (2.0, -1.0), scene.moment, scene.shown, plane=AXIAL, now_s=scene.now_s)
    (drawing,) = scene.room.marks.drawings(scene.now_s)
    assert (drawing.plane, drawing.points) == (AXIAL, [(-3.0, -4.5), (-3.0, 5.0)])
    (pointer,) = scene.room.marks.pointers(scene.now_s)
    assert (pointer.plane, pointer.at) == (AXIAL, (2.0, -1.0))
    scene.now_s += FADES_S
    assert (scene.drawn, scene.room.marks.pointers(scene.now_s)) == ([], ())


def test_marks_on_cuts_disappear_with_another_ct_and_those_on_the_video_stay(scene: Scene) -> None:
    session, other = scene.enter(SATO), scene.enter(ITO, View.OPERATOR)
    scene.room.draw(
        session, 1, Shape.PEN, [(1.0, 1.0)], scene.moment, scene.shown, plane=AXIAL, now_s=scene.now_s
    )
    scene.room.point(session, (1.0, 1.0), scene.moment, scene.shown, plane=AXIAL, now_s=scene.now_s)
    scene.draw(session, 2)
    scene.point(other)
    scene.room.marks.retain_ct("ct-1")
    assert scene.drawn == ["1-1", "1-2"]
    scene.room.marks.retain_ct("ct-2")
    assert scene.drawn == ["1-2"]
    assert [one.person for one in scene.room.marks.pointers(scene.now_s)] == [ITO]
    # Points that arrive late for a removed drawing do not start another one.
    scene.room.extend(session, 1, [(2.0, 2.0)], scene.shown, now_s=scene.now_s)
    assert scene.drawn == ["1-2"]


@pytest.mark.parametrize(
    ("at_mm", "ct_id", "shown_ct_id"),
    [
        pytest.param((1.0, 201.0), "ct-1", "ct-1", id="off-every-cut"),
        pytest.param((1.0, 1.0), "ct-0", "ct-1", id="of-another-ct"),
        pytest.param((1.0, 1.0), "ct-1", "", id="without-a-ct"),
    ],
)
def test_what_lies_on_no_cut_is_not_shown(
    scene: Scene, at_mm: tuple[float, float], ct_id: str, shown_ct_id: str
) -> None:
    session, plane = scene.enter(SATO), replace(AXIAL, ct_id=ct_id)
    shown = replace(scene.shown, ct_id=shown_ct_id)
    assert not scene.room.draw(
        session, 1, Shape.PEN, [at_mm], scene.moment, shown, plane=plane, now_s=scene.now_s
    )
    scene.room.point(session, at_mm, scene.moment, shown, plane=plane, now_s=scene.now_s)
    assert (scene.drawn, scene.room.marks.pointers(scene.now_s)) == ([], ())


@pytest.mark.parametrize("person", [GUEST, SCREEN])
def test_who_only_watches_is_cut_off(scene: Scene, person: Person) -> None:
    session = scene.enter(person)
    for act in (scene.point, scene.draw):
        with pytest.raises(RoomPolicyViolation, match="may not mark"):
            act(session)
    with pytest.raises(RoomPolicyViolation):
        scene.room.extend(session, 1, [(1.0, 1.0)], scene.shown, now_s=scene.now_s)
    with pytest.raises(RoomPolicyViolation):
        scene.room.undo(session, now_s=scene.now_s)
    with pytest.raises(RoomPolicyViolation):
        scene.room.clear(session, everybodys=False, now_s=scene.now_s)


def test_too_many_marks_are_cut_off_and_a_steady_hand_is_not(scene: Scene) -> None:
    session = scene.enter(SATO)
    for _ in range(600):
        scene.now_s += 1 / 50
        scene.point(session)
    hasty = scene.enter(SATO)
    for _ in range(int(MARKS_AT_ONCE)):
        scene.point(hasty)
    with pytest.raises(RoomPolicyViolation, match="per second"):
        scene.point(hasty)


def test_a_drawing_has_an_end(scene: Scene) -> None:
    session = scene.enter(SATO)
    scene.draw(session, points=50)
    for _ in range(MAX_POINTS_PER_DRAWING // 50 - 1):
        scene.room.extend(session, 1, [(1.0, 1.0)] * 50, scene.shown, now_s=scene.now_s)
    with pytest.raises(RoomPolicyViolation, match=str(MAX_POINTS_PER_DRAWING)):
        scene.room.extend(session, 1, [(1.0, 1.0)], scene.shown, now_s=scene.now_s)


def test_the_oldest_of_too_many_drawings_goes(scene: Scene) -> None:
    session = scene.enter(SATO)
    for key in range(MAX_DRAWINGS_PER_PERSON + 3):
        scene.draw(session, key)
    assert scene.drawn == [f"1-{key}" for key in range(3, MAX_DRAWINGS_PER_PERSON + 3)]


def test_own_drawings_are_taken_back_and_the_operator_clears_all(scene: Scene) -> None:
    sato, ito = scene.enter(SATO), scene.enter(ITO, View.OPERATOR)
    for key in (1, 2):
        scene.draw(sato, key)
    scene.draw(ito, 1)
    assert scene.room.undo(sato, now_s=scene.now_s)
    assert scene.drawn == ["1-1", "2-1"]
    with pytest.raises(RoomPolicyViolation, match="operator"):
        scene.room.clear(sato, everybodys=True, now_s=scene.now_s)
    assert scene.room.clear(sato, everybodys=False, now_s=scene.now_s) == 1
    scene.draw(sato, 3)
    assert scene.room.clear(ito, everybodys=True, now_s=scene.now_s) == 2
    assert not scene.room.undo(sato, now_s=scene.now_s)


@pytest.mark.parametrize(
    ("points", "moved"),
    [
        pytest.param([(1300.0, 20.0)], Moment(image_number=1, captured_at_s=99.0), id="off-the-picture"),
        pytest.param([(10.0, -0.9)], Moment(image_number=1, captured_at_s=99.0), id="above-it"),
        pytest.param([(10.0, 20.0)], Moment(image_number=5000, captured_at_s=99.0), id="an-image-to-come"),
        pytest.param([(10.0, 20.0)], Moment(image_number=1, captured_at_s=1e9), id="a-time-to-come"),
    ],
)
def test_what_lies_on_no_picture_is_not_shown(
    scene: Scene, points: list[tuple[float, float]], moved: Moment
) -> None:
    session = scene.enter(SATO)
    assert not scene.room.draw(session, 1, Shape.PEN, points, moved, scene.shown, now_s=scene.now_s)
    scene.room.point(session, points[0], moved, scene.shown, now_s=scene.now_s)
    assert not scene.room.draw(session, 1, Shape.PEN, [(1.0, 1.0)], scene.moment, None, now_s=scene.now_s)
    assert scene.drawn == []
    assert scene.room.marks.pointers(scene.now_s) == ()


def test_an_arrow_has_two_ends(scene: Scene) -> None:
    session = scene.enter(SATO)
    with pytest.raises(RoomPolicyViolation, match="2 points"):
        scene.draw(session, 1, Shape.ARROW, points=3)


def test_the_room_has_an_end(scene: Scene) -> None:
    for _ in range(20):
        scene.enter(SATO)
    with pytest.raises(RoomFull, match="20 pages"):
        scene.enter(SATO)
    scene.enter(ITO)


def test_a_page_gets_only_what_is_new(scene: Scene) -> None:
    sato, reported = scene.enter(SATO), SentState()
    scene.draw(sato, points=3)
    first = scene.update(reported)
    assert first.people is not None
    assert [(one.from_point, len(one.points)) for one in first.extensions] == [(0, 3)]
    scene.room.extend(sato, 1, [(1.0, 2.0)], scene.shown, now_s=scene.now_s)
    second = scene.update(reported)
    assert (second.people, second.signable) == (None, None)
    assert [(one.from_point, list(one.points)) for one in second.extensions] == [(3, [(1.0, 2.0)])]
    scene.enter(GUEST)
    third = scene.update(reported)
    assert third.people is not None
    assert third.extensions == ()
    assert [one.key for one in third.state.drawings] == ["1-1"]
    late = scene.update(SentState())
    assert [(one.from_point, len(one.points)) for one in late.extensions] == [(0, 4)]
