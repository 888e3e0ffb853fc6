"""Alarms, and the question after a restart, move nothing on the page, at every size that is in use."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.theatre import PATIENCE_MS, Theatre, WatchedPage
from tests.browser.unconfirmed import answer_unconfirmed

pytestmark = pytest.mark.browser

Watch = Callable[..., WatchedPage]
expect.set_options(timeout=PATIENCE_MS)

# Pictures, figures and main buttons of each view.
MAIN = {
    "theatre": (
        "[data-testid=video]",
        "[data-testid=cut-probe]",
        ".readings",
        ".layout-bar",
        "[data-testid=more]",
    ),
    "operator/navigate": (
        "[data-testid=video]",
        "[data-testid=cut-probe]",
        ".readings",
        ".next-step",
        ".rail",
    ),
    "supervisor": (
        "[data-testid=video]",
        "[data-testid=cut-probe]",
        ".readings",
        ".decisions",
        ".marks-tools",
    ),
}
SIZES = ((1180, 820), (1920, 1080), (1366, 768), (390, 844))
SETTLED = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
BAND_BUTTONS = ".alarms > button"
PLACES = """selectors => {
    const boxOf = (one) => {
        const { x, y, width, height } = one.getBoundingClientRect();
        return [one.dataset.testid ?? one.className, [x, y + scrollY, width, height]];
    };
    const shown = (one) => [...document.querySelectorAll(one)].filter((found) => found.checkVisibility());
    return Object.fromEntries(selectors.map((one) => [one, Object.fromEntries(shown(one).map(boxOf))]));
}"""


def places(page: Page, view: str) -> dict[str, dict[str, list[float]]]:
    """Boxes in pixels, by selector and name."""
    found: dict[str, dict[str, list[float]]] = page.evaluate(PLACES, [*MAIN[view], ".alarms", BAND_BUTTONS])
    return found


def moved(before: dict[str, dict[str, list[float]]], after: dict[str, dict[str, list[float]]]) -> list[str]:
    """What is in another place by a pixel or more; a button of the band that is gone is in none."""
    return [
        f"{selector} {name}: {box} -> {after[selector][name]}"
        for selector, boxes in before.items()
        for name, box in boxes.items()
        if name in after[selector] or selector != BAND_BUTTONS
        if max(abs(one - other) for one, other in zip(box, after[selector][name], strict=True)) >= 1
    ]


def alarms(page: Page, state: str) -> None:
    expect(page.locator(f".alarms{state}")).to_be_visible()


@pytest.mark.parametrize("view", MAIN)
def test_alarms_move_nothing(theatre: Theatre, watch: Watch, view: str) -> None:
    watched = watch(theatre, *SIZES[0], strict=False)
    watched.page.route("**/api/procedure", answer_unconfirmed)
    page = watched.open(view)
    theatre.tell("path")
    expect(page.locator("[data-reading=wall][data-status=within]")).to_be_visible()
    expect(page.get_by_test_id("cut-probe")).to_have_attribute("data-shows", "bare")
    calm: dict[tuple[int, int], dict[str, dict[str, list[float]]]] = {}

    def look(name: str) -> None:
        for size in SIZES:
            page.set_viewport_size({"width": size[0], "height": size[1]})
            expect(page.locator(MAIN[view][0])).to_be_visible()
            page.evaluate(SETTLED)
            found = places(page, view)
            assert all(found[one] for one in MAIN[view] if one != ".layout-bar"), found
            # A button that appears later is in its place from then on.
            known = calm.setdefault(size, found)
            known[BAND_BUTTONS] = {**found[BAND_BUTTONS], **known[BAND_BUTTONS]}
            moves = moved(known, found)
            assert not moves, f"{name}, {size}: {'; '.join(moves)}"

    look("sound is off")
    theatre.tell("near")
    alarms(page, "[data-priority=medium]")
    look("one alarm")
    theatre.tell("deep")
    alarms(page, "[data-priority=high]")
    theatre.tell("breach")
    expect(page.locator(".alarms-count")).to_have_text("+2")
    look("three at once")
    page.get_by_test_id("alarms-more").click()
    expect(page.get_by_test_id("alarms-all").locator("li")).to_have_count(3)
    look("all in full")
    page.keyboard.press("Escape")
    expect(page.get_by_test_id("alarms-all")).to_have_count(0)
    theatre.tell("path")
    expect(page.locator("[data-reading=wall][data-status=within]")).to_be_visible()
    expect(page.get_by_test_id("headline-event")).not_to_be_empty()
    look("latched")
    theatre.tell("insufficient")
    expect(page.locator("[data-verdict=setup_insufficient]")).to_be_visible()
    look("set-up insufficient")
    theatre.tell("stopped")
    expect(page.locator("[data-testid=no-tracking]")).to_be_visible()
    if view != "supervisor":
        expect(page.get_by_role("button", name="Confirm and continue with L3")).to_be_visible()
    look("navigation stopped")
    theatre.tell("lost")
    expect(page.get_by_test_id("no-tracking")).to_be_visible()
    look("camera lost")
    theatre.freeze()
    alarms(page, "[data-priority=unknown]")
    look("unknown")
    theatre.thaw()
    theatre.tell("path")
    expect(page.locator("[data-reading=wall][data-status=within]")).to_be_visible()
    look("known again")


def test_the_cut_has_most_of_its_pane_below_any_headline(shared_theatre: Theatre, watch: Watch) -> None:
    page = watch(shared_theatre, 1180, 820).open("/theatre")
    shares = {}
    for mode, verdict in (
        ("path", "on_path"),
        ("entry", "correct_entry"),
        ("insufficient", "setup_insufficient"),
    ):
        shared_theatre.tell(mode)
        expect(page.locator(f"[data-verdict={verdict}]")).to_be_visible()
        shares[mode] = page.get_by_test_id("cut-probe").evaluate(
            "cut => cut.getBoundingClientRect().height / cut.closest('.tiles').getBoundingClientRect().height"
        )
    assert min(shares.values()) >= 0.5, shares
