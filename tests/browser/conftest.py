"""A real server process with a feeder that does as it is told, and a real headless browser."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Self
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, ConsoleMessage, Page, Request, sync_playwright

CHECKOUT = Path(__file__).resolve().parents[2]
SCREENSHOTS = CHECKOUT / ".screenshots"
# How long anything may take on a busy machine before it counts as not happening.
PATIENCE_MS = 30_000
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


class Theatre:
    """The server process of `fake_server.py`; its feeder is told what to publish."""

    def __init__(self, port: int = 0) -> None:
        self._process = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("fake_server.py")), "--port", str(port)],
            cwd=CHECKOUT,
            env={**os.environ, "PYTHONPATH": str(CHECKOUT)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self._process.stdout is not None
        line = self._process.stdout.readline().strip()
        if not line.isdigit():
            self.kill()
            pytest.fail("the server did not say its port; what it said is on standard error")
        self.port = int(line)

    def tell(self, mode: str) -> None:
        """Publish this from now on: live, unseen, lost, bare, stop."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"{mode}\n")
        self._process.stdin.flush()

    def kill(self) -> None:
        """End the process as a power cut would."""
        self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                stream.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._process.poll() is None:
            self.kill()


class Watched:
    """A page, and all that it should not do."""

    def __init__(self, page: Page, port: int) -> None:
        self.page = page
        self.port = port
        self.complaints: list[str] = []
        self.strangers: list[str] = []
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", self._request)

    def _console(self, message: ConsoleMessage) -> None:
        if message.type == "error":
            self.complaints.append(message.text)

    def _request(self, request: Request) -> None:
        address = urlsplit(request.url)
        if address.scheme in ("http", "https", "ws", "wss") and address.netloc != f"127.0.0.1:{self.port}":
            self.strangers.append(request.url)

    def open(self, query: str = "") -> Page:
        """Load the dashboard."""
        self.page.goto(f"http://127.0.0.1:{self.port}/{query}")
        return self.page


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """The system's Chromium; `COAXIAL_CHROMIUM` names another one."""
    named = os.environ.get("COAXIAL_CHROMIUM")
    path = named or next(filter(None, map(shutil.which, BROWSERS)), None)
    assert path, f"no browser: set COAXIAL_CHROMIUM, or install one of {', '.join(BROWSERS)}"
    assert (CHECKOUT / "web" / "dist" / "index.html").is_file(), "the page is not built: npm run build in web/"
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
