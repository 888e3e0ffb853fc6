"""Accessibility: axe-core finds no serious violation on any page, and no page logs an error."""

import json
import re
from collections.abc import Callable, Iterator
from typing import Any, Literal
from urllib.request import urlopen

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.axe import COLOURS, load_axe, violations, violations_in_both_themes
from tests.browser.small_targets import GLOVE_PX, small_targets
from tests.browser.theatre import CHECKOUT, PATIENCE_MS, Theatre, WatchedPage

pytestmark = pytest.mark.browser

WEB = CHECKOUT / "web"
STEPS = re.findall(r'\{ name: "(\w+)",', (WEB / "src" / "operator" / "pages.ts").read_text(encoding="utf-8"))
# Where the guide is not built, its address answers how to build it.
NOT_BUILT = 503
SHELL = ".operator-top, .alarms, .rail, .step-head"
THEATRE, LYING, UPRIGHT, PHONE = (1920, 1080), (1280, 800), (800, 1280), (390, 844)


def patient(port: int) -> dict[str, Any]:
    """The server's settings with long limits: a busy machine delays images, and late numbers are removed."""
    with urlopen(f"http://127.0.0.1:{port}/api/dashboard") as answer:
        said = json.load(answer)
    return {**said, "limits": {**said["limits"], "pose_stale_after_ms": 600_000}}


@pytest.fixture(scope="module")
def watched(browser: Browser, shared_theatre: Theatre) -> Iterator[WatchedPage]:
    """The page of these tests."""
    said = patient(shared_theatre.port)
    context = browser.new_context(locale="en-GB", color_scheme="dark")
    context.set_default_timeout(PATIENCE_MS)
    context.route("**/api/dashboard", lambda route: route.fulfill(json=said))
    yield WatchedPage(context.new_page(), shared_theatre.port)
    context.close()


@pytest.fixture
def opened(watched: WatchedPage, shared_theatre: Theatre) -> Iterator[Callable[..., Page]]:
    """Goes to an address if the page is not there; an error logged by the page fails the test."""

    def go(path: str, size: tuple[int, int] = LYING) -> Page:
        width, height = size
        watched.page.set_viewport_size({"width": width, "height": height})
        if not watched.page.url.endswith(path):
            watched.open(path.removeprefix("/"))
        return watched.page

    shared_theatre.tell("live")
    yield go
    assert watched.complaints == []
    assert watched.strangers == []


@pytest.mark.parametrize(
    "size", [THEATRE, LYING, UPRIGHT, PHONE], ids=["theatre", "lying", "upright", "phone"]
)
def test_the_theatre_s_view(opened: Callable[..., Page], size: tuple[int, int]) -> None:
    page = opened("/theatre", size)
    expect(page.get_by_test_id("video")).to_have_attribute("data-live", "true", timeout=PATIENCE_MS)
    assert violations(page) == []


def test_the_cuts_in_the_patient_s_planes(opened: Callable[..., Page]) -> None:
    page = opened("/theatre", THEATRE)
    page.get_by_test_id("tile-anatomical").click()
    expect(page.get_by_test_id("cut-anatomical-sagittal")).to_be_visible(timeout=PATIENCE_MS)
    assert violations(page) == []
    page.get_by_test_id("tile-anatomical").click()


def test_numbers_stand_out_more_than_words_have_to(
    opened: Callable[..., Page], shared_theatre: Theatre
) -> None:
    page = opened("/theatre", THEATRE)
    shared_theatre.tell("deep")
    expect(page.locator("[data-reading=depth]")).to_have_attribute(
        "data-status", "through", timeout=PATIENCE_MS
    )
    load_axe(page)
    enhanced = {"runOnly": {"type": "rule", "values": ["color-contrast-enhanced"]}}
    found = page.evaluate(
        "options => axe.run('.readings', options).then(found => found.violations.map(one => one.nodes))",
        enhanced,
    )
    assert found == []


def test_the_theatre_s_view_while_nothing_is_well(
    opened: Callable[..., Page], shared_theatre: Theatre
) -> None:
    page = opened("/theatre?lang=de", THEATRE)
    shared_theatre.tell("lost")
    expect(page.get_by_test_id("alarm-top")).to_be_visible(timeout=PATIENCE_MS)
    assert violations(page) == []
    page.get_by_test_id("alarms-more").click()
    expect(page.get_by_test_id("alert")).to_be_visible(timeout=PATIENCE_MS)
    assert violations(page) == []
    # The server's English sentences on a German page are marked with their language.
    expect(page.get_by_test_id("alert").locator("[lang=en]").first).to_contain_text("camera")


@pytest.mark.parametrize("step", STEPS)
def test_every_page_of_the_operator(opened: Callable[..., Page], watched: WatchedPage, step: str) -> None:
    is_there = "/operator/" in watched.page.url
    page = watched.page if is_there else opened(f"/operator/{step}")
    link = page.get_by_test_id(f"step-{step}")
    link.click()
    expect(link).to_have_attribute("aria-current", "step", timeout=PATIENCE_MS)
    expect(page.locator(".step h2").first).to_be_visible(timeout=PATIENCE_MS)
    assert violations_in_both_themes(page) == []
    assert small_targets(page, min_px=GLOVE_PX, within=SHELL) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= LYING[0]


def test_with_a_camera_the_pages_have_help_and_no_tour(opened: Callable[..., Page]) -> None:
    page = opened("/operator/case")
    expect(page.get_by_test_id("new-case")).to_be_visible(timeout=PATIENCE_MS)
    expect(page.get_by_test_id("help")).to_have_attribute("href", re.compile("^/docs/first-procedure/"))
    expect(page.get_by_test_id("tour-offer")).to_have_count(0)
    expect(page.get_by_test_id("tour-start")).to_have_count(0)


def test_a_page_that_lacks_something_leads_to_where_it_comes_from(
    browser: Browser, shared_theatre: Theatre
) -> None:
    context = browser.new_context(locale="en-GB", viewport={"width": PHONE[0], "height": PHONE[1]})
    rejection = {
        "code": "CAMERA_NOT_CALIBRATED",
        "message": "the camera is not calibrated",
        "remedy": "Calibrate the camera first.",
        "context": {},
        "language": "en",
    }
    context.route("**/api/tools", lambda route: route.fulfill(status=409, json=rejection))
    page = context.new_page()
    step = page.locator("#step")
    for name in ("plan", "register", "recordings", "report", "camera"):
        page.goto(f"http://127.0.0.1:{shared_theatre.port}/operator/{name}")
        expect(step.get_by_test_id("go-case")).to_be_visible(timeout=PATIENCE_MS)
    assert violations(page) == []
    page.get_by_test_id("rail-now").click()
    page.get_by_test_id("step-tool").click()
    expect(step.get_by_role("alert")).to_contain_text("Calibrate the camera first.", timeout=PATIENCE_MS)
    assert violations(page) == []
    step.get_by_test_id("go-camera").click()
    expect(page).to_have_url(re.compile("/operator/camera$"))
    context.close()


@pytest.mark.parametrize("path", ["/operator", "/supervisor", "/enter"])
def test_every_other_view(opened: Callable[..., Page], path: str) -> None:
    page = opened(path, UPRIGHT if path == "/operator" else LYING)
    page.wait_for_function("() => document.body.innerText.length > 20")
    assert violations_in_both_themes(page) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= page.viewport_size["width"]  # pyrefly: ignore[unsupported-operation]  # it has one


def test_the_supervisor_s_view_while_it_is_live(opened: Callable[..., Page]) -> None:
    page = opened("/supervisor", PHONE)
    for size in (PHONE, LYING):
        page.set_viewport_size({"width": size[0], "height": size[1]})
        expect(page.get_by_test_id("cut-probe")).to_have_attribute("data-shows", "bare", timeout=PATIENCE_MS)
        assert violations(page) == []


def test_the_light_theme(opened: Callable[..., Page], shared_theatre: Theatre) -> None:
    page = opened("/operator/navigate")
    page.emulate_media(color_scheme="light")
    shared_theatre.tell("near")
    for path in ("/operator/navigate", "/supervisor"):
        opened(path)
        expect(page.locator("html")).to_have_attribute("data-theme", "light")
        over = page.locator("[data-reading=wall]")
        expect(over).to_have_attribute("data-status", "over", timeout=PATIENCE_MS)
        assert violations(page) == []
    opened("/enter")
    expect(page.get_by_test_id("enter")).to_be_visible(timeout=PATIENCE_MS)
    assert violations(page) == []
    opened("/supervisor")
    page.get_by_test_id("theme").click()
    expect(page.locator("html")).to_have_attribute("data-theme", "dark")
    # Stored in the browser for all of its pages.
    for path in ("/supervisor", "/theatre", "/enter"):
        page.goto(f"http://127.0.0.1:{shared_theatre.port}{path}")
        expect(page.locator("html")).to_have_attribute("data-theme", "dark")
    page.evaluate("localStorage.clear()")
    page.emulate_media(color_scheme="dark")


@pytest.mark.parametrize(
    ("preferred", "chosen"),
    [("light", None), ("dark", None), ("dark", "light"), ("light", "dark"), ("dark", "pink")],
)
def test_every_page_has_its_theme_before_its_first_paint(
    browser: Browser, shared_theatre: Theatre, preferred: Literal["light", "dark"], chosen: str | None
) -> None:
    context = browser.new_context(color_scheme=preferred)
    if chosen:
        context.add_init_script(f"localStorage.setItem('coaxial.theme', '{chosen}')")
    # Nothing of the page's own script has run.
    context.route("**/assets/*.js", lambda route: route.abort())
    page = context.new_page()
    for path in ("", "enter", "operator/case", "theatre", "supervisor", "camera"):
        # A theatre screen is dark unless chosen otherwise.
        usual = "dark" if path == "theatre" else preferred
        theme = chosen if chosen in ("light", "dark") else usual
        page.goto(f"http://127.0.0.1:{shared_theatre.port}/{path}")
        assert page.locator("html").get_attribute("data-theme") == theme
        ground = page.evaluate("getComputedStyle(document.documentElement).backgroundColor")
        assert ground == {"dark": "rgb(11, 16, 20)", "light": "rgb(233, 238, 241)"}[theme]
    context.close()


@pytest.mark.parametrize(("theme", "options"), [("light", COLOURS), ("dark", {})])
def test_each_layout_of_the_theatre_in_both_themes(
    opened: Callable[..., Page], shared_theatre: Theatre, theme: str, options: dict[str, Any]
) -> None:
    page = opened("/theatre", THEATRE)
    page.evaluate("theme => localStorage.setItem('coaxial.theme', theme)", theme)
    shared_theatre.tell("near")
    for layout in ("approach", "align", "drill", "figures"):
        opened(f"/theatre?layout={layout}", THEATRE)
        expect(page.locator("html")).to_have_attribute("data-theme", theme)
        expect(page.locator("[data-reading=wall]")).to_have_attribute(
            "data-status", "over", timeout=PATIENCE_MS
        )
        assert violations(page, **options) == []
    page.evaluate("localStorage.clear()")


def test_the_alarms_cover_nothing_of_a_page_that_is_scrolled(
    opened: Callable[..., Page], shared_theatre: Theatre
) -> None:
    page = opened("/operator/navigate", (LYING[0], 700))
    shared_theatre.tell("near")
    expect(page.get_by_test_id("alarm-top")).to_be_visible(timeout=PATIENCE_MS)
    # Not by the wheel: its event is lost where layout and compositor do not agree yet.
    page.wait_for_function(
        """() => {
            const content = document.querySelector('.step-content');
            content.scrollTo(0, content.scrollHeight);
            return content.scrollTop > 0;
        }"""
    )
    edges = "e => e.getBoundingClientRect()"
    assert (
        page.get_by_test_id("alarms").evaluate(edges)["bottom"]
        <= page.locator(".step-content").evaluate(edges)["top"]
    )


def test_the_keyboard_goes_past_the_shell_and_is_seen(opened: Callable[..., Page]) -> None:
    page = opened("/operator/camera")
    expect(page.locator(".step h2").first).to_be_visible(timeout=PATIENCE_MS)
    page.keyboard.press("Tab")
    skip = page.locator(".skip")
    expect(skip).to_be_focused()
    expect(skip).to_be_in_viewport()
    page.keyboard.press("Enter")
    expect(page.locator("#step")).to_be_focused()
    page.keyboard.press("Shift+Tab")
    assert page.evaluate("getComputedStyle(document.activeElement).outlineStyle") == "solid"


@pytest.mark.parametrize(
    ("locale", "title", "theme"),
    [("en-GB", "What is Coaxial?", "dark"), ("de-AT", "Was ist Coaxial?", "light")],
)
def test_without_a_session_the_page_says_what_coaxial_is_and_how_to_sign_in(
    browser: Browser, shared_theatre: Theatre, locale: str, title: str, theme: Literal["dark", "light"]
) -> None:
    # This server requires no sign-in: its answer is that of one that does.
    missing = {"code": "SESSION_NEEDED", "message": "", "remedy": "", "context": {}, "language": "en"}
    context = browser.new_context(locale=locale, color_scheme=theme)
    context.route("**/api/session", lambda route: route.fulfill(status=401, json=missing))
    page = context.new_page()
    page.goto(f"http://127.0.0.1:{shared_theatre.port}/operator")
    expect(page.get_by_test_id("about")).to_contain_text(title, timeout=PATIENCE_MS)
    expect(page.locator("main")).to_contain_text("--new-operator-link")
    # The guide needs no session.
    guide = page.get_by_test_id("guide").get_attribute("href")
    assert guide is not None
    assert page.request.get(f"http://127.0.0.1:{shared_theatre.port}{guide}").status in (200, NOT_BUILT)
    for width, height in (THEATRE, (1180, 820), PHONE):
        page.set_viewport_size({"width": width, "height": height})
        assert violations(page) == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        if width > UPRIGHT[0]:
            expect(page.get_by_test_id("enter")).to_be_in_viewport()
    context.close()
