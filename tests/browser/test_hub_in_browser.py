"""One supervisor at the hub: follows two theatres, signs in one, and sees nothing old of the other."""

import json
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.hospital import Hospital, hospital
from tests.browser.theatre import PATIENCE_MS, save_screenshot

pytestmark = pytest.mark.browser
NAME = "Dr. Weber"
NOTE_ALARMS = """() => {
    window.alarmsShown = [];
    const band = document.querySelector("[data-testid='alarms-shown']");
    const note = () => window.alarmsShown.push(band.dataset.priority);
    new MutationObserver(note).observe(band, { attributeFilter: ["data-priority"] });
}"""
expect.set_options(timeout=PATIENCE_MS)


def entered(browser: Browser, where: Hospital) -> Page:
    """The list of theatres, by an invitation of the hub."""
    context = browser.new_context(viewport={"width": 1400, "height": 900}, locale="en-GB")
    context.set_default_timeout(PATIENCE_MS)
    page = context.new_page()
    page.goto(f"http://127.0.0.1:{where.hub.port}/enter#{where.hub.invited(NAME)}")
    return page


def opened(page: Page, where: Hospital, theatre: str) -> Page:
    other = page.context.new_page()
    other.goto(f"http://127.0.0.1:{where.hub.port}/theatres/{theatre}")
    expect(other.get_by_test_id("numbers")).to_have_attribute("data-live", "true")
    expect(other.get_by_test_id("video")).to_have_attribute("data-live", "true")
    return other


def audited(where: Hospital, theatre: str) -> list[dict[str, Any]]:
    return [json.loads(line) for line in where.theatres[theatre].people.audit.complete_lines().splitlines()]


def test_a_supervisor_follows_two_theatres_and_signs_in_one(browser: Browser, tmp_path: Path) -> None:
    with hospital(tmp_path, "OR-1", "OR-2", sees={NAME: ["OR-*"]}) as where:
        page = entered(browser, where)
        for name in ("OR-1", "OR-2"):
            expect(page.get_by_test_id(f"theatre-{name}")).to_have_attribute("data-presence", "live")
        save_screenshot(page, "hub-list")
        first, second = opened(page, where, "OR-1"), opened(page, where, "OR-2")
        save_screenshot(second, "hub-theatre")

        first.get_by_role("textbox").fill(where.theatres["OR-1"].invited(NAME))
        first.get_by_test_id("theatre-enter").get_by_role("button").click()
        expect(first.get_by_test_id("theatre-session")).to_contain_text(NAME)
        first.get_by_test_id("fold-plan").locator("summary").click()
        first.get_by_test_id("cosign-plan").click()
        first.get_by_test_id("cosign-plan").click()
        expect(first.get_by_test_id("sign-plan")).to_have_attribute("data-signed", "true")
        (signed,) = [
            line for line in audited(where, "OR-1") if line["what"] == "POST /api/supervision/signatures"
        ]
        assert (signed["who"]["name"], signed["address"], signed["status"]) == (NAME, "hub", 201)

        for _ in range(2):
            first.get_by_test_id("hold-ask").click()
        expect(first.get_by_test_id("hold")).to_have_attribute("data-requested", "true")
        first.get_by_test_id("tool-circle").click()
        over = first.get_by_test_id("marks").bounding_box()
        assert over is not None
        first.mouse.move(over["x"] + over["width"] / 3, over["y"] + over["height"] / 2)
        first.mouse.down()
        first.mouse.move(over["x"] + over["width"] / 2, over["y"] + over["height"] / 2)
        first.mouse.up()
        # It is drawn when the theatre's room has it.
        expect(first.get_by_test_id("marks")).to_have_attribute("data-empty", "false")
        save_screenshot(first, "hub-acting")

        where.theatres["OR-2"].stop()
        second.evaluate(NOTE_ALARMS)
        expect(second.get_by_test_id("numbers")).to_have_attribute("data-live", "false")
        expect(second.get_by_test_id("video")).to_have_attribute("data-live", "false")
        expect(second.get_by_test_id("alarms-shown")).to_have_attribute("data-priority", "unknown")
        expect(second.get_by_test_id("reading-angle")).to_have_text("—")
        # Answers of the hub itself do not bring back the alarms of a theatre that is silent.
        expect(second.get_by_test_id("theatre-presence")).to_be_visible()
        assert set(second.evaluate("window.alarmsShown")) <= {"unknown"}
        expect(page.get_by_test_id("theatre-OR-2").get_by_test_id("image-age")).to_have_count(0)
        expect(first.get_by_test_id("numbers")).to_have_attribute("data-live", "true")

        where.nats.kill()
        expect(first.get_by_test_id("numbers")).to_have_attribute("data-live", "false")
        expect(page.get_by_test_id("hub-note")).to_contain_text("cannot be used")
        page.context.close()
