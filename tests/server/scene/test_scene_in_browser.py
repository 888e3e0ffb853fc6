"""The scene in a real browser: its picture, its messages to the page around it, and its recovery."""

import math
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from playwright.sync_api import Browser, Page

from server.scene import scene as scene_module
from server.scene.views import first_view
from tests.server.scene.scene_theatre import Running, Theatre, running

pytestmark = pytest.mark.browser


BONE_HIDES_ITSELF = """() => {
  const found = [];
  __viserMutable.nodeRefFromName["/setup_1/vertebra"].traverse((part) => {
    if (part.material) found.push(part.material.depthWrite);
  });
  return found;
}"""


@contextmanager
def fed(server: Running, theatre: Theatre, *, first_image: int = 0, seen: bool = True) -> Iterator[None]:
    """Publish instants at 30 Hz during the block."""
    over = threading.Event()

    def feed() -> None:
        sequence = 0
        while not over.wait(1 / 30):
            tip = 25 + 15 * math.sin(sequence / 15)
            image = first_image + sequence
            server.hub.publish(theatre.instant(sequence, image_number=image, seen=seen, tip_z_mm=tip))
            sequence += 1

    # Each feeder restarts the sequence, so earlier instants are forgotten first.
    server.hub._newest = None
    feeder = threading.Thread(target=feed)
    feeder.start()
    try:
        yield
    finally:
        over.set()
        feeder.join()


def opened(browser: Browser, address: str) -> Page:
    page = browser.new_page(viewport={"width": 640, "height": 480})
    page.goto(address)
    return page


def reported(page: Page, condition: str) -> None:
    """Wait until the page around the scene has received a message m for which `condition` holds."""
    page.wait_for_function(f"received.some((m) => {condition})", timeout=60_000)


def picture(page: Page) -> npt.NDArray[np.uint8]:
    image = cv2.imdecode(np.frombuffer(page.screenshot(), dtype=np.uint8), cv2.IMREAD_COLOR)
    assert image is not None
    return np.asarray(image, dtype=np.uint8)


def uncovered(page: Page) -> None:
    """Wait until the scene considers itself live: it checks ten times a second, and is dimmed until then."""
    page.frames[1].wait_for_selector("html[data-coaxial=live]", timeout=60_000)


def orange_px(image: npt.NDArray[np.uint8]) -> int:
    blue, green, red = (image[..., channel].astype(int) for channel in range(3))
    return int(((red > 150) & (green > 70) & (green < red - 40) & (blue < green - 40)).sum())


def test_a_click_on_the_bone_is_reported_as_its_point_in_the_vertebra(
    browser: Browser, theatre: Theatre
) -> None:
    view = first_view(theatre.setup, theatre.surface)
    with running(theatre) as server:
        page = opened(browser, server.address)
        with fed(server, theatre):
            reported(page, "m.image_number >= 5")
            uncovered(page)
            # Nothing is marked where the page marks nothing.
            page.mouse.click(320, 240)
            page.evaluate("scene.dataset.marking = 'true'")
            # A drag turns the view and marks nothing, as a click beside the bone.
            page.mouse.click(5, 5)
            page.mouse.move(320, 240)
            page.mouse.down()
            page.mouse.move(330, 240, steps=3)
            page.mouse.move(320, 240, steps=3)
            page.mouse.move(335, 240, steps=3)
            page.mouse.up()
            page.evaluate("scene.contentWindow.postMessage({kind: 'coaxial-view', view: 'behind'})")
            reported(page, f"m.image_number >= {page.evaluate('received.at(-1).image_number')} + 10")
            # The view looks at the middle of the page.
            page.mouse.click(320, 240)
            reported(page, "m.kind === 'coaxial-bone-point'")
            points = page.evaluate("received.filter((m) => m.kind === 'coaxial-bone-point')")
        page.close()
    assert len(points) == 1
    point_mm = np.array(points[0]["point_in_vertebra_mm"])
    vertices_mm = theatre.surface.vertices_mm
    middle_mm, half_mm = vertices_mm.mean(axis=0), np.ptp(vertices_mm, axis=0) / 2
    assert np.max(np.abs(point_mm - middle_mm) / half_mm) == pytest.approx(1.0, abs=1e-3)
    way = view.look_at_mm - view.position_mm
    aside_mm = np.linalg.norm(np.cross(point_mm - view.position_mm, way)) / np.linalg.norm(way)
    assert aside_mm < 0.5


def test_the_drill_is_drawn_reported_and_hidden(browser: Browser, theatre: Theatre) -> None:
    with running(theatre) as server:
        page = opened(browser, server.address)
        with fed(server, theatre, first_image=99_990):
            reported(page, "m.image_number >= 100010")
            uncovered(page)
            shown = picture(page)
            hides_itself = page.frames[1].evaluate(BONE_HIDES_ITSELF)
        with fed(server, theatre, first_image=200_000, seen=False):
            reported(page, "m.image_number >= 200010")
            uncovered(page)
            hidden = picture(page)
        messages = page.evaluate("received")
        page.close()
    assert orange_px(shown) > 500
    assert orange_px(hidden) == 0
    assert hides_itself == [False]
    assert hidden.std() > 5  # bone and channel are still shown
    numbers = [m["image_number"] for m in messages if m["image_number"] is not None]
    assert numbers == sorted(numbers)
    assert numbers[0] >= 99_990
    assert set(messages[0]) == {"kind", "image_number", "connected", "drawn_by_processor"}
    assert {m["kind"] for m in messages} == {"coaxial-scene"}


def test_silence_takes_the_number_away(browser: Browser, theatre: Theatre) -> None:
    with running(theatre) as server:
        page = opened(browser, server.address)
        with fed(server, theatre):
            reported(page, "m.image_number >= 5")
        page.wait_for_function(
            "received.at(-1).image_number === null && received.at(-1).connected", timeout=60_000
        )
        assert orange_px(picture(page)) == 0
        page.close()


def test_an_untouched_screen_comes_back_after_a_restart(browser: Browser, theatre: Theatre) -> None:
    with running(theatre) as server:
        port = server.port
        page = opened(browser, server.address)
        # The driver gives every page focus; a screen in theatre has none.
        page.context.new_cdp_session(page).send("Emulation.setFocusEmulationEnabled", {"enabled": False})
        other = browser.new_page()
        other.bring_to_front()
        with fed(server, theatre, first_image=1000):
            reported(page, "m.image_number >= 1005")
            frame = page.frames[1]
            assert frame.evaluate("Document.prototype.hasFocus.call(document)") is False
            frame.evaluate("window.untouched = true")
    reported(page, "!m.connected")
    page.evaluate("received.length = 0")
    with running(theatre, port=port) as server, fed(server, theatre, first_image=0):
        reported(page, "m.connected && m.image_number >= 5 && m.image_number < 1000")
        assert frame.evaluate("window.untouched") is True
    other.close()
    page.close()


def test_opened_alone_it_covers_itself_when_it_is_stale(browser: Browser, theatre: Theatre) -> None:
    with running(theatre) as server:
        page = opened(browser, f"{server.address}/scene/")
        cover = page.locator("#coaxial-stale")
        with fed(server, theatre):
            cover.wait_for(state="hidden", timeout=60_000)
            page.locator("html[data-coaxial=live]").wait_for(state="attached", timeout=60_000)
        cover.wait_for(state="visible", timeout=60_000)
        assert cover.text_content() == "SCENE STALE"
        page.close()


def test_nothing_outside_is_called_and_no_control_of_viser_is_there(
    browser: Browser, theatre: Theatre
) -> None:
    requested: list[str] = []
    with running(theatre) as server:
        page = browser.new_page(viewport={"width": 640, "height": 480})
        page.on("request", lambda request: requested.append(request.url))
        page.on("websocket", lambda line: requested.append(line.url))
        page.goto(f"{server.address}/scene/")
        with fed(server, theatre):
            page.locator("html[data-coaxial=live]").wait_for(state="attached", timeout=60_000)
            touched = page.evaluate(
                "Array.from({length: 63}, (_, i) => [5 + 70 * (i % 9), 5 + 70 * ~~(i / 9)])"
                ".map(([x, y]) => document.elementFromPoint(x, y).tagName)"
            )
        counts = dict(server.app.state.scene.counts)
        page.close()
        here = (f"http://127.0.0.1:{server.port}/", f"ws://127.0.0.1:{server.port}/", "data:", "blob:")
    assert [url for url in requested if not url.startswith(here)] == []
    assert f"ws://127.0.0.1:{server.port}/scene" in requested
    assert set(touched) == {"CANVAS"}
    # Unmodified, viser's client only sends its camera pose.
    assert {verdict: count for verdict, count in counts.items() if count} == {"camera": counts["camera"]}


def test_a_silent_connection_is_reopened(
    browser: Browser, theatre: Theatre, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scene_module, "MIN_SILENCE_MS", 1000.0)
    with running(theatre, stale_after_ms=100) as server:
        page = opened(browser, server.address)
        with fed(server, theatre):
            reported(page, "m.image_number >= 5")
        # A server without power: the connection stays open, and nothing arrives.
        task = server.app.state.scene._update_task
        page.evaluate("received.length = 0")
        task.get_loop().call_soon_threadsafe(task.cancel)
        page.wait_for_function(
            "received.findIndex((m) => !m.connected) >= 0 && received.at(-1).connected", timeout=60_000
        )
        page.close()
