"""Layouts of the theatre view: all figures in each, large enough for the distance at which they are read."""

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.theatre import PATIENCE_MS, Theatre, WatchedPage, save_screenshot

pytestmark = pytest.mark.browser

Watch = Callable[..., WatchedPage]
expect.set_options(timeout=PATIENCE_MS)

# 20 mm on a screen of 27 inches (597.7 mm wide), which are read at 4 m.
MIN_CAP_HEIGHT_MM = 20.0
SCREEN_WIDTH_MM = 597.7
FIGURES = ("entry", "angle", "depth", "wall")

# Height of a capital in the font in use, and whether the figure lies whole within its tile and the page.
FIGURE = """output => {
    const { fontWeight, fontSize, fontFamily } = getComputedStyle(output);
    const context = document.createElement("canvas").getContext("2d");
    context.font = `${fontWeight} ${fontSize} ${fontFamily}`;
    const glyphs = document.createRange();
    glyphs.selectNodeContents(output);
    const box = glyphs.getBoundingClientRect();
    const around = output.closest(".reading").getBoundingClientRect();
    const limit = output.closest(".reading").querySelector(".reading-limit").getBoundingClientRect();
    return {
        capPx: context.measureText("H").actualBoundingBoxAscent,
        isWhole: box.left >= around.left && box.right <= around.right && box.top >= around.top - 1
            && limit.bottom <= around.bottom + 1 && around.bottom <= innerHeight && box.width > 0,
    };
}"""


def check_figures(page: Page, width_px: int) -> None:
    for name in FIGURES:
        found = page.get_by_test_id(f"reading-{name}").evaluate(FIGURE)
        assert found["isWhole"], name
        assert found["capPx"] * SCREEN_WIDTH_MM / width_px >= MIN_CAP_HEIGHT_MM, (name, found)


def box(page: Page, selector: str) -> dict[str, float]:
    rect: dict[str, float] = page.locator(selector).first.evaluate(
        "e => { const { x, y, width, height } = e.getBoundingClientRect(); return { x, y, width, height }; }"
    )
    return rect


def test_each_layout_has_all_figures_and_the_same_alarms(shared_theatre: Theatre, watch: Watch) -> None:
    page = watch(shared_theatre, 1920, 1080).open("/theatre")
    shared_theatre.tell("entry")
    expect(page.locator("[data-reading=entry]")).to_have_attribute("data-status", "over")
    bands = set()
    large = {"approach": ".pane-video", "align": ".tiles-eye", "drill": ".tiles", "overview": ".pane-video"}
    for layout, pane in large.items():
        page.get_by_test_id(f"layout-{layout}").click()
        expect(page.get_by_test_id("theatre")).to_have_attribute("data-layout", layout)
        expect(page.get_by_test_id("numbers")).to_have_attribute("data-live", "true")
        check_figures(page, 1920)
        areas = {one: box(page, one) for one in (".pane-video", ".tiles-eye", ".tiles")}
        assert areas[pane]["width"] == max(one["width"] for one in areas.values()), layout
        assert page.evaluate("document.documentElement.scrollHeight") <= 1080
        band = box(page, "[data-testid=alarms]")
        bands.add((band["x"], band["y"], band["width"]))
        save_screenshot(page, f"layout-{layout}")
    assert len(bands) == 1
    page.set_viewport_size({"width": 390, "height": 844})
    hints = page.locator(".reading-name small")
    assert "before entry" in hints.all_inner_texts()
    assert hints.evaluate_all("hints => hints.filter(one => one.scrollWidth > one.clientWidth).length") == 0
    page.set_viewport_size({"width": 1920, "height": 1080})
    # A key does nothing before it is set on this screen.
    page.keyboard.press("F8")
    expect(page.get_by_test_id("theatre")).to_have_attribute("data-layout", "overview")
    page.get_by_test_id("more").click()
    page.get_by_test_id("key-drill").get_by_role("button").click()
    page.keyboard.press("F8")
    expect(page.get_by_test_id("key-drill")).to_contain_text("F8")
    page.keyboard.press("F8")
    expect(page.get_by_test_id("theatre")).to_have_attribute("data-layout", "drill")


@pytest.mark.parametrize(("width", "height"), [(1920, 1080), (3840, 2160)])
def test_figures_alone_are_read_at_4_m(
    shared_theatre: Theatre, watch: Watch, width: int, height: int
) -> None:
    page = watch(shared_theatre, width, height).open("/theatre?layout=figures")
    shared_theatre.tell("near")
    expect(page.locator("[data-reading=wall]")).to_have_attribute("data-status", "over")
    expect(page.get_by_test_id("alarm-top")).to_contain_text("0.5 mm to the medial wall")
    check_figures(page, width)
    save_screenshot(page, f"layout-figures-{width}")
    # Removed when they are too old, as on every other screen.
    shared_theatre.tell("stop")
    expect(page.get_by_test_id("no-tracking")).to_have_text(re.compile("NO TRACKING"))
    for name in FIGURES:
        expect(page.get_by_test_id(f"reading-{name}")).to_have_text("—")
    shared_theatre.tell("near")
