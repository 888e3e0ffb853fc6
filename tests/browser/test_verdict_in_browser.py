"""Headline, figures and alarm on the page always belong to one image, in every state of drilling."""

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.theatre import PATIENCE_MS, Theatre, WatchedPage, arm, save_screenshot

pytestmark = pytest.mark.browser

Watch = Callable[..., WatchedPage]
expect.set_options(timeout=PATIENCE_MS)
TIME = r"\d\d:\d\d:\d\d"

# Samples headline, wall figure and alarm with every refresh.
WITNESS = """() => {
    window.witnessed = { looks: 0, verdicts: {}, wrong: [] };
    const text = (id) => document.querySelector(`[data-testid="${id}"]`)?.textContent ?? "";
    const look = () => {
        const headline = text("verdict"), wall = text("reading-wall").replace("\u2212", "-");
        const breach = '[data-condition="BREACH"] [data-part=sentence]';
        const alarm = document.querySelector(breach)?.textContent ?? "";
        const note = (what) => window.witnessed.wrong.push(`${what}: ${headline} | ${wall} | ${alarm}`);
        window.witnessed.looks += 1;
        const verdict = document.querySelector('[data-testid="verdict"]')?.dataset.verdict;
        window.witnessed.verdicts[verdict] = (window.witnessed.verdicts[verdict] ?? 0) + 1;
        const through = /THROUGH MEDIAL WALL ([\\d.]+)\\smm/.exec(headline)?.[1];
        if (headline !== "" && wall !== "\u2014") {
            if (through !== undefined && wall !== `-${through}`) note("headline");
            if (through === undefined && /^-\\d/.test(wall)) note("figure");
            const drill = /^Drill ([\\d.]+) mm through/.exec(alarm)?.[1];
            if (drill !== undefined && wall !== `-${drill}`) note("alarm");
            if (/Not through now/.test(alarm) && /^-\\d/.test(wall)) note("past");
            if (headline.includes("ON PATH") && drill !== undefined) note("green");
        }
        requestAnimationFrame(look);
    };
    look();
}"""


def headline(page: Page, words: str | re.Pattern[str], tone: str | re.Pattern[str]) -> None:
    expect(page.get_by_test_id("verdict")).to_have_text(words)
    expect(page.get_by_test_id("verdict")).to_have_attribute("data-tone", tone)


def test_the_words_are_german_on_a_german_page(theatre: Theatre, watch: Watch) -> None:
    page = watch(theatre).open("/theatre?lang=de")
    theatre.tell("breach")
    headline(page, "✖ DURCH MEDIALE WAND 0,8 mm", "danger")
    expect(page.get_by_test_id("alarm-top")).to_contain_text(
        "Anhalten. Bohrer zurückziehen. Bohrer 0,8 mm durch die mediale Wand in 29,0 mm Tiefe."
    )


@pytest.fixture(scope="module")
def screen(shared_theatre: Theatre, watch_for_all: Watch) -> Page:
    """The screen of the tests below, with its sound armed."""
    page = watch_for_all(shared_theatre).open("/theatre")
    arm(page)
    return page


@pytest.fixture
def page(screen: Page, shared_theatre: Theatre) -> Page:
    """The same page in its initial state: the drill is on its path."""
    shared_theatre.tell("path")
    headline(screen, re.compile("ON PATH"), re.compile("good|caution"))
    return screen


def test_a_breach_from_the_path_to_its_acknowledgement(page: Page, shared_theatre: Theatre) -> None:
    headline(page, "● ON PATH", "good")
    save_screenshot(page, "verdict-on-path")
    shared_theatre.tell("entry")
    headline(page, "▲ CORRECT 2.4 mm medial, 1.3 mm caudal", "caution")
    expect(page.get_by_test_id("headline-detail")).to_have_text("entry 2.7 mm, limit 1.8 mm")
    expect(page.locator("[data-reading=entry]")).to_have_attribute("data-status", "over")
    save_screenshot(page, "verdict-entry-over")
    shared_theatre.tell("near")
    headline(page, "◆ NEAR MEDIAL WALL 0.5 mm", "warning")
    expect(page.get_by_test_id("alarm-top")).to_contain_text("0.5 mm to the medial wall, limit 1.0 mm.")
    save_screenshot(page, "verdict-near")
    shared_theatre.tell("breach")
    headline(page, "✖ THROUGH MEDIAL WALL 0.8 mm", "danger")
    alarm = page.get_by_test_id("alarm-top")
    expect(alarm).to_contain_text(
        "Stop. Withdraw the drill. Drill 0.8 mm through the medial wall at 29.0 mm depth."
    )
    save_screenshot(page, "verdict-breach")
    shared_theatre.tell("hidden")
    expect(page.get_by_test_id("no-tracking")).to_contain_text("NO TRACKING")
    expect(alarm).to_contain_text(
        re.compile(rf"Not tracked\. Was 0\.8 mm through the medial wall at 29\.0 mm depth, {TIME}\.")
    )
    expect(alarm).to_contain_text("Stop.")
    expect(page.get_by_test_id("headline-event")).to_have_text("BREACH when last seen")
    save_screenshot(page, "verdict-lost-in-a-breach")
    shared_theatre.tell("path")
    headline(page, "▲ ON PATH", "caution")
    expect(page.get_by_test_id("alarms")).to_have_attribute("data-state", "latched")
    expect(page.get_by_test_id("headline-event")).to_have_text(
        re.compile(rf"^BREACH {TIME} not acknowledged$")
    )
    expect(alarm).to_contain_text(
        re.compile(rf"Was 0\.8 mm through the medial wall at 29\.0 mm depth, {TIME}\. Not through now\.")
    )
    expect(alarm).not_to_contain_text("Stop.")
    # An alarm that is over does not flash and is not lit.
    unlit = "getComputedStyle(document.querySelector('.alarms-top .alarms-state')).backgroundColor"
    assert page.evaluate(unlit) == "rgba(0, 0, 0, 0)"
    headline(page, "▲ ON PATH", "caution")
    save_screenshot(page, "verdict-over-not-acknowledged")
    page.get_by_test_id("acknowledge").click()
    headline(page, "● ON PATH", "good")
    expect(page.get_by_test_id("headline-event")).to_have_text("")
    save_screenshot(page, "verdict-acknowledged")


def test_a_breach_that_is_acknowledged_and_still_there_is_not_green(
    page: Page, shared_theatre: Theatre
) -> None:
    shared_theatre.tell("breach")
    expect(page.get_by_test_id("alarms")).to_have_attribute("data-priority", "high")
    page.get_by_test_id("acknowledge").click()
    expect(page.get_by_test_id("alarms")).to_have_attribute("data-state", "acknowledged")
    headline(page, "✖ THROUGH MEDIAL WALL 0.8 mm", "danger")
    expect(page.get_by_test_id("alarm-top")).to_contain_text("Drill 0.8 mm through the medial wall")
    save_screenshot(page, "verdict-acknowledged-breach")


def test_no_image_of_the_screen_contradicts_itself(page: Page, shared_theatre: Theatre) -> None:
    page.evaluate(WITNESS)
    shared_theatre.tell("wander")
    page.wait_for_function(
        "() => ['through_wall', 'near_wall', 'correct_entry', 'on_path']"
        ".every(one => (window.witnessed.verdicts[one] ?? 0) > 5)"
    )
    witnessed = page.evaluate("window.witnessed")
    assert witnessed["wrong"] == []
    assert witnessed["looks"] > 50
