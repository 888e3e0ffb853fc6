"""Case, camera and tool by touch, with the rehearsal's board, pivot and spin."""

import re
from collections.abc import Sequence

from playwright.sync_api import FilePayload, expect

from server.config import RehearsalConfig
from tests.browser.by_touch.tablet import Tablet
from tests.procedure.team import board_images


def open_case(tablet: Tablet, name: str) -> None:
    """Create and open a case."""
    page = tablet.page
    tablet.tap("step-case")
    expect(page.get_by_role("heading", name="Begin with a case")).to_be_visible()
    tablet.looked_at("case-first")
    tablet.type_into("Name of the case", name)
    tablet.tap_on(page.get_by_role("button", name="Create and open"), "create")
    tablet.reads("opened-case", name)
    tablet.looked_at("case-open")


def play(tablet: Tablet, scene: str, *, step: str) -> None:
    """Open the page of a step, and play a scene of the rehearsal there."""
    tablet.tap(f"step-{step}")
    change_scene(tablet, scene)


def change_scene(tablet: Tablet, scene: str) -> None:
    """Play another scene on the present page."""
    tablet.tap(f"scene-{scene}")
    tablet.finds(f"scene-{scene}", "aria-pressed", "true")
    expect(tablet.page.locator("[data-begun]")).to_have_attribute(
        "data-begun", "true", timeout=tablet.patience_ms
    )


def board_views(rehearsal: RehearsalConfig) -> list[FilePayload]:
    """Image files of all positions of the board."""
    return [
        {"name": f"view-{place}.jpg", "mimeType": "image/jpeg", "buffer": image}
        for place, image in enumerate(board_images(rehearsal))
    ]


def calibrate_camera(tablet: Tablet, sent: Sequence[FilePayload]) -> None:
    """Collect views of the board, some captured automatically and the others sent as files, and calibrate."""
    page = tablet.page
    play(tablet, "board", step="camera")
    tablet.sees("marker-drill")
    tablet.looked_at("camera-board")
    tablet.tap("collect")
    expect(page.get_by_test_id("views")).to_contain_text(
        re.compile(r"Views\s*[2-9]"), timeout=tablet.patience_ms
    )
    tablet.looked_at("camera-collecting")
    page.get_by_test_id("view-files").set_input_files(sent)
    tablet.finds("missing", "data-enough", "true")
    tablet.tap("calibrate")
    tablet.finds("calibration-rms", "data-within", "true")
    expect(page.get_by_test_id("collection")).to_have_count(0)
    expect(page.get_by_test_id("calibration-rms")).to_be_in_viewport()
    for one in page.get_by_test_id("calibration").locator("summary").all():
        one.tap()
    expect(page.get_by_role("img", name="Residuals")).to_be_visible()
    tablet.looked_at("camera-calibrated")


def calibrate_tool(tablet: Tablet) -> None:
    """Calibrate the tip by pivoting and the axis by spinning."""
    play(tablet, "pivot", step="tool")
    tablet.looked_at("tool-none")
    tablet.tap("begin-new")
    tablet.type_into("Diameter (mm)", "4")
    tablet.type_into("Length (mm)", "118")
    _keep_when_enough(tablet, named="tool-pivot")
    tablet.reads("tool-drill", "The axis is not known yet")
    change_scene(tablet, "spin")
    tablet.tap("begin-spin")
    _keep_when_enough(tablet, named="tool-spin")
    tablet.looked_at("tool-calibrated")


def _keep_when_enough(tablet: Tablet, *, named: str) -> None:
    tablet.finds("missing", "data-enough", "true")
    tablet.looked_at(named)
    tablet.tap("keep")
    expect(tablet.page.get_by_test_id("gathering")).to_have_count(0)
