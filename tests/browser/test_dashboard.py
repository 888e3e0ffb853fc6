"""The dashboard in a real browser, with a real server and a controllable feeder."""

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.canvas import PIXELS
from tests.browser.theatre import PATIENCE_MS, Theatre, WatchedPage, save_screenshot, show_scene

pytestmark = pytest.mark.browser

Watch = Callable[..., WatchedPage]
PANES = ("video", "numbers", "scene")
# Beside the scene, which replaces the other cuts.
CUT = "cut-probe"

expect.set_options(timeout=PATIENCE_MS)

# A digest of the canvas, and whether it is blank.
DIGEST = f"""canvas => {{
    const pixels = {PIXELS}(canvas);
    let digest = 0;
    for (let i = 0; i < pixels.length; i += 4) {{
        digest = (digest * 31 + pixels[i] + pixels[i + 1] + pixels[i + 2]) | 0;
    }}
    return digest;
}}"""
BLACK = f"""canvas => {PIXELS}(canvas)
    .every((value, index) => index % 4 === 3 || value === 0)"""

# Whether an opaque cover fills the pane and receives a touch in its middle.
COVERED = """pane => {
    const cover = pane.querySelector(".cover");
    const [around, within] = [pane.getBoundingClientRect(), cover.getBoundingClientRect()];
    const middle = document.elementFromPoint(around.x + around.width / 2, around.y + around.height / 2);
    const fills = within.width >= around.width - 4 && within.height >= around.height - 4;
    const { backgroundColor, opacity } = getComputedStyle(cover);
    return fills && cover.contains(middle) && /^rgb\\(/.test(backgroundColor) && opacity === "1";
}"""

HAS_DRILL = """stage => [...stage.querySelectorAll("[data-part=shaft], [data-part=ring], [data-part=ahead]")]
    .some(path => path.getAttribute("d") !== "")"""

# Overlapping texts in the header and beside the video's title, in pairs, and truncated facts.
ILLEGIBLE = """page => {
    const within = ".top :is(dt, dd, h1, p, li), .pane-video .pane-head > *";
    const words = [...page.querySelectorAll(within)].filter(one => one.checkVisibility() && one.textContent);
    const boxes = words.map(one => one.getBoundingClientRect());
    const apart = (a, b) =>
        Math.min(a.right, b.right) - Math.max(a.left, b.left) < 2 ||
        Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) < 2;
    const over = words.flatMap((one, i) => words
        .filter((other, k) => k > i && !one.contains(other) && !apart(boxes[i], boxes[k]))
        .map(other => [one.textContent, other.textContent]));
    const facts = words.filter(one => one.matches("dd, .moves"));
    const cut = facts
        .filter(one => one.scrollWidth > one.clientWidth || one.scrollHeight > one.clientHeight + 2);
    return [...over, ...cut.map(one => one.textContent)];
}"""


def is_live(page: Page, pane: str, *, live: bool = True) -> None:
    expect(page.get_by_test_id(pane)).to_have_attribute("data-live", "true" if live else "false")


# Tests with their own page come first, so that the shared page is not drawn meanwhile.


def test_speaks_another_language(shared_theatre: Theatre, watch: Watch) -> None:
    page = watch(shared_theatre).open("?lang=de")
    expect(page.get_by_text("Forschungssoftware, kein Medizinprodukt")).to_be_visible()
    expect(page.locator("html")).to_have_attribute("lang", "de")


def test_the_picture_has_lines_and_no_numbers(shared_theatre: Theatre, watch: Watch) -> None:
    """Numbers do not depend on pictures: the page displays its own."""
    shared_theatre.tell("live")
    watched, sockets = watch(shared_theatre), list[str]()
    watched.page.on("websocket", lambda socket: sockets.append(socket.url))
    page = watched.open()
    is_live(page, "numbers")
    is_live(page, "video")
    paths = {url.partition(str(shared_theatre.port))[2] for url in sockets}
    assert {"/ws/live", "/ws/view?size=auto&overlay=geometry"} <= paths


def test_picture_is_empty_when_a_hidden_page_comes_back(shared_theatre: Theatre, watch: Watch) -> None:
    shared_theatre.tell("live")
    page = watch(shared_theatre).open()
    is_live(page, "video")
    shared_theatre.tell("stop")
    page.evaluate(
        """() => {
            Object.defineProperty(document, "visibilityState", { value: "hidden", configurable: true });
            document.dispatchEvent(new Event("visibilitychange"));
        }"""
    )
    # Synchronously: nothing old may remain for the next refresh.
    assert page.get_by_test_id("video").get_attribute("data-live") == "false"
    assert page.get_by_test_id("numbers").get_attribute("data-live") == "false"
    assert page.locator("canvas.sharp").evaluate(BLACK)


@pytest.fixture(scope="module")
def dashboard(shared_theatre: Theatre, watch_for_all: Watch) -> Page:
    """The page shared by tests that do not change it."""
    page = watch_for_all(shared_theatre).open()
    show_scene(page)
    return page


@pytest.fixture
def page(dashboard: Page, shared_theatre: Theatre) -> Page:
    """The shared page in its initial state: live, whatever the previous test did."""
    shared_theatre.tell("live")
    dashboard.set_viewport_size({"width": 1280, "height": 800})
    for pane in PANES:
        is_live(dashboard, pane)
    return dashboard


@pytest.mark.parametrize(
    ("width", "height"),
    [(1920, 1080), (1280, 720), (1180, 820), (1024, 768), (820, 1180), (390, 844)],
    ids=["theatre", "laptop", "large-tablet", "tablet-lying", "tablet-upright", "phone"],
)
def test_fits_the_screen_with_the_video_or_on_a_phone_the_figures_first(
    page: Page, width: int, height: int
) -> None:
    page.set_viewport_size({"width": width, "height": height})
    for pane in PANES:
        is_live(page, pane)
    save_screenshot(page, f"dashboard-{width}x{height}")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.locator("body").evaluate(ILLEGIBLE) == []
    boxes = [page.get_by_test_id(name).bounding_box() for name in ("video", "reading-entry", "scene")]
    video, numbers, scene = (box for box in boxes if box is not None)
    assert (video["y"] <= numbers["y"]) == (width > 640)
    assert video["y"] < scene["y"] or video["x"] + video["width"] <= scene["x"]
    # A phone shows one view under the figures, chosen by a touch, at the height that its width allows.
    if width > 640:
        assert video["width"] * video["height"] > scene["width"] * scene["height"]
    if width == 1920:
        assert page.evaluate("document.documentElement.scrollHeight") <= height
        size = page.get_by_test_id("reading-depth").evaluate("e => parseFloat(getComputedStyle(e).fontSize)")
        assert size >= 64.0


def test_picture_moves_and_numbers_change(page: Page) -> None:
    canvas = page.locator("canvas.sharp")
    depth = page.get_by_test_id("reading-depth")
    first_picture, first_depth = canvas.evaluate(DIGEST), depth.inner_text()
    expect(depth).not_to_have_text(first_depth)
    page.wait_for_function(
        f"first => ({DIGEST})(document.querySelector('canvas.sharp')) !== first", arg=first_picture
    )
    for name in ("entry", "angle", "depth", "toGo"):
        expect(page.get_by_test_id(f"reading-{name}")).to_have_text(re.compile(r"^−?\d+\.\d$"))
    expect(page.get_by_test_id("search-time")).to_contain_text("6.3 ms")
    expect(page.get_by_test_id("marker-drill")).to_contain_text("93 %")
    expect(page.get_by_text("Research software, not a medical device")).to_be_visible()


def test_scene_is_uncovered_when_it_has_drawn(page: Page) -> None:
    expect(page.get_by_test_id("scene-cover")).to_be_hidden()
    expect(page.get_by_test_id("scene-stamp")).to_contain_text("image")


def test_silence_is_said_by_the_page_itself_and_passes(page: Page, shared_theatre: Theatre) -> None:
    shared_theatre.tell("stop")
    is_live(page, "numbers", live=False)
    is_live(page, "video", live=False)
    # The complete line: its live content must be gone.
    expect(page.get_by_test_id("no-tracking")).to_have_text(re.compile(r"^\W*NO TRACKING"))
    expect(page.get_by_test_id("untracked-for")).to_have_text(re.compile(r"\d s$"))
    expect(page.get_by_test_id("reading-depth")).to_have_text("—")
    expect(page.get_by_test_id("video-cover")).to_contain_text("NO VIDEO")
    is_live(page, "scene", live=False)
    # The server still answers, so it is not reported as lost.
    expect(page.get_by_test_id("link-state")).to_contain_text("connected")
    assert page.locator("canvas.sharp").evaluate(BLACK), "an old picture is still on the canvas"
    shared_theatre.tell("live")
    is_live(page, "video")
    is_live(page, "numbers")


def test_camera_without_calibration_claims_no_millimetres(page: Page, shared_theatre: Theatre) -> None:
    shared_theatre.tell("bare")
    is_live(page, "numbers", live=False)
    is_live(page, "video")
    expect(page.get_by_test_id("numbers")).to_contain_text("CAMERA NOT CALIBRATED")
    expect(page.get_by_test_id("reading-entry")).to_have_text("—")


def test_failure_looks_like_failure(page: Page, shared_theatre: Theatre) -> None:
    page.set_viewport_size({"width": 1920, "height": 1080})
    is_live(page, "scene")
    # This theatre has no CT: drill and plan are drawn alone, with a note.
    is_live(page, CUT)
    expect(page.locator(f".pane-{CUT}").get_by_test_id("cut-note")).to_contain_text("NO CT")
    assert page.get_by_test_id(CUT).evaluate(HAS_DRILL)
    shared_theatre.tell("unseen")
    marker_is_out_of_view(page)
    is_live(page, CUT, live=False)
    assert not page.get_by_test_id(CUT).evaluate(HAS_DRILL), "a drill is drawn that is not seen"
    shared_theatre.tell("lost")
    is_live(page, "video", live=False)
    is_live(page, "scene", live=False)
    for pane, words in (("video", "NO VIDEO"), ("video", "CAMERA LOST"), ("scene", "SCENE STALE")):
        cover = page.get_by_test_id(f"{pane}-cover")
        expect(cover).to_contain_text(words)
        expect(cover).to_be_visible()
        assert page.get_by_test_id(pane).evaluate(COVERED), f"something shines through the words over {pane}"
    assert page.get_by_test_id(CUT).evaluate(COVERED), "something shines through the words over the cut"
    assert page.locator("canvas.sharp").evaluate(BLACK), "an old picture is still on the canvas"
    expect(page.get_by_test_id("no-tracking")).to_be_visible()
    figures_are_gone(page)
    expect(page.get_by_test_id("verdict")).to_have_count(0)
    # It is an alarm, and one touch away with its remedy.
    page.get_by_test_id("alarms-more").click()
    expect(page.get_by_test_id("alert")).to_contain_text("The camera has given no image for 2.0 s")
    expect(page.get_by_test_id("alert")).to_contain_text("Check the camera's cable")
    expect(page.get_by_test_id("alarms")).to_have_attribute("data-priority", "medium")
    expect(page.get_by_test_id("alarm-top")).to_have_attribute("data-condition", "CAMERA_GONE")
    save_screenshot(page, "camera-lost-1920x1080")
    shared_theatre.tell("unseen")
    marker_is_out_of_view(page)
    assert not page.locator("canvas.sharp").evaluate(BLACK), "the picture did not come back"
    save_screenshot(page, "marker-unseen-1920x1080")
    shared_theatre.tell("live")
    is_live(page, "numbers")
    expect(page.get_by_test_id("alert")).to_have_count(0)


def marker_is_out_of_view(page: Page) -> None:
    """The picture is valid and not covered; there are no numbers, with the reason."""
    is_live(page, "numbers", live=False)
    expect(page.get_by_test_id("numbers")).to_contain_text("too few of its edges")
    for pane in ("video", "scene"):
        is_live(page, pane)
        expect(page.get_by_test_id(f"{pane}-cover")).to_be_hidden()
    figures_are_gone(page)


def figures_are_gone(page: Page) -> None:
    for name in ("entry", "angle", "depth", "toGo"):
        expect(page.get_by_test_id(f"reading-{name}")).to_have_text("—")
