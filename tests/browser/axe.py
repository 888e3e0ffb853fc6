"""Violations that axe-core finds in a page."""

from typing import Any

from playwright.sync_api import Page, expect

from tests.browser.theatre import CHECKOUT, PATIENCE_MS

AXE = CHECKOUT / "web" / "node_modules" / "axe-core" / "axe.min.js"
# The scene's frame contains viser's own page, which this project does not control.
RUN = """options => axe
    .run(document, { iframes: false, resultTypes: ["violations"], ...options })
    .then(found => found.violations.map(({ id, impact, nodes }) =>
        ({ id, impact, nodes: nodes.map(node => node.html) })))"""


def load_axe(page: Page) -> None:
    """Load axe-core if it is not there; not as a script of the page, whose policy would reject it."""
    if not page.evaluate("'axe' in window"):
        page.evaluate(AXE.read_text(encoding="utf-8"))


def violations(page: Page, **options: Any) -> list[dict[str, Any]]:  # noqa: ANN401  axe's own options
    """Violations that axe-core rates serious or critical."""
    load_axe(page)
    found: list[dict[str, Any]] = page.evaluate(RUN, options)
    return [fault for fault in found if fault["impact"] in ("serious", "critical")]


# What a theme changes.
COLOURS = {"runOnly": {"type": "rule", "values": ["color-contrast", "link-in-text-block"]}}


def violations_in_both_themes(page: Page) -> list[dict[str, Any]]:
    """The same in the dark theme, and colours in the light one, on a page that follows the preference."""
    found = []
    for theme, options in (("light", COLOURS), ("dark", {})):
        page.emulate_media(color_scheme="light" if theme == "light" else "dark")
        expect(page.locator("html")).to_have_attribute("data-theme", theme, timeout=PATIENCE_MS)
        found += [{**one, "theme": theme} for one in violations(page, **options)]
    return found
