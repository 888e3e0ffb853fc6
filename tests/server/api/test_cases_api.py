"""Cases over HTTP."""

import sqlite3
import zipfile
from collections.abc import Callable, Iterator
from contextlib import closing
from io import BytesIO
from pathlib import Path

import httpx2
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.api import cases
from server.app import AppParts, create_app
from server.config import Config
from server.live import LiveHub
from server.store import CaseStore, DocumentKind, Home

UNKNOWN = "0" * 16


@pytest.fixture
def store(tmp_path: Path) -> Iterator[CaseStore]:
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        yield store


@pytest.fixture
def app(store: CaseStore) -> FastAPI:
    return create_app(AppParts(hub=LiveHub(), config=Config(), store=store))


@pytest.fixture
def door(app: FastAPI) -> Iterator[TestClient]:
    with TestClient(app, base_url="http://127.0.0.1:8000", raise_server_exceptions=False) as client:
        yield client


def made(door: TestClient, name: str = "one") -> str:
    return str(door.post("/api/cases", json={"name": name}).json()["id"])


def test_json_with_the_media_type_of_a_form_is_rejected_with_a_remedy(door: TestClient) -> None:
    def sent_as(content_type: str, content: str) -> str:
        answer = door.post("/api/cases", content=content, headers={"content-type": content_type})
        assert answer.status_code == 422
        return str(answer.json()["remedy"])

    assert "Content-Type: application/json" in sent_as("application/x-www-form-urlencoded", '{"name": "L3"}')
    assert "/api/docs" in sent_as("application/json", '{"nme": "L3"}')


def with_file(store: CaseStore, case_id: str, content: bytes) -> str:
    with store.new_file(case_id, ".bin") as new:
        new.path.write_bytes(content)
    store.put(case_id, DocumentKind.CT, "main", {"a": 1.5}, made_by="ito", files=[new.stored.id])
    return new.stored.id


def test_a_case_from_its_making_to_its_end(door: TestClient) -> None:
    assert door.get("/api/cases").json() == {"opened_id": None, "cases": []}
    answer = door.post("/api/cases", json={"name": "L3 🦴/left"})
    assert answer.status_code == 201
    case = answer.json()
    assert case["name"] == "L3 🦴/left"
    path = f"/api/cases/{case['id']}"
    assert door.get(path).json() == case
    assert door.post(f"{path}/open").json() == case
    assert door.get("/api/cases").json() == {"opened_id": case["id"], "cases": [case]}
    assert door.patch(path, json={"name": "two"}).json()["name"] == "two"
    rejected = door.post(f"{path}/deletion", json={"confirm": "two"})
    assert (rejected.status_code, rejected.json()["code"]) == (409, "CASE_OPEN")
    assert door.post(f"{path}/close").status_code == 200
    again = door.post(f"{path}/close")
    assert (again.status_code, again.json()["code"]) == (409, "CASE_NOT_OPEN")
    wrong = door.post(f"{path}/deletion", json={"confirm": "L3 🦴/left"})
    assert (wrong.status_code, wrong.json()["code"]) == (422, "CONFIRMATION_WRONG")
    assert door.post(f"{path}/deletion", json={"confirm": "two"}).status_code == 204
    gone = door.get(path)
    assert (gone.status_code, gone.json()["code"]) == (404, "CASE_UNKNOWN")


@pytest.mark.parametrize("name", ["", "  ", "a\nb", "x" * 201, 5, None, "\u202egnp", "\u200b", "a\u2028b"])
def test_a_name_that_cannot_be_is_rejected(door: TestClient, name: object) -> None:
    answer = door.post("/api/cases", json={"name": name})
    assert answer.status_code == 422
    assert set(answer.json()) == {"code", "message", "remedy", "context", "language"}
    assert door.get("/api/cases").json()["cases"] == []


def test_a_body_that_is_no_text_is_rejected_like_one_that_is_no_json(door: TestClient) -> None:
    for content in (b"\xff\xfe{", b"{", b'{"name": ' + b"9" * 5000 + b"}"):
        answer = door.post("/api/cases", content=content, headers={"Content-Type": "application/json"})
        assert answer.status_code == 422
        assert answer.json()["code"] == "REQUEST_INVALID"


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", ""),
        ("POST", "/open"),
        ("POST", "/close"),
        ("GET", "/archive"),
        ("GET", "/documents"),
        ("GET", f"/documents/{UNKNOWN}"),
        ("GET", "/files"),
        ("GET", "/files/..%2f..%2fcoaxial.sqlite3"),
        ("POST", "/verification"),
    ],
)
def test_what_is_not_there_is_reported(door: TestClient, method: str, path: str) -> None:
    for case_id in (UNKNOWN, "..%2f..%2fetc", "😀"):
        answer = door.request(method, f"/api/cases/{case_id}{path}")
        # A path with `..` belongs to no case but to the page, which only accepts GET.
        assert answer.status_code == 404 or (".." in case_id and answer.status_code == 405)
        assert set(answer.json()) == {"code", "message", "remedy", "context", "language"}


def test_documents_tell_what_they_stand_on_and_whether_they_hold(door: TestClient, store: CaseStore) -> None:
    case_id = made(door)
    ct = store.put(case_id, DocumentKind.CT, "main", {"voxels": [1, 2.5]}, made_by="ito")
    plan = store.put(case_id, DocumentKind.PLAN, "L3", {}, made_by="abe", depends_on=[ct.id])
    path = f"/api/cases/{case_id}/documents"
    listed = door.get(path).json()["documents"]
    assert [(one["kind"], one["version"], one["current"], one["depends_on"]) for one in listed] == [
        ("ct", 1, True, []),
        ("plan", 1, True, [ct.id]),
    ]
    assert door.get(f"{path}/{ct.id}").json()["content"] == {"voxels": [1, 2.5]}
    requested = {"by": "ito", "reason": "another patient"}
    withdrawn = door.post(f"{path}/{ct.id}/withdrawal", json=requested).json()["heading"]
    assert withdrawn["withdrawn"] == {"at": withdrawn["withdrawn"]["at"], **requested}
    assert withdrawn["current"] is False
    reported = door.get(f"{path}/{plan.id}").json()["heading"]
    assert (
        reported["out_of_date"]
        == "it depends on ct 'main' version 1, which was withdrawn by ito: another patient"
    )
    assert door.get(f"{path}/{UNKNOWN}").json()["code"] == "DOCUMENT_UNKNOWN"


def test_a_damaged_document_is_listed_and_the_version_before_it_used_on_request(
    door: TestClient, store: CaseStore
) -> None:
    case_id = made(door)
    old, lost = (store.put(case_id, DocumentKind.PLAN, "main", {"n": n}, made_by="ito") for n in (1, 2))
    with closing(sqlite3.connect(store.home.database)) as raw:
        raw.execute("DROP TRIGGER documents_never_change")
        raw.execute("UPDATE documents SET content = '{\"n\":3}' WHERE id = ?", (lost.id,))
        raw.commit()
    path = f"/api/cases/{case_id}/documents"
    headings = door.get(path).json()["documents"]
    assert [(one["version"], one["is_damaged"], one["current"]) for one in headings] == [
        (1, False, False),
        (2, True, False),
    ]
    assert headings[1]["out_of_date"] == "plan 'main' version 2 is damaged on the disk"
    answer = door.get(f"{path}/{lost.id}")
    assert (answer.status_code, answer.json()["code"]) == (503, "DOCUMENT_DAMAGED")
    restored = door.post(f"{path}/{old.id}/restoration", json={"by": "abe"}).json()
    assert (restored["heading"]["version"], restored["heading"]["made_by"]) == (3, "abe")
    assert restored["heading"]["current"]
    assert restored["content"] == {"n": 1}
    again = door.post(f"{path}/{old.id}/restoration", json={"by": "abe"})
    assert (again.status_code, again.json()["code"]) == (409, "NOT_RESTORABLE")


def test_a_case_goes_out_and_comes_in(door: TestClient, store: CaseStore) -> None:
    case_id = made(door, "Beeblebrox")
    file_id = with_file(store, case_id, bytes(range(256)) * 1000)
    answer = door.get(f"/api/cases/{case_id}/archive")
    assert answer.headers["content-type"] == "application/zip"
    assert "Beeblebrox" not in str(answer.headers)
    assert int(answer.headers["content-length"]) == len(answer.content)
    assert "manifest.json" in zipfile.ZipFile(BytesIO(answer.content)).namelist()
    assert list(store.home.temporary.iterdir()) == []
    taken = door.post("/api/cases/archive", content=answer.content)
    assert taken.status_code == 201
    assert (taken.json()["name"], taken.json()["copied_from"]) == (f"Case {case_id[:6]}", case_id)
    path = f"/api/cases/{taken.json()['id']}"
    assert [one["id"] for one in door.get(f"{path}/files").json()["files"]] == [file_id]
    assert door.get(f"{path}/files/{file_id}").content == bytes(range(256)) * 1000
    assert door.get(f"{path}/files/{file_id}", headers={"Range": "bytes=1-2"}).content == b"\x01\x02"
    assert list(store.home.temporary.iterdir()) == []
    named = door.get(f"/api/cases/{case_id}/archive?with_identity=true").content
    assert door.post("/api/cases/archive", content=named).json()["name"] == "Beeblebrox"


def test_damage_is_found_and_reported(door: TestClient, store: CaseStore) -> None:
    case_id = made(door)
    file_id = with_file(store, case_id, b"content")
    path = f"/api/cases/{case_id}"
    assert door.post(f"{path}/verification").json() == {"sound": True, "damages": []}
    store.file(case_id, file_id).path.unlink()
    (damage,) = door.post(f"{path}/verification").json()["damages"]
    assert (damage["problem"], damage["documents"]) == ("missing", ["ct 'main' version 1"])
    answer = door.post(f"{path}/verification", headers={"Accept-Language": "de"})
    (damage,) = answer.json()["damages"]
    assert damage["message"].startswith(f"die Datei {file_id} ist nicht lesbar: ")
    assert damage["documents"] == ["CT „main“ Version 1"]
    for requested in ("archive", f"files/{file_id}"):
        answer = door.get(f"{path}/{requested}")
        assert (answer.status_code, answer.json()["code"]) == (503, "FILE_DAMAGED")
    answer = door.get(f"{path}/archive?without_damaged=true")
    assert answer.headers["coaxial-missing"] == "1"
    assert f'filename="coaxial-case-{case_id[:6]}-incomplete.zip"' in answer.headers["content-disposition"]
    taken = door.post("/api/cases/archive", content=answer.content).json()
    assert [(one["file_id"], one["documents"]) for one in taken["damages"]] == [
        (file_id, ["ct 'main' version 1"])
    ]


@pytest.mark.parametrize(
    ("content", "status", "code"),
    [(b"no zip", 422, "ARCHIVE_INVALID"), (b"", 422, "UPLOAD_EMPTY"), (b"x" * 2000, 413, "UPLOAD_TOO_LARGE")],
)
def test_an_upload_that_cannot_be_leaves_nothing_behind(
    door: TestClient,
    store: CaseStore,
    monkeypatch: pytest.MonkeyPatch,
    content: bytes,
    status: int,
    code: str,
) -> None:
    monkeypatch.setattr(cases, "MAX_ARCHIVE_BYTES", 1000)

    def in_pieces() -> Iterator[bytes]:
        # Without a length that could be trusted in advance.
        yield from (content[at : at + 300] for at in range(0, len(content), 300))

    for body in (content, in_pieces()):
        answer = door.post("/api/cases/archive", content=body)
        assert (answer.status_code, answer.json()["code"]) == (status, code)
    assert list(store.home.temporary.iterdir()) == []
    assert store.list() == ()


def test_a_download_goes_on_when_its_case_is_deleted(
    app: FastAPI, store: CaseStore, serve: Callable[[FastAPI], int]
) -> None:
    port = serve(app)
    case = store.create("one")
    content = bytes(range(256)) * 40_000
    file_id = with_file(store, case.id, content)
    base = f"http://127.0.0.1:{port}/api/cases/{case.id}"
    for path in ("archive", f"files/{file_id}"):
        with httpx2.stream("GET", f"{base}/{path}") as answer:
            pieces = answer.iter_bytes()
            first = next(pieces)
            if path != "archive":
                store.delete(case.id, confirm="one")
            whole = first + b"".join(pieces)
            assert len(whole) == int(answer.headers["content-length"])
    assert whole == content


def test_a_full_disk_has_a_status_of_its_own(door: TestClient, store: CaseStore) -> None:
    pool = store._database._engine.raw_connection()
    pool.driver_connection.execute("PRAGMA max_page_count = 1")  # pyrefly: ignore[missing-attribute]  # SQLite's own
    pool.close()
    while (answer := door.post("/api/cases", json={"name": "x" * 200})).status_code == 201:
        pass
    assert (answer.status_code, answer.json()["code"]) == (507, "STORE_FULL")
