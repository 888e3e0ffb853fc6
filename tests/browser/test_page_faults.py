"""The fault finder of the screenshots finds each kind of fault that is put into a page, and no other."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page

from tests.browser.screenshots.page_faults import page_faults

pytestmark = pytest.mark.browser

SOUND = """<!doctype html><meta charset="utf-8"><style>
    body { margin: 0 } button { position: absolute; width: 90px; height: 48px; left: 10px; top: 10px }
    p { position: absolute; top: 80px; left: 10px; width: 200px; margin: 0; overflow: hidden }
    div { position: absolute; top: 120px; width: 200px; height: 40px; overflow: auto }
    #next { left: 110px }
</style><button>One</button><button id="next">Two</button><p>Short</p>
<div>A long text that is<br>scrolled,<br>line by<br>line</div>"""


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    context = browser.new_context(viewport={"width": 400, "height": 300})
    yield context.new_page()
    context.close()


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ("", []),
        ("p { width: 20px }", ['text cut off: p "Short" by p']),
        (
            "button { width: 40px }",
            ['small: button "One" has 40 x 48 px', 'small: button "Two" has 40 x 48 px'],
        ),
        ("#next { left: 60px }", ['overlap: button "One" and button "Two"']),
        ("#next { left: 60px; visibility: hidden }", []),
        ("p { left: 500px }", ["scrolls sideways: 700 px on 400 px"]),
    ],
    ids=["none", "cut off", "small", "overlapping", "hidden", "wide"],
)
def test_a_fault_that_is_put_into_a_page_is_found(page: Page, changes: str, fault: list[str]) -> None:
    page.set_content(SOUND + f"<style>{changes}</style>")
    assert page_faults(page) == fault
