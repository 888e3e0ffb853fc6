"""A CT that an archive sends: it waits, is listed without the patient, and becomes the CT of the case."""

import os
import signal
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest
from pydicom.dataset import Dataset

from tests.dicom_tools import closed_sockets  # noqa: F401  a fixture
from tests.procedure.conftest import Server, serving
from tests.server.dicom_receiver.sending import associated, sent
from tests.server.imaging.made_ct import BORN, NAME, NUMBER, made_ct

BY = {"made_by": "M. Ito"}
RECEIVE: dict[str, object] = {"port": 0, "allowed_ae_titles": ["SCANNER"]}
RECEIVING = {"dicom": {"receive": RECEIVE}}
SUCCESS = 0


@pytest.fixture
def receiving(tmp_path: Path) -> Iterator[Server]:
    with serving(tmp_path / "home", RECEIVING) as server:
        yield server


def port_of(server: Server) -> int:
    assert server.dicom is not None
    return server.dicom.status.port


def send(server: Server, slices: Iterable[Dataset]) -> None:
    association = associated(port_of(server))
    assert set(sent(association, slices)) == {SUCCESS}
    association.release()


def complete(server: Server) -> dict[str, Any]:
    """The only series, as soon as it can be taken."""

    def is_complete() -> bool:
        series = server.ask("GET", "/api/ct/received", 200)["series"]
        return len(series) == 1 and series[0]["complete"]

    server.until(is_complete)
    (one,) = server.ask("GET", "/api/ct/received", 200)["series"]
    found: dict[str, Any] = one
    return found


def open_case(server: Server) -> None:
    case = server.ask("POST", "/api/cases", 201, json={"name": "L3"})
    server.ask("POST", f"/api/cases/{case['id']}/open", 200)


def test_a_received_series_becomes_the_ct_of_the_case(receiving: Server) -> None:
    send(receiving, made_ct(count=8).slices)
    one = complete(receiving)
    columns, rows, slices = 16, 12, 8
    assert (one["files"], one["modality"], one["size_wh_px"]) == (slices, "CT", [columns, rows])
    listed = receiving.door.get("/api/ct/received").text
    assert not [word for word in (NAME.partition("^")[0], BORN, NUMBER) if word in listed]
    take = f"/api/ct/received/{one['id']}"
    assert receiving.ask("POST", take, 409, params=BY)["code"] == "NO_CASE_OPEN"
    open_case(receiving)
    job = receiving.done(receiving.ask("POST", take, 202, params=BY))
    assert job["state"] == "done", job["problem"]
    assert receiving.ask("GET", "/api/ct", 200)["size_ijk"] == [columns, rows, slices]
    assert receiving.ask("GET", "/api/ct/received", 200)["series"] == []
    assert receiving.ask("POST", take, 404, params=BY)["code"] == "RECEIVED_UNKNOWN"


def test_a_series_that_is_rejected_goes_on_waiting(receiving: Server) -> None:
    slices = made_ct(count=8).slices
    del slices[4]
    send(receiving, slices)
    one = complete(receiving)
    open_case(receiving)
    job = receiving.done(receiving.ask("POST", f"/api/ct/received/{one['id']}", 202, params=BY))
    assert job["problem"]["code"] == "CT_SLICES_MISSING"
    assert complete(receiving)["id"] == one["id"]
    receiving.ask("DELETE", f"/api/ct/received/{one['id']}", 204)
    assert receiving.ask("GET", "/api/ct/received", 200)["series"] == []
    assert receiving.ask("DELETE", f"/api/ct/received/{one['id']}", 404)["code"] == "RECEIVED_UNKNOWN"


def test_a_killed_receiver_comes_back_and_half_a_series_cannot_be_taken(receiving: Server) -> None:
    assert receiving.dicom is not None
    slices = made_ct(count=16).slices
    association = associated(port_of(receiving))
    sent(association, slices[:10])
    pid = receiving.dicom.pid
    assert pid is not None
    os.kill(pid, signal.SIGKILL)
    receiving.until(lambda: receiving.ask("GET", "/api/ct/received", 200)["remark"] is not None)
    listed = receiving.ask("GET", "/api/ct/received", 200)
    assert listed["remark"]["code"] == "RECEIVER_ENDED"
    assert "SIGKILL" in listed["remark"]["message"]
    (half,) = listed["series"]
    assert (half["files"], half["complete"]) == (10, False)
    open_case(receiving)
    rejection = receiving.ask("POST", f"/api/ct/received/{half['id']}", 422, params=BY)
    assert rejection["code"] == "RECEIVED_NOT_COMPLETE"
    # The socket was open all the time: the sender waits until the new process answers.
    send(receiving, slices)
    assert complete(receiving)["files"] == len(slices)


def test_a_quota_below_one_slice_is_answered_and_told(tmp_path: Path) -> None:
    receive = {**RECEIVE, "max_gb": 1e-6}
    with serving(tmp_path / "home", {"dicom": {"receive": receive}}) as server:
        association = associated(port_of(server))
        assert sent(association, made_ct(size_wh=(64, 64)).slices[:1]) == [0xA700]
        association.release()
        server.until(lambda: server.ask("GET", "/api/ct/received", 200)["remark"] is not None)
        listed = server.ask("GET", "/api/ct/received", 200)
        assert (listed["remark"]["code"], listed["series"]) == ("RECEIVE_FULL", [])


def test_a_refusal_is_told_with_its_remedy(receiving: Server) -> None:
    assert associated(port_of(receiving), title="STRANGER").is_rejected
    receiving.until(lambda: receiving.ask("GET", "/api/ct/received", 200)["remark"] is not None)
    remark = receiving.ask("GET", "/api/ct/received", 200, headers={"Accept-Language": "de"})["remark"]
    assert remark["code"] == "RECEIVE_SENDER_REFUSED"
    assert "STRANGER wurde abgelehnt" in remark["message"]


def test_it_is_off_unless_a_port_is_set(server: Server) -> None:
    assert server.ask("GET", "/api/ct/received", 200) == {"address": "", "series": [], "remark": None}
    assert server.ask("POST", f"/api/ct/received/{'0' * 32}", 404, params=BY)["code"] == "RECEIVER_OFF"
