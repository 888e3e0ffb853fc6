"""The server process of the browser tests, and the page that watches it."""

import contextlib
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import TracebackType
from typing import Self
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import ConsoleMessage, Page, Request, expect

CHECKOUT = Path(__file__).resolve().parents[2]
SCREENSHOTS = CHECKOUT / ".screenshots"
# Timeout of each wait on a busy machine.
PATIENCE_MS = 30_000


def save_screenshot(page: Page, name: str, *, is_full_page: bool = False) -> None:
    """Save what the page shows in `.screenshots`, except in the gate, where nobody looks at it."""
    if not os.environ.get("CI"):
        page.screenshot(path=SCREENSHOTS / f"{name}.png", full_page=is_full_page, animations="disabled")


class Theatre:
    """The server process of `fake_server.py`; its feeder takes orders."""

    def __init__(self, port: int = 0) -> None:
        self._process = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("fake_server.py")), "--port", str(port)],
            cwd=CHECKOUT,
            env={**os.environ, "PYTHONPATH": str(CHECKOUT)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.port = self._port()

    def _port(self) -> int:
        """The port that it prints next."""
        assert self._process.stdout is not None
        line = self._process.stdout.readline().strip()
        if not line.isdigit():
            self.kill()
            pytest.fail("the server did not say its port; what it said is on standard error")
        return int(line)

    def anew(self) -> None:
        """Start another server without memory in the same process, which saves a process start."""
        self.thaw()
        self.tell("anew")
        self.port = self._port()

    def tell(self, mode: str) -> None:
        """Publish this from now on: live, unseen, lost, bare, deep, stop."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"{mode}\n")
        self._process.stdin.flush()

    def freeze(self) -> None:
        """Stop the process with its sockets open: a server that hangs."""
        self._process.send_signal(signal.SIGSTOP)

    def thaw(self) -> None:
        """Resume the process."""
        self._process.send_signal(signal.SIGCONT)

    def kill(self) -> None:
        """Kill the process, as a power failure would."""
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


class WatchedPage:
    """A page and its logged errors."""

    def __init__(self, page: Page, port: int) -> None:
        self.page = page
        self.port = port
        self.complaints: list[str] = []
        self.strangers: list[str] = []
        page.on("console", self._console)
        page.on("pageerror", lambda error: self._complain(str(error)))
        page.on("request", self._request)

    def _console(self, message: ConsoleMessage) -> None:
        if message.type == "error":
            self._complain(message.text)

    def _complain(self, text: str) -> None:
        # viser's client tries to evaluate a string, which the scene's policy rejects (the page's policy
        # does not allow wasm), and continues without it.
        if not ("Evaluating a string as JavaScript" in text and "wasm-unsafe-eval" in text):
            self.complaints.append(text)

    def _request(self, request: Request) -> None:
        address = urlsplit(request.url)
        if address.scheme in ("http", "https", "ws", "wss") and address.netloc != f"127.0.0.1:{self.port}":
            self.strangers.append(request.url)

    def open(self, query: str = "") -> Page:
        """Load the dashboard."""
        self.page.goto(f"http://127.0.0.1:{self.port}/{query}")
        return self.page


def show_scene(page: Page) -> None:
    """Show the 3-D scene in place of a cut."""
    page.get_by_test_id("tile-scene").click()


def arm(page: Page) -> None:
    """Touch the sound until it is armed; on a busy machine it may fail at first."""
    sound = page.get_by_test_id("sound")
    for _ in range(5):
        sound.click()
        with contextlib.suppress(AssertionError):
            expect(sound).to_have_attribute("data-armed", "true", timeout=PATIENCE_MS / 5)
            return
    pytest.fail(f"the sound is not armed: {sound.inner_text()}")
