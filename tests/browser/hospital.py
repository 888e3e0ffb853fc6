"""A NATS server, theatres with synthetic images that publish to it, and a hub, all real, in this process."""

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from typing import Any, cast

import numpy as np
import uvicorn
from fastapi import FastAPI

from server.alarms import AlarmService, StoredAlarmLog
from server.app import AppParts, create_app
from server.config import Config
from server.hub.connection import HubAddress
from server.hub.publisher import Outgoing, Publisher, PublisherSettings
from server.hub.theatre import HubPublication
from server.hub_app import create_hub_app
from server.jobs import Jobs
from server.live import LiveHub, Problem
from server.logs import LogSettings
from server.overlay import encode_jpeg
from server.procedure import Steps, TrackingLink
from server.security import AuditLog, PeopleService, Role
from server.security.people.service import NewInvitation
from server.sinks import SinkStatus
from server.store import CaseStore, Home
from server.stream.messages import live_message
from tests.browser.fake_server import Feeder, setup
from tests.browser.supervised_server import PATIENT, RATE_HZ, fill
from tests.nats_server import NatsServer, nats_in
from tracker.errors import NavigationError


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """A server in this process.

    Attributes:
        port: Where it listens.
        people: Its own accounts.
        stop: Stops it, as at the end of a day.
    """

    port: int
    people: PeopleService
    stop: Callable[[], None]

    def invited(self, name: str, role: Role = Role.SUPERVISOR) -> str:
        """Token of an invitation."""
        wanted = NewInvitation(name=name, role=role, lasts=timedelta(hours=1))
        return self.people.invite(wanted, by="ito")[1].text


@dataclass(frozen=True, slots=True, kw_only=True)
class Hospital:
    """All of it."""

    nats: NatsServer
    theatres: dict[str, Place]
    hub: Place


@contextmanager
def hospital(folder: Path, *names: str, sees: dict[str, list[str]]) -> Iterator[Hospital]:
    """Return theatres of these names, each with a plan to be signed, and a hub."""
    with ExitStack() as stack:
        nats = stack.enter_context(nats_in(folder / "nats"))
        at = {"url": nats.url, "hospital": "clinic", "sees": sees, "requests": True}
        theatres = {name: _theatre(stack, folder / name, {**at, "theatre": name}) for name in names}
        config = Config.model_validate({"hub": at, "limits": PATIENT})
        people = _people(folder / "hub")
        app = create_hub_app(config, HubAddress.of(config.hub), people)
        port, stop = _served(stack, app)
        yield Hospital(nats=nats, theatres=theatres, hub=Place(port=port, people=people, stop=stop))


class PublishedByThread:
    """Publishes a theatre by a thread: a process for it costs more than all of the test."""

    def __init__(self, hub: LiveHub, config: Config, folder: Path) -> None:
        assert config.hub.theatre is not None
        self._hub = hub
        self._publisher = Publisher(
            PublisherSettings(
                address=HubAddress.of(config.hub), theatre=config.hub.theatre, home=folder, max_rate_hz=60.0
            )
        )
        self._problem: Problem | None = None
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._jpeg = encode_jpeg(np.full((180, 320, 3), 90, np.uint8), 70)

    @property
    def status(self) -> SinkStatus:
        return SinkStatus(name="hub", problem=self._problem)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._ended.set()
        self._thread.join()
        self._publisher.close()

    def _run(self) -> None:
        sequence = -1
        while not self._ended.is_set():
            instant = self._hub.wait_after(sequence, 0.1)
            if instant is None or instant.snapshot is None:
                continue
            sequence = instant.sequence
            outgoing = Outgoing(
                text=live_message(instant, now_s=time.monotonic()).model_dump_json(),
                captured_at_s=instant.snapshot.captured_at_s,
                picture=self._jpeg,
            )
            try:
                self._publisher.receive(outgoing)
                self._problem = None
            except NavigationError as error:
                self._problem = Problem.from_error(error)


def _people(folder: Path) -> PeopleService:
    folder.mkdir(parents=True, exist_ok=True)
    return PeopleService(folder, audit=AuditLog(folder))


def _theatre(stack: ExitStack, folder: Path, at: dict[str, Any]) -> Place:
    config = Config.model_validate({"hub": at, "limits": PATIENT})
    hub, settings = LiveHub(), LogSettings(as_json=True)
    store = stack.enter_context(CaseStore(stack.enter_context(Home(folder))))
    log = StoredAlarmLog(store)
    alarms = AlarmService(config, log=log)
    jobs = Jobs(log=settings)
    stack.callback(jobs.close)
    people = _people(folder / "security")
    store.set_change_listener(people.audit.record_change)
    link = TrackingLink(publish_setup=lambda _: None)
    steps = Steps.of(hub=hub, store=store, jobs=jobs, config=config, markers=(), tracking=link)
    fill(store, steps.procedure.run)
    publication = PublishedByThread(hub, config, folder)
    parts = AppParts(
        hub=hub,
        config=config,
        setup=setup(),
        alarms=alarms,
        store=store,
        jobs=jobs,
        steps=steps,
        people=people,
        publication=cast(HubPublication, publication),
    )
    port, stop_serving = _served(stack, create_app(parts))
    feeder = Feeder(hub, alarms, rate_hz=RATE_HZ)
    feeder.start()
    publication.start()
    ending = ExitStack()
    for each in (log.stop, publication.stop, stop_serving, feeder.end):
        ending.callback(each)
    stack.callback(ending.close)
    return Place(port=port, people=people, stop=ending.close)


def _served(stack: ExitStack, app: FastAPI) -> tuple[int, Callable[[], None]]:
    """Serve in a thread; return the port, and what stops it."""
    door = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
    server = uvicorn.Server(uvicorn.Config(app, log_level="error", timeout_graceful_shutdown=1))
    serving = threading.Thread(target=server.run, args=([door],), daemon=True)

    def stop() -> None:
        server.should_exit = True
        serving.join()

    serving.start()
    stack.callback(stop)
    return door.getsockname()[1], stop
