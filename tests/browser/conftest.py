"""A server process with a feeder that does as it is told, and pages that watch it."""

from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager

import pluggy
import pytest
from playwright.sync_api import Browser
from playwright.sync_api import Error as PlaywrightError

from tests.browser.theatre import CHECKOUT, PATIENCE_MS, Theatre, WatchedPage


@pytest.fixture(scope="session")
def playhouse() -> Iterator[Theatre]:
    """A process that serves one theatre after the other."""
    assert (CHECKOUT / "web" / "dist" / "index.html").is_file(), (
        "the page is not built: npm run build in web/"
    )
    with Theatre() as started:
        yield started


@pytest.fixture
def theatre(playhouse: Theatre) -> Iterator[Theatre]:
    """A server that nobody has used. A test that kills its process starts one of its own."""
    playhouse.anew()
    yield playhouse
    # Images that nobody sees would take their part of the machine from the tests that need none of it.
    playhouse.tell("stop")


@pytest.fixture(scope="module")
def shared_theatre(playhouse: Theatre) -> Iterator[Theatre]:
    """One server for all tests of a file, none of which hurts it or takes one of its own."""
    playhouse.anew()
    yield playhouse
    playhouse.tell("stop")


@pytest.fixture
def watch(browser: Browser) -> Iterator[Callable[..., WatchedPage]]:
    """Opens a page on a screen of this size; with `strict`, a complaint of the page fails the test."""
    with watching(browser) as opened:
        yield opened


@pytest.fixture(scope="module")
def watch_for_all(browser: Browser) -> Iterator[Callable[..., WatchedPage]]:
    """The same for a page that all tests of a file share: to load it costs more than most of them."""
    with watching(browser) as opened:
        yield opened


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, "pluggy.Result[pytest.TestReport]"]:
    """What stood on each page when a test failed, which no later run may show again."""
    report = (yield).get_result()
    browser = getattr(item, "funcargs", {}).get("browser")
    if not report.failed or browser is None:
        return
    for context in browser.contexts:
        for page in context.pages:
            try:
                report.sections.append((f"page {page.url}", page.inner_text("body", timeout=5_000)))
            except PlaywrightError as error:
                report.sections.append((f"page {page.url}", f"not to be read: {error.message}"))


@contextmanager
def watching(browser: Browser) -> Iterator[Callable[..., WatchedPage]]:
    """What opens pages, which are closed at the end, and judged."""
    pages: list[tuple[WatchedPage, bool]] = []

    def opened(theatre: Theatre, width: int = 1280, height: int = 800, *, strict: bool = True) -> WatchedPage:
        context = browser.new_context(viewport={"width": width, "height": height}, locale="en-GB")
        context.set_default_timeout(PATIENCE_MS)
        watched = WatchedPage(context.new_page(), theatre.port)
        pages.append((watched, strict))
        return watched

    yield opened
    for watched, strict in pages:
        watched.page.context.close()
        assert watched.strangers == []
        assert not strict or watched.complaints == []
