"""A theatre screen with armed sound, through a server restart, a crash of its tab, and a reload."""

from collections.abc import Callable

import httpx2
import pytest
from playwright.sync_api import Error, Page, expect

from tests.browser.theatre import PATIENCE_MS, Theatre, WatchedPage, arm

pytestmark = pytest.mark.browser

Watch = Callable[..., WatchedPage]
SCREENS = "/api/alarms/screens"
expect.set_options(timeout=PATIENCE_MS)


def conditions(theatre: Theatre) -> set[str]:
    """Alarms that the server raises at present."""
    reported = httpx2.get(f"http://127.0.0.1:{theatre.port}/api/alarms").json()
    return {one["condition"] for one in reported["alarms"]}


def raised(page: Page, theatre: Theatre, condition: str, *, there: bool = True) -> None:
    """Wait until the server raises this alarm; the page only provides the waiting."""
    for _ in range(PATIENCE_MS // 100):
        if (condition in conditions(theatre)) is there:
            return
        page.wait_for_timeout(100)
    pytest.fail(f"{condition} was not {'raised' if there else 'cleared'}")


def cleared(page: Page, theatre: Theatre, condition: str) -> None:
    """Wait until the server no longer raises it."""
    raised(page, theatre, condition, there=False)


def armed(page: Page) -> None:
    sound = page.get_by_test_id("sound")
    expect(sound).to_have_text("SOUND NOT ARMED: touch here")
    arm(page)


def test_a_server_that_starts_again_hears_of_the_armed_screen_without_a_touch(watch: Watch) -> None:
    with Theatre() as first:
        page = watch(first, strict=False).open()
        armed(page)
        first.kill()
    with Theatre(first.port) as again:

        def says_armed(answer: object) -> bool:
            request = getattr(answer, "request", None)
            return request is not None and request.url.endswith(SCREENS) and "armed" in request.post_data

        with page.expect_response(says_armed, timeout=PATIENCE_MS) as heard:
            again.tell("live")
        assert heard.value.ok
        expect(page.get_by_test_id("sound")).to_have_attribute("data-armed", "true")
        cleared(page, again, "NO_ARMED_SCREEN")


def test_a_screen_whose_tab_crashed_is_missed_and_asks_again_when_it_is_back(
    theatre: Theatre, watch: Watch
) -> None:
    theatre.tell("live")
    page = watch(theatre, strict=False).open()
    armed(page)
    beside = page.context.new_page()
    with pytest.raises(Error):
        page.goto("chrome://crash")
    raised(beside, theatre, "VIEWER_LOST")
    raised(beside, theatre, "NO_ARMED_SCREEN")
    beside.goto(f"http://127.0.0.1:{theatre.port}/")
    armed(beside)


def test_a_screen_that_is_loaded_again_is_not_missed_and_asks_in_words(
    theatre: Theatre, watch: Watch
) -> None:
    theatre.tell("live")
    page = watch(theatre).open()
    armed(page)
    page.reload()
    expect(page.get_by_test_id("sound")).to_have_text("SOUND NOT ARMED: touch here")
    raised(page, theatre, "NO_ARMED_SCREEN")
    assert "VIEWER_LOST" not in conditions(theatre)
