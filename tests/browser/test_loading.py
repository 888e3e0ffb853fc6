"""A loading page claims nothing before the server has answered.

Answers and live messages are held back until the test releases them, and the page's clock is controlled by
the test.

"""

import contextlib
import re
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Page, Route, WebSocketRoute, expect

from tests.browser.made_up_ct import answer_ct
from tests.browser.supervised import Supervised
from tests.browser.theatre import CHECKOUT, PATIENCE_MS, WatchedPage

pytestmark = pytest.mark.browser
expect.set_options(timeout=PATIENCE_MS)

Watch = Callable[..., WatchedPage]
NAME = "L3, rehearsal"
STEPS = (
    "",
    "/case",
    "/camera",
    "/tool",
    "/plan",
    "/register",
    "/register/points",
    "/register/needles",
    "/register/sweep",
    "/register/nudges",
    "/check",
    "/navigate",
    "/report",
    "/people",
)
PAGES = [
    ("o1", "theatre"),
    ("v1", "theatre"),
    ("s1", "supervisor"),
    *(("o1", f"operator{step}") for step in STEPS),
]
# Live messages before the answers matter to what shows both: the views, and of the operator's pages those
# that are about the newest image. The others have only the frame of all pages live.
WITH_LIVE = [
    ("o1", "theatre"),
    ("s1", "supervisor"),
    *(("o1", f"operator{step}") for step in ("", "/check", "/navigate")),
]

# None of this is true of the server, so it may never appear.
FALSE = [
    "SERVER LOST",
    "SERVER NOT REACHED",
    "ALARMS UNKNOWN",
    "NO VIDEO",
    "NO TRACKING",
    "NO NUMBERS",
    "SCENE STALE",
    "No drill to show",
    "No tool is calibrated",
    "not visible: turn",
    "not registered",
    "No case is open",
    "no case open",
    "none chosen",
    "not known",
    "no numbers",
    "lost, reconnecting",
    "There is no plan",
    "There is no registration",
    "Open a case",
    "▲  ",
]
# Runs before the page's own script, and records every appearance of these texts and every alert.
RECORDER = f"""(() => {{
    if (window.parent !== window) return;
    const wrong = {FALSE!r};
    const seen = window.seen = [];
    const look = (part) => {{
        const words = document.createTreeWalker(part, NodeFilter.SHOW_TEXT);
        for (let node = words.currentNode; node; node = words.nextNode()) {{
            const around = node.nodeType === Node.TEXT_NODE ? node.parentElement : null;
            if (!around?.checkVisibility({{ visibilityProperty: true }})) continue;
            if (wrong.some((one) => node.data.includes(one))) seen.push(node.data);
            // What the server has told may be an alarm.
            else if (!window.isAnswered && around.closest("[role=alert]")) seen.push(node.data);
        }}
    }};
    new MutationObserver((records) => {{
        for (const {{ target }} of records) look(target.nodeName === "#text" ? target.parentNode : target);
    }}).observe(document, {{ subtree: true, childList: true, characterData: true, attributes: true }});
}})()"""
# Loading may take this long on a busy machine; a silent server counts as lost after 0.8 s.
LOADS_FOR_MS = 2000
REACHED_WITHIN_MS = 10_000
# The longest delay before a reconnect.
NEXT_LINE_AFTER_MS = 500
# Shorter than the silence after which a server counts as lost.
MOMENTS, MOMENT_MS = 10, 300


class Loading:
    """A page whose answers and live messages are held back, with a clock controlled by the test."""

    def __init__(self, watched: WatchedPage, *, rejects: bool = False) -> None:
        self.page = watched.page
        self._rejects = rejects
        self._pending: dict[str, list[Route]] = {"session": [], "rest": [], "live": []}
        self._lines: list[WebSocketRoute] = []
        self._open: set[str] = set()
        self.page.add_init_script(RECORDER)
        self.page.route("**/api/**", self._answer)
        # This server's CT has no slices, and the browser would log each rejection.
        self.page.route("**/api/navigation/ct", answer_ct)
        self.page.route_web_socket(re.compile(r"/ws/(view|live|room)"), self._line)
        self.page.clock.install(time=0)

    def go(self, address: str, path: str) -> None:
        """Load the page with its clock stopped."""
        self.page.goto(f"{address}/{path}")
        # Most views are separate files, which are not held back.
        view = path.split("/", maxsplit=1)[0].capitalize()
        for file in (CHECKOUT / "web" / "dist" / "assets").glob(f"{view}View-*.js"):
            self.page.evaluate("name => import(name)", f"/assets/{file.name}")
        self.page.clock.pause_at(600_000)

    def release(self, *kinds: str) -> None:
        """Release the session, all other answers (rest), or live messages, from now on."""
        self._open.update(kinds)
        if kinds != ("session",):
            self.page.evaluate("window.isAnswered = true")
        for kind in kinds:
            while self._pending[kind]:
                self._pending[kind].pop().continue_()
        if "live" in kinds:
            while self._lines:
                self._lines.pop().close()
            # From here on the clock stands still, so that no image ages and no connection is silent.
            self.pass_ms(NEXT_LINE_AFTER_MS)

    def shows(self, path: str) -> None:
        """Wait until the view is rendered: React shows late content only when its timers have run."""
        view = self.page.locator(f".{path.split('/', maxsplit=1)[0]}")
        for _ in range(20):
            self.pass_ms(50)
            if view.is_visible():
                return
        pytest.fail(f"no view of {path}")

    def comes_true(self, path: str) -> None:
        """Wait until the server's data is shown: numbers that were old return only after a moment."""
        for _ in range(MOMENTS):
            with contextlib.suppress(AssertionError):
                is_true(self.page, path, PATIENCE_MS / MOMENTS)
                return
            self.pass_ms(MOMENT_MS)
        is_true(self.page, path, PATIENCE_MS)

    def pass_ms(self, ms: int) -> None:
        """Advance the page's clock, with all its timers."""
        self.page.clock.run_for(ms)

    def seen(self) -> list[str]:
        """False texts and alerts that appeared."""
        return sorted(set(self.page.evaluate("seen")))

    def _answer(self, route: Route) -> None:
        name = route.request.url.rsplit("/api/", maxsplit=1)[-1]
        # The limits arrive with the session; otherwise the first image counts as old on a busy machine.
        kind = {"session": "session", "dashboard": "session", "live": "live"}.get(name, "rest")
        if kind in self._open:
            route.continue_()
        else:
            self._pending[kind].append(route)

    def _line(self, line: WebSocketRoute) -> None:
        if "live" in self._open:
            line.connect_to_server()
        elif self._rejects:
            line.close()
        else:
            self._lines.append(line)


@pytest.fixture(scope="module")
def supervised() -> Iterator[Supervised]:
    server = Supervised()
    yield server
    server.process.communicate(timeout=30)


def begun(watch: Watch, server: Supervised, person: str, path: str, *, rejects: bool = False) -> Loading:
    # This server's CT has no slices, and the browser logs each rejection.
    watched = watch(server, 1180, 820, strict=path != "operator/plan")
    address = f"http://127.0.0.1:{server.port}"
    watched.page.context.add_cookies([{"name": "person", "value": person, "url": address}])
    loading = Loading(watched, rejects=rejects)
    loading.go(address, path)
    return loading


def is_answered(page: Page, path: str) -> None:
    """The requested data is shown, although nothing live has arrived."""
    if path.startswith("operator"):
        expect(page.get_by_test_id("step-register")).to_contain_text("done")
    elif path == "supervisor":
        expect(page.get_by_test_id("steps")).to_contain_text("Registration")
    expect(page.locator("main .mantine-Loader-root")).to_have_count(0)


def is_true(page: Page, path: str, within_ms: float) -> None:
    """The server's data is shown."""
    if path.startswith("operator"):
        expect(page.get_by_test_id("link-state")).to_contain_text("connected", timeout=within_ms)
        expect(page.get_by_test_id("open-case")).to_contain_text(NAME, timeout=within_ms)
        expect(page.get_by_test_id("step-register")).to_contain_text("done", timeout=within_ms)
    else:
        expect(page.get_by_test_id("numbers")).to_have_attribute("data-live", "true", timeout=within_ms)
        reported = page.get_by_test_id("case-name" if path == "theatre" else "steps")
        expect(reported).to_contain_text(NAME if path == "theatre" else "Registration", timeout=within_ms)
    bands = page.locator(
        "main .loading:visible, .alarms:is([data-priority=loading], [data-priority=unknown])"
    )
    expect(bands).to_have_count(0, timeout=within_ms)


@pytest.mark.parametrize(
    ("person", "path", "first"),
    [*((*page, "rest") for page in PAGES), *((*page, "live") for page in WITH_LIVE)],
)
def test_nothing_false_is_seen_while_a_page_loads(
    supervised: Supervised, watch: Watch, person: str, path: str, first: str
) -> None:
    loading = begun(watch, supervised, person, path)
    page = loading.page
    loading.pass_ms(LOADS_FOR_MS // 2)
    loading.release("session")
    loading.shows(path)
    loading.pass_ms(LOADS_FOR_MS)
    assert loading.seen() == []
    loading.release(first)
    if first == "rest":
        is_answered(page, path)
        loading.pass_ms(LOADS_FOR_MS // 2)
    else:
        expect(page.locator("[aria-busy=true], .alarms[data-priority=loading]")).to_have_count(0)
    assert loading.seen() == []
    loading.release("rest", "live")
    loading.comes_true(path)
    assert loading.seen() == []
    if path == "operator":
        # The page is named, so that it stays when another step is next or the server does not answer.
        expect(page).to_have_url(re.compile(r"/operator/\w+$"))


@pytest.mark.parametrize(
    ("person", "path"), [("o1", "theatre"), ("s1", "supervisor"), ("o1", "operator/check")]
)
def test_server_that_is_not_reached_is_reported_after_ten_seconds_and_not_before(
    supervised: Supervised, watch: Watch, person: str, path: str
) -> None:
    loading = begun(watch, supervised, person, path, rejects=True)
    page = loading.page
    loading.release("session", "rest")
    loading.shows(path)
    loading.pass_ms(REACHED_WITHIN_MS - 1500)
    assert loading.seen() == []
    loading.pass_ms(2000)
    cover = page.locator(".when-stale:visible").first
    expect(cover).to_contain_text("SERVER NOT REACHED")
    expect(cover).to_contain_text("that Coaxial is running")
    expect(page.locator(".alarms [role=alert]")).to_be_visible()
    loading.release("live")
    loading.comes_true(path)
    for band in (".when-stale", ".alarms", ".facts-status"):
        reported = page.locator(f"{band}:visible").filter(has_text=re.compile("not reached", re.IGNORECASE))
        expect(reported).to_have_count(0)
