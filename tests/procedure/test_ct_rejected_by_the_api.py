"""Invalid CTs through the API: rejected with code, numbers and remedy, and nothing is stored."""

import functools
import io
import os
import signal
import struct
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from pydicom import uid

from server.jobs import JobState
from tests.procedure.conftest import Server
from tests.procedure.test_ct_step import BY, leftovers, opened, sent
from tests.procedure.uploads import dicom_zip, zip_of_folder
from tests.server.imaging.made_ct import BORN, NAME, NUMBER, compressed, file_of, made_ct
from tests.server.imaging.spoilt_ct import (
    HU,
    Case,
    cut_zip,
    every,
    lone_file,
    nifti,
    spoilt,
    text_file,
    truncated,
    two_patients,
    without,
    zip_damaged,
    zipped,
)

BAD: dict[str, tuple[str, Case]] = {
    "an-empty-zip": ("CT_EMPTY", zipped()),
    "a-zip-with-nothing-but-an-empty-file": ("CT_EMPTY", zipped("IM1", content=b"")),
    "a-text-named-dcm": ("CT_NO_DICOM", text_file),
    "a-text": ("CT_NO_DICOM", lone_file(b"This is a letter.")),
    "a-truncated-slice": ("CT_SLICE_TRUNCATED", truncated(0.9)),
    "a-truncated-jpeg-2000": ("CT_SLICE_TRUNCATED", truncated(0.85, uid.JPEG2000Lossless)),
    "two-patients-mixed": ("CT_PATIENTS_MIXED", two_patients),
    "a-nifti-without-affine": ("CT_AFFINE_MISSING", nifti(patch=(252, struct.pack("<hh", 0, 0)))),
    "a-nifti-cut-off": ("CT_FILE_DAMAGED", nifti(HU, keep=600)),
    "a-huge-nifti": ("CT_TOO_LARGE", nifti(patch=(42, struct.pack("<hhh", 32000, 32000, 32000)))),
    "a-slice-missing": ("CT_SLICES_MISSING", spoilt(lambda made: made.slices.pop(3))),
    "one-slice": ("CT_TOO_FEW_SLICES", spoilt(lambda _: None, count=1)),
    "an-mr": ("CT_NOT_CT", spoilt(every("Modality", "MR"))),
    "no-position": ("CT_GEOMETRY_MISSING", spoilt(without("ImagePositionPatient"))),
    "a-zip-leading-out": ("CT_ARCHIVE_UNSAFE", zipped("../../evil.dcm")),
    "a-zip-cut-off": ("CT_ARCHIVE_BROKEN", cut_zip),
    "a-zip-damaged-inside": ("CT_FILE_DAMAGED", zip_damaged),
}


def stored(server: Server) -> list[Any]:
    """Every document and file of every case."""
    return [(server.store.outline(case.id), server.store.files(case.id)) for case in server.store.list()]


def test_bad_cts_are_reported_and_leave_nothing(server: Server, tmp_path: Path) -> None:
    opened(server)
    assert sent(server, dicom_zip())["state"] == "done"
    before = stored(server)
    for name, (code, make) in BAD.items():
        folder = tmp_path / name
        folder.mkdir()
        job = sent(server, zip_of_folder(make(folder)))
        assert job["state"] == "failed", name
        problem = job["problem"]
        assert (problem["code"], bool(problem["remedy"])) == (code, True), name
        for secret in (*NAME.split("^"), BORN, NUMBER, str(tmp_path)):
            assert secret.casefold() not in str(job).casefold(), name
        assert stored(server) == before, name
        assert leftovers(server) == [], name
    assert server.ask("POST", "/api/ct", 422, content=b"", params=BY)["code"] == "UPLOAD_EMPTY"
    assert stored(server) == before
    assert server.ask("GET", "/api/ct", 200)["heading"]["version"] == 1


def test_a_surface_that_cannot_be_read_leaves_nothing(server: Server) -> None:
    opened(server)
    before = stored(server)
    for content, query, code in (
        (b"solid nothing", {}, "MESH_FORMAT_UNKNOWN"),
        (b"hello", {}, "MESH_FORMAT_UNKNOWN"),
        (b"ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n", {}, "MESH_UNREADABLE"),
        (stl(50.0)[:-10], {}, "MESH_UNREADABLE"),
        (stl(0.05), {}, "MESH_UNIT_NEEDED"),
        (stl(50.0), {"unit": "m"}, "MESH_SIZE_IMPLAUSIBLE"),
    ):
        job = server.done(server.ask("POST", "/api/surface", 202, content=content, params={**BY, **query}))
        assert job["problem"]["code"] == code
        assert stored(server) == before
        assert leftovers(server) == []
    assert server.ask("GET", "/api/surface", 409)["code"] == "SURFACE_MISSING"


def stl(side: float) -> bytes:
    """A box with these sides, as binary STL."""
    return bytes(trimesh.creation.box((side, side, side)).export(file_type="stl"))


def test_a_surface_from_the_ct_and_one_in_metres(server: Server) -> None:
    opened(server)
    sent(server, dicom_zip())
    region = {"low_lps_mm": [-30, -30, -15], "high_lps_mm": [30, 30, 15]}
    requested = {**BY, "region": region, "max_faces": 5000}
    job = server.done(server.ask("POST", "/api/surface/from-ct", 202, json=requested))
    assert job["state"] == "done", job["problem"]
    made = server.ask("GET", "/api/surface", 200)
    assert made["heading"]["current"]
    assert made["content"]["faces"] <= 5000
    assert np.all(np.array(made["content"]["low_lps_mm"]) >= [-31, -31, -16])
    ply = server.door.get("/api/surface.ply")
    assert ply.content.startswith(b"ply")
    assert (
        server.door.get("/api/surface.ply", headers={"If-None-Match": ply.headers["etag"]}).status_code == 304
    )
    wrong = {**requested, "region": {**region, "high_lps_mm": [-40, 0, 0]}}
    assert server.ask("POST", "/api/surface/from-ct", 409, json=wrong)["code"] == "REGION_INVALID"
    # Another CT: documents based on the old one are out of date.
    sent(server, dicom_zip())
    assert not server.ask("GET", "/api/surface", 200)["heading"]["current"]
    in_metres = server.ask("POST", "/api/surface", 202, content=stl(0.05), params={**BY, "unit": "m"})
    assert server.done(in_metres)["result"]["size_mm"] == pytest.approx([50.0] * 3, rel=1e-5)
    assert server.ask("GET", "/api/surface", 200)["heading"]["depends_on"] == []


@functools.cache
def slow_zip() -> bytes:
    """A CT that takes seconds to read: large slices, compressed as JPEG 2000."""
    made = made_ct(count=120, size_wh=(384, 384), spacing_mm=1.0)
    content = compressed(made.slices[0], uid.JPEG2000Lossless)
    files = io.BytesIO()
    with zipfile.ZipFile(files, "w") as archive:
        for k, one in enumerate(made.slices):
            archive.writestr(f"IM{k:04d}", file_of(one, uid.JPEG2000Lossless, content=content))
    return files.getvalue()


def sent_and_begun(server: Server) -> Any:  # noqa: ANN401  JSON
    """The upload of a slow CT, of which one slice has been read."""
    begun = server.ask("POST", "/api/ct", 202, content=slow_zip(), params=BY)
    address = f"/api/ct/uploads/{begun['upload_id']}/preview.png"
    server.until(lambda: server.door.get(address).status_code != 204)
    return begun


def test_a_first_slice_is_shown_before_the_ct_and_reading_is_cancelled_in_the_middle(server: Server) -> None:
    opened(server)
    before = stored(server)
    begun = sent_and_begun(server)
    shown = server.door.get(f"/api/ct/uploads/{begun['upload_id']}/preview.png")
    assert server.jobs.get(begun["id"]).state is JobState.RUNNING
    assert shown.status_code == 200
    assert shown.content.startswith(b"\x89PNG")
    assert any(path.suffix == ".partial" for path in leftovers(server))
    over = server.ask("DELETE", f"/api/jobs/{begun['id']}", 200)
    assert over["state"] == "cancelled"
    server.done(begun)
    assert stored(server) == before
    assert leftovers(server) == []
    assert server.ask("GET", "/api/ct", 409)["code"] == "CT_MISSING"
    gone = server.ask("GET", f"/api/ct/uploads/{begun['upload_id']}/preview.png", 404)
    assert gone["code"] == "UPLOAD_UNKNOWN"


def test_the_process_that_reads_is_killed(server: Server) -> None:
    opened(server)
    begun = sent_and_begun(server)
    watched = server.jobs._entries[begun["id"]]
    pid = None if watched.process is None else watched.process.pid
    assert pid is not None
    os.kill(pid, signal.SIGKILL)
    job = server.done(begun)
    assert job["problem"]["code"] == "JOB_ENDED"
    assert leftovers(server) == []
    assert sent(server, dicom_zip())["state"] == "done"


def test_an_invalid_name_is_rejected_before_anything_is_done(server: Server) -> None:
    opened(server)
    for name in ("ito\nroot", "\u202eoti", " ", "\x00"):
        by = {"made_by": name}
        for path, sent_up in (
            ("/api/ct", {"params": by, "content": b"PK"}),
            ("/api/surface", {"params": by, "content": b"PK"}),
            ("/api/surface/from-ct", {"json": by}),
            ("/api/plan/vertebrae", {"json": {**by, "name": "L3"}}),
            ("/api/camera/calibration", {"json": by}),
            ("/api/tools/collection/conclusion", {"json": by}),
        ):
            reported = server.ask("POST", path, 422, **sent_up)
            assert reported["code"] == "NAME_INVALID", path
    assert server.jobs.list() == ()
