"""Another scene takes the place of the one before, in a process that runs and in one that is started."""

import threading
import time
from multiprocessing import Pipe
from multiprocessing.connection import Connection

import pytest

from server.capture.rehearsal import Begun, RehearsalSource
from server.config import Config, RehearsalConfig, RehearsalEventConfig
from server.logs import LogSettings
from server.loop.board import Board
from server.loop.rehearsed import Rehearsed
from server.loop.staging import SceneOrder, Staging
from server.loop.supervisor import Supervisor
from server.loop.worker import NewestCase, NewestScene, WorkerOrder, _listen
from server.setup import CaseSetup, build_setup
from server.theatre import theatre_of
from tests.server.loop.made import steady_worker
from tracker.errors import InvalidInput
from tracker.navigation import Absent
from tracker.registration import AnchoredTo
from tracker.rehearsal import EventKind, Phase

SMALL = RehearsalConfig(width=160, height=160, clutter=0.0)


def staged() -> tuple[RehearsalSource, Staging]:
    theatre = theatre_of(SMALL)
    renderer = theatre.renderer()
    source = RehearsalSource(renderer, rate_hz=30.0, stop=threading.Event(), fast=True)
    source.open()
    return source, Staging(source, renderer)


def test_the_newest_order_is_played_when_it_is_ready() -> None:
    source, staging = staged()
    for _ in range(3):
        source.read()
    stalls = RehearsalEventConfig(kind="camera_stalls", at_s=3.0)
    for number, scene in ((1, "pivot"), (2, "sweep"), (3, "check")):
        settings = SMALL.model_copy(update={"scene": scene, "events": [stalls]})
        staging.order(SceneOrder(number=number, rehearsal=settings))
    deadline_s = time.monotonic() + 60.0
    while staging.begun.scene_number != 3:
        assert time.monotonic() < deadline_s
        threading.Event().wait(0.005)
    shot = source.read()
    assert shot is not None
    assert shot.source_time_s == 0.0
    assert shot.number == staging.begun.first_number
    assert source.stalls


def test_a_new_process_goes_on_with_the_scene_or_begins_it() -> None:
    order = SceneOrder(number=2, rehearsal=SMALL)
    assert order.begun(70) == Begun(scene_number=2, first_number=70)
    told = SceneOrder(number=2, rehearsal=SMALL, first_number=31)
    assert told.begun(70) == Begun(scene_number=2, first_number=31)


def test_the_next_process_is_told_where_the_scene_began() -> None:
    board = Board("rehearsal")
    order = WorkerOrder(config=Config(), log=LogSettings(as_json=True))
    supervisor = Supervisor(order=order, board=board, target=steady_worker)
    supervisor.play(SceneOrder(number=1, rehearsal=SMALL))
    unbegun = supervisor._next_order().scene
    assert unbegun is not None
    assert unbegun.first_number is None
    board.note_begun(Begun(scene_number=1, first_number=44))
    begun = supervisor._next_order().scene
    assert begun is not None
    assert begun.first_number == 44


def test_scenes_and_cases_arrive_where_they_belong(monkeypatch: pytest.MonkeyPatch) -> None:
    heard: Connection
    told: Connection
    heard, told = Pipe(duplex=False)
    cases, scenes, stop = NewestCase(), NewestScene(), threading.Event()
    monkeypatch.setattr("server.loop.worker.os._exit", lambda _status: None)
    monkeypatch.setattr("server.loop.worker.STOP_GRACE_S", 0.0)
    told.send(CaseSetup())
    told.send(SceneOrder(number=5, rehearsal=SMALL))
    told.close()
    _listen(heard, cases, scenes, stop)
    scene = scenes.take()
    assert cases.take() == CaseSetup()
    assert scene is not None
    assert scene.number == 5
    assert stop.is_set()


def test_truth_follows_from_the_number_of_an_image_of_the_running_scene() -> None:
    ordered: list[SceneOrder] = []
    begun = Begun()
    rehearsed = Rehearsed(SMALL, play=ordered.append, begun=lambda: begun)
    first = rehearsed.truth_of(330)
    assert first is not None
    assert (first.at_s, first.phase) == (11.0, Phase.ALIGN)
    rehearsed.play(SMALL.model_copy(update={"scene": "landmarks"}))
    assert rehearsed.first_number is None
    assert rehearsed.truth_of(400) is None, "the scene before is still in the picture"
    begun = Begun(scene_number=1, first_number=400)
    assert rehearsed.truth_of(399) is None
    touched = rehearsed.truth_of(400 + 90)
    assert touched is not None
    assert touched.touched == rehearsed.theatre.landmarks[0].name
    with pytest.raises(InvalidInput):
        rehearsed.play(SMALL.model_copy(update={"seed": -1}))
    assert len(ordered) == 1


def test_settings_make_the_theatre_that_they_say() -> None:
    event = RehearsalEventConfig(kind="patient_moves", at_s=4.0, lasts_s=2.0)
    theatre = theatre_of(SMALL.model_copy(update={"reference": True, "events": [event]}))
    assert theatre.reference is not None
    assert theatre.settings.events[0].kind is EventKind.PATIENT_MOVES
    assert [theatre.is_on(EventKind.PATIENT_MOVES, at_s) for at_s in (3.0, 5.0, 6.5)] == [False, True, False]


def test_a_reference_is_looked_for_and_the_brought_registration_is_fixed_to_it() -> None:
    with_it = build_setup(Config(rehearsal=SMALL.model_copy(update={"reference": True})))
    assert [model.name for model in with_it.models] == ["drill", "reference"]
    assert with_it.reference == "reference"
    assert not isinstance(with_it.registration, Absent)
    assert with_it.registration.anchored_to is AnchoredTo.REFERENCE
    without = build_setup(Config(rehearsal=SMALL))
    assert [model.name for model in without.models] == ["drill"]
    assert without.reference == ""
