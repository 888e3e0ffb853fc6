"""The set-up walked on a tablet by touch: from no case to a camera and a tool that pass their gates."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, ViewportSize, expect

from tests.browser.theatre import SCREENSHOTS, Watched
from tests.procedure.real_server import BUSY_MACHINE, RealServer, real_server

pytestmark = pytest.mark.browser

LANDSCAPE: ViewportSize = {"width": 1280, "height": 800}
UPRIGHT: ViewportSize = {"width": 800, "height": 1280}
PHONE: ViewportSize = {"width": 390, "height": 844}
# Smaller than a glove is no target; what is only read may be as small as it likes.
SMALL_TARGETS = """() => [...document.querySelectorAll('main :is(button, a, input, summary)')]
    .filter((one) => one.type !== 'file' && one.checkVisibility())
    .map((one) => [/radio|checkbox/.test(one.type) ? one.labels[0] : one, one])
    .filter(([target]) => target.getBoundingClientRect().height < 47.5)
    .map(([, one]) => one.outerHTML.slice(0, 120))"""
WIDER_THAN_SCREEN = "() => document.documentElement.scrollWidth > document.documentElement.clientWidth + 1"
SCENE_MS, MOTION_MS = 60_000, 240_000
SETTINGS = {**BUSY_MACHINE, "rehearsal": {"seed": 3, "brings_setup": False, "width": 960, "height": 540}}


@pytest.fixture
def server(tmp_path: Path) -> Iterator[RealServer]:
    with real_server(tmp_path, SETTINGS) as started:
        yield started


@pytest.fixture
def tablet(browser: Browser, server: RealServer) -> Iterator[Watched]:
    context = browser.new_context(viewport=LANDSCAPE, has_touch=True, locale="en-GB")
    context.set_default_timeout(SCENE_MS)
    watched = Watched(context.new_page(), server.port)
    yield watched
    context.close()
    assert watched.strangers == []
    # What is gathered may end between two questions about it; the browser writes that refusal down.
    assert [one for one in watched.complaints if "409 (Conflict)" not in one] == []


def looked_at(page: Page, name: str) -> list[str]:
    """Targets that are too small and what hangs over, at each size; with pictures to be looked at."""
    SCREENSHOTS.mkdir(exist_ok=True)
    faults: list[str] = []
    for size, suffix in ((PHONE, "phone"), (UPRIGHT, "upright"), (LANDSCAPE, "landscape")):
        page.set_viewport_size(size)
        faults += [f"{name}, {suffix}: small: {one}" for one in page.evaluate(SMALL_TARGETS)]
        faults += [f"{name}, {suffix}: wider than the screen"] * bool(page.evaluate(WIDER_THAN_SCREEN))
        page.screenshot(path=SCREENSHOTS / f"setup-{name}-{suffix}.png", full_page=True)
    return faults


def play(page: Page, scene: str) -> None:
    """Have a scene of the rehearsal played, as a person does on the page of cases."""
    page.get_by_test_id("step-case").tap()
    page.get_by_test_id(f"scene-{scene}").tap()
    expect(page.get_by_test_id(f"scene-{scene}")).to_have_attribute("aria-pressed", "true")
    expect(page.locator("[data-begun]")).to_have_attribute("data-begun", "true", timeout=SCENE_MS)


def keep_when_enough(page: Page, *, named: str) -> list[str]:
    expect(page.get_by_test_id("missing")).to_have_attribute("data-enough", "true", timeout=MOTION_MS)
    faults = looked_at(page, named)
    page.get_by_test_id("keep").tap()
    expect(page.get_by_test_id("gathering")).to_have_count(0)
    return faults


@pytest.mark.timeout(900)
def test_from_no_case_to_a_calibrated_camera_and_tool(tablet: Watched, server: RealServer) -> None:
    page = tablet.page
    page.goto(f"http://127.0.0.1:{server.port}/operator/case")
    expect(page.get_by_role("heading", name="Begin with a case")).to_be_visible()
    faults = looked_at(page, "case-first")
    page.get_by_label("Name of the case").fill("L3, left")
    page.get_by_role("button", name="Make and open").tap()
    expect(page.get_by_test_id("opened-case")).to_contain_text("L3, left")
    faults += looked_at(page, "case-open")

    play(page, "board")
    page.get_by_test_id("step-camera").tap()
    expect(page.get_by_test_id("marker-drill")).to_be_visible()
    faults += looked_at(page, "camera-board")
    page.get_by_test_id("collect").tap()
    expect(page.get_by_test_id("views")).to_contain_text("5", timeout=MOTION_MS)
    faults += looked_at(page, "camera-collecting")
    expect(page.get_by_test_id("missing")).to_have_attribute("data-enough", "true", timeout=MOTION_MS)
    page.get_by_test_id("calibrate").tap()
    expect(page.get_by_test_id("calibration-rms")).to_have_attribute("data-within", "true", timeout=MOTION_MS)
    expect(page.get_by_test_id("collection")).to_have_count(0)
    for one in page.get_by_test_id("calibration").locator("summary").all():
        one.tap()
    expect(page.get_by_role("img", name="Residuals")).to_be_visible()
    faults += looked_at(page, "camera-calibrated")

    play(page, "pivot")
    page.get_by_test_id("step-tool").tap()
    faults += looked_at(page, "tool-none")
    page.get_by_test_id("begin-new").tap()
    page.get_by_label("Diameter (mm)").fill("4")
    page.get_by_label("Length (mm)").fill("118")
    faults += keep_when_enough(page, named="tool-pivot")
    expect(page.get_by_test_id("tool-drill")).to_contain_text("Nobody knows yet which way it points")

    play(page, "spin")
    page.get_by_test_id("step-tool").tap()
    page.get_by_test_id("begin-spin").tap()
    faults += keep_when_enough(page, named="tool-spin")
    faults += looked_at(page, "tool-calibrated")
    page.get_by_test_id("step-report").tap()
    expect(page.get_by_test_id("report")).to_contain_text("L3, left")
    faults += looked_at(page, "report")
    told = server.ask("GET", "/api/procedure", 200)
    assert {one["step"]: one["state"] for one in told["steps"]} == {
        "camera": "done",
        "tool": "done",
        "plan": "missing",
        "register": "missing",
        "check": "missing",
        "navigate": "missing",
    }
    page.get_by_test_id("step-case").tap()
    expect(page.get_by_test_id("documents")).to_contain_text("Tool · drill")
    faults += looked_at(page, "case-done")
    assert faults == []
