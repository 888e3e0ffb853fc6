"""A German page writes decimal commas in every state, and its number fields accept comma and point."""

import json
import re
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from urllib.request import urlopen

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect

from tests.browser.screenshots.states import (
    PREPARED_STATES,
    SUPERVISED_STATES,
    THEATRE_STATES,
    Stage,
    State,
    click,
    prepared_stage,
    supervised_stage,
    theatre_stage,
)
from tests.browser.theatre import PATIENCE_MS, WatchedPage
from tests.browser.unconfirmed import answer_unconfirmed

pytestmark = pytest.mark.browser
expect.set_options(timeout=PATIENCE_MS)

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


def with_points(texts: list[str]) -> list[str]:
    return [text for text in texts if DECIMAL_POINT.search(SEVERAL_POINTS.sub("", text))]


def is_read(state: State) -> bool:
    """Whether a state without a case has texts that no other one has: a layout only arranges them."""
    is_layout = "layout" in state.name and state.name != "theatre-layout-figures"
    return not (state.has_real_limits or is_layout or "operator" in state.name)


@contextmanager
def german(browser: Browser, stage: Stage, person: str = "") -> Iterator[BrowserContext]:
    """A German browser, on whose pages late images stay."""
    address = f"http://127.0.0.1:{stage.port}"
    context = browser.new_context(viewport={"width": 1280, "height": 800}, locale="de-DE")
    context.set_default_timeout(PATIENCE_MS)
    if person:
        context.add_cookies([{"name": "person", "value": person, "url": address}])
    else:
        with urlopen(f"{address}/api/dashboard", timeout=60) as answer:  # noqa: S310  our own server
            said = json.load(answer)
        for what in ("pose", "video"):
            said["limits"][f"{what}_stale_after_ms"] = 600_000
        context.route("**/api/dashboard", lambda route: route.fulfill(json=said))
    yield context
    context.close()


def read(page: Page, stage: Stage, state: State) -> list[str]:
    """Open a state, and return its texts."""
    if state.order:
        stage.tell(state.order)
    WatchedPage(page, stage.port).open(state.path.replace("lang=de", ""))
    if state.event:
        page.locator(state.event).first.wait_for()
        stage.tell(state.next_order)
    for step in state.clicks:
        click(page, step)
    page.locator(state.ready).first.wait_for()
    expect(page.locator("html")).to_have_attribute("lang", "de")
    texts: list[str] = page.evaluate(TEXTS)
    return texts


@pytest.mark.parametrize(
    ("make", "states"),
    [
        pytest.param(
            theatre_stage,
            [one for one in THEATRE_STATES if is_read(one)],
            id="theatre",
        ),
        pytest.param(supervised_stage, SUPERVISED_STATES, id="supervised"),
        pytest.param(prepared_stage, PREPARED_STATES, id="prepared"),
    ],
)
def test_no_state_of_a_german_page_has_a_decimal_point(
    make: Callable[[], AbstractContextManager[Stage]], states: list[State], browser: Browser
) -> None:
    found, commas = [], 0
    with make() as stage, ExitStack() as open_contexts:
        # A page for the states of a person, because a new one takes as long as a state.
        pages: dict[tuple[str, bool], Page] = {}
        for state in states:
            key = (state.person, state.is_unconfirmed)
            if key not in pages:
                pages[key] = open_contexts.enter_context(german(browser, stage, state.person)).new_page()
                if state.is_unconfirmed:
                    pages[key].route("**/api/procedure", answer_unconfirmed)
            texts = read(pages[key], stage, state)
            # Shows and requests nothing while another page is read.
            pages[key].goto("about:blank")
            found += [(state.name, text) for text in with_points(texts)]
            commas += sum(bool(DECIMAL_COMMA.search(text)) for text in texts)
    assert found == []
    assert commas > 10, "the test finds no numbers"


@pytest.fixture(scope="module")
def prepared_case() -> Iterator[Stage]:
    """A case in which a number can be typed."""
    with prepared_stage() as stage:
        yield stage


@pytest.mark.parametrize(
    ("locale", "typed", "shown"),
    [
        pytest.param("de-DE", "12,5", "12,5", id="a comma on a German page"),
        pytest.param("de-DE", "12.5", "12,5", id="a point on a German page"),
        pytest.param("en-GB", "12,5", "12.5", id="a comma on an English page"),
        pytest.param("en-GB", "12.5", "12.5", id="a point on an English page"),
    ],
)
def test_a_number_field_accepts_comma_and_point(
    prepared_case: Stage, browser: Browser, locale: str, typed: str, shown: str
) -> None:
    context = browser.new_context(locale=locale)
    context.set_default_timeout(PATIENCE_MS)
    page = WatchedPage(context.new_page(), prepared_case.port).open("operator/camera")
    field = page.get_by_test_id("readout-ms")
    field.evaluate("element => { const fold = element.closest('details'); if (fold) fold.open = true; }")
    field.click()
    field.press("ControlOrMeta+a")
    field.press_sequentially(typed)
    expect(field).to_have_value(shown)
    with page.expect_request("**/api/camera/readout") as sent:
        page.get_by_test_id("keep-readout").click()
    assert json.loads(sent.value.post_data or "{}")["readout_ms"] == 12.5
    context.close()
