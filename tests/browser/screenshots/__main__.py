"""Takes a screenshot of every view in its states, sizes, themes and languages, and prints their faults.

    PYTHONPATH=. python -m tests.browser.screenshots --to FOLDER [--only NAME] [--sizes 1920x1080 ...]

writes one PNG for each, and `index.html` with all of them. The page must be built.
"""

import argparse
import json
import sys
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from urllib.request import urlopen

from playwright.sync_api import Browser, BrowserContext, ViewportSize, sync_playwright
from playwright.sync_api import Error as PlaywrightError

from tests.browser.made_up_ct import answer_ct
from tests.browser.screenshots.contact_sheet import Picture, contact_sheet
from tests.browser.screenshots.german_numbers import page_texts, with_points
from tests.browser.screenshots.page_faults import page_faults
from tests.browser.screenshots.states import STAGES, Stage, State, click
from tests.browser.theatre import WatchedPage
from tests.browser.unconfirmed import answer_unconfirmed
from tests.conftest import FLAGS, chromium_path

SIZES = ("1920x1080", "1366x768", "1180x820", "390x844")
THEMES = ("dark", "light")
LOCALES: Mapping[str, str] = {"en": "en-GB", "de": "de-DE"}
PATIENCE_MS = 60_000
# Long enough that a busy machine's late images stay on the page.
OLD_MS = 600_000
# What the state is about may be further down.
IN_SIGHT = "elements => elements[0]?.scrollIntoView({ block: 'nearest' })"
# Layout and canvases follow the size of the window within some frames.
SETTLED = """() => new Promise(resolve => {
    let frames = 8;
    const next = () => { frames -= 1; if (frames < 0) resolve(); else requestAnimationFrame(next); };
    next();
})"""


class Photographer:
    """Takes the screenshots of one server in one theme and language."""

    def __init__(self, browser: Browser, stage: Stage, theme: str, language: str, folder: Path) -> None:
        self._browser = browser
        self._stage = stage
        self._theme = theme
        self._language = language
        self._folder = folder

    def take(self, state: State, sizes: Sequence[str]) -> list[Picture]:
        """Open the state, and return its pictures; a state that does not come is a fault."""
        if state.order:
            self._stage.tell(state.order)
        context = self._context(state)
        try:
            watched = WatchedPage(context.new_page(), self._stage.port)
            problems = self._open(watched, state)
            return [self._picture(watched, state, size, problems) for size in sizes]
        finally:
            context.close()

    def _open(self, watched: WatchedPage, state: State) -> list[str]:
        page = watched.open(state.path)
        try:
            if state.event:
                page.locator(state.event).first.wait_for()
                self._stage.tell(state.next_order)
            for step in state.clicks:
                click(page, step)
            page.locator(state.ready).first.wait_for()
        except PlaywrightError as error:
            return [f"not reached: {error.message.splitlines()[0]}"]
        return []

    def _picture(self, watched: WatchedPage, state: State, size: str, problems: Sequence[str]) -> Picture:
        page = watched.page
        page.set_viewport_size(size_of(size))
        page.locator(state.ready).first.evaluate_all(IN_SIGHT)
        page.evaluate(SETTLED)
        variant = f"{size} {self._theme} {self._language}"
        file = f"{state.name} {variant}.png".replace(" ", "-")
        page.screenshot(path=self._folder / file, animations="disabled")
        logged = [f"console: {one}" for one in watched.complaints]
        watched.complaints.clear()
        faults = [*problems, *page_faults(page), *logged]
        if self._language == "de":
            faults += [f"decimal point: {text}" for text in with_points(page_texts(page))]
        return Picture(file=file, variant=variant, faults=faults)

    def _context(self, state: State) -> BrowserContext:
        address = f"http://127.0.0.1:{self._stage.port}"
        context = self._browser.new_context(
            viewport=size_of(SIZES[0]),
            locale=LOCALES[self._language],
            color_scheme="light" if self._theme == "light" else "dark",
        )
        context.set_default_timeout(PATIENCE_MS)
        context.add_init_script(f"localStorage.setItem('coaxial.theme', {json.dumps(self._theme)})")
        if state.is_unconfirmed:
            context.route("**/api/procedure", answer_unconfirmed)
        if state.person:
            context.add_cookies([{"name": "person", "value": state.person, "url": address}])
            context.route("**/api/navigation/ct", answer_ct)
        elif not state.has_real_limits:
            with urlopen(f"{address}/api/dashboard", timeout=60) as answer:  # noqa: S310  our own server
                said = json.load(answer)
            said["limits"]["pose_stale_after_ms"] = OLD_MS
            context.route("**/api/dashboard", lambda route: route.fulfill(json=said))
        return context


def size_of(text: str) -> ViewportSize:
    """Viewport of a size like 1920x1080."""
    width, height = map(int, text.split("x"))
    return {"width": width, "height": height}


def print_faults(name: str, pictures: Sequence[Picture]) -> None:
    """Print each fault of a state once, with the variants that have it."""
    variants: dict[str, list[str]] = defaultdict(list)
    for picture in pictures:
        for fault in picture.faults:
            variants[fault].append(picture.variant)
    for fault, where in variants.items():
        sys.stdout.write(f"{name}: {fault} ({', '.join(where)})\n")
    sys.stdout.flush()


def main() -> None:
    """Take the screenshots, print the faults."""
    parser = argparse.ArgumentParser(description="Screenshots of every view, and their faults.")
    parser.add_argument("--to", type=Path, required=True, help="folder of the pictures")
    parser.add_argument("--only", default="", help="states whose name contains this")
    parser.add_argument("--sizes", nargs="+", default=SIZES, help="such as 1920x1080")
    parser.add_argument("--themes", nargs="+", default=THEMES, choices=THEMES)
    parser.add_argument("--languages", nargs="+", default=tuple(LOCALES), choices=LOCALES)
    arguments = parser.parse_args()
    arguments.to.mkdir(parents=True, exist_ok=True)
    pictures: dict[str, Sequence[Picture]] = {}
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium_path(), headless=True, args=list(FLAGS))
        for make, states in STAGES.values():
            wanted = [state for state in states if arguments.only in state.name]
            if not wanted:
                continue
            with make() as stage:
                photographers = [
                    Photographer(browser, stage, theme, language, arguments.to)
                    for theme in arguments.themes
                    for language in arguments.languages
                ]
                for state in wanted:
                    shown = [one for each in photographers for one in each.take(state, arguments.sizes)]
                    print_faults(state.name, shown)
                    pictures[state.name] = shown
        browser.close()
    (arguments.to / "index.html").write_text(contact_sheet(pictures), encoding="utf-8")
    sys.stdout.write(f"{sum(map(len, pictures.values()))} screenshots in {arguments.to}/index.html\n")


if __name__ == "__main__":
    main()
