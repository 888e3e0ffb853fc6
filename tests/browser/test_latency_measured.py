"""End-to-end latency measurement: the camera sees the page's own screen with a known delay."""

import json
import math
import os
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Page, Route, expect

from server.latency.codes import MIN_TIMED_RATIO
from tests.browser.screen_camera import RATE_HZ, ScreenCamera
from tests.browser.theatre import PATIENCE_MS, WatchedPage, save_screenshot
from tests.procedure.real_server import BUSY_MACHINE, RealServer, real_server

pytestmark = pytest.mark.browser

# Fewer codes than in use; each lasts two to three image periods.
CODES = 24
# Time for aiming, codes and the last images on a busy machine.
MEASURED_WITHIN_MS = 4 * PATIENCE_MS
TRIES = 5
SHORT_S, LONG_S = 0.1, 0.9
ADDED_MS = 1000.0 * (LONG_S - SHORT_S)


@pytest.fixture(scope="module")
def camera() -> Iterator[ScreenCamera]:
    made = ScreenCamera()
    yield made
    made.end()


@pytest.fixture(scope="module")
def filming(camera: ScreenCamera, tmp_path_factory: pytest.TempPathFactory) -> Iterator[RealServer]:
    settings = {**BUSY_MACHINE, "camera": {"source": camera.address}}
    with real_server(tmp_path_factory.mktemp("filming"), settings) as server:
        yield server


@pytest.fixture
def page(camera: ScreenCamera, filming: RealServer, watch: Callable[..., WatchedPage]) -> Page:
    """The camera page, with the camera in front of it."""
    camera.delay_s, camera.covered = SHORT_S, False
    # A rejected measurement is a 409, which the browser logs.
    watched = watch(filming, strict=False)
    page = watched.page

    def fewer(route: Route) -> None:
        if route.request.method == "POST":
            route.continue_(post_data=json.dumps({"codes": CODES}))
        else:
            route.continue_()

    page.route("**/api/latency/measurement", fewer)
    watched.open("operator/camera")
    camera.look_at(page)
    expect(page.get_by_test_id("video")).to_have_attribute("data-live", "true", timeout=PATIENCE_MS)
    return page


def measured(page: Page, filming: RealServer) -> dict[str, Any]:
    """Start the measurement and wait for the result; repeat it if a busy machine skipped images."""
    before = filming.ask("GET", "/api/latency", 200)["result"]
    for _ in range(TRIES):
        page.get_by_test_id("latency-begin").click()
        code = page.get_by_test_id("latency-code")
        expect(code).to_be_visible()
        expect(code).to_have_count(0, timeout=MEASURED_WITHIN_MS)
        rejections = page.get_by_test_id("latency").get_by_role("alert")
        if rejections.count() == 0:
            result: dict[str, Any] = filming.ask("GET", "/api/latency", 200)["result"]
            assert result != before
            return result
        expect(rejections).to_contain_text("LATENCY_IMAGES_SKIPPED")
    pytest.fail(f"{TRIES} times in a row: {rejections.inner_text()}")


@pytest.mark.skipif(
    "COAXIAL_MEASURE_LATENCY" not in os.environ,
    reason="measures real time, for which a machine must be quiet: COAXIAL_MEASURE_LATENCY=1 runs it",
)
def test_a_known_delay_before_the_camera_is_in_the_latency(
    camera: ScreenCamera, filming: RealServer, page: Page
) -> None:
    short = measured(page, filming)
    camera.delay_s = LONG_S
    long = measured(page, filming)
    print(json.dumps([short, long], indent=1))  # noqa: T201  the numbers of a test that fails
    for result, delay_s in ((short, SHORT_S), (long, LONG_S)):
        report = result["report"]
        assert report["samples"] >= CODES * MIN_TIMED_RATIO
        # Everything before the capture time belongs to screen and camera.
        assert report["stage_ms"]["screen and camera"] >= 1000.0 * delay_s
        assert report["median_ms"] <= report["p99_ms"]
        assert sum(report["stage_ms"].values()) == pytest.approx(
            report["median_ms"], abs=report["image_period_ms"]
        )
        assert report["image_period_ms"] == pytest.approx(1000.0 / RATE_HZ, rel=0.3)
    resolution_ms = max(one["report"]["image_period_ms"] for one in (short, long))
    added_ms = long["report"]["median_ms"] - short["report"]["median_ms"]
    assert added_ms == pytest.approx(ADDED_MS, abs=resolution_ms)
    shown_ms = math.floor(long["report"]["median_ms"] + 0.5)
    expect(page.get_by_test_id("latency-median")).to_contain_text(f"{shown_ms} ms")
    save_screenshot(page, "latency-card")
    page.goto(f"http://127.0.0.1:{filming.port}/theatre")
    page.get_by_test_id("more").click()
    line = page.get_by_test_id("light-to-page")
    expect(line).to_contain_text(f"{shown_ms} ms median")
    expect(line).to_contain_text(f"measured {long['at'][:10]}")


def test_a_touch_ends_it_and_the_server_reads_no_more(filming: RealServer, page: Page) -> None:
    page.get_by_test_id("latency-begin").click()
    expect(page.get_by_test_id("latency-code")).to_be_visible()
    assert filming.ask("GET", "/api/latency", 200)["measuring"] is True
    save_screenshot(page, "latency-codes")
    page.get_by_test_id("latency-stop").click()
    expect(page.get_by_test_id("latency-code")).to_have_count(0)
    filming.until("the end of reading", lambda: not filming.ask("GET", "/api/latency", 200)["measuring"])


def test_a_page_that_is_left_ends_it(filming: RealServer, page: Page) -> None:
    page.get_by_test_id("latency-begin").click()
    expect(page.get_by_test_id("latency-code")).to_be_visible()
    page.goto("about:blank")
    filming.until("the end of reading", lambda: not filming.ask("GET", "/api/latency", 200)["measuring"])


def test_a_camera_under_a_hand_is_reported_in_numbers(
    camera: ScreenCamera, filming: RealServer, page: Page
) -> None:
    stored = filming.ask("GET", "/api/latency", 200)["result"]
    page.get_by_test_id("latency-begin").click()
    read = page.get_by_test_id("latency-read")
    expect(read).to_contain_text("hold the camera still", timeout=PATIENCE_MS)
    camera.covered = True
    expect(page.get_by_test_id("latency-code")).to_have_count(0, timeout=MEASURED_WITHIN_MS)
    rejection = page.get_by_test_id("latency").get_by_role("alert")
    expect(rejection).to_contain_text("The code was read in")
    expect(rejection).to_contain_text("Point the camera at the screen, darken the room")
    assert filming.ask("GET", "/api/latency", 200)["result"] == stored
