"""Display and sound of alarms on a theatre screen."""

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.theatre import PATIENCE_MS, Theatre, WatchedPage, arm, save_screenshot

pytestmark = pytest.mark.browser

Watch = Callable[..., WatchedPage]
expect.set_options(timeout=PATIENCE_MS)
# Records from outside what the page plays: start and stop of every source.
EARS = """window.heard = [];
const start = AudioBufferSourceNode.prototype.start, stop = AudioBufferSourceNode.prototype.stop;
AudioBufferSourceNode.prototype.start = function (...at) {
    window.heard.push({ seconds: this.buffer.duration, loop: this.loop });
    return start.apply(this, at);
};
AudioBufferSourceNode.prototype.stop = function (...at) {
    window.heard.push("stopped");
    return stop.apply(this, at);
};"""


def band(page: Page, priority: str, state: str = "active") -> None:
    expect(page.get_by_test_id("alarms")).to_have_attribute("data-priority", priority)
    expect(page.get_by_test_id("alarms")).to_have_attribute("data-state", state)


def test_an_alarm_is_seen_heard_paused_acknowledged_and_goes(theatre: Theatre, watch: Watch) -> None:
    watched = watch(theatre)
    watched.page.add_init_script(EARS)
    page = watched.open()
    sound = page.get_by_test_id("sound")
    expect(sound).to_have_text("SOUND NOT ARMED: touch here")
    arm(page)
    # On a slow machine no sound may have been armed for so long that this was an alarm.
    band(page, "none", "normal")
    # Its sound stops shortly after its band disappears.
    page.wait_for_function("() => !window.heard.some(one => one.loop) || window.heard.at(-1) === 'stopped'")
    page.evaluate("window.heard = []")
    theatre.tell("deep")
    band(page, "high")
    expect(page.get_by_test_id("alarm-top")).to_contain_text(
        re.compile(
            r"▲▲▲ HIGH TOO DEEP.*Stop\. Withdraw the drill\. Tip 3\.0 mm past the planned depth\.", re.DOTALL
        )
    )
    page.wait_for_function("() => window.heard.length > 0")
    assert page.evaluate("window.heard") == [{"seconds": 7.0, "loop": True}]
    box = page.get_by_test_id("pause").bounding_box()
    assert box is not None
    assert min(box["width"], box["height"]) >= 48
    save_screenshot(page, "alarm")
    page.get_by_test_id("pause").click()
    expect(page.get_by_test_id("pause-left")).to_have_text(re.compile(r"^1[12]\d s$"))
    page.wait_for_function("() => window.heard.at(-1) === 'stopped'")
    page.get_by_test_id("resume").click()
    page.wait_for_function("() => window.heard.length === 3")
    page.get_by_test_id("acknowledge").click()
    band(page, "high", "acknowledged")
    page.wait_for_function("() => window.heard.at(-1) === 'stopped'")
    expect(page.get_by_test_id("alarm-top")).to_contain_text("Acknowledged by screen")
    theatre.tell("live")
    band(page, "none", "normal")


def test_alarms_are_claimed_by_no_page_that_does_not_hear_the_server(theatre: Theatre, watch: Watch) -> None:
    page = watch(theatre, strict=False).open("?lang=de")
    # Before its first picture a page says instead that the server is not reached.
    expect(page.get_by_test_id("video")).to_have_attribute("data-live", "true")
    theatre.tell("deep")
    band(page, "high")
    theatre.freeze()
    expect(page.get_by_test_id("alarms")).to_have_attribute("data-priority", "unknown")
    expect(page.get_by_test_id("alarms")).to_contain_text("ALARME UNBEKANNT")
    theatre.thaw()
    band(page, "high")
