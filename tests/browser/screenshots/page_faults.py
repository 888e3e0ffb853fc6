"""Layout faults of a page that a machine can find."""

from pathlib import Path

from playwright.sync_api import Page

from tests.browser.small_targets import FINGER_PX, small_targets

FINDER = Path(__file__).with_name("faults.js").read_text(encoding="utf-8")


def page_faults(page: Page) -> list[str]:
    """Text that is cut off, targets that are small or overlap, and sideways scrolling, as sentences.

    Text in SVG and canvases is not examined, nor what is scrolled out of sight.
    """
    found: list[str] = page.evaluate(FINDER)
    return [*found, *small_targets(page, min_px=FINGER_PX)]
