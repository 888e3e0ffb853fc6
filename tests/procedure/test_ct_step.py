"""A CT through the API: sent, read, sliced, rejected, cancelled, and present after a restart."""

import gc
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from tests.procedure.conftest import Server, serving
from tests.procedure.uploads import dicom_slices, dicom_zip, nifti, scanned, zip_of
from tests.server.imaging.made_ct import BORN, NAME, NUMBER
from tracker.plan.slices import WINDOWS, patient_slice, shown

BY = {"made_by": "M. Ito"}


def opened(server: Server) -> str:
    case = server.ask("POST", "/api/cases", 201, json={"name": "L3"})
    server.ask("POST", f"/api/cases/{case['id']}/open", 200)
    return str(case["id"])


def sent(server: Server, content: bytes) -> Any:  # noqa: ANN401  JSON
    return server.done(server.ask("POST", "/api/ct", 202, content=content, params=BY))


def two_series() -> bytes:
    return zip_of(dicom_slices(scanned()), dicom_slices(scanned(), series="1.2.3.9", number=2)[:20])


def picture(server: Server, path: str) -> np.ndarray:
    answer = server.door.get(path)
    assert answer.status_code == 200, answer.text
    return np.asarray(cv2.imdecode(np.frombuffer(answer.content, np.uint8), cv2.IMREAD_UNCHANGED))


@pytest.mark.parametrize("content", [dicom_zip, lambda: nifti(scanned())], ids=["dicom-zip", "nifti-turned"])
def test_a_ct_is_sent_and_looked_at(server: Server, content: Any) -> None:  # noqa: ANN401
    opened(server)
    job = sent(server, content())
    assert job["state"] == "done", job["problem"]
    ct = server.ask("GET", "/api/ct", 200)
    truth = scanned()
    assert ct["size_ijk"] == list(truth.shape_ijk)
    assert ct["spacing_mm"] == pytest.approx(truth.spacing_mm)
    for plane in ("axial", "sagittal", "coronal"):
        reach = ct["planes"][plane]
        at_mm = reach["from_mm"] + 12 * reach["step_mm"]
        expected = patient_slice(truth, plane, at_mm)
        seen = picture(server, f"/api/ct/slices/{plane}.png?at_mm={at_mm}&preset=bone")
        assert np.abs(seen.astype(int) - shown(expected.hu, WINDOWS["bone"])).max() <= 1
        place = server.ask("GET", f"/api/ct/slices/{plane}?at_mm={at_mm}", 200)
        assert np.array(place["lps_from_px"]) == pytest.approx(expected.lps_from_px, abs=1e-4)
        answer = server.door.get(f"/api/ct/slices/{plane}.png?at_mm={at_mm}")
        assert json.loads(answer.headers["slice-place"]) == place
        assert answer.headers["slice-ct"] == ct["heading"]["id"]
    point = truth.lps_from_index([40, 50, 20])
    probed = server.ask("POST", "/api/ct/probe", 200, json={"point_lps_mm": point.tolist()})
    assert probed["hu"] == pytest.approx(truth.hu[20, 50, 40], abs=1.0)
    assert probed["inside"]
    reported = server.door.get("/api/ct").text + server.door.get("/api/jobs").text
    for secret in (*NAME.split("^"), NUMBER, BORN, "QUIBBLE"):
        assert secret.casefold() not in reported.casefold()


def test_a_picture_is_kept_by_the_browser_until_the_ct_is_another(server: Server) -> None:
    opened(server)
    sent(server, dicom_zip())
    first = server.door.get("/api/ct/slices/axial.png")
    again = {"If-None-Match": first.headers["etag"]}
    assert server.door.get("/api/ct/slices/axial.png", headers=again).status_code == 304
    assert server.door.get("/api/ct/slices/axial.png?preset=metal", headers=again).status_code == 200
    sent(server, dicom_zip())
    assert server.door.get("/api/ct/slices/axial.png", headers=again).status_code == 200


def test_slices_along_and_across_a_channel(server: Server) -> None:
    opened(server)
    sent(server, dicom_zip())
    way = "entry=15,14,1&target=5,-30,3&preset=soft-tissue"
    assert picture(server, f"/api/ct/oblique.png?{way}&pixel_mm=1").shape == (101, 61)
    assert picture(
        server, f"/api/ct/oblique.png?{way}&view=across&depth_mm=15&width_mm=40&height_mm=40&pixel_mm=1"
    ).shape == (41, 41)
    place = server.ask(
        "GET", f"/api/ct/oblique?{way}&rotation_deg=90&pixel_mm=1".replace("&preset=soft-tissue", ""), 200
    )
    assert place["edges"]["top"].startswith("A")


def test_one_of_several_series_is_chosen(server: Server) -> None:
    case_id = opened(server)
    begun = server.ask("POST", "/api/ct", 202, content=two_series(), params=BY)
    job = server.done(begun)
    assert [one["images"] for one in job["result"]["series"]] == [40, 20]
    assert server.store.files(case_id) == ()
    upload = f"/api/ct/uploads/{begun['upload_id']}"
    wrong = server.done(server.ask("POST", f"{upload}/series/1.2.3.4", 202))
    assert wrong["problem"]["code"] == "CT_SERIES_UNKNOWN"
    right = server.done(server.ask("POST", f"{upload}/series/1.2.3.9", 202))
    assert right["state"] == "done", right["problem"]
    assert server.ask("GET", "/api/ct", 200)["size_ijk"][2] == 20
    assert leftovers(server) == []
    server.ask("POST", f"{upload}/series/1.2.3.9", 404)


def leftovers(server: Server) -> list[Path]:
    home = server.store.home
    known = {file.path for case in server.store.list() for file in server.store.files(case.id)}
    return [
        path
        for room in (home.temporary, home.cases)
        for path in room.rglob("*")
        if path.is_file() and path not in known
    ]


def test_nothing_is_sent_where_no_case_is_open(server: Server) -> None:
    assert server.ask("POST", "/api/ct", 409, content=b"x", params=BY)["code"] == "NO_CASE_OPEN"
    assert server.ask("GET", "/api/ct", 409)["code"] == "NO_CASE_OPEN"
    opened(server)
    assert server.ask("GET", "/api/ct", 409)["code"] == "CT_MISSING"
    assert server.ask("GET", "/api/ct/uploads/nothing/preview.png", 404)["code"] == "UPLOAD_UNKNOWN"


def test_the_ct_is_there_again_after_a_restart(server: Server, restarted: Callable[[], Server]) -> None:
    opened(server)
    sent(server, dicom_zip())
    before = server.ask("GET", "/api/ct", 200)
    shown_before = server.door.get("/api/ct/slices/coronal.png")
    begun = server.ask("POST", "/api/ct", 202, content=two_series(), params=BY)
    server.done(begun)
    again = restarted()
    assert again.ask("GET", "/api/ct", 200) == before
    assert again.door.get("/api/ct/slices/coronal.png").content == shown_before.content
    # An upload that waits for a choice does not survive a restart.
    again.ask("POST", f"/api/ct/uploads/{begun['upload_id']}/series/1.2.3.9", 404)
    assert leftovers(again) == []


def test_the_ct_and_plan_of_a_case_come_along_in_its_archive(server: Server) -> None:
    case_id = opened(server)
    sent(server, dicom_zip())
    server.ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": "L3"})
    shown_before = server.door.get("/api/ct/slices/axial.png").content
    archive = server.door.get(f"/api/cases/{case_id}/archive").content
    server.ask("POST", f"/api/cases/{case_id}/close", 200)
    server.ask("POST", f"/api/cases/{case_id}/deletion", 204, json={"confirm": "L3"})
    copied = server.ask("POST", "/api/cases/archive", 201, content=archive)
    server.ask("POST", f"/api/cases/{copied['id']}/open", 200)
    assert server.door.get("/api/ct/slices/axial.png").content == shown_before
    assert server.ask("GET", "/api/plan", 200)["heading"]["current"]


@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="the system does not tell what is mapped")
def test_nothing_of_a_closed_case_stays_mapped(server: Server) -> None:
    case_id = opened(server)
    sent(server, dicom_zip())
    server.door.get("/api/ct/slices/axial.png")
    assert case_id in Path("/proc/self/maps").read_text()
    server.ask("POST", f"/api/cases/{case_id}/close", 200)
    gc.collect()
    assert case_id not in Path("/proc/self/maps").read_text()


@pytest.mark.parametrize(
    ("path", "status", "code"),
    [
        pytest.param("slices/axial.png?at_mm=9000", 409, "SLICE_OUTSIDE", id="beyond-the-ct"),
        pytest.param("slices/axial?at_mm=nan", 422, "REQUEST_INVALID", id="nowhere"),
        pytest.param("slices/upside.png", 422, "REQUEST_INVALID", id="another-plane"),
        pytest.param("slices/axial.png?window=0", 422, "REQUEST_INVALID", id="no-window"),
        pytest.param("slices/axial.png?preset=x-ray", 422, "PRESET_UNKNOWN", id="another-preset"),
        pytest.param("slices/axial.png?slab_mm=1e9", 422, "REQUEST_INVALID", id="thick-slab"),
        pytest.param("oblique.png?entry=1,2&target=1,2,3", 422, "POINT_INVALID", id="two-numbers"),
        pytest.param("oblique.png?entry=1,2,inf&target=1,2,3", 422, "POINT_INVALID", id="infinite"),
        pytest.param("oblique.png?entry=1,2,3&target=1,2,3", 409, "CHANNEL_INVALID", id="no-length"),
        pytest.param(
            "oblique?entry=0,0,0&target=0,9,0&pixel_mm=0.05&height_mm=400", 409, "SLICE_TOO_LARGE", id="huge"
        ),
    ],
)
def test_slices_that_cannot_be_shown_are_reported(viewed: Server, path: str, status: int, code: str) -> None:
    assert viewed.ask("GET", f"/api/ct/{path}", status)["code"] == code


@pytest.fixture(scope="module")
def viewed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server with a CT that no test changes."""
    with serving(tmp_path_factory.mktemp("viewed")) as server:
        opened(server)
        sent(server, dicom_zip())
        yield server
