"""Another scene replaces the present one, in a running process and in a new one."""

import threading
import time
from multiprocessing import Pipe
from multiprocessing.connection import Connection

import pytest

from server.capture.rehearsal import PlayedScene, RehearsalSource
from server.config import Config, RehearsalConfig, RehearsalEventConfig
from server.logs import LogSettings
from server.loop.rehearsal_control import RehearsalControl
from server.loop.shared_status import SharedStatus
from server.loop.staging import SceneOrder, Staging
from server.loop.supervisor import Supervisor
from server.loop.worker import ReceivedOrders, WorkerOrder, _listen
from server.setup import CaseSetup, build_setup
from server.theatre import theatre_from_config
from tests.server.loop.fake_workers import steady_worker
from tracker.errors import InvalidInput
from tracker.navigation import Absent
from tracker.registration import AnchoredTo
from tracker.rehearsal import EventKind, Phase

SMALL = RehearsalConfig(width=160, height=160, clutter=0.0)


def staged() -> tuple[RehearsalSource, Staging]:
    theatre = theatre_from_config(SMALL)
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
    while staging.played_scene.scene_number != 3:
        assert time.monotonic() < deadline_s
        threading.Event().wait(0.005)
    shot = source.read()
    assert shot is not None
    assert shot.source_time_s == 0.0
    assert shot.number == staging.played_scene.first_number
    assert source.stalls


def test_a_new_process_goes_on_with_the_scene_or_begins_it() -> None:
    order = SceneOrder(number=2, rehearsal=SMALL)
    assert order.played_scene(70) == PlayedScene(scene_number=2, first_number=70)
    reported = SceneOrder(number=2, rehearsal=SMALL, first_number=31)
    assert reported.played_scene(70) == PlayedScene(scene_number=2, first_number=31)


def test_the_next_process_receives_the_start_of_the_scene() -> None:
    status = SharedStatus("rehearsal")
    order = WorkerOrder(config=Config(), log=LogSettings(as_json=True))
    supervisor = Supervisor(order=order, status=status, target=steady_worker)
    supervisor.play(SceneOrder(number=1, rehearsal=SMALL))
    unbegun = supervisor._next_order().scene
    assert unbegun is not None
    assert unbegun.first_number is None
    status.set_played_scene(PlayedScene(scene_number=1, first_number=44))
    played_scene = supervisor._next_order().scene
    assert played_scene is not None
    assert played_scene.first_number == 44


def test_scenes_and_cases_arrive_where_they_belong(monkeypatch: pytest.MonkeyPatch) -> None:
    heard: Connection
    reported: Connection
    heard, reported = Pipe(duplex=False)
    received, stop = ReceivedOrders(), threading.Event()
    monkeypatch.setattr("server.loop.worker.os._exit", lambda _status: None)
    monkeypatch.setattr("server.loop.worker.STOP_GRACE_S", 0.0)
    reported.send(CaseSetup())
    reported.send(SceneOrder(number=5, rehearsal=SMALL))
    reported.close()
    _listen(heard, received, stop)
    scene = received.scenes.take()
    assert received.cases.take() == CaseSetup()
    assert scene is not None
    assert scene.number == 5
    assert stop.is_set()


def test_truth_follows_from_the_number_of_an_image_of_the_running_scene() -> None:
    ordered: list[SceneOrder] = []
    played_scene = PlayedScene()
    rehearsed = RehearsalControl(SMALL, play=ordered.append, played_scene=lambda: played_scene)
    first = rehearsed.truth_of(330)
    assert first is not None
    assert (first.at_s, first.phase) == (11.0, Phase.ALIGN)
    rehearsed.play(SMALL.model_copy(update={"scene": "landmarks"}))
    assert rehearsed.first_number is None
    assert rehearsed.truth_of(400) is None, "the scene before is still in the picture"
    played_scene = PlayedScene(scene_number=1, first_number=400)
    assert rehearsed.truth_of(399) is None
    touched = rehearsed.truth_of(400 + 90)
    assert touched is not None
    assert touched.touched == rehearsed.theatre.landmarks[0].name
    with pytest.raises(InvalidInput):
        rehearsed.play(SMALL.model_copy(update={"seed": -1}))
    assert len(ordered) == 1


def test_settings_make_the_theatre_that_they_say() -> None:
    event = RehearsalEventConfig(kind="patient_moves", at_s=4.0, lasts_s=2.0)
    theatre = theatre_from_config(SMALL.model_copy(update={"reference": True, "events": [event]}))
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
