"""Recordings on the page: their state on every view, and what the operator does with them."""

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Page, expect

from tests.browser.supervised import Supervised, opened
from tests.browser.theatre import PATIENCE_MS, SCREENSHOTS, WatchedPage

pytestmark = pytest.mark.browser
expect.set_options(timeout=PATIENCE_MS)

Watch = Callable[..., WatchedPage]
SCREEN, TABLET, PHONE = (1920, 1080), (1180, 820), (390, 844)


@pytest.fixture(scope="module")
def supervised() -> Iterator[Supervised]:
    """One server with an open case."""
    server = Supervised()
    yield server
    server.process.communicate(timeout=30)


def picture(page: Page, name: str) -> None:
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / f"recording-{name}.png")


def test_what_the_operator_records_is_said_on_every_view(supervised: Supervised, watch: Watch) -> None:
    operator = opened(watch, supervised, "o1", "operator/navigate", TABLET)
    theatre = opened(watch, supervised, "v1", "theatre", SCREEN)
    phone = opened(watch, supervised, "s1", "supervisor?lang=de", PHONE)
    pages = {"operator": operator, "theatre": theatre, "supervisor": phone}
    for page in pages.values():
        expect(page.get_by_test_id("recording-state")).to_have_attribute("data-state", "off")
    button = operator.get_by_test_id("record")
    box = button.bounding_box()
    assert box is not None
    assert box["height"] >= 48
    button.click()
    # Before the first recording of a case somebody answers for the patient.
    expect(operator.get_by_role("dialog")).to_contain_text("Has the patient consented to recording?")
    picture(operator, "consent")
    operator.get_by_test_id("consent-no").click()
    expect(operator.get_by_role("dialog")).to_be_hidden()
    expect(operator.get_by_test_id("recording-state")).to_have_attribute("data-state", "off")
    button.click()
    operator.get_by_test_id("consent-yes").click()
    for name, page in pages.items():
        state = page.get_by_test_id("recording-state")
        expect(state).to_have_attribute("data-state", "on")
        expect(state).to_contain_text("REC 0:")
        expect(state).to_contain_text("1.0 kB")
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        picture(page, name)
    assert theatre.get_by_test_id("record").count() == phone.get_by_test_id("record").count() == 0
    expect(button).to_have_text("■ Stop recording")
    button.click()
    for page in pages.values():
        expect(page.get_by_test_id("recording-state")).to_have_attribute("data-state", "off")
    # Once answered, it is not asked again.
    button.click()
    expect(operator.get_by_test_id("recording-state")).to_have_attribute("data-state", "on")
    button.click()
    expect(operator.get_by_test_id("recording-state")).to_have_attribute("data-state", "off")
