"""A device as camera: a real browser with a simulated camera, and the source that reads its images."""

import contextlib
import threading
import time
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, expect

from server.app import AppParts, create_app
from server.capture.phone import PhoneSource
from server.capture.shot import Shot
from server.config import CameraConfig, Config
from server.errors import CaptureError
from server.live import ImageClock, LiveHub
from server.loop.phone_inbox import PhoneInbox
from server.stream.phone.receiver import Receiver
from tests.browser.axe import violations_in_both_themes
from tests.browser.theatre import PATIENCE_MS, save_screenshot
from tests.served import served

# Not the default size of the browser's camera.
SETTINGS = CameraConfig(source="phone", width=1280, height=720)
# Each takes about half a second if nothing arrives.
ATTEMPTS = 60
UPRIGHT, LYING = (390, 844), (1180, 820)


@pytest.fixture
def inbox() -> Iterator[PhoneInbox]:
    inbox = PhoneInbox()
    yield inbox
    inbox.close()


@pytest.fixture
def port(inbox: PhoneInbox) -> Iterator[int]:
    receiver = Receiver(inbox, SETTINGS)
    parts = AppParts(hub=LiveHub(), config=Config(camera=SETTINGS), phone=receiver)
    with served(create_app(parts)) as port:
        yield port


def opened(browser: Browser, port: int, size: tuple[int, int], path: str = "/camera") -> Page:
    context = browser.new_context(viewport={"width": size[0], "height": size[1]}, locale="en-GB")
    context.set_default_timeout(PATIENCE_MS)
    page = context.new_page()
    page.goto(f"http://127.0.0.1:{port}{path}")
    return page


def touch_start(page: Page) -> None:
    button = page.get_by_test_id("phone-button")
    box = button.bounding_box()
    assert box is not None
    assert box["height"] >= 64
    button.click()


def opened_source(inbox: PhoneInbox) -> PhoneSource:
    """The source, after a device has connected."""
    source = PhoneSource(inbox, stop=threading.Event())
    for _ in range(ATTEMPTS):
        with contextlib.suppress(CaptureError):
            source.open()
            return source
    pytest.fail("nobody sends")


def first_read(source: PhoneSource) -> Shot:
    """The first image: a connected page is silent until its camera is open."""
    for _ in range(ATTEMPTS):
        with contextlib.suppress(CaptureError):
            shot = source.read()
            assert shot is not None
            return shot
    pytest.fail("no image comes")


def failure_of(source: PhoneSource) -> str:
    """Reason why the source has no more images, after pending ones."""
    for _ in range(ATTEMPTS):
        try:
            source.read()
        except CaptureError as reported:
            return reported.code
    pytest.fail("images still come")


def test_images_of_a_browsers_camera_arrive_in_their_size_and_in_order(
    browser: Browser, inbox: PhoneInbox, port: int
) -> None:
    page = opened(browser, port, UPRIGHT)
    touch_start(page)
    source = opened_source(inbox)
    images = [first_read(source).image]
    times = []
    for _ in range(10):
        shot = source.read()
        assert shot is not None
        images.append(shot.image)
        times.append(shot.captured_at_s)
        assert shot.captured_at_s <= time.monotonic()
    assert {image.shape for image in images} == {(720, 1280, 3)}
    assert times == sorted(set(times))
    assert len({image.tobytes() for image in images}) == len(images), "the same image came twice"
    assert source.camera.clock is ImageClock.BROWSER
    assert source.camera.granted is not None
    assert source.camera.granted.size_wh_px == (1280, 720)
    expect(page.get_by_test_id("phone")).to_have_attribute("data-state", "sending")
    expect(page.get_by_test_id("phone")).to_contain_text("1280 × 720 px")
    expect(page.get_by_test_id("phone-server")).to_be_visible()
    assert violations_in_both_themes(page) == []
    save_screenshot(page, "phone_upright")

    # A second device is rejected with a reason, and the first continues.
    second = opened(browser, port, LYING)
    assert violations_in_both_themes(second) == []
    save_screenshot(second, "phone_lying_idle")
    touch_start(second)
    expect(second.get_by_test_id("phone-problem")).to_contain_text("PHONE_TAKEN")
    save_screenshot(second, "phone_lying_rejected")
    assert source.read() is not None

    # After a reload the first device gets its place back.
    page.reload()
    touch_start(page)
    expect(page.get_by_test_id("phone")).to_have_attribute("data-state", "sending")

    page.get_by_test_id("phone-button").click()
    assert failure_of(source) == "PHONE_GONE"
    touch_start(second)
    expect(second.get_by_test_id("phone")).to_have_attribute("data-state", "sending")
    save_screenshot(second, "phone_lying")
    for one in (page, second):
        one.context.close()


def test_no_other_page_may_ask_for_a_camera(browser: Browser, port: int) -> None:
    page = opened(browser, port, UPRIGHT, "/theatre")
    requested = "navigator.mediaDevices.getUserMedia({ video: true }).then(() => 'given', (no) => no.name)"
    assert page.evaluate(requested) == "NotAllowedError"
    page.goto(f"http://127.0.0.1:{port}/camera")
    assert page.evaluate(requested) == "given"
    page.context.close()
