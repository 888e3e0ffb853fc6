"""The whole application with access control, and users of every role."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

from fastapi import FastAPI
from fastapi.testclient import TestClient
from starlette.routing import BaseRoute

from server.app import AppParts, create_app
from server.config import Config
from server.jobs import Jobs
from server.live import LiveHub
from server.logs import LogSettings
from server.procedure import Steps, TrackingLink
from server.security import AuditLog, PeopleService, Role
from server.security.people.service import NewInvitation
from server.store import CaseStore, Home
from tests.server.recording.no_recorder import recordings_without_process

HOST = "127.0.0.1:8000"


class Clock:
    """A wall clock and a stopwatch set by the test."""

    def __init__(self) -> None:
        self.at = datetime(2026, 11, 21, 8, tzinfo=UTC)
        self.seconds_s = 1000.0

    def now(self) -> datetime:
        return self.at

    def seconds(self) -> float:
        return self.seconds_s

    def passes(self, **time: float) -> None:
        gone = timedelta(**time)
        self.at += gone
        self.seconds_s += gone.total_seconds()


@dataclass(slots=True, kw_only=True)
class Guarded:
    """The application, its client, and its access control."""

    app: FastAPI
    door: TestClient
    people: PeopleService
    store: CaseStore
    live: LiveHub
    clock: Clock

    def invited(self, role: Role = Role.OPERATOR, **wanted: Any) -> str:  # noqa: ANN401  as Wanted takes it
        """The token of a new invitation."""
        usual: dict[str, Any] = {"name": role.value, "role": role, "lasts": timedelta(hours=1)}
        requested = NewInvitation(**(usual | wanted))
        return self.people.invite(requested, by="test")[1].text

    def token(self, role: Role = Role.OPERATOR, **wanted: Any) -> str:  # noqa: ANN401  as Wanted takes it
        """Token of a session with this role."""
        return self.people.sign_in(self.invited(role, **wanted), address="test")[1].text

    def bearer(self, role: Role = Role.OPERATOR, **wanted: Any) -> dict[str, str]:  # noqa: ANN401
        """Header of a signed-in script with this role."""
        return {"Authorization": f"Bearer {self.token(role, **wanted)}"}


def people_of(folder: Path, clock: Clock, *, required: bool = True) -> PeopleService:
    """Return the service of a folder, with this clock."""
    audit = AuditLog(folder, clock=clock.now)
    return PeopleService(folder, audit=audit, required=required, clock=clock.now, seconds=clock.seconds)


@contextmanager
def guarded(
    folder: Path, *, required: bool = True, settings: Mapping[str, object] | None = None
) -> Iterator[Guarded]:
    """All parts, in this folder."""
    config = Config.model_validate(settings or {})
    clock, hub, jobs = Clock(), LiveHub(), Jobs(log=LogSettings(as_json=True))
    try:
        with Home(folder) as home, CaseStore(home) as store:
            people = people_of(folder / "security", clock, required=required)
            store.set_change_listener(people.audit.record_change)
            steps = Steps.of(
                hub=hub,
                store=store,
                jobs=jobs,
                config=config,
                markers=(),
                tracking=TrackingLink(publish_setup=lambda _: None),
            )
            parts = AppParts(
                hub=hub,
                config=config,
                store=store,
                jobs=jobs,
                steps=steps,
                people=people,
                recordings=recordings_without_process(store, config),
            )
            app = create_app(parts)
            with TestClient(app, base_url=f"http://{HOST}", raise_server_exceptions=False) as door:
                yield Guarded(app=app, door=door, people=people, store=store, live=hub, clock=clock)
    finally:
        jobs.close()


def addresses_of(app: FastAPI) -> set[tuple[str, str]]:
    """Every method and path of the application, except the files of page and guide."""
    return {found for route in app.router.routes for found in _addresses(route)}


def _addresses(route: BaseRoute) -> Iterator[tuple[str, str]]:
    inner = getattr(route, "original_router", None)
    if inner is not None:
        for one in inner.routes:
            yield from _addresses(one)
        return
    path = getattr(route, "path", "")
    if getattr(route, "name", "") in {"page", "not_built", "guide"}:
        return
    methods = getattr(route, "methods", None)
    if methods is None:
        yield ("WS", path)
        return
    for method in set(methods) - {"HEAD"}:
        yield (method, path)
