"""The CT around the navigated vertebra, through the API: voxels, id, and the reason if there is none."""

import json
from pathlib import Path

import numpy as np
import pytest

from server.jobs import Report
from server.setup import REHEARSAL_CT_ID
from tests.procedure.conftest import Server, serving
from tests.procedure.test_ct_step import BY, opened, sent
from tests.procedure.uploads import nifti, scanned
from tracker.plan import Volume

DOOR = "/api/navigation/ct"
HAND = {"entry_lps_mm": [15, 14, 2], "target_lps_mm": [8, -30, 3], "diameter_mm": 6.0}


def navigated(server: Server) -> None:
    """A case with a CT and an active channel."""
    opened(server)
    assert sent(server, nifti(scanned()))["state"] == "done"
    server.ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": "L3"})
    server.ask("PUT", "/api/plan/vertebrae/L3/channels/left", 200, json={**BY, "by_hand": HAND})
    server.ask("POST", "/api/plan/active-channel", 200, json={**BY, "vertebra": "L3", "side": "left"})


def received(server: Server) -> tuple[str, Volume]:
    """The id of the CT, and its voxels at their positions."""
    answer = server.door.get(DOOR)
    assert answer.status_code == 200, answer.text
    place = json.loads(answer.headers["Volume-Place"])
    hu = np.frombuffer(answer.content, "<i2").reshape(place["size_ijk"][::-1])
    return place["ct_id"], Volume(hu=hu, lps_from_ijk=np.array(place["lps_from_ijk"]))


def test_a_case_has_its_ct_with_the_id_that_navigation_states(server: Server) -> None:
    navigated(server)
    ct_id, part = received(server)
    assert server.adopted[-1].ct_id == ct_id
    ends = np.array([HAND["entry_lps_mm"], HAND["target_lps_mm"]], dtype=float)
    assert part.contains(ends).all()
    # NIfTI stores its affine in single precision.
    np.testing.assert_allclose(part.sample_hu(ends), scanned().sample_hu(ends), atol=0.01)

    # A browser that has it gets no voxels again, in either encoding; another CT is another answer.
    for encoding in ("gzip", "identity"):
        first = server.door.get(DOOR, headers={"Accept-Encoding": encoding})
        known = {"Accept-Encoding": encoding, "If-None-Match": first.headers["ETag"]}
        again = server.door.get(DOOR, headers=known)
        assert (again.status_code, again.content) == (304, b"")
        assert again.headers["Cache-Control"] == "private, no-cache"
        np.testing.assert_array_equal(np.frombuffer(first.content, "<i2"), part.hu.ravel())
    sent(server, nifti(Volume(hu=scanned().hu + np.int16(7), lps_from_ijk=scanned().lps_from_ijk)))
    assert server.ask("GET", DOOR, 409)["code"] == "NO_ACTIVE_CHANNEL"


def test_without_a_case_or_a_channel_the_reason_is_said(server: Server) -> None:
    assert server.ask("GET", DOOR, 409)["code"] == "NO_CASE_OPEN"
    opened(server)
    assert server.ask("GET", DOOR, 409)["code"] == "NO_ACTIVE_CHANNEL"


def small_scan(report: Report) -> Volume:
    """Replaces a simulated scan that takes seconds."""
    report(0.5, "scanning")
    return Volume(hu=np.arange(24, dtype=np.int16).reshape(2, 3, 4), lps_from_ijk=np.eye(4))


def broken_scan(report: Report) -> Volume:
    """A job that fails."""
    report(0.5, "scanning")
    raise RuntimeError("no memory is left")


def test_a_rehearsal_without_a_case_is_scanned_once_at_the_first_request(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("server.procedure.navigation_ct.scan_rehearsal", small_scan)
    with serving(tmp_path / "home", {"rehearsal": {"provides_setup": True}}) as server:
        assert server.jobs.list() == ()
        assert server.ask("GET", DOOR, 204) is None
        (job,) = server.jobs.list()
        server.jobs.wait_for(job.id)
        ct_id, part = received(server)
        setup = server.preparation.setup
        assert setup is not None
        assert ct_id == setup.ct_id == REHEARSAL_CT_ID
        np.testing.assert_array_equal(part.hu.ravel(), np.arange(24))
        assert len(server.jobs.list()) == 1


def test_a_scan_that_fails_is_said_and_tried_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("server.procedure.navigation_ct.scan_rehearsal", broken_scan)
    with serving(tmp_path / "home", {"rehearsal": {"provides_setup": True}}) as server:
        server.ask("GET", DOOR, 204)
        (job,) = server.jobs.list()
        server.jobs.wait_for(job.id)
        assert server.ask("GET", DOOR, 409)["code"] == "SCAN_FAILED"
        monkeypatch.setattr("server.procedure.navigation_ct.scan_rehearsal", small_scan)
        server.ask("GET", DOOR, 204)
