"""The page's files have the right cache lifetimes; a page that is not built states how to build it."""

from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.api.page import mount_page, page_folder


@pytest.fixture
def built(tmp_path: Path) -> Path:
    (tmp_path / "assets").mkdir()
    (tmp_path / "index.html").write_text("<!doctype html><title>Coaxial</title>")
    (tmp_path / "assets" / "index-4f3a.js").write_text("0")
    return tmp_path


def test_the_page_is_asked_for_again_and_its_hashed_files_are_kept(built: Path) -> None:
    app = FastAPI()
    mount_page(app, camera="main", folder=built)
    client = TestClient(app)
    assert client.get("/").headers["cache-control"] == "no-cache"
    assert "<title>Coaxial</title>" in client.get("/").text
    assert "immutable" in client.get("/assets/index-4f3a.js").headers["cache-control"]
    assert client.get("/assets/gone.js").status_code == 404


@pytest.mark.parametrize("address", ["/theatre", "/operator", "/operator/plan", "/supervisor", "/enter"])
def test_every_view_of_the_page_has_an_address_of_its_own(built: Path, address: str) -> None:
    app = FastAPI()
    mount_page(app, camera="main", folder=built)
    answer = TestClient(app).get(address)
    assert "<title>Coaxial</title>" in answer.text
    assert answer.headers["cache-control"] == "no-cache"
    assert TestClient(app).get("/nonsense").status_code == 404


def test_files_outside_the_page_are_not_given(built: Path) -> None:
    (built.parent / "secret.txt").write_text("secret")
    app = FastAPI()
    mount_page(app, camera="main", folder=built)
    assert TestClient(app).get("/%2e%2e/secret.txt").status_code == 404


def test_a_missing_build_of_the_page_states_how_to_build_it() -> None:
    app = FastAPI()
    mount_page(app, camera="main", folder=None)
    answer = TestClient(app).get("/")
    assert answer.status_code == 503
    assert "make run" in answer.text
    assert "/video/main.mjpg" in answer.text


def test_the_installed_page_comes_before_the_one_in_the_checkout(built: Path, tmp_path: Path) -> None:
    assert page_folder((built, tmp_path / "other")) == built
    assert page_folder((tmp_path / "other", built)) == built
    assert page_folder((tmp_path / "other",)) is None
