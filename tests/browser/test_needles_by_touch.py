"""Registration with the slice overlay, by touch, against the real program."""

import contextlib
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, Route, expect
from playwright.sync_api import TimeoutError as PlaywrightTimeout

from server.config import Config
from tests.browser.by_touch.tablet import Tablet, tablet_at
from tests.browser.prepared import prepared
from tests.browser.theatre import PATIENCE_MS
from tests.procedure.real_server import BUSY_MACHINE, RealServer, real_server

pytestmark = pytest.mark.browser

BY = {"made_by": "M. Ito"}
SETTINGS = {
    **BUSY_MACHINE,
    "rehearsal": {
        "seed": 3,
        "provides_setup": False,
        "reference": True,
        "rate_hz": 4,
        "scene": "landmarks",
        "skill": "good",
    },
    "reference": {"marker": "reference"},
}
OVERLAY = "JSON.parse(document.querySelector('[data-testid=overlay-state]').dataset.overlay)"
# A slow page processes a gesture late: it has ended after this many refreshes without movement.
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


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RealServer]:
    """The program with a case that is ready for registration."""
    folder = tmp_path_factory.mktemp("operator")
    prepared(folder / "home", Config.model_validate(SETTINGS).rehearsal)
    with real_server(folder, SETTINGS) as running:
        requested = {**BY, "vertebra": "L3", "side": "left"}
        running.ask("POST", "/api/plan/active-channel", 200, json=requested)
        yield running


@pytest.fixture
def tablet(server: RealServer, browser: Browser) -> Iterator[Tablet]:
    with tablet_at(browser, server.port, patience_ms=PATIENCE_MS) as opened:
        yield opened


def test_one_failed_answer_does_not_end_the_work_on_the_plan(tablet: Tablet) -> None:
    page = tablet.page
    tablet.go("plan")
    tablet.tap("part-landmarks")
    # The button moves when the catalogue has loaded.
    tablet.reads("landmark-count", "needed at least")
    tablet.tap("set-landmark")
    name = page.get_by_role("button", name="left transverse process", exact=True)
    expect(name).to_be_visible()
    message = "the case is being written"
    problem = {"code": "STORE_BUSY", "message": message, "remedy": "Wait.", "context": {}}

    def reject(route: Route) -> None:
        route.fulfill(status=409, json=problem)

    page.route("**/api/procedure", reject)
    expect(page.get_by_text(message)).to_be_visible()
    page.unroute("**/api/procedure", reject)
    expect(page.get_by_text(message)).to_be_hidden()
    expect(name).to_be_visible()


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

    def until_changed(field: str, *paths: tuple[tuple[float, float], tuple[float, float]]) -> None:
        # A slow page may take two fingers that arrive late for one; a user would repeat the gesture.
        for _ in range(3):
            before = overlay_of(page)
            fingers(*paths)
            with contextlib.suppress(PlaywrightTimeout):
                page.wait_for_function(f"was => ({OVERLAY}).{field} !== was", arg=before[field])
                page.evaluate(AT_REST)
                return

    fingers(((0, 0), (60, -20)))
    dragged = overlay_of(page)
    moved = np.subtract(dragged["shift_px"], first["shift_px"])
    np.testing.assert_allclose(moved, [60 * per_px, -20 * per_px], atol=4 * per_px)
    assert dragged["rotation_deg"] == first["rotation_deg"]

    until_changed("scale_px_per_mm", ((-40, 0), (-80, 0)), ((40, 0), (80, 0)))
    pinched = overlay_of(page)
    assert pinched["scale_px_per_mm"] / dragged["scale_px_per_mm"] == pytest.approx(2.0, rel=0.3)

    until_changed("rotation_deg", ((-60, 0), (-60, -30)), ((60, 0), (60, 30)))
    turned = overlay_of(page)
    clockwise = np.degrees(np.arctan2(30, 60))
    assert turned["rotation_deg"] - pinched["rotation_deg"] == pytest.approx(clockwise, abs=8.0)

    tablet.tap("overlay-undo")
    expect(state).to_have_attribute("data-settled", "true")
    assert overlay_of(page) == pinched
    tablet.looked_at("needles")
    same_as_the_server(server, page)
    tablet.tap("needles-conclude")
    if server.ask("GET", "/api/procedure", 200)["may_navigate"]:
        tablet.tap("needles-conclude-sure")
    expect(page.get_by_test_id("needles-said")).to_contain_text("Depth along the view is known to ±")
    made = server.ask("GET", "/api/registration", 200)["made_from"]
    assert made["overlay"]["scale_px_per_mm"] > first["scale_px_per_mm"]
    tablet.looked_at("needles-registered")


def at(middle: tuple[float, float], by: tuple[float, float]) -> tuple[float, float]:
    return middle[0] + by[0], middle[1] + by[1]


def gesture(page: Page, paths: list[list[tuple[float, float]]], *, steps: int = 8) -> None:
    """Move as many fingers as there are paths, simultaneously from start to end."""
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
    """Position of the overlay."""
    reported: dict[str, Any] = page.evaluate(OVERLAY)
    return reported


def same_as_the_server(server: RealServer, page: Page) -> None:
    """All lines and the slice picture are drawn where the server would use them."""
    view: dict[str, Any] = page.evaluate("JSON.parse(Object.values(localStorage)[0])")
    requested = {"view": view, "overlay": overlay_of(page)}
    laid = server.ask("POST", "/api/registration/needles/overlay", 200, json=requested)
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
