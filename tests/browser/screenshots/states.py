"""States of the page that are worth a screenshot, and the servers that show them."""

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Page

from server.app import AppParts, create_app
from server.config import CameraConfig, Config
from server.live import LiveHub
from server.loop.phone_inbox import PhoneInbox
from server.stream.phone.receiver import Receiver
from tests.browser.prepared import prepared
from tests.browser.supervised import Supervised
from tests.browser.theatre import Theatre
from tests.procedure.real_server import BUSY_MACHINE, real_server
from tests.served import served


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """One state of one view.

    Attributes:
        name: Of the picture.
        path: Address, without its first slash.
        order: What the server is told before, if anything.
        event: CSS selector of what must have been visible, if anything.
        next_order: What the server is told after that.
        ready: CSS selector of what is visible then, and is brought into sight.
        person: Who is signed in, on a server with users.
        clicks: Test ids of what is clicked, in order.
        is_unconfirmed: Whether the procedure waits for a confirmation after a restart.
        has_real_limits: Whether the page keeps the server's age limits, so that numbers become old.
    """

    name: str
    path: str
    ready: str
    order: str = ""
    event: str = ""
    next_order: str = ""
    person: str = ""
    clicks: Sequence[str] = ()
    is_unconfirmed: bool = False
    has_real_limits: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """A running server.

    Attributes:
        port: Of the server.
        tell: Changes what it publishes.
    """

    port: int
    tell: Callable[[str], None] = lambda _: None


LIVE_VIDEO = "[data-testid=video][data-live=true]"
LIVE_NUMBERS = "[data-testid=numbers][data-live=true]"
ALERT = "[data-testid=alert]"
STEPS = ("case", "camera", "tool", "plan", "register", "check", "navigate", "recordings", "report", "people")
WAYS = ("points", "needles", "sweep", "nudges")


def figure(name: str, status: str) -> str:
    """Selector of a figure in this state."""
    return f"[data-reading={name}][data-status={status}]"


THEATRE_STATES = (
    *(
        State(name=f"theatre-layout-{one}", path=f"theatre?layout={one}", order="path", ready=LIVE_VIDEO)
        for one in ("approach", "align", "drill", "overview")
    ),
    State(
        name="theatre-layout-figures",
        path="theatre?layout=figures",
        order="path",
        ready=figure("wall", "within"),
    ),
    State(
        name="theatre-layout-figures-near",
        path="theatre?layout=figures",
        order="near",
        ready=figure("wall", "over"),
    ),
    State(name="theatre-verdict-on-path", path="theatre", order="path", ready=figure("wall", "within")),
    State(name="theatre-verdict-entry", path="theatre", order="entry", ready=figure("entry", "over")),
    State(name="theatre-verdict-near", path="theatre", order="near", ready=figure("wall", "over")),
    State(name="theatre-verdict-breach", path="theatre", order="breach", ready=".alarms[data-priority=high]"),
    State(name="theatre-verdict-hidden", path="theatre", order="hidden", ready="[data-testid=no-tracking]"),
    State(name="theatre-verdict-deep", path="theatre", order="deep", ready=figure("depth", "through")),
    State(
        name="theatre-insufficient",
        path="theatre",
        order="insufficient",
        ready="[data-verdict=setup_insufficient]",
    ),
    State(
        name="theatre-latched",
        path="theatre?latched",
        order="breach",
        event=".alarms[data-priority=high]",
        next_order="path",
        ready="[data-testid=headline-event]:not(:empty)",
    ),
    *(
        State(
            name=f"{view}-stopped",
            path=path,
            order="stopped",
            ready=".restart",
            is_unconfirmed=True,
        )
        for view, path in (
            ("theatre", "theatre"),
            ("theatre-figures", "theatre?layout=figures"),
            ("operator", "operator/navigate"),
        )
    ),
    State(name="theatre-details", path="theatre", order="path", clicks=("more",), ready=LIVE_VIDEO),
    State(name="theatre-scene", path="theatre?", order="path", clicks=("tile-scene",), ready=LIVE_VIDEO),
    State(name="theatre-unseen", path="theatre", order="unseen", ready="[data-testid=no-tracking]"),
    State(name="theatre-uncalibrated", path="theatre", order="bare", ready="[data-testid=no-tracking]"),
    State(name="theatre-camera-lost", path="theatre", order="lost", clicks=("alarms-more",), ready=ALERT),
    State(
        name="supervisor-camera-lost", path="supervisor", order="lost", clicks=("alarms-more",), ready=ALERT
    ),
    State(name="supervisor-breach", path="supervisor", order="breach", ready=".alarms[data-priority=high]"),
    State(name="supervisor-path", path="supervisor", order="path", ready=figure("wall", "within")),
    *(
        State(name=f"operator-empty-{step}", path=f"operator/{step}", order="live", ready=".step h2")
        for step in STEPS
    ),
    State(
        name="operator-breach", path="operator/navigate", order="breach", ready=".alarms[data-priority=high]"
    ),
    State(name="sign-in", path="enter", ready="[data-testid=enter]"),
    State(
        name="theatre-stale",
        path="theatre?stale",
        order="stop",
        ready="[data-testid=no-tracking]",
        has_real_limits=True,
    ),
    State(
        name="supervisor-stale",
        path="supervisor?stale",
        order="stop",
        ready="[data-testid=no-tracking]",
        has_real_limits=True,
    ),
)
SUPERVISED_STATES = (
    State(name="supervised-supervisor", path="supervisor", person="s1", ready=LIVE_NUMBERS),
    *(
        State(
            name=f"supervised-fold-{fold}",
            path=f"supervisor?{fold}",
            person="s1",
            clicks=(f"fold-{fold} summary",),
            ready=f"[data-testid=fold-{fold}][open]",
        )
        for fold in ("plan", "registration", "log", "recordings")
    ),
    State(
        name="supervised-review",
        path="supervisor?review",
        person="s1",
        clicks=("fold-recordings summary", "review-open"),
        ready="[data-testid=review-image]",
    ),
    State(name="supervised-theatre-guest", path="theatre", person="v1", ready=LIVE_VIDEO),
    *(
        State(name=f"supervised-{step}", path=f"operator/{step}", person="o1", ready=".step h2")
        for step in STEPS
        if step not in ("camera", "plan")
    ),
    State(
        name="supervised-consent",
        path="operator/navigate?consent",
        person="o1",
        clicks=("record",),
        ready="[role=dialog]",
    ),
)
PREPARED_STATES = (
    *(
        State(name=f"prepared-{step}", path=f"operator/{step}", ready=".step h2")
        for step in ("case", "camera", "tool", "plan", "register", "check", "navigate", "report")
    ),
    State(
        name="prepared-plan-landmarks", path="operator/plan?", clicks=("part-landmarks",), ready=".step h2"
    ),
    *(
        State(name=f"prepared-register-{way}", path=f"operator/register/{way}", ready=".step h2")
        for way in WAYS
    ),
)
CUT = "[data-testid=cut-probe][data-shows=live]"
REHEARSAL_STATES = (
    *(
        State(name=f"rehearsal-{one}", path=f"theatre?layout={one}", ready=CUT)
        for one in ("approach", "align", "drill", "overview")
    ),
    State(
        name="rehearsal-anatomical", path="theatre?anatomical", clicks=("tile-anatomical",), ready=LIVE_VIDEO
    ),
    State(name="rehearsal-supervisor", path="supervisor", ready=CUT),
    State(name="rehearsal-navigate", path="operator/navigate", ready=".step h2"),
)
CAMERA_STATES = (
    State(name="camera-idle", path="camera", ready="[data-testid=phone-button]"),
    State(
        name="camera-sending",
        path="camera?sending",
        clicks=("phone-button",),
        ready="[data-testid=phone][data-state=sending]",
    ),
)


@contextmanager
def theatre_stage() -> Iterator[Stage]:
    """A simulated drill, an empty store and no users."""
    with Theatre() as theatre:
        yield Stage(port=theatre.port, tell=theatre.tell)


@contextmanager
def supervised_stage() -> Iterator[Stage]:
    """A case that lacks only a co-signature, with users and two recordings."""
    server = Supervised()
    try:
        yield Stage(port=server.port)
    finally:
        server.process.communicate(timeout=60)


SETUP_SCENE = {
    **BUSY_MACHINE,
    "rehearsal": {"provides_setup": False, "reference": True, "rate_hz": 4, "scene": "landmarks"},
    "reference": {"marker": "reference"},
}


@contextmanager
def prepared_stage() -> Iterator[Stage]:
    """A case with camera, tool, CT and plan, before its registration."""
    with tempfile.TemporaryDirectory() as folder:
        prepared(Path(folder) / "home", Config.model_validate(SETUP_SCENE).rehearsal)
        with real_server(Path(folder), SETUP_SCENE) as server:
            channel = {"made_by": "M. Ito", "vertebra": "L3", "side": "left"}
            server.ask("POST", "/api/plan/active-channel", 200, json=channel)
            yield Stage(port=server.port)


@contextmanager
def rehearsal_stage() -> Iterator[Stage]:
    """The rehearsal with its own set-up and CT."""
    settings = {**BUSY_MACHINE, "rehearsal": {"rate_hz": 4}}
    with tempfile.TemporaryDirectory() as folder, real_server(Path(folder), settings) as server:
        yield Stage(port=server.port)


@contextmanager
def camera_stage() -> Iterator[Stage]:
    """A server that takes the images of a phone."""
    settings = CameraConfig(source="phone", width=1280, height=720)
    inbox = PhoneInbox()
    try:
        parts = AppParts(hub=LiveHub(), config=Config(camera=settings), phone=Receiver(inbox, settings))
        with served(create_app(parts)) as port:
            yield Stage(port=port)
    finally:
        inbox.close()


def click(page: Page, step: str) -> None:
    """Click the first element with this test id, or what follows it as a selector inside."""
    name, _, inside = step.partition(" ")
    found = page.get_by_test_id(name).first
    (found.locator(inside) if inside else found).click()


STAGES: Mapping[str, tuple[Callable[[], AbstractContextManager[Stage]], Sequence[State]]] = {
    "theatre": (theatre_stage, THEATRE_STATES),
    "supervised": (supervised_stage, SUPERVISED_STATES),
    "prepared": (prepared_stage, PREPARED_STATES),
    "rehearsal": (rehearsal_stage, REHEARSAL_STATES),
    "camera": (camera_stage, CAMERA_STATES),
}
