"""Recordings on the page: their state on every view, and the operator's actions."""

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import av
import pytest
from playwright.sync_api import Locator, Page, expect

from tests.browser.axe import violations_in_both_themes
from tests.browser.small_targets import FINGER_PX, small_targets
from tests.browser.supervised import Supervised, opened
from tests.browser.theatre import PATIENCE_MS, WatchedPage, save_screenshot
from tests.server.recording.reviewed import DRILLED

pytestmark = pytest.mark.browser
expect.set_options(timeout=PATIENCE_MS)

Watch = Callable[..., WatchedPage]
SCREEN, TABLET, PHONE = (1920, 1080), (1180, 820), (390, 844)


@pytest.fixture(scope="module")
def supervised() -> Iterator[Supervised]:
    """One server with an open case."""
    server = Supervised()
    yield server
    server.process.communicate(timeout=30)


def test_what_the_operator_records_is_said_on_every_view(supervised: Supervised, watch: Watch) -> None:
    operator = opened(watch, supervised, "o1", "operator/navigate", TABLET)
    theatre = opened(watch, supervised, "v1", "theatre", SCREEN)
    phone = opened(watch, supervised, "s1", "supervisor?lang=de", PHONE)
    pages = {"operator": operator, "theatre": theatre, "supervisor": phone}
    for page in pages.values():
        expect(page.get_by_test_id("recording-state")).to_have_attribute("data-state", "off")
    button = operator.get_by_test_id("record")
    box = button.bounding_box()
    assert box is not None
    assert box["height"] >= 48
    button.click()
    # Before the first recording of a case the patient's consent must be answered.
    expect(operator.get_by_role("dialog")).to_contain_text("Has the patient consented to recording?")
    save_screenshot(operator, "recording-consent")
    # The question covers no alarm: everything beside it stays visible and usable.
    expect(operator.locator(".mantine-Modal-overlay")).to_have_count(0)
    button.click(trial=True)
    operator.get_by_test_id("consent-no").click()
    expect(operator.get_by_role("dialog")).to_be_hidden()
    expect(operator.get_by_test_id("recording-state")).to_have_attribute("data-state", "off")
    button.click()
    operator.get_by_test_id("consent-yes").click()
    for name, page in pages.items():
        state = page.get_by_test_id("recording-state")
        expect(state).to_have_attribute("data-state", "on")
        expect(state).to_contain_text("REC 0:")
        expect(state).to_contain_text("1,0 kB" if page is phone else "1.0 kB")
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        save_screenshot(page, f"recording-{name}")
    assert theatre.get_by_test_id("record").count() == phone.get_by_test_id("record").count() == 0
    expect(button).to_have_text("■ Stop recording")
    button.click()
    for page in pages.values():
        expect(page.get_by_test_id("recording-state")).to_have_attribute("data-state", "off")
    # After the answer it is not asked again.
    button.click()
    expect(operator.get_by_test_id("recording-state")).to_have_attribute("data-state", "on")
    button.click()
    expect(operator.get_by_test_id("recording-state")).to_have_attribute("data-state", "off")


def shows(page: Page, number: int) -> None:
    """Wait until an image of the recording is shown with its figures."""
    expect(page.get_by_test_id("review-instant")).to_have_attribute("data-number", str(number))
    source = f"/images/{number}.jpg"
    expect(page.get_by_test_id("review-image")).to_have_attribute("src", re.compile(re.escape(source) + "$"))


def test_any_instant_of_a_recording_is_reviewed(supervised: Supervised, watch: Watch) -> None:
    page = opened(watch, supervised, "s1", "supervisor", PHONE)
    page.get_by_test_id("fold-recordings").locator("summary").click()
    row = page.locator("[data-name='20260101T000000Z-0000.mcap']")
    expect(row.get_by_test_id("recording-end")).to_have_text("complete")
    assert row.get_by_test_id("delete").count() == row.get_by_test_id("protect").count() == 0
    row.get_by_test_id("review-open").click()
    shows(page, 0)
    expect(page.get_by_test_id("review-wall")).to_have_text(re.compile(r"^\d\.\d$"))

    # An event leads to its instant: image, figures and alarms.
    page.get_by_test_id("review-events").get_by_role("button", name="Alarm · BREACH").click()
    breach = DRILLED.index("breach")
    expect(page.get_by_test_id("review-wall")).to_have_text(re.compile(r"^−\d\.\d$"))
    number = int(page.get_by_test_id("review-instant").get_attribute("data-number") or -1)
    assert breach <= number < breach + 3
    page.get_by_test_id("review-after").click()
    shows(page, number + 1)
    expect(page.get_by_test_id("review-alarms")).to_contain_text("BREACH")
    page.get_by_test_id("review-before").click()
    shows(page, number)

    expect(page.get_by_role("img", name="Risk of breach: its curve")).to_be_visible()

    # A tap on the curves, and a drag over a part of them.
    plot = page.locator(".review-plot")
    plot.evaluate("plot => plot.scrollIntoView({ block: 'center' })")
    box = plot.bounding_box()
    assert box is not None
    at_y = box["y"] + box["height"] / 2
    hidden = (DRILLED.index("hidden") + 3.5) / (len(DRILLED) - 1)
    page.mouse.click(box["x"] + hidden * box["width"], at_y)
    expect(page.get_by_test_id("review-wall")).to_have_text("—")
    expect(page.get_by_test_id("review-instant")).to_contain_text("No numbers at this instant.")
    axis = page.locator(".review-axis")
    expect(axis).to_contain_text("0:03")
    page.mouse.move(box["x"] + 0.1 * box["width"], at_y)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], at_y, steps=5)
    page.mouse.up()
    expect(axis).not_to_contain_text("0:03")
    page.get_by_test_id("review-whole").click()
    expect(axis).to_contain_text("0:03")

    page.get_by_test_id("review-play").click()
    shows(page, len(DRILLED) - 1)
    expect(page.get_by_test_id("review-play")).to_contain_text("Play")
    for width, height in (SCREEN, TABLET, PHONE):
        page.set_viewport_size({"width": width, "height": height})
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        assert small_targets(page, min_px=FINGER_PX, within=".recordings") == []
        page.get_by_test_id("review").scroll_into_view_if_needed()
        save_screenshot(page, f"recording-review-{width}")
    assert violations_in_both_themes(page) == []


def test_the_3d_scene_shows_the_displayed_instant(supervised: Supervised, watch: Watch) -> None:
    page = opened(watch, supervised, "s1", "supervisor", TABLET)
    page.get_by_test_id("fold-recordings").locator("summary").click()
    page.locator("[data-name='20260102T000000Z-0000.mcap']").get_by_test_id("review-open").click()
    shows(page, 0)
    page.get_by_test_id("review-scene-toggle").click()
    stage = page.get_by_test_id("review-scene-stage")
    expect(stage).to_have_attribute("data-live", "true")
    stage.scroll_into_view_if_needed()
    save_screenshot(page, "recording-review-scene")
    before = stage.screenshot()
    page.get_by_test_id("review-events").get_by_role("button", name="Alarm · BREACH").click()
    expect(page.get_by_test_id("review-wall")).to_have_text(re.compile(r"^−\d\.\d$"))
    expect(stage).to_have_attribute("data-live", "true")
    stage.scroll_into_view_if_needed()
    assert stage.screenshot() != before


def side(page: Page, place: int) -> Locator:
    """Return one of two recordings that are compared."""
    return page.get_by_test_id(f"review-side-{place}")


def at(page: Page, *numbers: int) -> None:
    """Wait until both recordings show these images."""
    for place, number in enumerate(numbers):
        instant = side(page, place).get_by_test_id("review-instant")
        expect(instant).to_have_attribute("data-number", str(number))


def go(page: Page, place: int, number: int) -> None:
    """Move one of two recordings to an image."""
    side(page, place).get_by_role("slider").focus()
    page.keyboard.press("Home")
    for _ in range(number):
        page.keyboard.press("ArrowRight")


def test_two_recordings_are_aligned_and_compared(supervised: Supervised, watch: Watch) -> None:
    page = opened(watch, supervised, "o1", "operator/navigate", TABLET)
    page.get_by_test_id("step-recordings").click()
    page.locator("[data-name='20260101T000000Z-0000.mcap']").get_by_test_id("review-open").click()
    page.locator("[data-name='20260102T000000Z-0000.mcap']").get_by_test_id("review-compare").click()
    at(page, 0, 0)
    difference = page.get_by_test_id("review-difference-wall")
    expect(difference).to_have_text(re.compile(r"^0\.0 ± \d\.\d\d$"))

    # Linked without an offset, the same time is another moment of the drilling.
    near = DRILLED.index("breach") - 2
    go(page, 0, near)
    at(page, near, near)
    expect(difference).not_to_have_text("—")
    expect(difference).not_to_have_text(re.compile(r"^0\.0"))

    # Aligned by the same event in both, nothing differs.
    page.get_by_test_id("review-unlink").click()
    expect(difference).to_have_text("—")
    go(page, 1, near - 3)
    at(page, near, near - 3)
    page.get_by_test_id("review-align").click()
    expect(page.get_by_test_id("review-offset")).to_contain_text("− 0.30 s")
    expect(difference).to_have_text(re.compile(r"^0\.0 ± \d\.\d\d$"))
    for size in (TABLET, SCREEN):
        page.set_viewport_size({"width": size[0], "height": size[1]})
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        page.get_by_test_id("review-pair").evaluate("pair => pair.scrollIntoView()")
        save_screenshot(page, f"recording-pair-{size[0]}")

    # The second leads, and a hidden drill has no difference.
    hidden = DRILLED.index("hidden")
    side(page, 1).get_by_test_id("review-events").get_by_role("button", name="No numbers").first.click()
    at(page, hidden, hidden - 3)
    expect(difference).to_have_text("—")
    expect(page.get_by_test_id("review-difference-reason")).to_contain_text("no numbers")

    # Before the beginning of the second there is nothing to compare with.
    go(page, 0, 0)
    at(page, 0, 0)
    expect(page.get_by_test_id("review-difference-reason")).to_contain_text("no image within 0.1 s")
    expect(difference).to_have_text("—")
    page.get_by_test_id("review-pair-close").click()
    expect(page.get_by_test_id("review-pair")).to_be_hidden()
    shows(page, 0)

    # The report of the case has a drilling from each.
    page.get_by_test_id("step-report").click()
    drillings = page.get_by_test_id("report-drillings").get_by_role("row")
    expect(drillings).to_have_count(3)
    expect(drillings.nth(1)).to_contain_text(
        re.compile(r"L3 left · drill.*−0\.8 ± 0\.17 mm.*B, .*longest 0\.9 s")
    )
    page.get_by_test_id("report-drillings").evaluate("part => part.scrollIntoView()")
    save_screenshot(page, "recording-report")


def test_a_piece_and_a_video_are_saved_and_an_instant_is_commented(
    supervised: Supervised, watch: Watch, tmp_path: Path
) -> None:
    page = opened(watch, supervised, "o1", "operator/navigate", TABLET)
    page.get_by_test_id("step-recordings").click()
    row = "[data-name='20260101T000000Z-0000.mcap']"
    page.locator(row).get_by_test_id("review-open").click()
    shows(page, 0)
    expect(page.get_by_test_id("review-piece-save")).to_be_disabled()
    page.get_by_test_id("review-events").get_by_role("button", name="Alarm · BREACH").click()
    # The section begins at the displayed instant, which is still the first one until the other is loaded.
    expect(page.get_by_test_id("review-instant")).to_have_attribute("data-number", re.compile("^[1-9]"))
    page.get_by_test_id("review-piece-begin").click()
    begin = int(page.get_by_test_id("review-instant").get_attribute("data-number") or -1)
    page.get_by_test_id("review-after").click()
    shows(page, begin + 1)
    page.get_by_test_id("review-piece-end").click()
    expect(page.get_by_test_id("review-piece")).to_be_visible()
    page.get_by_test_id("review-piece-save").click()
    exports = page.locator(".review-exports")
    expect(exports).to_contain_text("2 images, from 0:02 on. No tracking state is stored before them")
    with page.expect_download() as piece:
        page.get_by_test_id("review-export-download").click()
    assert piece.value.suggested_filename.endswith("s.mcap")

    page.get_by_test_id("review-comment").fill("Medial wall")
    expect(page.get_by_test_id("review-comment-write")).to_have_text("Comment at 0:02")
    page.get_by_test_id("review-comment-write").click()
    commented = page.get_by_test_id("review-events").get_by_role("button", name="Comment · Medial wall · ")
    expect(commented).to_be_visible()
    expect(page.get_by_test_id("review-comment")).to_have_value("")

    page.get_by_test_id("review-video-save").click()
    expect(exports).to_contain_text(
        f"{len(DRILLED)} images, 0 with the overlay. The others state why the overlay is missing."
    )
    save_screenshot(page, "recording-exports")
    # Exports are listed again after the review was closed.
    page.locator(row).get_by_test_id("review-open").click()
    page.locator(row).get_by_test_id("review-open").click()
    downloads = page.get_by_test_id("review-export-download")
    expect(downloads).to_have_count(2)
    with page.expect_download() as film:
        downloads.filter(has_text=".mp4").click()
    film.value.save_as(tmp_path / "case.mp4")
    with av.open(str(tmp_path / "case.mp4")) as video:
        assert sum(1 for _ in video.decode(video=0)) == len(DRILLED)

    # A supervisor can read and write comments, but not export.
    page = opened(watch, supervised, "s1", "supervisor", PHONE)
    page.get_by_test_id("fold-recordings").locator("summary").click()
    page.locator(row).get_by_test_id("review-open").click()
    shows(page, 0)
    expect(page.get_by_test_id("review-events")).to_contain_text("Medial wall")
    page.get_by_test_id("review-comment").fill("Seen")
    page.get_by_test_id("review-comment-write").click()
    expect(page.get_by_test_id("review-events")).to_contain_text("Comment · Seen · ")
    assert page.get_by_test_id("review-video-save").count() == 0


def test_the_operator_protects_and_deletes_a_recording(supervised: Supervised, watch: Watch) -> None:
    page = opened(watch, supervised, "o1", "operator/navigate", TABLET)
    page.get_by_test_id("step-recordings").click()
    row = page.locator("[data-name='20260101T000000Z-0000.mcap']")
    row.get_by_test_id("protect").click()
    expect(row).to_contain_text("protected")
    expect(row.get_by_test_id("delete")).to_be_hidden()
    save_screenshot(page, "recording-list")
    row.get_by_test_id("protect").click()
    with page.expect_download() as download:
        row.get_by_role("link", name="Download").click()
    assert download.value.suggested_filename == "20260101T000000Z-0000.mcap"
    row.get_by_test_id("delete").click()
    row.get_by_test_id("delete").click()
    expect(row).to_be_hidden()
