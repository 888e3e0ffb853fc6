"""A German page writes decimal commas, and its number fields accept comma and point.

Some states with many numbers are read here; `python -m tests.browser.screenshots` reads all of them.

"""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from urllib.request import urlopen

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, Request, expect

from tests.browser.screenshots.german_numbers import DECIMAL_COMMA, page_texts, with_points
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

pytestmark = pytest.mark.browser
expect.set_options(timeout=PATIENCE_MS)

STATES = {one.name: one for one in (*THEATRE_STATES, *SUPERVISED_STATES, *PREPARED_STATES)}


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
    WatchedPage(page, stage.port).open(state.path)
    for step in state.clicks:
        click(page, step)
    page.locator(state.ready).first.wait_for()
    expect(page.locator("html")).to_have_attribute("lang", "de")
    return page_texts(page)


def points_and_commas(browser: Browser, stage: Stage, names: Sequence[str]) -> tuple[list[str], int]:
    """Open these states; return texts with a decimal point, and the number of those with a comma."""
    found, commas = [], 0
    with ExitStack() as open_contexts:
        # A page for the states of a person, because a new one takes as long as a state.
        pages: dict[str, Page] = {}
        for state in (STATES[name] for name in names):
            if state.person not in pages:
                pages[state.person] = open_contexts.enter_context(
                    german(browser, stage, state.person)
                ).new_page()
            texts = read(pages[state.person], stage, state)
            # Shows and requests nothing while another page is read.
            pages[state.person].goto("about:blank")
            found += with_points(texts)
            commas += sum(bool(DECIMAL_COMMA.search(text)) for text in texts)
    return found, commas


@pytest.mark.parametrize(
    ("make", "names"),
    [
        pytest.param(
            theatre_stage,
            ("theatre-verdict-near", "theatre-insufficient", "theatre-camera-lost", "supervisor-breach"),
            id="theatre",
        ),
        pytest.param(
            supervised_stage,
            ("supervised-fold-registration", "supervised-review", "supervised-report"),
            id="supervised",
        ),
    ],
)
def test_no_number_of_a_german_page_has_a_decimal_point(
    make: Callable[[], AbstractContextManager[Stage]], names: Sequence[str], browser: Browser
) -> None:
    with make() as stage:
        found, commas = points_and_commas(browser, stage, names)
    assert found == []
    assert commas > 5, "the test finds no numbers"


@pytest.fixture(scope="module")
def prepared_case() -> Iterator[Stage]:
    """A case in which a number can be typed."""
    with prepared_stage() as stage:
        yield stage


def test_no_number_of_a_german_step_has_a_decimal_point(prepared_case: Stage, browser: Browser) -> None:
    names = ("prepared-camera", "prepared-plan", "prepared-register-points")
    found, commas = points_and_commas(browser, prepared_case, names)
    assert found == []
    assert commas > 3, "the test finds no numbers"


def is_stored(request: Request) -> bool:
    """Whether a request stores a readout time."""
    return request.url.endswith("/api/camera/readout") and request.method != "GET"


@pytest.mark.parametrize(
    ("locale", "shown"),
    [pytest.param("de-DE", "12,5", id="a German page"), pytest.param("en-GB", "12.5", id="an English page")],
)
def test_a_number_field_accepts_comma_and_point(
    prepared_case: Stage, browser: Browser, locale: str, shown: str
) -> None:
    context = browser.new_context(locale=locale)
    context.set_default_timeout(PATIENCE_MS)
    page = WatchedPage(context.new_page(), prepared_case.port).open("operator/camera")
    field = page.get_by_test_id("readout-ms")
    field.evaluate("element => { const fold = element.closest('details'); if (fold) fold.open = true; }")
    for typed, other in (("12,5", "13"), ("12.5", "14")):
        field.fill(other)
        field.click()
        field.press("ControlOrMeta+a")
        field.press_sequentially(typed)
        expect(field).to_have_value(shown)
        # After the first one is stored, the page reads it again from the same address.
        with page.expect_request(is_stored) as sent:
            page.get_by_test_id("keep-readout").click()
        assert json.loads(sent.value.post_data or "{}")["readout_ms"] == 12.5
    context.close()
