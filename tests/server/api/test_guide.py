"""The user guide at `/docs/`: public, under the page's policy except for its own inline scripts."""

import base64
import hashlib
import os
import subprocess
from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.api.guide import GuidePlaces, guide_folder, is_guide, mount_guide
from server.security import SecurityHeaders
from tests.server.security.guarded_app import guarded

SCRIPT = "document.title += '!'"
DATA = '<script type="application/json">{}</script>'
PAGE = f"<!doctype html><title>Guide</title><script>{SCRIPT}</script>{DATA}"
HASH = f"'sha256-{base64.b64encode(hashlib.sha256(SCRIPT.encode()).digest()).decode()}'"


@pytest.fixture
def built(tmp_path: Path) -> Path:
    (tmp_path / "alarms").mkdir()
    (tmp_path / "alarms" / "index.html").write_text("<!doctype html><title>Alarms</title>")
    (tmp_path / "index.html").write_text(PAGE)
    (tmp_path / "bundle.js").write_text("0")
    return tmp_path


def client_of(folder: Path | None, state: Path | None = None) -> TestClient:
    app = FastAPI(docs_url=None)
    app.add_middleware(SecurityHeaders)
    folders, states = (() if one is None else (one,) for one in (folder, state))
    mount_guide(app, places=GuidePlaces(folders=folders, states=states))
    return TestClient(app, base_url="http://127.0.0.1:8000")


def scripts_allowed(policy: str) -> list[str]:
    return next(part.split()[1:] for part in policy.split("; ") if part.startswith("script-src "))


def test_each_page_may_run_its_own_inline_scripts_and_no_others(built: Path) -> None:
    client = client_of(built)
    answer = client.get("/docs/")
    assert answer.text == PAGE
    assert scripts_allowed(answer.headers["content-security-policy"]) == ["'self'", HASH]
    assert scripts_allowed(client.get("/docs/alarms/").headers["content-security-policy"]) == ["'self'"]
    assert scripts_allowed(client.get("/docs/bundle.js").headers["content-security-policy"]) == ["'self'"]
    assert answer.headers["x-content-type-options"] == "nosniff"


def test_a_page_that_did_not_change_keeps_its_policy(built: Path) -> None:
    client = client_of(built)
    first = client.get("/docs/")
    assert first.headers["cache-control"] == "no-cache"
    again = client.get("/docs/", headers={"If-None-Match": first.headers["etag"]})
    assert again.status_code == 304
    assert again.headers["content-security-policy"] == first.headers["content-security-policy"]


def test_a_rebuilt_guide_has_a_new_policy(built: Path) -> None:
    client = client_of(built)
    client.get("/docs/")
    (built / "index.html").write_text("<!doctype html><title>New</title>")
    assert scripts_allowed(client.get("/docs/").headers["content-security-policy"]) == ["'self'"]


def test_an_address_without_its_slash_leads_to_the_one_with_it(built: Path) -> None:
    assert "Guide" in client_of(built).get("/docs").text
    assert "Alarms" in client_of(built).get("/docs/alarms").text


def test_files_outside_the_guide_are_not_given(built: Path) -> None:
    (built.parent / "secret.txt").write_text("secret")
    (built / "404.html").write_text("<link rel=stylesheet href=/assets/main.css>")
    assert client_of(built).get("/docs/gone/").json() == {"detail": "Not Found"}
    assert client_of(built).get("/docs/%2e%2e/secret.txt").status_code == 404


@pytest.mark.parametrize("address", ["/docs", "/docs/", "/docs/camera/"])
def test_a_missing_build_of_the_guide_states_how_to_build_it(address: str) -> None:
    answer = client_of(None).get(address)
    assert answer.status_code == 503
    assert "make docs" in answer.text
    assert "/api/docs" in answer.text


def test_a_guide_that_is_being_built_is_said_so_and_served_once_it_is_there(tmp_path: Path) -> None:
    folder, state = tmp_path / "site", tmp_path / "guide.state"
    client = client_of(folder, state)
    state.write_text(f"{os.getpid()}\n")
    folder.mkdir()
    (folder / "index.html").write_text(PAGE)
    answer = client.get("/docs/camera/")
    assert answer.status_code == 503
    assert "is being built" in answer.text
    assert "<script" not in answer.text
    state.unlink()
    assert client.get("/docs/").text == PAGE


@pytest.mark.parametrize("stated", ["failed", "999999999", "9" * 40], ids=["failed", "ended", "no process"])
def test_a_failed_build_of_the_guide_is_said_with_the_end_of_its_log(tmp_path: Path, stated: str) -> None:
    state = tmp_path / "guide.state"
    state.write_text(stated)
    (tmp_path / "guide.txt").write_text(
        "\n".join(["first line", *["more"] * 20, "link to <nowhere> is dead"])
    )
    answer = client_of(None, state).get("/docs/")
    assert answer.status_code == 503
    assert "Building it failed" in answer.text
    assert "link to &lt;nowhere&gt; is dead" in answer.text
    assert "first line" not in answer.text
    assert "make docs" in answer.text


def test_the_build_after_a_start_states_its_process_and_then_whether_it_failed(tmp_path: Path) -> None:
    script = Path(__file__).parents[3] / ".make" / "build-guide"
    state = tmp_path / ".venv" / "log" / "guide.state"
    state.parent.mkdir(parents=True)

    def build(*command: str) -> None:
        subprocess.run(["sh", str(script), *command], cwd=tmp_path, check=True)

    build("sh", "-c", "test $PPID = $(cat .venv/log/guide.state) && touch built")
    assert (tmp_path / "built").exists(), "the state has the process that builds"
    assert not state.exists()
    build("false")
    assert state.read_text() == "failed\n"


def test_the_installed_guide_comes_before_the_one_in_the_checkout(built: Path, tmp_path: Path) -> None:
    assert guide_folder((built, tmp_path / "other")) == built
    assert guide_folder((tmp_path / "other", built)) == built
    assert guide_folder((tmp_path / "other",)) is None


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("/docs", True),
        ("/docs/", True),
        ("/docs/alarms/", True),
        ("/docs/../api/cases", False),
        ("/docsets", False),
        ("/api/docs", False),
    ],
)
def test_only_what_lies_under_docs_is_the_guide(path: str, *, expected: bool) -> None:
    assert is_guide(path) is expected


def test_nobody_has_to_sign_in_to_read_the_guide(tmp_path: Path) -> None:
    with guarded(tmp_path) as house:
        assert house.door.get("/docs/").status_code in {200, 503}
        assert house.door.get("/api/docs").status_code == 401
