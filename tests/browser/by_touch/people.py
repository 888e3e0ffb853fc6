"""Users on the page: the operator signs in with the printed link, others by invitation."""

import re

from playwright.sync_api import Browser, Page, ViewportSize

from tests.browser.by_touch.tablet import Tablet
from tests.browser.theatre import WatchedPage
from tests.procedure.real_server import RealServer


def printed_link(server: RealServer) -> str:
    """The operator's link, which the server prints after its address."""
    for line in server.process.stdout or ():
        found = re.search(r"http\S+/enter#\S+", line)
        if found is not None:
            return found[0]
    raise AssertionError("the server printed no link")


def invite(tablet: Tablet, name: str, role: str) -> str:
    """Create an invitation link on the tablet."""
    page = tablet.page
    tablet.tap("step-people")
    page.get_by_label("Name", exact=True).fill(name)
    page.get_by_role("group", name="Role").get_by_text(role, exact=True).tap()
    tablet.tap("invite")
    link = page.get_by_test_id("invitation-link").inner_text()
    page.get_by_role("button", name="Done").tap()
    return link


def let_in(browser: Browser, port: int, link: str, size: ViewportSize, *, patience_ms: float) -> WatchedPage:
    """Open a browser that signs in with this link."""
    context = browser.new_context(viewport=size, locale="en-GB")
    context.set_default_timeout(patience_ms)
    watched = WatchedPage(context.new_page(), port)
    watched.page.goto(link)
    return watched


def left(watched: WatchedPage) -> None:
    """Close the browser and check that its page logged no error."""
    watched.page.context.close()
    assert not watched.strangers, watched.strangers
    assert not watched.complaints, watched.complaints


def reading(page: Page, name: str) -> str:
    """Read a figure as displayed on this page."""
    return page.get_by_test_id(f"reading-{name}").inner_text()
