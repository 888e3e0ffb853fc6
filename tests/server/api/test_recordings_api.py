"""`/api/recordings`: complete answers."""

import csv
import io
import zipfile
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient

from server.app import AppParts, create_app
from server.clock import utc_text
from server.config import Config
from server.jobs import Jobs
from server.live import LiveHub
from server.logs import LogSettings
from server.recording.service import RecordingService
from server.store import CaseStore, DocumentKind, Home
from tests.server.recording.no_recorder import recordings_without_process
from tests.server.recording.reviewed import DRILLED, HEIGHT, WIDTH, drawn, write_drilling

NOTHING = {
    "when": "manual",
    "consent": {"state": "not_required", "answered_at": None, "answered_by": None},
    "is_recording": False,
    "name": None,
    "duration_s": 0.0,
    "size_bytes": 0,
    "images": 0,
    "missing_images": 0,
    "remaining_s": None,
    "problem": None,
}


class Door:
    """The HTTP door of a server with one case."""

    def __init__(self, client: TestClient, store: CaseStore, jobs: Jobs) -> None:
        self.client, self.store, self.jobs = client, store, jobs

    def ask(self, method: str, path: str, status: int, body: object = None) -> dict[str, Any]:
        answer = self.client.request(method, f"/api/recordings{path}", json=body)
        assert answer.status_code == status, answer.text
        return {} if status == 204 else dict(answer.json())

    def put_drilling(self) -> str:
        """Put a recording of an earlier server into the open case; return its name."""
        case = self.store.get_open_case()
        assert case is not None
        folder = self.store.home.cases / case.id / "recordings"
        folder.mkdir(parents=True, exist_ok=True)
        return write_drilling(folder / "20260101T000000Z-0000.mcap").name

    def timeline(self, name: str, query: str = "") -> dict[str, Any]:
        """Wait for the timeline of a recording."""
        found = self.ask("GET", f"/{name}/timeline{query}", 200)
        if found["job"] is not None:
            self.jobs.wait_for(found["job"]["id"], timeout_s=60.0)
            found = self.ask("GET", f"/{name}/timeline{query}", 200)
        return dict(found["timeline"])

    def open_a_case(self) -> None:
        self.store.open(self.store.create("L4").id)


@pytest.fixture
def door(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Door]:
    consent = getattr(request, "param", "not_required")
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        config = Config.model_validate({"recording": {"min_free_gb": 0.0, "consent": consent}})
        recordings = recordings_without_process(store, config)
        jobs = Jobs(log=LogSettings(as_json=True))
        app = create_app(
            AppParts(hub=LiveHub(), config=config, store=store, recordings=recordings, jobs=jobs)
        )
        with TestClient(app, base_url="http://127.0.0.1:8000") as client:
            yield Door(client, store, jobs)
        jobs.close()


def test_without_an_open_case_nothing_is_recorded(door: Door) -> None:
    assert door.ask("GET", "/state", 200) == NOTHING
    assert door.ask("POST", "/start", 409)["code"] == "NO_CASE_OPEN"
    assert door.ask("GET", "", 409)["code"] == "NO_CASE_OPEN"


def test_a_recording_is_started_listed_stopped_downloaded_and_deleted(door: Door) -> None:
    door.open_a_case()
    started = door.ask("POST", "/start", 200)
    name = started["name"]
    assert started == {
        **NOTHING,
        "is_recording": True,
        "name": name,
        "size_bytes": 1000,
        "images": 3,
        "duration_s": started["duration_s"],
    }
    began_at = utc_text(datetime.strptime(f"{name[:16]}", "%Y%m%dT%H%M%S%z"))
    assert door.ask("GET", "", 200) == {
        "recordings": [
            {
                "name": name,
                "began_at": began_at,
                "duration_s": None,
                "size_bytes": 8,
                "is_protected": False,
                "is_running": True,
            }
        ]
    }
    assert door.ask("DELETE", f"/{name}", 409)["code"] == "RECORDING_RUNS"
    assert door.ask("POST", "/stop", 200) == {**NOTHING, "size_bytes": 1000, "images": 3}
    answer = door.client.get(f"/api/recordings/{name}/file")
    assert answer.content == b"recorded"
    assert name in answer.headers["content-disposition"]
    assert door.ask("PUT", f"/{name}/protection", 200, {"is_protected": True}) == {"is_protected": True}
    assert door.ask("DELETE", f"/{name}", 409)["code"] == "RECORDING_PROTECTED"
    door.ask("PUT", f"/{name}/protection", 200, {"is_protected": False})
    door.ask("DELETE", f"/{name}", 204)
    assert door.ask("DELETE", f"/{name}", 404)["code"] == "RECORDING_UNKNOWN"
    assert door.ask("GET", "", 200) == {"recordings": []}


def test_a_disk_that_is_too_full_answers_with_507(door: Door, monkeypatch: pytest.MonkeyPatch) -> None:
    door.open_a_case()
    monkeypatch.setattr(Home, "free_bytes", lambda _: -1)
    assert door.ask("POST", "/start", 507)["code"] == "RECORDING_DISK_FULL"


@pytest.mark.parametrize("door", ["required"], indirect=True)
def test_consent_is_answered_before_the_first_recording_of_a_case(door: Door) -> None:
    door.open_a_case()
    rejected = door.ask("POST", "/start", 409)
    assert rejected["code"] == "RECORDING_CONSENT_MISSING"
    assert rejected["remedy"]
    case = door.store.get_open_case()
    assert case is not None
    answer = {"case_id": case.id, "is_given": True}
    stored = door.ask("POST", "/consent", 200, answer)
    assert stored == {"state": "given", "answered_at": stored["answered_at"], "answered_by": "this computer"}
    assert door.ask("POST", "/start", 200)["consent"] == stored
    declined = door.ask("POST", "/consent", 200, {**answer, "is_given": False})
    assert declined["state"] == "not_given"
    assert not door.ask("GET", "/state", 200)["is_recording"]
    assert door.ask("POST", "/consent", 409, {**answer, "case_id": "0" * 16})["code"] == "CASE_NOT_OPEN"


def test_the_timeline_of_a_recording_is_made_by_a_job_once(door: Door) -> None:
    door.open_a_case()
    name = door.put_drilling()
    assert door.ask("GET", f"/{name}/instants/0", 409)["code"] == "RECORDING_NOT_INDEXED"
    timeline = door.timeline(name)
    assert len(door.jobs.list()) == 1
    assert timeline["began_at"] == "2026-01-01T00:01:40.000Z"
    assert (timeline["images"], timeline["is_whole"]) == (len(DRILLED), True)
    assert timeline["duration_s"] == pytest.approx(3.9)
    curve = timeline["curves"]["wall"]
    assert [one is None for one in curve["values"]] == [mode == "hidden" for mode in DRILLED]
    assert "through" in curve["statuses"]
    risk = timeline["curves"]["risk"]
    percent = {"path": 0.0, "hidden": None, "near": 1.0, "breach": 100.0}
    assert risk["values"] == [percent[mode] for mode in DRILLED]
    assert set(risk["limits"]) == {5.0, None}
    assert [one == "over" for one in risk["statuses"]] == [mode == "breach" for mode in DRILLED]
    assert ("alarm", "BREACH") in [(one["kind"], one["code"]) for one in timeline["events"]]
    few = door.timeline(name, "?from_s=2&to_s=3&samples=5")["curves"]
    assert len(few["at_s"]) < 10
    door.ask("DELETE", f"/{name}", 204)
    case = door.store.get_open_case()
    assert case is not None
    assert list((door.store.home.cases / case.id / "recordings").iterdir()) == []


def test_any_instant_of_a_recording_is_shown_with_its_image(door: Door) -> None:
    door.open_a_case()
    name = door.put_drilling()
    door.timeline(name)
    breach = DRILLED.index("breach") + 4
    instant = door.ask("GET", f"/{name}/instants/{breach}", 200)
    assert instant["snapshot"]["image_number"] == 1000 + breach
    assert "BREACH" in [one["condition"] for one in instant["alarms"]["alarms"]]
    for number in (breach, breach + 1):
        answer = door.client.get(f"/api/recordings/{name}/images/{number}.jpg")
        assert answer.headers["content-type"] == "image/jpeg"
        shown = cv2.imdecode(np.frombuffer(answer.content, np.uint8), cv2.IMREAD_COLOR)
        assert shown is not None
        assert shown.shape == (HEIGHT, WIDTH, 3)
        assert np.abs(shown.astype(int) - drawn(number)[0]).mean() < 2.0
    assert door.ask("GET", f"/{name}/instants/{len(DRILLED)}", 404)["code"] == "RECORDED_IMAGE_UNKNOWN"
    assert door.ask("GET", f"/{name}/images/-1.jpg", 422)["code"] == "REQUEST_INVALID"


@pytest.mark.parametrize(("at_s", "number"), [(0.0, 0), (1.26, 13), (99.0, len(DRILLED) - 1)])
def test_the_image_nearest_to_a_time_is_found(door: Door, at_s: float, number: int) -> None:
    door.open_a_case()
    name = door.put_drilling()
    door.timeline(name)
    found = door.ask("GET", f"/{name}/nearest?at_s={at_s}", 200)
    assert found == {"number": number, "at_s": pytest.approx(number / 10.0, abs=1e-5)}
    assert door.ask("GET", f"/{name}/nearest?at_s=-1", 422)["code"] == "REQUEST_INVALID"


def test_a_recording_that_runs_is_not_reviewed(door: Door) -> None:
    door.open_a_case()
    name = door.ask("POST", "/start", 200)["name"]
    assert door.ask("GET", f"/{name}/timeline", 409)["code"] == "RECORDING_RUNS"


def test_a_recording_is_exported_as_csv(door: Door) -> None:
    door.open_a_case()
    name = door.put_drilling()
    answer = door.client.get(f"/api/recordings/{name}/export/deviations.csv")
    assert answer.headers["content-type"].startswith("text/csv")
    rows = list(csv.DictReader(answer.text.splitlines()))
    assert [row["reason"] == "" for row in rows] == [mode != "hidden" for mode in DRILLED]
    assert door.ask("GET", f"/{name}/export/images.csv", 422)["code"] == "REQUEST_INVALID"


def test_a_damaged_result_costs_its_own_rows_only(door: Door) -> None:
    door.open_a_case()
    name = door.put_drilling()
    case = door.store.get_open_case()
    assert case is not None
    path = door.store.home.cases / case.id / "recordings" / name
    path.write_bytes(path.read_bytes().replace(b'"image_number":1000,', b'"image?number":1000,'))
    answer = door.client.get(f"/api/recordings/{name}/export/poses.csv")
    images = {int(row["image"]) for row in csv.DictReader(answer.text.splitlines())}
    assert images == set(range(1, len(DRILLED)))


def made(door: Door, name: str, what: str, body: object) -> dict[str, Any]:
    """Wait for an exported video or section, and return its job."""
    job = door.ask("POST", f"/{name}/{what}", 202, body)
    door.jobs.wait_for(job["id"], timeout_s=120.0)
    return dict(door.client.get(f"/api/jobs/{job['id']}").json())


def downloaded(door: Door, name: str, file: str) -> bytes:
    answer = door.client.get(f"/api/recordings/{name}/exports/{file}")
    assert answer.status_code == 200
    assert file in answer.headers["content-disposition"]
    return answer.content


def test_a_video_is_made_by_a_job_and_downloaded(door: Door) -> None:
    door.open_a_case()
    name = door.put_drilling()
    job = made(door, name, "video", {"language": "de"})
    assert job["state"] == "done", job
    assert job["progress_ratio"] == 1.0
    result = job["result"]
    assert (result["images"], result["gaps"], result["is_whole"]) == (len(DRILLED), 0, True)
    content = downloaded(door, name, result["file"])
    assert len(content) == result["size_bytes"]
    with av.open(io.BytesIO(content), "r") as video:
        assert len(list(video.decode(video=0))) == len(DRILLED)
    # The next one replaces it.
    again = made(door, name, "video", {})["result"]["file"]
    assert again != result["file"]
    assert door.ask("GET", f"/{name}/exports/{result['file']}", 404)["code"] == "EXPORT_UNKNOWN"


def test_tables_and_a_sequence_are_made_by_jobs_and_downloaded(door: Door) -> None:
    door.open_a_case()
    name = door.put_drilling()
    tables = made(door, name, "tables", None)["result"]
    with zipfile.ZipFile(io.BytesIO(downloaded(door, name, tables["file"]))) as archive:
        assert len(archive.namelist()) == 3
    sequence = made(door, name, "sequence", {"from_s": 1.0, "to_s": 1.2})["result"]
    assert (sequence["images"], sequence["file"]) == (3, f"{name[:-5]}-1.0-1.2s.igs.mha")
    assert downloaded(door, name, sequence["file"]).startswith(b"ObjectType = Image\n")
    # One file of each kind.
    assert {one["file"] for one in door.ask("GET", f"/{name}/exports", 200)["files"]} == {
        tables["file"],
        sequence["file"],
    }
    empty = made(door, name, "sequence", {"from_s": 90.0, "to_s": 91.0})
    assert empty["problem"]["code"] == "SEQUENCE_EMPTY"


def test_a_piece_is_made_by_a_job_and_deleted_with_its_recording(door: Door) -> None:
    door.open_a_case()
    name = door.put_drilling()
    job = made(door, name, "cut", {"from_s": 1.75, "to_s": 2.55})
    assert job["state"] == "done", job
    result = job["result"]
    assert (result["images"], result["is_exact"]) == (8, False)
    assert downloaded(door, name, result["file"]).startswith(b"\x89MCAP0")
    # Not a recording of the case.
    assert [one["name"] for one in door.ask("GET", "", 200)["recordings"]] == [name]
    assert made(door, name, "cut", {"from_s": 9, "to_s": 10})["problem"]["code"] == "CUT_EMPTY"
    for other in ("..", 300 * "a", "a%00b"):
        assert door.ask("GET", f"/{name}/exports/{other}", 404)["code"]
    assert list(door.store.home.temporary.iterdir()) == []
    door.ask("DELETE", f"/{name}", 204)
    case = door.store.get_open_case()
    assert case is not None
    assert list((door.store.home.cases / case.id / "recordings").iterdir()) == []


def test_what_was_made_from_a_recording_is_listed(door: Door) -> None:
    door.open_a_case()
    name = door.put_drilling()
    assert door.ask("GET", f"/{name}/exports", 200) == {"files": [], "job": None}
    piece = made(door, name, "cut", {"from_s": 1.75, "to_s": 2.55})["result"]
    job = made(door, name, "cut", {"from_s": 9, "to_s": 10})
    assert job["state"] == "failed"
    file = {"file": piece["file"], "size_bytes": piece["size_bytes"]}
    assert door.ask("GET", f"/{name}/exports", 200) == {"files": [file], "job": job}
    job = made(door, name, "cut", {"from_s": 0, "to_s": 1})
    file = {"file": job["result"]["file"], "size_bytes": job["result"]["size_bytes"]}
    assert door.ask("GET", f"/{name}/exports", 200) == {"files": [file], "job": job}
    assert door.ask("GET", f"/{name.replace('-0', '-1')}/exports", 404)["code"] == "RECORDING_UNKNOWN"


def test_nothing_is_stored_of_a_recording_that_was_deleted_meanwhile(
    door: Door, monkeypatch: pytest.MonkeyPatch
) -> None:
    door.open_a_case()
    name = door.put_drilling()
    case = door.store.get_open_case()
    assert case is not None
    folder = door.store.home.cases / case.id / "recordings"
    # From a killed job.
    (folder / f"{name}.index.npz.77").write_bytes(b"half")
    put_export = RecordingService.put_export

    def after_deletion(service: RecordingService, recording: Path, file: Path) -> Path:
        service.delete(name)
        return put_export(service, recording, file)

    monkeypatch.setattr(RecordingService, "put_export", after_deletion)
    job = made(door, name, "cut", {"from_s": 0, "to_s": 1})
    assert (job["state"], job["problem"]["code"]) == ("failed", "RECORDING_UNKNOWN")
    assert list(folder.iterdir()) == []


def test_nothing_is_made_from_a_recording_that_runs_or_on_a_full_disk(
    door: Door, monkeypatch: pytest.MonkeyPatch
) -> None:
    door.open_a_case()
    name = door.put_drilling()
    running = door.ask("POST", "/start", 200)["name"]
    assert door.ask("POST", f"/{running}/video", 409, {})["code"] == "RECORDING_RUNS"
    door.ask("POST", "/stop", 200)
    monkeypatch.setattr(Home, "free_bytes", lambda _: -1)
    assert door.ask("POST", f"/{name}/cut", 507, {"from_s": 0, "to_s": 1})["code"] == "RECORDING_DISK_FULL"
    assert list(door.store.home.temporary.iterdir()) == []


def test_a_comment_is_stored_in_the_case_and_is_in_the_timeline(door: Door) -> None:
    door.open_a_case()
    name = door.put_drilling()
    other = name.replace("0000.mcap", "0001.mcap")
    body = {"at_s": 2.5, "text": "  Wandkontakt: 1 mm medial "}
    stored = door.ask("POST", f"/{name}/comments", 201, body)
    assert stored == {
        "document_id": stored["document_id"],
        "at_s": 2.5,
        "text": "Wandkontakt: 1 mm medial",
        "made_at": stored["made_at"],
        "made_by": "this computer",
    }
    door.ask("POST", f"/{name}/comments", 201, {"at_s": 0.5, "text": "begins"})
    assert door.ask("POST", f"/{other}/comments", 404, body)["code"] == "RECORDING_UNKNOWN"
    for text in ("", " ", "two\nlines", "x" * 501):
        assert door.ask("POST", f"/{name}/comments", 422, {**body, "text": text})["code"] == "REQUEST_INVALID"

    def shown() -> list[tuple[float, str, str]]:
        events = door.timeline(name)["events"]
        assert [one["from_s"] for one in events] == sorted(one["from_s"] for one in events)
        return [(one["from_s"], one["title"]["de"], one["by"]) for one in events if one["kind"] == "comment"]

    assert shown() == [
        (0.5, "begins", "this computer"),
        (2.5, "Wandkontakt: 1 mm medial", "this computer"),
    ]
    case = door.store.get_open_case()
    assert case is not None
    document = door.store.document(case.id, stored["document_id"])
    assert document.content == {"recording": name, "at_s": 2.5, "text": "Wandkontakt: 1 mm medial"}
    door.store.withdraw(document, by="ito", reason="mistaken")
    assert len(shown()) == 1
    # It belongs to the case and stays when the recording is deleted.
    door.ask("DELETE", f"/{name}", 204)
    assert len(door.store.all(case.id, DocumentKind.COMMENT)) == 1


def test_what_is_no_recording_is_not_listed(door: Door) -> None:
    door.open_a_case()
    name = door.put_drilling()
    case = door.store.get_open_case()
    assert case is not None
    folder = door.store.home.cases / case.id / "recordings"
    (folder / "20269999T999999Z-0001.mcap").write_bytes(b"of no day")
    (folder / "20260101T000000Z-0002.mcap").mkdir()
    (folder / "copy.mcap").touch()
    assert [one["name"] for one in door.ask("GET", "", 200)["recordings"]] == [name]


def test_the_list_opens_no_file_a_second_time(door: Door, monkeypatch: pytest.MonkeyPatch) -> None:
    door.open_a_case()
    name = door.put_drilling()
    (first,) = door.ask("GET", "", 200)["recordings"]
    assert first["duration_s"] == pytest.approx(3.9, abs=0.2)

    def read(path: Path) -> float:
        assert path.name == name
        return 7.0

    monkeypatch.setattr("server.recording.service.read_duration_s", read)
    assert door.ask("GET", "", 200)["recordings"] == [first]
    # A changed file is indexed again.
    case = door.store.get_open_case()
    assert case is not None
    with (door.store.home.cases / case.id / "recordings" / name).open("ab") as file:
        file.write(b"more")
    assert door.ask("GET", "", 200)["recordings"][0]["duration_s"] == 7.0


def test_the_course_of_each_drilling_comes_from_all_recordings_of_the_case(door: Door) -> None:
    door.open_a_case()
    assert door.ask("GET", "/drillings", 200) == {"drillings": [], "job": None, "unread": [], "running": 0}
    name = door.put_drilling()
    case = door.store.get_open_case()
    assert case is not None
    damaged = door.store.home.cases / case.id / "recordings" / "20260102T000000Z-0000.mcap"
    damaged.write_bytes(b"not a recording")
    while (found := door.ask("GET", "/drillings", 200))["job"] is not None:
        door.jobs.wait_for(found["job"]["id"], timeout_s=60.0)
    assert found["unread"] == [damaged.name]
    (drilling,) = found["drillings"]
    nearest, deepest = drilling.pop("nearest"), drilling.pop("deepest")
    assert nearest["wall"]["value"] < 0.0 < nearest["wall"]["error_95"]
    assert deepest["depth"] == {"value": 29.0, "error_95": deepest["depth"]["error_95"]}
    assert drilling == {
        "recording": name,
        "is_whole": True,
        "began_at": "2026-01-01T00:01:40.000Z",
        "channel": "L3 left",
        "tool": "drill",
        "images": DRILLED.count("path") + DRILLED.count("near") + DRILLED.count("breach"),
        "from_s": 0.0,
        "to_s": pytest.approx((len(DRILLED) - 1) / 10.0),
        "at_entry": drilling["at_entry"],
        "against": "bone",
        "grade": "B",
        "worst_grade": "B",
        "missing_s": 0.9,
        "longest_missing_s": 0.9,
    }
