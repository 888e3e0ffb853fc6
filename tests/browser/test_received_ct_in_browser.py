"""A CT that a scanner sent is listed on the page Plan without the patient, and taken by one touch."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.test_rehearsal_in_browser import Rehearsal
from tests.dicom_tools import closed_sockets  # noqa: F401  a fixture
from tests.procedure.uploads import dicom_slices, scanned
from tests.server.dicom_receiver.sending import associated, sent
from tests.server.imaging.made_ct import NAME

pytestmark = pytest.mark.browser
PATIENCE_MS = 60_000


@pytest.fixture
def page(browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Page]:
    """The page Plan of a case without a CT, on a server that receives."""
    monkeypatch.setenv("COAXIAL__DICOM__RECEIVE__PORT", "0")
    monkeypatch.setenv("COAXIAL__DICOM__RECEIVE__ALLOWED_AE_TITLES", "[SCANNER]")
    rehearsal = Rehearsal(tmp_path)
    try:
        address = f"http://127.0.0.1:{rehearsal.port}"
        context = browser.new_context(viewport={"width": 1180, "height": 820}, locale="en-GB")
        context.set_default_timeout(PATIENCE_MS)
        case = context.request.post(f"{address}/api/cases", data={"name": "L3"}).json()["id"]
        assert context.request.post(f"{address}/api/cases/{case}/open").ok
        opened = context.new_page()
        opened.goto(f"{address}/operator/plan")
        yield opened
        context.close()
    finally:
        rehearsal.stop()


def test_a_received_series_is_taken_by_one_touch(page: Page) -> None:
    listed = page.get_by_test_id("received-ct")
    expect(listed).to_contain_text("No series waits.")
    door = page.request.get(f"{page.url.partition('/operator')[0]}/api/ct/received").json()
    port = int(door["address"].rpartition(":")[2])
    assert associated(port, title="STRANGER").is_rejected
    association = associated(port)
    assert set(sent(association, dicom_slices(scanned()))) == {0}
    association.release()
    expect(listed).to_contain_text(f"{scanned().shape_ijk[2]} slices")
    expect(listed).to_contain_text("A connection of STRANGER was refused")
    take = listed.get_by_role("button", name="Use this one")
    expect(take).to_be_enabled()
    assert NAME.partition("^")[0] not in page.content()
    take.click()
    expect(page.get_by_test_id("slice-axial")).to_be_visible(timeout=PATIENCE_MS)
    expect(page.get_by_test_id("received-ct")).to_have_count(0)
