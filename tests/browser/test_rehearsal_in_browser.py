"""The real program in a real browser: the rehearsal with tracking, display, failures and recovery.

`COAXIAL_URL=http://127.0.0.1:8000/` runs these tests against a running server (as started by `make run`)
instead of their own; tests that would damage it are skipped.

"""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Page, Request, ViewportSize, expect

from tests.browser.axe import violations
from tests.browser.canvas import PIXELS
from tests.browser.test_accessibility import PHONE, THEATRE
from tests.browser.test_dashboard import DIGEST, is_live
from tests.browser.theatre import CHECKOUT, WatchedPage, save_screenshot, show_scene

pytestmark = pytest.mark.browser

# The rehearsal's drill is out of view for nine of its forty seconds.
ONE_CYCLE_MS = 60_000
# Scale of screenshots: legible, and small in the repository.
PICTURE: ViewportSize = {"width": 1440, "height": 810}

STATIONS = re.findall(
    r'\{ name: "(\w+)",', (CHECKOUT / "web" / "src" / "tour" / "stations.ts").read_text(encoding="utf-8")
)
# The card of the tour is in the window, and apart from the alarms.
CARD_IS_APART = """() => {
    const [card, alarms] = [".tour", ".alarms"]
        .map(part => document.querySelector(part)?.getBoundingClientRect());
    if (!card || !alarms) return false;
    const isWithin = card.left >= 0 && card.right <= innerWidth;
    const isInside = isWithin && card.top >= 0 && card.bottom <= innerHeight;
    return isInside && (alarms.bottom <= card.top || card.bottom <= alarms.top);
}"""
THREE_DEPTHS = """() => {
    const text = document.querySelector('[data-testid="reading-depth"]').textContent;
    window.depths ??= new Set();
    if (/^\u2212?\\d+\\.\\d$/.test(text)) window.depths.add(text);
    return window.depths.size >= 3;
}"""
CUTS = ("axial", "sagittal", "probe")
# Left, right, top and bottom in the radiological convention.
ANATOMICAL_CUTS = {"anatomical-axial": "RLAP", "anatomical-coronal": "RLHF"}
SCAN_MS = 120_000
LETTERS = """stage => ["left", "right", "top", "bottom"]
    .map(edge => stage.querySelector(`[data-edge=${edge}]`).textContent).join("")"""
# Every cut shows bone and soft tissue around the drill, and its image number has advanced.
CUT_AND_MOVING = """() => {
    window.cutImages ??= new Map();
    return ["axial", "sagittal", "probe"].every((name) => {
        const stage = document.querySelector(`[data-testid="cut-${name}"]`);
        if (stage?.dataset.shows !== "live") return false;
        const canvas = stage.querySelector("canvas");
        const data = PIXELS(canvas);
        const greys = data.filter((_, index) => index % 4 === 0 && data[index + 3] === 255);
        const drill = stage.querySelector(name === "probe" ? "[data-part=ring]" : "[data-part=shaft]");
        const images = window.cutImages.get(name) ?? new Set();
        const stamp = stage.querySelector(".cut-stamp").textContent;
        window.cutImages.set(name, images.add(stamp.match(/\\d+/)?.[0]));
        const hasBone = greys.some((grey) => grey > 150) && greys.some((grey) => grey < 110);
        return hasBone && drill.getAttribute("d") !== "" && images.size > 2;
    });
}""".replace("PIXELS", PIXELS)
DRILLING = """() => {
    const pane = (name) => document.querySelector(`[data-testid="${name}"]`);
    const depth = Number(pane("reading-depth").textContent);
    const live = [...document.querySelectorAll("[data-live]")].every((one) => one.dataset.live === "true");
    return live && depth > 6 && depth < 24;
}"""


class Rehearsal:
    """`coaxial run` in its own process, or the server at `COAXIAL_URL`."""

    def __init__(self, folder: Path) -> None:
        self.process: subprocess.Popen[str] | None = None
        named = os.environ.get("COAXIAL_URL")
        if named:
            self.port = urlsplit(named).port or 80
            return
        # A busy machine delays images, and late ones are covered; other tests check when.
        (folder / "config.yaml").write_text(
            "limits: {pose_stale_after_ms: 4000, video_stale_after_ms: 5000, scene_stale_after_ms: 5000}\n"
            "security: {sign_in: off}\n"
            # The first minute is tested at the usual rate.
            "rehearsal: {rate_hz: 10}\n"
        )
        self.process = subprocess.Popen(
            [sys.executable, "-m", "server", "run", "--port", "0"],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": str(CHECKOUT), "COAXIAL_HOME": str(folder / "home")},
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        said = "".join(self.process.stdout.readline() for _ in range(2))
        address = re.search(r"http://127\.0\.0\.1:(\d+)/", said)
        assert address, f"the server said no address, but: {said!r}"
        self.port = int(address[1])

    def tracking_pid(self) -> int:
        """The capture and tracking process: the fork server's only child."""
        assert self.process is not None
        (forker,) = (pid for pid in children_of(self.process.pid) if children_of(pid))
        (tracking,) = children_of(forker)
        return tracking

    def stop(self) -> None:
        """Send SIGINT, as Ctrl+C does."""
        if self.process is None:
            return
        self.process.send_signal(signal.SIGINT)
        _, _ = self.process.communicate(timeout=30)
        assert self.process.returncode == 0


def children_of(pid: int) -> list[int]:
    """Child processes of this process."""
    found = []
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
        except OSError:
            continue
        if parent == pid:
            found.append(int(entry.name))
    return found


@pytest.fixture(scope="module")
def rehearsal(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rehearsal]:
    server = Rehearsal(tmp_path_factory.mktemp("rehearsal"))
    yield server
    server.stop()


def test_rehearsal_is_tracked_and_seen_in_picture_numbers_and_scene(
    rehearsal: Rehearsal, watch: Callable[..., WatchedPage]
) -> None:
    page = watch(rehearsal, 1920, 1080).open()
    cuts_follow_the_drill(page)
    show_scene(page)
    expect(page.get_by_test_id("scene")).to_have_attribute("data-live", "true", timeout=ONE_CYCLE_MS)
    first_picture = page.locator("canvas.sharp").evaluate(DIGEST)
    page.wait_for_function(
        f"first => ({DIGEST})(document.querySelector('canvas.sharp')) !== first", arg=first_picture
    )
    page.wait_for_function(THREE_DEPTHS, timeout=2 * ONE_CYCLE_MS)
    page.set_viewport_size(PICTURE)
    page.get_by_test_id("tile-sagittal").click()
    picture_while_drilling(page, "dashboard")


def cuts_follow_the_drill(page: Page) -> None:
    """Three cuts of the rehearsal's CT follow the drill, each in its own plane."""
    for name in CUTS:
        # The rehearsal's CT is simulated after the first request, at the lowest priority.
        expect(page.get_by_test_id(f"cut-{name}")).to_have_attribute("data-shows", "live", timeout=SCAN_MS)
    page.wait_for_function(CUT_AND_MOVING, timeout=ONE_CYCLE_MS)
    # Seen from behind a prone patient: left on the left, head on top; in-line cuts have anterior on top.
    assert [page.get_by_test_id(f"cut-{name}").evaluate(LETTERS) for name in CUTS] == ["RLAP", "FHAP", "LRHF"]
    page.get_by_test_id("ahead-10").click()
    page.wait_for_function(CUT_AND_MOVING, timeout=ONE_CYCLE_MS)
    page.get_by_test_id("tile-anatomical").click()
    page.get_by_test_id("tile-anatomical-coronal").click()
    for name, letters in ANATOMICAL_CUTS.items():
        cut = page.get_by_test_id(f"cut-{name}")
        expect(cut).to_have_attribute("data-shows", "live", timeout=ONE_CYCLE_MS)
        assert cut.evaluate(LETTERS) == letters
    page.get_by_test_id("tile-anatomical").click()


def picture_while_drilling(page: Page, name: str) -> None:
    """Take a screenshot during drilling, with every pane live; the README shows one of them.

    On a slow machine taking it blocks the page, and late content is removed; then it is repeated.

    """
    for _ in range(20):
        page.wait_for_function(DRILLING, timeout=2 * ONE_CYCLE_MS)
        save_screenshot(page, name)
        if page.evaluate(DRILLING):
            return
    pytest.fail("in 20 screenshots the page was never live before and after")


def test_a_tour_leads_through_the_pages_by_the_keyboard_covers_no_alarm_and_is_left_by_escape(
    rehearsal: Rehearsal, watch: Callable[..., WatchedPage]
) -> None:
    page = watch(rehearsal, 1180, 820).open("operator/case")
    page.emulate_media(reduced_motion="reduce")
    changes: list[str] = []

    def note(request: Request) -> None:
        # Each page with alarms states by itself whether its sound is armed.
        if request.method != "GET" and not request.url.endswith("/api/alarms/screens"):
            changes.append(f"{request.method} {request.url}")

    page.on("request", note)
    page.get_by_test_id("tour-offer").get_by_role("button").first.click()
    tour = page.get_by_test_id("tour")
    for number, station in enumerate(STATIONS):
        expect(tour).to_have_attribute("data-station", station)
        expect(page.locator("[data-toured]")).to_have_count(1)
        for width, height in (THEATRE, PHONE, (1180, 820)):
            page.set_viewport_size({"width": width, "height": height})
            page.wait_for_function(CARD_IS_APART)
        expect(page.get_by_test_id("tour-next")).to_be_focused()
        if number + 1 < len(STATIONS):
            page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.closest('.tour')") is None
    page.keyboard.press("Escape")
    expect(tour).to_have_count(0)
    # It was a look around, and it is not offered again, but it can be started.
    assert changes == []
    page.goto(f"http://127.0.0.1:{rehearsal.port}/operator/case")
    page.get_by_test_id("tour-start").click()
    expect(tour).to_have_attribute("data-station", STATIONS[0])
    for theme in ("dark", "light"):
        page.emulate_media(color_scheme=theme)
        expect(page.locator("html")).to_have_attribute("data-theme", theme)
        assert violations(page) == []
    page.get_by_test_id("tour-leave").click()
    page.get_by_test_id("step-case").click()
    expect(page.get_by_test_id("new-case")).to_be_visible()
    expect(page.get_by_test_id("tour-offer")).to_have_count(0)


def test_killed_tracking_takes_the_numbers_and_comes_back_by_itself(
    rehearsal: Rehearsal, watch: Callable[..., WatchedPage]
) -> None:
    if rehearsal.process is None:
        pytest.skip("the server that COAXIAL_URL names is not ours to hurt")
    page = watch(rehearsal).open()
    expect(page.get_by_test_id("numbers")).to_have_attribute("data-live", "true", timeout=ONE_CYCLE_MS)
    killed = rehearsal.tracking_pid()
    os.kill(killed, signal.SIGKILL)
    is_live(page, "video", live=False)
    is_live(page, "numbers", live=False)
    is_live(page, "video")
    expect(page.get_by_test_id("numbers")).to_have_attribute("data-live", "true", timeout=ONE_CYCLE_MS)
    assert rehearsal.tracking_pid() != killed
