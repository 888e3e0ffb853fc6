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


@pytest.mark.parametrize("as_json", [True, False], ids=["json", "terminal"])
def test_an_unexpected_error_while_signing_in_logs_no_token(
    tmp_path: Path, log: io.StringIO, monkeypatch: pytest.MonkeyPatch, as_json: bool
) -> None:
    monkeypatch.setattr("sys.stderr", log)
    configure_logging(LogSettings(as_json=as_json, debug=True))

    def fail(_service: object, _shown: str, *, address: str) -> None:
        del address
        raise ZeroDivisionError("nobody expected this")

    with guarded(tmp_path / "home") as house:
        invitation = house.invited()
        monkeypatch.setattr("server.security.people.service.PeopleService.sign_in", fail)
        answer = house.door.post("/api/session", json={"invitation": invitation}, headers=OWN)
    assert answer.status_code == 500
    # A traceback with the values of variables would have the token.
    assert "nobody expected this" in log.getvalue()
    assert invitation.rpartition(".")[2] not in log.getvalue()
