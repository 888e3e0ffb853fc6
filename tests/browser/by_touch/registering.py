"""Registration with landmarks, check and navigation by touch."""

from playwright.sync_api import expect

from tests.browser.by_touch.setting_up import change_scene
from tests.browser.by_touch.tablet import Tablet

ENOUGH = 4


def register_by_points(tablet: Tablet) -> None:
    """Capture four landmarks, the last one twice, and register."""
    page = tablet.page
    tablet.tap("method-points")
    change_scene(tablet, "landmarks")
    tablet.tap("points-begin")
    expect(page.get_by_test_id("points-conclude")).to_be_disabled()
    _touch_until_enough(tablet)
    # A slip: the last capture is discarded and repeated.
    touched = page.locator("[data-touched=true]").count()
    with tablet.uncounted():
        tablet.tap("undo-last")
        expect(page.locator("[data-touched=true]")).to_have_count(touched - 1)
        _touch_until_enough(tablet)
    tablet.sees("points-pass")
    tablet.looked_at("points")
    tablet.tap("points-conclude")
    tablet.reads("registration-now", "Error at the entry point")
    tablet.looked_at("registered")


def check_on_a_landmark(tablet: Tablet) -> None:
    """Check on the landmark that was not used for the registration."""
    page = tablet.page
    landmark = tablet.asks("/api/rehearsal?truth=1")["truth"]["check_landmark"]["name"]
    change_scene(tablet, "check")
    tablet.finds("tip-rests", "data-landmark", landmark)
    tablet.tap(f"check-{landmark}")
    tablet.tap("check-begin")
    over = page.locator("[data-testid=check-outcome], [data-testid=capture-rejected]")
    over.wait_for()
    # If the tip has just left the landmark, it returns later.
    while page.get_by_test_id("capture-rejected").count() > 0:
        tablet.finds("tip-rests", "data-landmark", landmark)
        with page.expect_response(lambda answer: answer.url.endswith("/api/registration/check")):
            tablet.tap("check-again")
        page.locator("[data-testid=capturing], [data-testid=check-outcome]").wait_for()
        over.wait_for()
    tablet.finds("check-outcome", "data-passed", "true")
    tablet.looked_at("check")
    tablet.tap("check-conclude")
    tablet.sees("navigate")


def _touch_until_enough(tablet: Tablet) -> None:
    while tablet.page.locator("[data-touched=true]").count() < ENOUGH:
        _touch_where_the_tip_rests(tablet)


def _touch_where_the_tip_rests(tablet: Tablet) -> None:
    """Capture each landmark as soon as the tip rests on it."""
    page = tablet.page
    rests = page.get_by_test_id("tip-rests")
    expect(rests).to_have_attribute("data-landmark", "", timeout=tablet.patience_ms)
    name = page.locator("[data-testid=tip-rests]:not([data-landmark=''])").get_attribute("data-landmark")
    line = page.get_by_test_id(f"landmark-{name}")
    if line.get_attribute("data-touched") == "true":
        return
    tablet.tap_on(line.locator(".landmark-name"), f"landmark {name}")
    with page.expect_response(lambda answer: answer.url.endswith("/points/captures")):
        tablet.tap("capture")
    over = page.locator("[data-testid=captured], [data-testid=capture-rejected]").filter(has_text=str(name))
    over.wait_for()
    if over.get_attribute("data-testid") == "captured":
        expect(line).to_have_attribute("data-touched", "true", timeout=tablet.patience_ms)
