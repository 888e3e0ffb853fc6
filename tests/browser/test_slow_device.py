"""A device that is too slow: what is reduced first, and what the page reports as slow.

The slowness is forced by a fixed additional time per image, so that the order does not depend on the machine.

"""

import json
import re
import urllib.request
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.test_dashboard import is_live
from tests.browser.theatre import Theatre, WatchedPage, show_scene

pytestmark = pytest.mark.browser

Watch = Callable[..., WatchedPage]

# In the page and in the scene's frame: records reductions in their order.
RECORDER = """
const given = (top.given ??= []);
const note = (what, value) => {
  if (given.findLast(([one]) => one === what)?.[1] !== value) given.push([what, value]);
};
const widths = (top.widths ??= new Set());
if (window !== top) {
  addEventListener("message", ({ data }) => {
    if (data?.kind === "coaxial-rate") note("interval_ms", data.min_interval_ms);
  });
} else {
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (text) {
    const { largest } = JSON.parse(text);
    if (largest !== undefined) note("largest", largest);
    return send.call(this, text);
  };
  const look = () => {
    const frame = document.querySelector(".scene-stage iframe");
    if (frame) note("scale", parseFloat(frame.style.width) / 100);
    const picture = document.querySelector("canvas.sharp");
    if (picture) widths.add(picture.width);
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}
"""
SLOW_DECODING = """
const decode = window.createImageBitmap.bind(window);
window.createImageBitmap = async (...options) => {
  if (window.slow) await new Promise((done) => setTimeout(done, 150));
  return decode(...options);
};
"""
SLOW_DRAWING = """
const draw = ImageBitmapRenderingContext.prototype.transferFromImageBitmap;
ImageBitmapRenderingContext.prototype.transferFromImageBitmap = function (...options) {
  if (this.canvas.className === "sharp") {
    for (const until = performance.now() + 150; performance.now() < until; );
  }
  return draw.apply(this, options);
};
"""
ORDER = ["interval_ms", "scale", "largest"]


@pytest.fixture
def theatre(theatre: Theatre) -> Theatre:
    """A server with more images per second, because the page judges no fewer than 30 images of 3 s."""
    theatre.tell("fast")
    return theatre


def slowed(watched: WatchedPage) -> Page:
    """The page after all reductions. Its decoding is slow only once its scene is drawn."""
    watched.page.add_init_script(f"(() => {{ {RECORDER} {SLOW_DECODING} }})()")
    page = watched.open("theatre")
    show_scene(page)
    page.wait_for_function("() => given.some(([what]) => what === 'scale')")
    page.evaluate("slow = true")
    page.wait_for_function("() => given.some(([what]) => what === 'largest')")
    return page


def gave_way_in_order(page: Page) -> None:
    """First the rate, then the scene, last the picture's size; and the page reports what is slow."""
    expect(page.get_by_test_id("line-note")).to_have_text(re.compile("Slow decoding: .* 640x360"))
    # Full size is no step.
    given = [one for one in page.evaluate("given") if one != ["scale", 1]]
    assert [ORDER.index(what) for what, _ in given] == sorted(ORDER.index(what) for what, _ in given)
    assert [scale for what, scale in given if what == "scale"] == [0.7, 0.5]
    intervals_ms = [interval_ms for what, interval_ms in given if what == "interval_ms"]
    assert intervals_ms == sorted(intervals_ms)
    assert intervals_ms[-1] == 200
    # The note names the requested size; the first picture of that size arrives later.
    page.wait_for_function("() => widths.has(640)")
    # The connection is fast enough: the server has not reduced anything by itself.
    assert set(page.evaluate("[...widths]")) == {1280, 640}


def test_a_device_that_decodes_slowly_keeps_its_picture_longest_and_its_scene_live(
    theatre: Theatre, watch: Watch
) -> None:
    page = slowed(watch(theatre, 1280, 900))
    gave_way_in_order(page)
    # At its lowest rate and resolution.
    is_live(page, "scene")
    frame = page.locator(".scene-stage iframe")
    assert frame.evaluate("e => [e.clientWidth / e.parentElement.clientWidth]")[0] == pytest.approx(
        0.5, abs=0.02
    )
    # It is displayed at its former size, without overflow.
    shown = frame.evaluate("e => e.getBoundingClientRect().width / e.parentElement.clientWidth")
    assert shown == pytest.approx(1.0, abs=0.02)


def test_a_device_that_draws_slowly_says_so_with_its_picture_at_half_size(
    theatre: Theatre, watch: Watch
) -> None:
    watched = watch(theatre, 1280, 900)
    watched.page.add_init_script(SLOW_DRAWING)
    page = watched.open("theatre?lang=de")
    expect(page.get_by_test_id("line-note")).to_have_text(re.compile("Langsames Zeichnen: .* 640x360"))


def test_a_scene_that_makes_the_figures_late_is_switched_off_until_somebody_asks_for_it(
    theatre: Theatre, watch: Watch
) -> None:
    watched = watch(theatre, 1280, 800)
    with urllib.request.urlopen(f"http://127.0.0.1:{theatre.port}/api/dashboard", timeout=60) as answer:
        dashboard = json.load(answer)
    # Every image exceeds such a limit, on any machine.
    dashboard["limits"]["pose_stale_after_ms"] = 1
    watched.page.route("**/api/dashboard", lambda route: route.fulfill(json=dashboard))
    page = watched.open("theatre")
    show_scene(page)
    is_live(page, "scene")
    expect(page.get_by_test_id("scene-cover")).to_contain_text("3-D OFF")
    expect(page.locator(".scene-stage iframe")).to_have_count(0)
    page.get_by_role("button", name="Show 3-D").click()
    is_live(page, "scene")
