"""What a browser shows while the page's scripts load, if they never arrive, and without scripts."""

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page, expect

from tests.browser.theatre import PATIENCE_MS, Theatre, WatchedPage

pytestmark = pytest.mark.browser
expect.set_options(timeout=PATIENCE_MS)
SCRIPTS = "**/assets/*.js"
# Runs the animation that shows the sentence after ten seconds to its end.
TEN_SECONDS_LATER = "() => document.getAnimations().forEach((one) => one.finish())"


@pytest.fixture
def context(browser: Browser) -> Iterator[BrowserContext]:
    opened = browser.new_context(viewport={"width": 390, "height": 844}, reduced_motion="reduce")
    opened.set_default_timeout(PATIENCE_MS)
    yield opened
    opened.close()


def logged(page: Page) -> list[str]:
    lines: list[str] = []

    def keep(line: ConsoleMessage) -> None:
        if "Content Security Policy" in line.text:
            lines.append(line.text)

    page.on("console", keep)
    return lines


def test_a_page_without_its_scripts_says_that_it_loads_and_then_what_to_do(
    theatre: Theatre, context: BrowserContext
) -> None:
    page = context.new_page()
    rejected_by_policy = logged(page)
    page.route(SCRIPTS, lambda route: route.abort())
    page.goto(f"http://127.0.0.1:{theatre.port}/theatre")
    loading, failed = page.get_by_test_id("loading"), page.get_by_test_id("loading-failed")
    expect(loading).to_contain_text("Coaxial")
    expect(loading).to_contain_text("The page is loading")
    expect(failed).to_be_hidden()
    page.evaluate(TEN_SECONDS_LATER)
    expect(failed).to_be_visible()
    expect(failed).to_contain_text("Check the network and that the server runs")
    expect(failed).to_contain_text("Netzwerk und Server prüfen")
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")
    assert rejected_by_policy == []
    # The remedy works once the scripts come.
    page.unroute(SCRIPTS)
    failed.get_by_role("link", name="load it again").click()
    expect(loading).to_have_count(0)
    expect(page.get_by_test_id("verdict")).to_be_attached()


def test_a_browser_without_scripts_is_told_what_to_do(theatre: Theatre, browser: Browser) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(f"http://127.0.0.1:{theatre.port}/")
    # The locators of Playwright leave out what is in <noscript>.
    shown = page.inner_text("body")
    assert "This page needs JavaScript." in shown
    assert "Diese Seite braucht JavaScript." in shown
    assert "/video/main.mjpg" in shown
    expect(page.get_by_text("The page is loading")).to_be_hidden()
    context.close()


def test_a_page_that_has_loaded_keeps_nothing_of_it(
    theatre: Theatre, watch: Callable[..., WatchedPage]
) -> None:
    page = watch(theatre).open()
    expect(page.get_by_test_id("loading")).to_have_count(0)
