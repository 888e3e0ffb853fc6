"""What all tests share: one real headless browser, and the order in which they run."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, sync_playwright

# Before anything loads NumPy, whose threads wait for each other at full speed: workers use the cores already.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

CHECKOUT = Path(__file__).resolve().parents[1]
IN_BROWSER = CHECKOUT / "tests" / "browser"
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # SwiftShader draws the scene alone; to put whole pages together, it takes five times the work of Skia.
    "--disable-gpu-compositing",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    # A camera that is made of software, for the one page that may ask for it.
    "--use-fake-device-for-media-stream",
    "--use-fake-ui-for-media-stream",
)


def chromium_path() -> str:
    """The one that `COAXIAL_CHROMIUM` names, or the first on the path."""
    named = os.environ.get("COAXIAL_CHROMIUM")
    path = named or next(filter(None, map(shutil.which, BROWSERS)), None)
    assert path, f"no browser: set COAXIAL_CHROMIUM, or install one of {', '.join(BROWSERS)}"
    return path


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """The system's Chromium; `COAXIAL_CHROMIUM` names another one."""
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(
            executable_path=chromium_path(), headless=True, args=list(FLAGS)
        )
        yield chromium
        chromium.close()


def pytest_configure() -> None:
    """Cases of tests never come among those of people: who starts a server names a folder of its own."""
    os.environ["COAXIAL_HOME"] = os.devnull


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """What needs the browser is marked so, and comes last.

    Playwright keeps an event loop running in the thread where other tests start theirs.
    """
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()):
            # `make test` looks for them there alone.
            is_found = IN_BROWSER in item.path.parents or item.path.stem.endswith("_in_browser")
            assert is_found, f"{item.path} needs a browser: name it test_..._in_browser.py"
            item.add_marker(pytest.mark.browser)
    items.sort(key=lambda item: item.get_closest_marker("browser") is not None)
