"""The plan made by touch on a tablet, from the rehearsal's CT to the channel that is drilled now."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, ConsoleMessage, Page, Response, expect

from tests.browser.theatre import CHECKOUT, SCREENSHOTS
from tests.procedure.real_server import BUSY_MACHINE, PATIENCE_S, RealServer, real_server

pytestmark = pytest.mark.browser

SETTINGS = {**BUSY_MACHINE, "rehearsal": {"seed": 3, "brings_setup": False}}
PX_PER_MM = """() => {
    const ruler = document.querySelector(".planes-large .slice-ruler");
    return ruler.querySelector("span").getBoundingClientRect().width / parseFloat(ruler.textContent);
}"""
# What a glove can hit; a mark in a list of choices may be as low as its text, if it is as wide as the list.
LEAST_TARGET_PX = 48.0
SMALL_TARGETS = f"""() => [...document.querySelectorAll(".plan button, .plan a, .plan select")]
    .map((one) => [one.textContent || one.ariaLabel, one.getBoundingClientRect()])
    .filter(([, box]) => box.width > 0 && Math.min(box.width, box.height) < {LEAST_TARGET_PX - 0.5})
    .map(([name, box]) => `${{name}}: ${{box.width}} x ${{box.height}}`)"""


class Tablet:
    """A page on a tablet, and the fingers on it."""

    def __init__(self, page: Page, server: RealServer) -> None:
        self.page = page
        self.server = server
        self.complaints: list[str] = []
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("console", self._said)
        page.on("response", self._answered)

    def _said(self, message: ConsoleMessage) -> None:
        # What the server refused is told below, by its address.
        if message.type == "error" and not message.text.startswith("Failed to load resource"):
            self.complaints.append(message.text)

    def _answered(self, response: Response) -> None:
        # The first slice of an upload goes with it, which may be while it is asked for.
        if response.status >= 400 and not response.url.split("?")[0].endswith("/preview.png"):
            self.complaints.append(f"{response.status} {response.url}")

    def tap(self, name: str) -> None:
        """On what bears this name for tests."""
        self.page.get_by_test_id(name).tap()

    def sees(self, name: str) -> None:
        """That it comes."""
        expect(self.page.get_by_test_id(name)).to_be_visible()

    def cross(self) -> Any:  # noqa: ANN401  an array
        """Where the page says that the cross is."""
        said = self.page.get_by_test_id("cursor").inner_text()
        return np.array([float(one) for one in re.findall(r"[xyz] (-?[\d.]+)", said)])

    def put_cross(self, point_lps_mm: list[float]) -> None:
        """Scroll to the slice, tap on the place, and bring the cross there with the arrows."""
        wanted = np.array(point_lps_mm)
        for _ in range(100):
            below = wanted[2] - self.cross()[2]
            if abs(below) <= 0.5:
                break
            self.tap("slice-on" if below > 0 else "slice-back")
        # A tap goes to what is seen: while an earlier slice still stands there, to that one.
        expect(self.page.get_by_test_id("slice-axial")).not_to_have_attribute("data-late", "true")
        place = self.page.locator(".planes-large [data-testid=cross] circle").bounding_box()
        assert place is not None
        away_px = (wanted - self.cross()) * self.page.evaluate(PX_PER_MM)
        self.page.touchscreen.tap(
            place["x"] + place["width"] / 2 + away_px[0], place["y"] + place["height"] / 2 + away_px[1]
        )
        expect(self.page.get_by_test_id("slice-axial")).not_to_have_attribute("data-late", "true")
        for axis, (less, more) in enumerate((("cross-left", "cross-right"), ("cross-up", "cross-down"))):
            for _ in range(6):
                off = wanted[axis] - self.cross()[axis]
                if abs(off) <= 0.3:
                    break
                self.tap(more if off > 0 else less)
        assert np.abs(self.cross() - wanted).max() < 0.7

    def plan(self) -> Any:  # noqa: ANN401  JSON
        """As the server has it."""
        return self.server.ask("GET", "/api/plan", 200)


@pytest.fixture
def tablet(browser: Browser, tmp_path: Path) -> Iterator[Tablet]:
    assert (CHECKOUT / "web" / "dist" / "index.html").is_file(), "the page is not built"
    with real_server(tmp_path, SETTINGS) as server:
        case = server.ask("POST", "/api/cases", 201, json={"name": "L3, left"})
        server.ask("POST", f"/api/cases/{case['id']}/open", 200)
        context = browser.new_context(viewport={"width": 1280, "height": 800}, has_touch=True, locale="en-GB")
        context.set_default_timeout(PATIENCE_S * 1000)
        expect.set_options(timeout=PATIENCE_S * 1000)
        try:
            made = Tablet(context.new_page(), server)
            made.page.goto(f"http://127.0.0.1:{server.port}/operator/plan")
            yield made
        finally:
            expect.set_options(timeout=5000)
            context.close()


def test_a_plan_is_made_by_touch(tablet: Tablet) -> None:
    tablet.tap("rehearsal-ct")
    tablet.sees("slice-axial")
    tablet.tap("add-vertebra")
    tablet.tap("level-L3")

    truth = tablet.server.ask("GET", "/api/rehearsal?truth=1", 200)["truth"]
    for side, channel in zip(("left", "right"), truth["channels"], strict=True):
        measured_where_it_is(tablet, side, channel)
    SCREENSHOTS.mkdir(exist_ok=True)
    tablet.page.screenshot(path=SCREENSHOTS / "tablet-plan.png")
    assert tablet.page.evaluate(SMALL_TARGETS) == []

    tablet.tap("activate")
    tablet.sees("is-active")
    assert tablet.plan()["active_channel"]["side"] == "right"
    moved_and_undone(tablet)
    with_lines(tablet)
    with_landmarks(tablet)

    expect(tablet.page.get_by_test_id("step-said")).to_have_attribute("data-state", "done")
    assert tablet.complaints == []


def measured_where_it_is(tablet: Tablet, side: str, channel: dict[str, Any]) -> None:
    """Tap into a pedicle, measure it, lay its channel and take the proposed screw."""
    tablet.tap("part-pedicle")
    tablet.page.get_by_test_id("side").get_by_text(side.capitalize(), exact=True).tap()
    entry, target = np.array(channel["entry_lps_mm"]), np.array(channel["target_lps_mm"])
    tablet.put_cross((entry + 0.35 * (target - entry)).tolist())
    tablet.tap("measure")
    tablet.sees("pedicle-numbers")
    tablet.tap("lay-channel")
    tablet.tap("propose-screw")
    expect(tablet.page.get_by_test_id("screw-numbers")).to_contain_text("Gertzbein-Robbins A")
    (vertebra,) = tablet.plan()["plan"]["vertebrae"]
    laid = next(one for one in vertebra["channels"] if one["side"] == side)["channel"]
    assert np.linalg.norm(
        np.cross(entry - laid["entry_in_vertebra_mm"], target - entry)
    ) < 1.5 * np.linalg.norm(target - entry)


def moved_and_undone(tablet: Tablet) -> None:
    """A slip of the hand: the channel is moved and kept, then taken back."""

    def entry() -> Any:  # noqa: ANN401  JSON
        (vertebra,) = tablet.plan()["plan"]["vertebrae"]
        right = next(one for one in vertebra["channels"] if one["side"] == "right")
        return right["channel"]["entry_in_vertebra_mm"]

    before = entry()
    tablet.tap("move-channel")
    knob = tablet.page.get_by_test_id("handle-entry").locator(".draw-handle-touch").bounding_box()
    assert knob is not None
    assert min(knob["width"], knob["height"]) >= LEAST_TARGET_PX
    tablet.tap("channel-right")
    tablet.tap("channel-right")
    tablet.tap("keep-channel")
    tablet.sees("move-channel")
    assert np.array(entry()) - before == pytest.approx([1.0, 0.0, 0.0], abs=1e-6)
    assert tablet.plan()["active_channel"] is None
    tablet.tap("undo")
    tablet.server.until("the channel where it was", lambda: entry() == pytest.approx(before, abs=1e-9))
    tablet.tap("activate")
    tablet.sees("is-active")


def with_lines(tablet: Tablet) -> None:
    """The proposed slice, with the needles' lines 20.5 mm to each side."""
    tablet.tap("part-lines")
    tablet.tap("propose-slice")
    tablet.tap("apart-more")
    tablet.tap("lay-lines")
    tablet.sees("reference")
    (reference,) = tablet.plan()["plan"]["vertebrae"][0]["references"]
    assert reference["apart_mm"] == 20.5
    assert [line["name"] for line in reference["lines"]] == ["middle", "left", "right"]


def with_landmarks(tablet: Tablet) -> None:
    """One is set at the cross by its usual name; then those that the rehearsal's drill will touch."""
    tablet.tap("part-landmarks")
    cross = tablet.cross()
    tablet.tap("set-landmark")
    tablet.page.get_by_role("button", name="spinous process, upper end").tap()
    expect(tablet.page.get_by_test_id("landmark-count")).to_contain_text("1 set · needed at least 3")
    (vertebra,) = tablet.plan()["plan"]["vertebrae"]
    assert vertebra["landmarks"][0]["point_lps_mm"] == pytest.approx(cross, abs=0.06)
    truth = tablet.server.ask("GET", "/api/rehearsal?truth=1", 200)["truth"]
    tablet.tap("rehearsed-landmarks")
    expect(tablet.page.get_by_test_id("landmark-count")).to_contain_text(f"{len(truth['landmarks']) + 1} set")
