"""A real headless browser, and a server process with a feeder that does as it is told."""

import os
import shutil
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, sync_playwright

from tests.browser.theatre import CHECKOUT, PATIENCE_MS, Theatre, Watched

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """The system's Chromium; `COAXIAL_CHROMIUM` names another one."""
    named = os.environ.get("COAXIAL_CHROMIUM")
    path = named or next(filter(None, map(shutil.which, BROWSERS)), None)
    assert path, f"no browser: set COAXIAL_CHROMIUM, or install one of {', '.join(BROWSERS)}"
    assert (CHECKOUT / "web" / "dist" / "index.html").is_file(), (
        "the page is not built: npm run build in web/"
    )
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=path, headless=True, args=list(FLAGS))
        yield chromium
        chromium.close()


@pytest.fixture
def theatre() -> Iterator[Theatre]:
    """A server of its own."""
    with Theatre() as started:
        yield started


@pytest.fixture
def watch(browser: Browser) -> Iterator[Callable[..., Watched]]:
    """Opens a page on a screen of this size; with `strict`, a complaint of the page fails the test."""
    pages: list[tuple[Watched, bool]] = []

    def opened(theatre: Theatre, width: int = 1280, height: int = 800, *, strict: bool = True) -> Watched:
        context = browser.new_context(viewport={"width": width, "height": height}, locale="en-GB")
        context.set_default_timeout(PATIENCE_MS)
        watched = Watched(context.new_page(), theatre.port)
        pages.append((watched, strict))
        return watched

    yield opened
    for watched, strict in pages:
        watched.page.context.close()
        assert watched.strangers == []
        assert not strict or watched.complaints == []
