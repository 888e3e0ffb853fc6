"""Users who work through a server's API until it is killed."""

import json
import random
import threading
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import count
from typing import Any

from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

from tests.procedure.killing.promised import Promised
from tests.procedure.killing.theatre import VERTEBRA
from tests.procedure.real_server import RealServer
from tests.procedure.team import BY, POINTS, Team

VALID_STATES = {"done", "due"}
CONFIRM = "/api/procedure/confirmation"
SERVERS_MISTAKE, MAX_REJECTED = 500, 20


class KilledUnderUs(Exception):
    """The server was killed during a wait."""


class Rejected(Exception):
    """The server rejected a request."""

    def __init__(self, reported: str, status: int) -> None:
        super().__init__(reported)
        self.status = status


@dataclass(slots=True, kw_only=True)
class WatchedServer(RealServer):
    """A client that records confirmations and notices when the server is killed during a wait."""

    promised: Promised
    killed: threading.Event = field(default_factory=threading.Event)

    def ask(self, method: str, path: str, status: int, **sent: Any) -> Any:  # noqa: ANN401  JSON
        """Send a request; a confirmed change is recorded as promised."""
        answer = self.door.request(method, path, **sent)
        if answer.status_code != status:
            raise Rejected(f"{method} {path}: {answer.status_code} {answer.text[:300]}", answer.status_code)
        reported = answer.json() if answer.content else None
        if method != "GET":
            self.promised.note(reported)
        return reported

    def until(self, what: str, true: Any) -> Any:  # noqa: ANN401  whatever became true
        """Wait as usual, or end at once when the server was killed."""

        def or_killed() -> Any:  # noqa: ANN401  whatever became true
            if self.killed.is_set():
                raise KilledUnderUs
            return true()

        return RealServer.until(self, what, or_killed)


@dataclass(slots=True, kw_only=True)
class Listener:
    """Receives every live message and records in which tracking processes numbers were shown."""

    port: int
    numbers: set[int] = field(default_factory=set)
    reasons: dict[int, set[str]] = field(default_factory=dict)
    _stop: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None

    def start(self) -> "Listener":
        """Start receiving."""
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()
        return self

    def stop(self) -> None:
        """Stop receiving."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join()

    def _run(self) -> None:
        with (
            suppress(WebSocketException, OSError),
            connect(f"ws://127.0.0.1:{self.port}/ws/live", proxy=None, compression=None) as socket,
        ):
            while not self._stop.is_set():
                with suppress(TimeoutError):
                    self._hear(json.loads(socket.recv(timeout=0.5)))

    def _hear(self, message: dict[str, Any]) -> None:
        if message["snapshot"] is None:
            return
        process = int(message["process"]["restarts"])
        for tool in message["snapshot"]["tools"]:
            if any(tool[name]["kind"] != "absent" for name in ("deviation", "judgement", "assessment")):
                self.numbers.add(process)
            elif tool["deviation"]["kind"] == "absent":
                self.reasons.setdefault(process, set()).add(tool["deviation"]["reason"])


class People:
    """Do the next step, or something else if all steps are done.

    Args:
        team: the users.
        server: their server.
        chance: source of random choices.
        numbers: of the changes, so that each is made under a unique name.

    """

    def __init__(self, team: Team, server: WatchedServer, rng: random.Random, numbers: "count[int]") -> None:
        self._team = team
        self._server = server
        self._probability = rng
        self._numbers = numbers
        self.doing = ""

    def work(self) -> None:
        """Repeat until killed."""
        rejected = 0
        while True:
            if self._server.killed.is_set():
                raise KilledUnderUs
            try:
                self.act()
                rejected = 0
            except Rejected as why:
                # A collection that lost its images is rejected and started again.
                rejected += 1
                if why.status == SERVERS_MISTAKE or rejected > MAX_REJECTED:
                    raise
            self._server.promised.observe(self._server)

    def act(self) -> None:
        """Do one thing."""
        reported = self._server.ask("GET", "/api/procedure", 200)
        states = {one["step"]: one["state"] for one in reported["steps"]}
        due = next((step for step, state in states.items() if state not in VALID_STATES), "")
        if reported["case_id"] is None:
            self.doing = "a new case"
            self._team.open_case(self._name())
            return
        self.doing = due or "navigating"
        if reported["confirmation"] is not None:
            self.confirm()
            return
        match due:
            case "camera":
                self._team.calibrate_camera()
            case "tool":
                self._team.calibrate_tool()
            case "plan":
                self._plan(reported)
            case "register":
                self._team.touch(5)
                self._server.ask("POST", f"{POINTS}/conclusion", 201, json=BY)
            case "check":
                self._team.check()
            case _:
                self._while_navigating()

    def confirm(self) -> None:
        """Confirm that nothing has moved: navigation continues."""
        needed = self._server.ask("GET", "/api/procedure", 200)["confirmation"]
        assert self._server.shown()
        if needed is not None:
            self._server.ask("POST", CONFIRM, 200, json={"registration_id": needed["registration_id"]})

    def _plan(self, reported: dict[str, Any]) -> None:
        step = next(one for one in reported["steps"] if one["step"] == "plan")
        if step["document_id"] is None:
            self._team.plan(VERTEBRA)
        self._choose(self._probability.choice(("left", "right")))

    def _while_navigating(self) -> None:
        """One of the minor actions."""
        ask, act = self._server.ask, self._probability.random()
        if act < 0.35:
            self.doing = "choosing"
            self._choose(self._probability.choice(("left", "right")))
        elif act < 0.7:
            self._ask_to_hold_or_release()
        elif act < 0.8:
            self.doing = "a second case"
            name = self._name()
            ask("POST", "/api/cases", 201, json={"name": name})
            self._server.promised.names.add(name)
        elif act < 0.95:
            self.doing = "checking"
            self._team.check()
        else:
            self.doing = "registering again"
            self._team.touch(5)
            ask("POST", f"{POINTS}/conclusion", 201, json=BY)

    def _ask_to_hold_or_release(self) -> None:
        """Ask to hold, or release this user's hold, so that kills happen while a hold is active."""
        promised, name = self._server.promised, self._name()
        requested_by = promised.holding
        # Nothing is promised before it is confirmed.
        promised.holding = None
        if requested_by == "":
            self.doing = "asking to hold"
            self._server.ask("POST", "/api/alarms/hold", 200, json={"by": name})
            promised.holding = name
        else:
            self.doing = "releasing the hold"
            self._server.ask("POST", "/api/alarms/release", 200, json={"by": name})
            promised.holding = ""
        # After a kill in the middle of a request there may have been nothing to release, and nothing to log.
        if requested_by is not None:
            promised.names.add(name)

    def _choose(self, side: str) -> None:
        name = self._name()
        requested = {"made_by": name, "vertebra": VERTEBRA, "side": side}
        self._server.ask("POST", "/api/plan/active-channel", 200, json=requested)
        self._server.promised.names.add(name)

    def _name(self) -> str:
        return f"person {next(self._numbers)}"
