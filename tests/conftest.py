"""Shared fixtures: one real headless browser, the root logger, and the order of the tests."""

import gc
import logging
import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import hypothesis
import pytest
from playwright.sync_api import Browser, sync_playwright

# Set before NumPy is loaded, whose threads spin while waiting: workers use the cores already.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# A law has no time limit of its own: on a loaded machine a single example may take seconds.
hypothesis.settings.register_profile("coaxial", deadline=None)
hypothesis.settings.load_profile("coaxial")

CHECKOUT = Path(__file__).resolve().parents[1]
IN_BROWSER = CHECKOUT / "tests" / "browser"
BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # SwiftShader renders the scene only; for composing whole pages it needs five times the work of Skia.
    "--disable-gpu-compositing",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    # A simulated camera, for the only page that may request one.
    "--use-fake-device-for-media-stream",
    "--use-fake-ui-for-media-stream",
)


def chromium_path() -> str:
    """The executable named by `COAXIAL_CHROMIUM`, or the first on the path."""
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
    """Cases of tests are never stored among a user's: each server start names its own folder."""
    os.environ["COAXIAL_HOME"] = os.devnull
    gc.disable()


def pytest_collection_finish() -> None:
    """Leave loaded modules out of garbage collection, which took a fifth of the processor time of tests."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000)
    gc.enable()


@pytest.fixture(autouse=True)
def unchanged_root_logger() -> Iterator[None]:
    """Undo what a command configured in this process: its handler writes to a stream that is then closed."""
    root = logging.getLogger()
    handlers, level = root.handlers[:], root.level
    yield
    root.handlers[:] = handlers
    root.setLevel(level)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark tests that need the browser, and run them last.

    Playwright keeps an event loop running in the thread where other tests start theirs.

    """
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()):
            # `make test` looks for them there alone.
            is_found = IN_BROWSER in item.path.parents or item.path.stem.endswith("_in_browser")
            assert is_found, f"{item.path} needs a browser: name it test_..._in_browser.py"
            item.add_marker(pytest.mark.browser)
    items.sort(key=lambda item: item.get_closest_marker("browser") is not None)
