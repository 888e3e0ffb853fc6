"""Fixtures: a server process with a controllable feeder, and pages that watch it."""

from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager

import pluggy
import pytest
from playwright.sync_api import Browser
from playwright.sync_api import Error as PlaywrightError

from tests.browser.theatre import CHECKOUT, PATIENCE_MS, Theatre, WatchedPage


@pytest.fixture(scope="session")
def playhouse() -> Iterator[Theatre]:
    """A process that serves one theatre after another."""
    assert (CHECKOUT / "web" / "dist" / "index.html").is_file(), (
        "the page is not built: npm run build in web/"
    )
    with Theatre() as started:
        yield started


@pytest.fixture
def theatre(playhouse: Theatre) -> Iterator[Theatre]:
    """A new server. A test that kills its process starts its own."""
    playhouse.anew()
    yield playhouse
    # Unwatched images would take processor time from tests that do not need them.
    playhouse.tell("stop")


@pytest.fixture(scope="module")
def shared_theatre(playhouse: Theatre) -> Iterator[Theatre]:
    """One server shared by all tests of a file that do not damage it."""
    playhouse.anew()
    yield playhouse
    playhouse.tell("stop")


@pytest.fixture
def watch(browser: Browser) -> Iterator[Callable[..., WatchedPage]]:
    """Opens a page with this screen size; with `strict`, an error logged by the page fails the test."""
    with watching(browser) as opened:
        yield opened


@pytest.fixture(scope="module")
def watch_for_all(browser: Browser) -> Iterator[Callable[..., WatchedPage]]:
    """The same for a page shared by all tests of a file, because loading takes longer than most of them."""
    with watching(browser) as opened:
        yield opened


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, "pluggy.Result[pytest.TestReport]"]:
    """Save what each page displayed when a test failed."""
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
    """Opens pages, closes them at the end, and checks their logs."""
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
