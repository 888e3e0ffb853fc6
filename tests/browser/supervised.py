"""The server process of `supervised_server.py`, and the pages of its users."""

import os
import subprocess
import sys
from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.browser.made_up_ct import answer_ct
from tests.browser.theatre import CHECKOUT, WatchedPage


class Supervised:
    """The server process of `supervised_server.py`."""

    def __init__(self) -> None:
        self.process = subprocess.Popen(
            [sys.executable, str(CHECKOUT / "tests" / "browser" / "supervised_server.py")],
            cwd=CHECKOUT,
            env={**os.environ, "PYTHONPATH": str(CHECKOUT)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        self.port = int(self.process.stdout.readline())


def opened(
    watch: Callable[..., WatchedPage], server: Supervised, person: str, path: str, size: tuple[int, int]
) -> Page:
    watched = watch(server, *size)
    address = f"http://127.0.0.1:{server.port}"
    watched.page.context.add_cookies([{"name": "person", "value": person, "url": address}])
    watched.page.route("**/api/navigation/ct", answer_ct)
    page = watched.open(path)
    expect(page.get_by_test_id("video")).to_have_attribute("data-live", "true")
    return page
