"""Tokens, links and passwords are in no log."""

import io
import logging
from pathlib import Path

import pytest

from server.capture.address import source_from_text
from server.logs import LogSettings, configure_logging
from server.security import Role
from tests.server.security.guarded_app import HOST, guarded

OWN = {"Origin": f"http://{HOST}"}


@pytest.fixture
def log(monkeypatch: pytest.MonkeyPatch) -> io.StringIO:
    """Everything that this process logs, with all details."""
    lines = io.StringIO()
    monkeypatch.setattr("sys.stderr", lines)
    configure_logging(LogSettings(as_json=True, debug=True))
    logging.getLogger("uvicorn.access").setLevel(logging.DEBUG)
    return lines


def test_neither_log_nor_audit_log_has_a_token(tmp_path: Path, log: io.StringIO) -> None:
    with guarded(tmp_path / "home") as house:
        invitation, wrong = house.invited(), f"{house.invited(Role.VIEWER)[:-4]}zzzz"
        signed_in = house.door.post("/api/session", json={"invitation": invitation}, headers=OWN)
        cookie = next(iter(house.door.cookies.values()))
        house.door.post("/api/session", json={"invitation": wrong}, headers=OWN)
        invited = house.door.post(
            "/api/people/invitations",
            json={"name": "Ada", "role": "viewer", "lasts_h": 1},
            headers=OWN,
        )
        bearer = house.bearer(Role.SUPERVISOR)
        house.door.get("/api/nowhere", headers=bearer)
        logging.getLogger("test").warning("this line is logged")
        audit = b"\n".join(house.people.audit.newest(100)).decode()
    assert signed_in.status_code == 200
    assert invited.status_code in {200, 201}, invited.text
    logged = log.getvalue()
    assert "this line is logged" in logged
    assert "Ada" in audit
    for token in (invitation, wrong, cookie, bearer["Authorization"][7:]):
        secret = token.rpartition(".")[2]
        assert len(secret) > 20
        assert secret not in logged
        assert secret not in audit


def test_the_password_of_a_stream_is_not_in_its_error(log: io.StringIO) -> None:
    name = source_from_text("rtsp://nurse:s3cret-word@127.0.0.1:9/live?token=another-one").name
    logging.getLogger("test").warning("the stream %s cannot be opened", name)
    assert "s3cret-word" not in log.getvalue()
    assert "another-one" not in log.getvalue()
