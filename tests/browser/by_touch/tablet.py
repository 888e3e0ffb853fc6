"""A tablet page under test: taps, reads, and records targets that are too small for a glove."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from playwright.sync_api import Browser, Locator, Page, ViewportSize, expect

from tests.browser.small_targets import GLOVE_PX, small_targets
from tests.browser.theatre import WatchedPage, save_screenshot

LANDSCAPE: ViewportSize = {"width": 1180, "height": 820}
UPRIGHT: ViewportSize = {"width": 800, "height": 1280}
PHONE: ViewportSize = {"width": 390, "height": 844}
# What the next step needs: what to do, the picture, what is measured so far, and the main buttons.
MAIN_PATH = """main :is(.step-said, .video-stage, .planes-large, .newest, .missing, .capture, .outcome,
    .measure:has(.measure-bar)), .step-actions button"""
TO_THE_TOP = "() => document.querySelector('.step-content')?.scrollTo(0, 0)"
OUT_OF_SIGHT = f"""() => {{
    const content = document.querySelector(".step-content");
    if (content === null || document.querySelector(".step-actions").childElementCount === 0) return [];
    const within = (box, seen) => box.top >= seen.top - 1 && box.bottom <= seen.bottom + 1;
    const screen = {{ top: 0, bottom: innerHeight }};
    return [...document.querySelectorAll(`{MAIN_PATH}`)].filter((one) => one.checkVisibility())
        .filter((one) => {{
            const box = one.getBoundingClientRect();
            const seen = content.contains(one) ? content.getBoundingClientRect() : screen;
            return !within(box, seen) || !within(box, screen);
        }})
        .map((one) => one.outerHTML.slice(0, 160));
}}"""
WIDER_THAN_SCREEN = "() => document.documentElement.scrollWidth > document.documentElement.clientWidth + 1"


@dataclass(frozen=True, slots=True, kw_only=True)
class Tablet:
    """A page on a tablet.

    Attributes:
        page: page of the browser.
        address: address of the server.
        patience_ms: timeout of each wait.
        faults: problems found by `looked_at`.
        taps: what was tapped or typed into so far, without what the shortest way does not need.

    """

    page: Page
    address: str
    patience_ms: float
    faults: list[str]
    taps: list[str]

    def go(self, path: str) -> None:
        """Load the page of a step."""
        self.page.goto(f"{self.address}/operator/{path}")

    def tap(self, name: str) -> None:
        """Tap the element with this test id as soon as it can be tapped."""
        there = self.page.get_by_test_id(name)
        expect(there).to_be_enabled(timeout=self.patience_ms)
        self.tap_on(there, name)

    def tap_on(self, there: Locator, name: str) -> None:
        """Tap this element."""
        there.tap()
        self.taps.append(name)

    def type_into(self, label: str, text: str) -> None:
        """Fill the field with this label."""
        self.page.get_by_label(label).fill(text)
        self.taps.append(label)

    @contextmanager
    def uncounted(self) -> Iterator[None]:
        """Taps that the shortest way to navigation does not need."""
        before = len(self.taps)
        yield
        del self.taps[before:]

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
        # The server may close an idle connection at the moment in which it is used again.
        answer = self.page.request.get(f"{self.address}{path}", max_retries=2)
        assert answer.ok, f"{path}: {answer.status} {answer.text()[:400]}"
        return answer.json()

    def looked_at(self, name: str) -> None:
        """Record small targets, overflow, and what a tablet would have to scroll to, with screenshots."""
        for size, way in ((PHONE, "phone"), (UPRIGHT, "upright"), (LANDSCAPE, "landscape")):
            self.page.set_viewport_size(size)
            self.page.evaluate(TO_THE_TOP)
            save_screenshot(self.page, f"operator-{name}-{way}", is_full_page=True)
            small = small_targets(self.page, min_px=GLOVE_PX, within="main")
            self.faults.extend(f"{name}, {way}: {one}" for one in small)
            if self.page.evaluate(WIDER_THAN_SCREEN):
                self.faults.append(f"{name}, {way}: wider than the screen")
        self.faults.extend(f"{name}: out of sight: {one}" for one in self.page.evaluate(OUT_OF_SIGHT))


@contextmanager
def tablet_at(browser: Browser, port: int, *, patience_ms: float) -> Iterator[Tablet]:
    """Yield a tablet in landscape that is operated by touch only; fail on layout faults or logged errors."""
    context = browser.new_context(viewport=LANDSCAPE, has_touch=True, locale="en-GB")
    context.set_default_timeout(patience_ms)
    expect.set_options(timeout=patience_ms)
    watched = WatchedPage(context.new_page(), port)
    tablet = Tablet(
        page=watched.page, address=f"http://127.0.0.1:{port}", patience_ms=patience_ms, faults=[], taps=[]
    )
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
