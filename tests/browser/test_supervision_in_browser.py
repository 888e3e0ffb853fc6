"""A supervisor in one browser and the theatre screen in another: marks, co-signature, hold."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.browser.small_targets import GLOVE_PX, small_targets
from tests.browser.supervised import Supervised, opened
from tests.browser.theatre import PATIENCE_MS, WatchedPage, save_screenshot

pytestmark = pytest.mark.browser
expect.set_options(timeout=PATIENCE_MS)

# Whether anything is painted within a radius around a pixel of the image.
PAINTED = """(canvas, [x, y, radius]) => {
    const ratio = canvas.width / canvas.clientWidth;
    const scale = Math.min(canvas.clientWidth / 1280, canvas.clientHeight / 720);
    const left = (canvas.clientWidth - 1280 * scale) / 2, top = (canvas.clientHeight - 720 * scale) / 2;
    const at = [(left + (x + 0.5) * scale) * ratio, (top + (y + 0.5) * scale) * ratio].map(Math.round);
    const [reach] = [Math.ceil(radius * scale * ratio)];
    const context = canvas.getContext("2d");
    const { data } = context.getImageData(at[0] - reach, at[1] - reach, 2 * reach + 1, 2 * reach + 1);
    for (let i = 3; i < data.length; i += 4) if (data[i] > 200) return true;
    return false;
}"""


@pytest.fixture(scope="module")
def supervised() -> Iterator[Supervised]:
    """One server: read-only pages come before the plan is signed."""
    server = Supervised()
    yield server
    server.process.communicate(timeout=30)


def on_picture(page: Page, x_px: float, y_px: float) -> tuple[float, float]:
    """Page position of an image pixel: the picture is shown completely, centred."""
    box = page.get_by_test_id("marks").bounding_box()
    assert box is not None
    scale = min(box["width"] / 1280, box["height"] / 720)
    left = box["x"] + (box["width"] - 1280 * scale) / 2
    top = box["y"] + (box["height"] - 720 * scale) / 2
    return left + (x_px + 0.5) * scale, top + (y_px + 0.5) * scale


def is_painted(marks: Locator, x_px: float, y_px: float, *, within_px: float = 4) -> bool:
    return bool(marks.evaluate(PAINTED, [x_px, y_px, within_px]))


def until_painted(marks: Locator, x_px: float, y_px: float) -> None:
    handle = marks.element_handle()
    assert handle is not None
    marks.page.wait_for_function(f"([canvas, at]) => ({PAINTED})(canvas, at)", arg=[handle, [x_px, y_px, 4]])


def marks_reach(theatre: Page, sato: Page) -> None:
    marks, own = theatre.get_by_test_id("marks"), sato.get_by_test_id("marks")

    # A pointer appears at the same place of a picture of another size, and expires.
    # It expires when it rests, on a busy machine possibly before it is checked.
    for turn in range(1000):
        sato.mouse.move(*on_picture(sato, 900 + turn % 2, 500))
        # In the same turn: both the supervisor and theatre see it.
        if is_painted(own, 900, 500) and is_painted(marks, 900, 500):
            break
    else:
        pytest.fail("the pointer did not appear to who points and in theatre")
    assert not is_painted(marks, 300, 600)
    expect(marks).to_have_attribute("data-pointers", "0")

    # A circle and a line, on both pages.
    sato.get_by_test_id("tool-circle").click()
    sato.mouse.move(*on_picture(sato, 640, 360))
    sato.mouse.down()
    sato.mouse.move(*on_picture(sato, 740, 360), steps=4)
    sato.mouse.up()
    until_painted(marks, 740, 360)
    until_painted(marks, 640, 460)
    sato.get_by_test_id("tool-pen").click()
    sato.mouse.move(*on_picture(sato, 200, 600))
    sato.mouse.down()
    sato.mouse.move(*on_picture(sato, 500, 600), steps=12)
    sato.mouse.up()
    until_painted(marks, 350, 600)
    expect(own).to_have_attribute("data-marks", "2")
    save_screenshot(theatre, "marks-in-theatre")
    save_screenshot(sato, "supervisor")
    sato.get_by_test_id("marks-undo").click()
    expect(marks).to_have_attribute("data-marks", "1")
    sato.get_by_test_id("marks-clear").click()
    expect(marks).to_have_attribute("data-marks", "0")


def marks_on_a_cut_reach(theatre: Page, sato: Page) -> None:
    # A circle on a cut is in the theatre's cut of the same plane, not on the video; a cut across it shows the
    # parts that it crosses.
    cut, seen = sato.get_by_test_id("marks-axial"), theatre.get_by_test_id("marks-axial")
    expect(sato.get_by_test_id("cut-axial")).to_have_attribute("data-shows", "live")
    expect(theatre.get_by_test_id("cut-axial")).to_have_attribute("data-shows", "live")
    sato.get_by_test_id("tool-circle").click()
    box = cut.bounding_box()
    assert box is not None
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    sato.mouse.move(*middle)
    sato.mouse.down()
    sato.mouse.move(middle[0] + box["width"] / 5, middle[1], steps=4)
    sato.mouse.up()
    expect(seen).to_have_attribute("data-marks", "1")
    expect(theatre.get_by_test_id("marks-sagittal")).to_have_attribute("data-marks", "1")
    expect(theatre.get_by_test_id("marks")).to_have_attribute("data-marks", "0")
    save_screenshot(theatre, "marks-on-a-cut-in-theatre")
    save_screenshot(sato, "marks-on-a-cut")
    sato.get_by_test_id("marks-undo").click()
    expect(seen).to_have_attribute("data-marks", "0")
    # The supervisor has the layouts of the theatre, and theirs do not follow each other.
    sato.get_by_test_id("layout-drill").click()
    expect(sato.locator(".board")).to_have_attribute("data-board-layout", "drill")
    expect(theatre.get_by_test_id("theatre")).to_have_attribute("data-layout", "overview")
    # Each knows what the other sees.
    drill = "Supervisor, Drill · In-line axial, In-line sagittal"
    theatre.get_by_test_id("more").click()
    expect(theatre.get_by_test_id("looks")).to_contain_text(drill)
    save_screenshot(theatre, "looks-in-theatre")
    theatre.keyboard.press("Escape")
    expect(sato.get_by_test_id("watching")).to_contain_text("Overview · Video")
    assert sato.evaluate("document.querySelector('.first-screen').getBoundingClientRect().bottom") <= 800


def signature_opens_navigation(supervised: Supervised, theatre: Page, sato: Page) -> None:
    # The required signature is missing; after review and two touches it exists, and navigation is allowed.
    asks = theatre.request.get
    address = f"http://127.0.0.1:{supervised.port}/api/procedure"
    reported: Any = asks(address).json()
    assert not reported["may_navigate"]
    plan = sato.get_by_test_id("fold-plan")
    expect(plan.locator("summary")).to_contain_text("to be co-signed")
    plan.locator("summary").click()
    expect(plan).to_contain_text("required before navigation")
    expect(plan).to_contain_text("plan 'main' version 1")
    sato.get_by_test_id("cosign-plan").click()
    assert not asks(address).json()["may_navigate"], "a slip has signed"
    sato.get_by_test_id("cosign-plan").click()
    expect(sato.get_by_test_id("sign-plan")).to_have_attribute("data-signed", "true")
    assert asks(address).json()["may_navigate"]
    expect(sato.locator("[data-step=navigate]")).to_have_attribute("data-state", "done")


def hold_is_heard(theatre: Page, sato: Page) -> None:
    # A hold, in two touches, raises an alarm in theatre with the name of its requester.
    sato.get_by_test_id("hold-ask").click()
    sato.get_by_test_id("hold-ask").click()
    expect(theatre.get_by_test_id("alarms")).to_contain_text("Dr Sato")
    expect(sato.get_by_test_id("hold")).to_have_attribute("data-requested", "true")
    save_screenshot(theatre, "hold-in-theatre")
    sato.get_by_test_id("hold-release").click()
    expect(sato.get_by_test_id("hold")).to_have_attribute("data-requested", "false")


def test_nothing_of_the_supervisors_page_lies_outside_its_screen(
    supervised: Supervised, watch: Callable[..., WatchedPage]
) -> None:
    page = opened(watch, supervised, "s1", "supervisor?lang=de", (1920, 1080))
    # What is signed lies over the rest of the page.
    for fold in ("log", "plan", "registration"):
        page.get_by_test_id(f"fold-{fold}").locator("summary").click()
    expect(page.get_by_test_id("sign-registration")).to_be_visible()
    for width, height in ((1920, 1080), (390, 844)):
        page.set_viewport_size({"width": width, "height": height})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert small_targets(page, min_px=GLOVE_PX, within=".supervisor") == []
        save_screenshot(page, f"supervisor-{width}", is_full_page=True)


def test_the_header_of_a_signed_in_operator_fits_with_the_tour_of_a_rehearsal(
    supervised: Supervised, watch: Callable[..., WatchedPage]
) -> None:
    page = opened(watch, supervised, "o1", "supervisor?lang=de", (1366, 820))
    # This server has a camera, and its pages no tour.
    page.get_by_test_id("help").evaluate(
        "help => help.insertAdjacentHTML('afterend', '<button class=help-button>Rundgang</button>')"
    )
    for width in (1366, 1280, 1180, 1024, 820):
        page.set_viewport_size({"width": width, "height": 820})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.set_viewport_size({"width": 1180, "height": 820})
    assert page.locator(".marks-tools").evaluate("tools => tools.scrollHeight <= tools.clientHeight")
    # On a phone the lower bar covers no figure.
    page.set_viewport_size({"width": 390, "height": 844})
    ends = page.locator(".readings").evaluate("figures => figures.getBoundingClientRect().bottom")
    assert ends <= page.locator(".decisions").evaluate("bar => bar.getBoundingClientRect().top")


@pytest.mark.parametrize(("width", "height"), [(1366, 768), (390, 844)])
def test_hold_marks_and_signatures_are_on_the_first_screen(
    supervised: Supervised, watch: Callable[..., WatchedPage], width: int, height: int
) -> None:
    page = opened(watch, supervised, "s1", "supervisor", (width, height))
    tools = ("tool-point", "tool-pen", "tool-arrow", "tool-circle", "marks-undo", "marks-clear")
    for name in ("video", "hold-ask", *tools):
        expect(page.get_by_test_id(name)).to_be_in_viewport(ratio=1)
    for what in ("plan", "registration"):
        page.get_by_test_id(f"fold-{what}").locator("summary").click()
        expect(page.get_by_test_id(f"cosign-{what}")).to_be_in_viewport(ratio=1)
        expect(page.get_by_test_id("hold-ask")).to_be_in_viewport(ratio=1)
        save_screenshot(page, f"supervisor-signs-{what}-{width}")
    assert page.evaluate("scrollY") == 0


def test_what_a_supervisor_marks_signs_and_asks_reaches_the_theatre(
    supervised: Supervised, watch: Callable[..., WatchedPage]
) -> None:
    theatre = opened(watch, supervised, "v1", "theatre", (1600, 900))
    sato = opened(watch, supervised, "s1", "supervisor", (1280, 800))
    expect(sato.get_by_test_id("watching")).to_contain_text("Guest")
    marks_reach(theatre, sato)
    marks_on_a_cut_reach(theatre, sato)
    signature_opens_navigation(supervised, theatre, sato)
    hold_is_heard(theatre, sato)
