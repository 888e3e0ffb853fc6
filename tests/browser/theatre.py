"""The server process that the browser tests talk to, and the page that they watch."""

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
# How long anything may take on a busy machine before it counts as not happening.
PATIENCE_MS = 30_000


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
        self.port = self._port()

    def _port(self) -> int:
        """The one that it says next."""
        assert self._process.stdout is not None
        line = self._process.stdout.readline().strip()
        if not line.isdigit():
            self.kill()
            pytest.fail("the server did not say its port; what it said is on standard error")
        return int(line)

    def anew(self) -> None:
        """Another server in the same process, which remembers nothing: it costs no start of a process."""
        self.thaw()
        self.tell("anew")
        self.port = self._port()

    def tell(self, mode: str) -> None:
        """Publish this from now on: live, unseen, lost, bare, deep, stop."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"{mode}\n")
        self._process.stdin.flush()

    def freeze(self) -> None:
        """Stop the process in its tracks, with its sockets open: a server that hangs."""
        self._process.send_signal(signal.SIGSTOP)

    def thaw(self) -> None:
        """Let it go on."""
        self._process.send_signal(signal.SIGCONT)

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


class WatchedPage:
    """A page, and all that it should not do."""

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
        # viser's client tries to evaluate a string, is rejected by the scene's own policy (the page's names
        # no wasm), and goes on without.
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
    """The 3-D scene in the place of a cut, which a screen shows at first."""
    page.get_by_test_id("tile-scene").click()


def arm(page: Page) -> None:
    """Touch the sound until it is armed, as its words ask for: a busy machine may have none at first."""
    sound = page.get_by_test_id("sound")
    for _ in range(5):
        sound.click()
        with contextlib.suppress(AssertionError):
            expect(sound).to_have_attribute("data-armed", "true", timeout=PATIENCE_MS / 5)
            return
    pytest.fail(f"the sound is not armed: {sound.inner_text()}")
