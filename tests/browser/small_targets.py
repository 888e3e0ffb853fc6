"""Targets of a page that are too small to be hit."""

from playwright.sync_api import Page

# A glove misses what has less.
GLOVE_PX = 48
# WCAG 2.2, target size (enhanced).
FINGER_PX = 44
# A checkbox is hit by its label.
FINDER = """([minPx, within]) => {
    const targets = "button, a[href], input, select, textarea, summary, [role=button], [role=slider]";
    return [...document.querySelectorAll(within)].flatMap((part) => [...part.querySelectorAll(targets)])
        .filter((one) => one.type !== "file")
        .filter((one) => one.checkVisibility({ opacityProperty: true, visibilityProperty: true }))
        .filter((one) => one.closest("[inert], dialog:not([open])") === null)
        .map((one) => [one, /radio|checkbox/.test(one.type) ? (one.labels[0] ?? one) : one])
        .map(([one, target]) => [one, target.getBoundingClientRect()])
        .filter(([, { width, height }]) => width > 1 && Math.min(width, height) < minPx - 0.5)
        .map(([one, { width, height }]) => {
            const { testid } = one.dataset;
            const words = (one.innerText ?? "").trim().replace(/\\s+/g, " ").slice(0, 40);
            const size = `${Math.round(width)} x ${Math.round(height)} px`;
            return `small: ${one.tagName.toLowerCase()}${testid ? `[${testid}]` : ""} "${words}" has ${size}`;
        });
}"""


def small_targets(page: Page, *, min_px: int, within: str = "body") -> list[str]:
    """Return the visible targets narrower or lower than this, as sentences."""
    found: list[str] = page.evaluate(FINDER, [min_px, within])
    return found
