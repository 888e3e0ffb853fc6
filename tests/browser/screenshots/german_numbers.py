"""Numbers of a German page that are written with a decimal point."""

import re

from playwright.sync_api import Page

# Texts that a person sees or hears, without what is for machines: code, and what is marked as English.
TEXTS = """() => {
    const found = [];
    const isOfMachines = (element) => element.closest("code, pre, script, style, [lang=en]") !== null;
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
        if (!isOfMachines(node.parentElement)) found.push(node.textContent);
    }
    for (const element of document.body.querySelectorAll("*")) {
        if (isOfMachines(element)) continue;
        for (const name of ["aria-label", "aria-valuetext", "title", "placeholder", "alt"]) {
            if (element.hasAttribute(name)) found.push(element.getAttribute(name));
        }
        if (element.tagName === "INPUT" && element.type !== "range") found.push(element.value);
    }
    return found.filter((text) => text.trim() !== "");
}"""
# Versions, addresses and German dates have several points.
SEVERAL_POINTS = re.compile(r"\d+(?:\.\d+){2,}\.?")
DECIMAL_POINT = re.compile(r"\d\.\d")
DECIMAL_COMMA = re.compile(r"\d,\d")


def page_texts(page: Page) -> list[str]:
    """Return what a person reads or hears on a page, in pieces."""
    found: list[str] = page.evaluate(TEXTS)
    return found


def with_points(texts: list[str]) -> list[str]:
    """Return the texts that have a decimal point."""
    return [text for text in texts if DECIMAL_POINT.search(SEVERAL_POINTS.sub("", text))]
