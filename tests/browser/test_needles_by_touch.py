"""The operator's tablet, by touch, against the real program: registered, checked, navigating with numbers."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

from server.config import Config
from tests.browser.prepared import prepared
from tests.browser.theatre import PATIENCE_MS, SCREENSHOTS, Watched
from tests.procedure.real_server import BUSY_MACHINE, RealServer, real_server

pytestmark = pytest.mark.browser

BY = {"made_by": "M. Ito"}
SETTINGS = {
    **BUSY_MACHINE,
    "rehearsal": {
        "seed": 3,
        "brings_setup": False,
        "reference": True,
        "rate_hz": 8,
        "scene": "landmarks",
        "skill": "good",
    },
    # A busy machine brings images seldom; how still a tip must be held, others ask.
    "registration": {
        "capture_images": 3,
        "capture_s": 0.8,
        "most_capture_gap_s": 2.0,
        "most_capture_sd_mm": 1.0,
    },
    "reference": {"marker": "reference"},
}
LANDSCAPE, UPRIGHT = (1280, 800), (800, 1280)
LEAST_TARGET_PX = 48.0
# The rehearsed hand goes from one to the next, in the plan's order.
TOUCHED_IN_TURN = 7
TARGETS = """least => [...document.querySelectorAll("#step :is(button, a, input[type=text])")]
    .map(one => [one.textContent || one.getAttribute("aria-label"), one.getBoundingClientRect()])
    .filter(([, box]) => box.width > 0 && (box.height < least - 0.5 || box.width < least - 0.5))
    .map(([name, box]) => `${name} ${box.width}x${box.height}`)"""
# A slow page sees the last of a gesture late: so many images of the screen without a move are its end.
AT_REST = """() => new Promise(resolve => {
    const state = () => document.querySelector("[data-testid=overlay-state]").dataset;
    let [last, still] = ["", 0];
    const look = () => {
        const now = state().overlay;
        still = now === last && state().settled === "true" ? still + 1 : 0;
        last = now;
        if (still >= 20) resolve(); else requestAnimationFrame(look);
    };
    look();
})"""


@dataclass(frozen=True, slots=True)
class Tablet:
    """A page under a finger."""

    page: Page
    server: RealServer

    def go(self, path: str) -> None:
        """Load a step's page."""
        self.page.goto(f"http://127.0.0.1:{self.server.port}/operator/{path}")

    def tap(self, name: str) -> None:
        """Touch what has this name for tests, as soon as it can be touched."""
        there = self.page.get_by_test_id(name)
        expect(there).to_be_enabled(timeout=PATIENCE_MS)
        there.tap()

    def picture(self, name: str) -> None:
        """Both ways of holding the tablet, looked at later; every target is large enough for a glove."""
        SCREENSHOTS.mkdir(exist_ok=True)
        for way, (width, height) in (("upright", UPRIGHT), ("landscape", LANDSCAPE)):
            self.page.set_viewport_size({"width": width, "height": height})
            self.page.screenshot(path=SCREENSHOTS / f"operator-{name}-{way}.png", full_page=True)
            assert self.page.evaluate(TARGETS, LEAST_TARGET_PX) == []
            assert self.page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RealServer]:
    """The program on a case that waits for registration."""
    folder = tmp_path_factory.mktemp("operator")
    prepared(folder / "home", Config.model_validate(SETTINGS).rehearsal)
    with real_server(folder, SETTINGS) as running:
        asked = {**BY, "vertebra": "L3", "side": "left"}
        running.ask("POST", "/api/plan/active-channel", 200, json=asked)
        yield running


@pytest.fixture
def tablet(server: RealServer, browser: Browser) -> Iterator[Tablet]:
    """A tablet in landscape that only its fingers move."""
    width, height = LANDSCAPE
    context = browser.new_context(viewport={"width": width, "height": height}, has_touch=True, locale="en-GB")
    context.set_default_timeout(PATIENCE_MS)
    watched = Watched(context.new_page(), server.port)
    yield Tablet(watched.page, server)
    context.close()
    assert watched.strangers == []
    assert watched.complaints == []


@pytest.mark.skip(reason="not yet seen to pass from end to end: its captures want a machine that is free")
def test_points_are_touched_checked_and_navigated_by(server: RealServer, tablet: Tablet) -> None:
    page = tablet.page
    tablet.go("register")
    expect(page.get_by_test_id("registration-none")).to_be_visible()
    tablet.picture("register")
    tablet.tap("method-points")
    tablet.tap("points-begin")
    expect(page.get_by_test_id("points-conclude")).to_be_disabled()
    while page.locator("[data-touched=true]").count() < 4:
        touch_where_the_tip_rests(page)
    # A slip of the glove: the last one is thrown away, and taken again.
    tablet.tap("undo-last")
    expect(page.locator("[data-touched=true]")).to_have_count(3)
    while page.locator("[data-touched=true]").count() < 4:
        touch_where_the_tip_rests(page)
    expect(page.get_by_test_id("points-pass")).to_be_visible()
    tablet.picture("points")
    tablet.tap("points-conclude")
    expect(page.get_by_test_id("registration-now")).to_contain_text("Error at the entry point")
    tablet.picture("registered")

    tablet.tap("to-check")
    tablet.tap("scene-check")
    resting = page.locator("[data-testid=tip-rests]:not([data-landmark=''])")
    landmark = resting.get_attribute("data-landmark")
    tablet.tap(f"check-{landmark}")
    begin_until_taken(tablet)
    expect(page.get_by_test_id("check-outcome")).to_have_attribute("data-passed", "true")
    tablet.picture("check")
    tablet.tap("check-conclude")

    expect(page.get_by_test_id("navigate")).to_have_attribute("data-may", "true")
    tablet.tap("scene-operation")
    page.wait_for_function(
        """() => /^.?\\d+\\.\\d$/.test(document.querySelector('[data-testid="reading-angle"]').textContent)"""
    )
    tablet.picture("navigate")
    # The other side of the same vertebra: registration and check still hold.
    tablet.tap("switch-channel")
    tablet.tap("channel-L3-right")
    tablet.tap("channel-L3-right-sure")
    expect(page.get_by_test_id("active-channel")).to_have_text("L3 right")
    assert server.ask("GET", "/api/procedure", 200)["may_navigate"]


def touch_where_the_tip_rests(page: Page) -> None:
    """The landmark that comes next is asked for while the tip is on its way to it, and taken when it rests.

    A slow page would hear of the rest when it is nearly over.
    """
    rests = page.get_by_test_id("tip-rests")
    now = page.locator("[data-testid=tip-rests]:not([data-landmark=''])").get_attribute("data-landmark")
    names: list[str] = page.locator("[data-testid^='landmark-']").evaluate_all(
        "lines => lines.map(one => one.dataset.testid.slice('landmark-'.length))"
    )
    name = names[(names.index(str(now)) + 1) % TOUCHED_IN_TURN]
    line = page.get_by_test_id(f"landmark-{name}")
    expect(rests).to_have_attribute("data-landmark", "")
    if line.get_attribute("data-touched") == "true":
        expect(rests).to_have_attribute("data-landmark", name)
        return
    line.locator(".landmark-name").tap()
    page.get_by_test_id("capture").tap()
    page.locator("[data-testid=capturing]").filter(has_text=name).wait_for()
    page.locator("[data-testid=captured], [data-testid=capture-refused]").filter(has_text=name).wait_for()


def begin_until_taken(tablet: Tablet) -> None:
    """A hand that had just left the landmark holds the tip on it again."""
    tablet.tap("check-begin")
    page = tablet.page
    over = page.locator("[data-testid=check-outcome], [data-testid=capture-refused]")
    over.wait_for()
    while page.get_by_test_id("capture-refused").count() > 0:
        page.locator("[data-testid=tip-rests]:not([data-landmark=''])").wait_for()
        tablet.tap("check-again")
        page.locator("[data-testid=capturing], [data-testid=check-outcome]").wait_for()
        over.wait_for()


def test_the_slice_is_dragged_pinched_and_turned_over_the_live_picture(
    server: RealServer, tablet: Tablet
) -> None:
    page = tablet.page
    tablet.go("register/needles")
    tablet.tap("ruler-rehearsed")
    tablet.tap("ruler-done")
    state = page.get_by_test_id("overlay-state")
    expect(state).to_have_attribute("data-settled", "true")
    first = overlay_of(page)
    box = page.get_by_test_id("stage").bounding_box()
    assert box is not None
    middle = (box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    per_px = 1280.0 / box["width"]

    def fingers(*paths: tuple[tuple[float, float], tuple[float, float]]) -> None:
        gesture(page, [[at(middle, one) for one in path] for path in paths])
        page.evaluate(AT_REST)

    fingers(((0, 0), (60, -20)))
    dragged = overlay_of(page)
    moved = np.subtract(dragged["shift_px"], first["shift_px"])
    np.testing.assert_allclose(moved, [60 * per_px, -20 * per_px], atol=4 * per_px)
    assert dragged["turn_deg"] == first["turn_deg"]

    # A page that is short of time takes two fingers that come late for one; a person does it again.
    for _ in range(3):
        fingers(((-40, 0), (-80, 0)), ((40, 0), (80, 0)))
        pinched = overlay_of(page)
        if pinched["scale_px_per_mm"] != dragged["scale_px_per_mm"]:
            break
    assert pinched["scale_px_per_mm"] / dragged["scale_px_per_mm"] == pytest.approx(2.0, rel=0.3)

    fingers(((-60, 0), (-60, -30)), ((60, 0), (60, 30)))
    turned = overlay_of(page)
    clockwise = np.degrees(np.arctan2(30, 60))
    assert turned["turn_deg"] - pinched["turn_deg"] == pytest.approx(clockwise, abs=8.0)

    tablet.tap("overlay-undo")
    expect(state).to_have_attribute("data-settled", "true")
    assert overlay_of(page) == pinched
    tablet.picture("needles")
    same_as_the_server(server, page)
    tablet.tap("needles-conclude")
    if server.ask("GET", "/api/procedure", 200)["may_navigate"]:
        tablet.tap("needles-conclude-sure")
    expect(page.get_by_test_id("needles-said")).to_contain_text("Depth along the view is known to ±")
    made = server.ask("GET", "/api/registration", 200)["made_from"]
    assert made["overlay"]["scale_px_per_mm"] > first["scale_px_per_mm"]
    tablet.picture("needles-registered")


def at(middle: tuple[float, float], by: tuple[float, float]) -> tuple[float, float]:
    return middle[0] + by[0], middle[1] + by[1]


def gesture(page: Page, paths: list[list[tuple[float, float]]], *, steps: int = 8) -> None:
    """As many fingers as there are paths, from their beginnings to their ends, all at once."""
    touch = page.context.new_cdp_session(page)

    def points(share: float) -> list[dict[str, Any]]:
        return [
            {
                "x": start[0] + share * (end[0] - start[0]),
                "y": start[1] + share * (end[1] - start[1]),
                "id": finger,
            }
            for finger, (start, end) in enumerate(paths)
        ]

    touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": points(0.0)})
    for step in range(1, steps + 1):
        touch.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": points(step / steps)})
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    touch.detach()


def overlay_of(page: Page) -> dict[str, Any]:
    """Where the hand has the slice."""
    told: dict[str, Any] = page.evaluate(
        "JSON.parse(document.querySelector('[data-testid=overlay-state]').dataset.overlay)"
    )
    return told


def same_as_the_server(server: RealServer, page: Page) -> None:
    """Every line, and the picture of the slice, stand where the server would take them."""
    view: dict[str, Any] = page.evaluate("JSON.parse(Object.values(localStorage)[0])")
    asked = {"view": view, "overlay": overlay_of(page)}
    laid = server.ask("POST", "/api/registration/needles/overlay", 200, json=asked)
    drawn = page.locator("[data-testid=lines] polyline.line").evaluate_all(
        "lines => lines.map(one => [...one.points].map(point => [point.x, point.y]))"
    )
    assert len(drawn) == len(laid["needles"]) == 3
    for line, needle in zip(drawn, laid["needles"], strict=True):
        np.testing.assert_allclose(line, needle["line_px"], atol=0.01)

    place, stage = laid["slice"], page.get_by_test_id("stage").bounding_box()
    assert stage is not None
    right, bottom = place["width_px"] - 0.5, place["height_px"] - 0.5
    corners = np.array([[-0.5, -0.5, 1], [right, -0.5, 1], [-0.5, bottom, 1], [right, bottom, 1]])
    there = corners @ np.array(place["image_from_slice"]).T
    there_css = (there[:, :2] / there[:, 2:] + 0.5) * stage["width"] / 1280.0
    (left, top), (width, height) = there_css.min(axis=0), np.ptp(there_css, axis=0)
    shown = page.get_by_test_id("slice-layer").bounding_box()
    assert shown is not None
    box = [shown["x"] - stage["x"], shown["y"] - stage["y"], shown["width"], shown["height"]]
    np.testing.assert_allclose(box, [left, top, width, height], atol=1.5)
