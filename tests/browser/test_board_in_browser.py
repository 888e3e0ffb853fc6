"""Figures, video and cuts on one screen: the pages of supervisor and operator."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.canvas import PIXELS
from tests.browser.theatre import PATIENCE_MS, Theatre, WatchedPage, save_screenshot

pytestmark = pytest.mark.browser
expect.set_options(timeout=PATIENCE_MS)

FIGURES = ("reading-entry", "reading-angle", "reading-depth", "reading-wall")
PAGES = {"supervisor": ("hold-ask", "cut-probe"), "operator/navigate": ("cut-probe",)}


# Number of figures with a curve.
CURVES = f"""() => [...document.querySelectorAll("canvas[data-trend]")].filter(
    (canvas) => {PIXELS}(canvas).some((value) => value > 0),
).length"""


@pytest.fixture(scope="module", params=PAGES)
def board(
    request: pytest.FixtureRequest, shared_theatre: Theatre, watch_for_all: Callable[..., WatchedPage]
) -> Page:
    """One of the two pages, at all sizes."""
    shared_theatre.tell("path")
    page = watch_for_all(shared_theatre, 1366, 768).open(request.param)
    expect(page.get_by_test_id("cut-probe")).to_have_attribute("data-shows", "bare")
    return page


def cut_off(page: Page, name: str) -> list[str]:
    """Elements of this page that are not completely visible without scrolling."""
    wanted = [*FIGURES, *PAGES[name]]
    width, height = page.evaluate("[innerWidth, innerHeight]")
    off = []
    for one in wanted:
        box = page.get_by_test_id(one).bounding_box()
        assert box is not None, one
        if (
            box["x"] < 0
            or box["y"] < 0
            or box["x"] + box["width"] > width
            or box["y"] + box["height"] > height
        ):
            off.append(f"{one} {box}")
    return off


def test_a_laptop_shows_all_that_counts_without_scrolling(board: Page) -> None:
    board.set_viewport_size({"width": 1366, "height": 768})
    name = board.url.split("/", 3)[3]
    save_screenshot(board, f"board-{name.replace('/', '-')}")
    assert cut_off(board, name) == []
    stage = board.get_by_test_id("cut-probe").bounding_box()
    assert stage is not None
    assert min(stage["width"], stage["height"]) >= 200


def test_curves_go_with_the_figures_when_messages_stop(board: Page, shared_theatre: Theatre) -> None:
    board.wait_for_function(f"() => ({CURVES})() === 4")
    shared_theatre.tell("stop")
    expect(board.get_by_test_id("numbers")).to_have_attribute("data-live", "false")
    expect(board.get_by_test_id("numbers")).to_have_attribute("data-trend", "false")
    # Cleared, not only hidden.
    expect(board.locator("canvas[data-trend=entry]")).to_be_hidden()
    assert board.evaluate(CURVES) == 0
    shared_theatre.tell("path")
    board.wait_for_function(f"() => ({CURVES})() === 4")


def test_a_phone_has_nothing_beside_its_screen_and_the_hold_under_the_thumb(board: Page) -> None:
    board.set_viewport_size({"width": 390, "height": 844})
    assert board.evaluate("document.documentElement.scrollWidth") <= 390
    hold = board.get_by_test_id("hold-ask")
    if hold.count() == 0:
        return
    for place in ("0", "document.documentElement.scrollHeight"):
        board.evaluate(f"scrollTo(0, {place})")
        expect(hold).to_be_in_viewport(ratio=1)
