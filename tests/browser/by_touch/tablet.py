"""A tablet page under test: taps, reads, and records targets that are too small for a glove."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from playwright.sync_api import Browser, Page, ViewportSize, expect

from tests.browser.theatre import WatchedPage, save_screenshot

LANDSCAPE: ViewportSize = {"width": 1280, "height": 800}
UPRIGHT: ViewportSize = {"width": 800, "height": 1280}
PHONE: ViewportSize = {"width": 390, "height": 844}
MIN_TARGET_PX = 48.0
# A checkbox is hit by its label; text without an action may be small.
SMALL_TARGETS = f"""() => [...document.querySelectorAll("main :is(button, a, input, select, summary)")]
    .filter(one => one.type !== "file" && one.checkVisibility())
    .map(one => [/radio|checkbox/.test(one.type) ? one.labels[0] : one, one])
    .map(([target, one]) => [target.getBoundingClientRect(), one])
    .filter(([box]) => box.width > 0 && Math.min(box.width, box.height) < {MIN_TARGET_PX - 0.5})
    .map(([box, one]) => `${{box.width}} x ${{box.height}}: ${{one.outerHTML.slice(0, 160)}}`)"""
WIDER_THAN_SCREEN = "() => document.documentElement.scrollWidth > document.documentElement.clientWidth + 1"


@dataclass(frozen=True, slots=True, kw_only=True)
class Tablet:
    """A page on a tablet.

    Attributes:
        page: page of the browser.
        address: address of the server.
        patience_ms: timeout of each wait.
        faults: problems found by `looked_at`.

    """

    page: Page
    address: str
    patience_ms: float
    faults: list[str]

    def go(self, path: str) -> None:
        """Load the page of a step."""
        self.page.goto(f"{self.address}/operator/{path}")

    def tap(self, name: str) -> None:
        """Tap the element with this test id as soon as it can be tapped."""
        there = self.page.get_by_test_id(name)
        expect(there).to_be_enabled(timeout=self.patience_ms)
        there.tap()

    def sees(self, name: str) -> None:
        """Wait until the element with this test id exists."""
        expect(self.page.get_by_test_id(name)).to_be_visible(timeout=self.patience_ms)

    def reads(self, name: str, text: str) -> None:
        """Wait until the element contains this text."""
        expect(self.page.get_by_test_id(name)).to_contain_text(text, timeout=self.patience_ms)

    def finds(self, name: str, attribute: str, value: str) -> None:
        """Wait until the attribute has this value."""
        expect(self.page.get_by_test_id(name)).to_have_attribute(attribute, value, timeout=self.patience_ms)

    def asks(self, path: str) -> Any:  # noqa: ANN401  JSON
        """Return the server's answer for the user of this tablet."""
        answer = self.page.request.get(f"{self.address}{path}")
        assert answer.ok, f"{path}: {answer.status} {answer.text()[:400]}"
        return answer.json()

    def looked_at(self, name: str) -> None:
        """Record small targets and overflow at each screen size, with screenshots."""
        for size, way in ((PHONE, "phone"), (UPRIGHT, "upright"), (LANDSCAPE, "landscape")):
            self.page.set_viewport_size(size)
            save_screenshot(self.page, f"operator-{name}-{way}", is_full_page=True)
            self.faults.extend(f"{name}, {way}: small: {one}" for one in self.page.evaluate(SMALL_TARGETS))
            if self.page.evaluate(WIDER_THAN_SCREEN):
                self.faults.append(f"{name}, {way}: wider than the screen")


@contextmanager
def tablet_at(browser: Browser, port: int, *, patience_ms: float) -> Iterator[Tablet]:
    """Yield a tablet in landscape that is operated by touch only; fail on layout faults or logged errors."""
    context = browser.new_context(viewport=LANDSCAPE, has_touch=True, locale="en-GB")
    context.set_default_timeout(patience_ms)
    expect.set_options(timeout=patience_ms)
    watched = WatchedPage(context.new_page(), port)
    tablet = Tablet(page=watched.page, address=f"http://127.0.0.1:{port}", patience_ms=patience_ms, faults=[])
    try:
        yield tablet
    finally:
        context.close()
    assert not tablet.faults, tablet.faults
    assert not watched.strangers, watched.strangers
    # A collection may end between two requests for it, as may the first slice of an upload;
    # the browser logs such rejections.
    complaints = [one for one in watched.complaints if "409 (Conflict)" not in one]
    assert not complaints, complaints
