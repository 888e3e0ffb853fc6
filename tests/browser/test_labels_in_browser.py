"""Labels of vertebrae on the page Plan: sent, drawn, switched off, and both pedicles measured from them."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, FilePayload, Page, Route, expect

from server.imaging.nifti import nifti_bytes
from tests.browser.test_rehearsal_in_browser import Rehearsal
from tests.server.imaging.made_labels import label_nifti
from tracker.plan.labels import CLASS_OF_LEVEL, LabelVolume
from tracker.rehearsal.anatomy import bone_field
from tracker.rehearsal.ct import rehearsal_ct

pytestmark = pytest.mark.browser
PATIENCE_MS = 60_000


@pytest.fixture(scope="module")
def files() -> tuple[bytes, bytes]:
    """The rehearsal's CT, and a segmentation with its true bone as L3."""
    volume = rehearsal_ct(spacing_mm=(1.2, 1.2, 1.5))
    index = np.argwhere(np.ones(volume.hu.shape, dtype=bool))[:, ::-1]
    bone = bone_field(volume.lps_from_index(index)) < 0.0
    labels = bone.reshape(volume.hu.shape) * np.uint8(CLASS_OF_LEVEL["L3"])
    truth = LabelVolume(labels=labels, lps_from_ijk=volume.lps_from_ijk, voxel_mm=1.5)
    return nifti_bytes(volume), label_nifti(truth)


@pytest.fixture
def page(browser: Browser, tmp_path: Path, files: tuple[bytes, bytes]) -> Iterator[Page]:
    """The page Plan of a case with a CT."""
    rehearsal = Rehearsal(tmp_path)
    try:
        address = f"http://127.0.0.1:{rehearsal.port}"
        context = browser.new_context(viewport={"width": 1180, "height": 820}, locale="en-GB")
        context.set_default_timeout(PATIENCE_MS)
        door = context.request
        case = door.post(f"{address}/api/cases", data={"name": "L3"}).json()["id"]
        assert door.post(f"{address}/api/cases/{case}/open").ok
        opened = context.new_page()
        opened.goto(f"{address}/operator/plan")
        sent: FilePayload = {"name": "ct.nii.gz", "mimeType": "application/gzip", "buffer": files[0]}
        opened.get_by_test_id("ct-intake").get_by_test_id("file-input").set_input_files(sent)
        expect(opened.get_by_test_id("slice-axial")).to_be_visible(timeout=PATIENCE_MS)
        yield opened
        context.close()
    finally:
        rehearsal.stop()


def test_labels_are_drawn_and_both_pedicles_are_measured_without_a_click(
    page: Page, files: tuple[bytes, bytes]
) -> None:
    page.get_by_test_id("part-ct").click()
    intake = page.get_by_test_id("label-intake")
    sent: FilePayload = {"name": "vertebrae.nii.gz", "mimeType": "application/gzip", "buffer": files[1]}
    intake.get_by_test_id("file-input").set_input_files(sent)
    expect(page.get_by_test_id("label-L3")).to_contain_text("6", timeout=PATIENCE_MS)
    axial = page.get_by_test_id("slice-axial")
    expect(axial.get_by_test_id("draw-labels").locator("text")).to_have_text("L3", timeout=PATIENCE_MS)
    expect(axial.get_by_test_id("draw-labels").locator("path")).to_have_attribute("d", re.compile("M .* Z"))
    page.get_by_test_id("show-labels").click(force=True)
    expect(page.get_by_test_id("draw-labels")).to_have_count(0)
    page.get_by_test_id("show-labels").click(force=True)

    page.get_by_test_id("part-pedicle").click()
    page.get_by_test_id("add-vertebra").click()
    page.get_by_test_id("level-L4").click()
    expect(page.get_by_test_id("vertebra-L4")).to_be_visible()
    expect(page.get_by_test_id("measure-both")).to_have_count(0)
    page.get_by_test_id("add-vertebra").click()
    # The alarms are readable, and their buttons are touched while a dialog is open.
    page.get_by_test_id("sound").click(trial=True)
    alarms, dialog = page.get_by_test_id("alarms").bounding_box(), page.get_by_role("dialog").bounding_box()
    assert alarms
    assert dialog
    assert dialog["y"] >= alarms["y"] + alarms["height"]
    page.get_by_test_id("level-L3").click()
    _cancel_a_measurement(page)
    page.get_by_test_id("measure-both").click()
    expect(page.get_by_test_id("part-pedicle")).to_contain_text("2", timeout=PATIENCE_MS)
    plan = page.request.get(f"{page.url.partition('/operator')[0]}/api/plan").json()["plan"]
    measured = next(one for one in plan["vertebrae"] if one["name"] == "L3")["pedicles"]
    assert sorted(one["measured"]["side"] for one in measured) == ["left", "right"]
    expect(page.get_by_test_id("lay-channel")).to_be_enabled(timeout=PATIENCE_MS)


def _cancel_a_measurement(page: Page) -> None:
    """Begin a measurement that the server does not see, cancel it, and expect that another may begin."""
    job = {"id": "0", "title": "measuring", "state": "running", "progress_ratio": 0.0, "doing": ""}
    job |= {"result": None, "problem": None}

    def answer(route: Route) -> None:
        if route.request.method == "DELETE":
            job["state"] = "cancelled"
        route.fulfill(json=job)

    addresses = ("**/pedicles/*", "**/api/jobs/0")
    for address in addresses:
        page.route(address, answer)
    page.get_by_test_id("measure-both").click()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_test_id("measure-both")).to_be_enabled()
    for address in addresses:
        page.unroute(address)
