"""Layout faults of a page that a machine can find."""

from pathlib import Path

from playwright.sync_api import Page

# WCAG 2.2, target size (enhanced). Pages of the tablet are tested with 48 px, for gloves.
MIN_TARGET_PX = 44
FINDER = Path(__file__).with_name("faults.js").read_text(encoding="utf-8")


def page_faults(page: Page) -> list[str]:
    """Text that is cut off, targets that are small or overlap, and sideways scrolling, as sentences.

    Text in SVG and canvases is not examined, nor what is scrolled out of sight.
    """
    found: list[str] = page.evaluate(FINDER, MIN_TARGET_PX)
    return found
