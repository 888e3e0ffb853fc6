"""Access control: cookies, cross-site requests, audit entries, sessions that end during a stream."""

import asyncio
import json
from collections.abc import Iterator
from pathlib import Path

import httpx2
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from server.security import Role
from server.security.audit import AuditLog, Entry
from server.security.audited_response import run_audited
from server.security.person import LOCAL_USER
from tests.served import served
from tests.server.security.guarded_app import HOST, Guarded, guarded, people_of

OWN = {"Origin": f"http://{HOST}"}


@pytest.fixture
def house(tmp_path: Path) -> Iterator[Guarded]:
    with guarded(tmp_path / "home") as house:
        yield house


def enter(house: Guarded, token: str, **headers: str) -> httpx2.Response:
    answer: httpx2.Response = house.door.post(
        "/api/session", json={"invitation": token}, headers={**OWN, **headers}
    )
    return answer


def last_line(house: Guarded) -> dict[str, object]:
    reported: dict[str, object] = json.loads(house.people.audit.newest(1)[0])
    return reported


def test_signing_in_gives_a_cookie_that_scripts_and_strangers_do_not_get(house: Guarded) -> None:
    answer = enter(house, house.invited())
    cookie = answer.headers["set-cookie"]
    assert cookie.startswith("coaxial-8000=")
    assert set(cookie.split("; ")[1:]) == {"Path=/", "HttpOnly", "SameSite=Strict", "Max-Age=43200"}
    assert answer.json()["token"] is None
    assert house.door.get("/api/session").json()["role"] == "operator"
    assert last_line(house)["changes"] == [
        {"what": "session", "name": "operator", "from": None, "to": "operator"}
    ]


def test_a_session_that_was_there_before_is_another_one_after_signing_in(house: Guarded) -> None:
    enter(house, house.invited())
    before = dict(house.door.cookies)
    enter(house, house.invited(Role.VIEWER))
    assert dict(house.door.cookies) != before
    assert [one.person.role for one in house.people.sessions()] == [Role.VIEWER]
    # A foreign cookie is not adopted.
    house.door.cookies.clear()
    house.door.cookies.set("coaxial-8000", "0" * 12 + "." + "A" * 43)
    assert enter(house, house.invited()).status_code == 200


def test_a_machine_gets_a_token_and_no_cookie(house: Guarded) -> None:
    answer = enter(house, house.invited(Role.SUPERVISOR, for_machine=True))
    assert "set-cookie" not in answer.headers
    bearer = {"Authorization": f"Bearer {answer.json()['token']}"}
    assert house.door.get("/metrics", headers=bearer).status_code == 200
    assert house.door.get("/metrics").status_code == 401


def test_signing_out_ends_the_session_itself(house: Guarded) -> None:
    enter(house, house.invited())
    stored = dict(house.door.cookies)
    assert house.door.delete("/api/session", headers=OWN).status_code == 204
    house.door.cookies.update(stored)
    reported = house.door.get("/api/session")
    assert (reported.status_code, reported.json()["code"]) == (401, "SESSION_EXPIRED")
    assert house.door.get("/").status_code in {200, 503}


@pytest.mark.parametrize(
    "headers",
    [
        pytest.param({}, id="a change without an origin"),
        pytest.param({"Origin": "http://evil.example"}, id="another site"),
        pytest.param({"Origin": "http://127.0.0.1:9000"}, id="another port of this host"),
        pytest.param({**OWN, "Sec-Fetch-Site": "same-site"}, id="another port, as the browser says"),
        pytest.param({**OWN, "Sec-Fetch-Site": "cross-site"}, id="another site, as the browser says"),
        pytest.param({"Origin": "null"}, id="a page without origin"),
    ],
)
def test_a_cookie_alone_changes_nothing_for_another_page(house: Guarded, headers: dict[str, str]) -> None:
    enter(house, house.invited())
    reported = house.door.post("/api/cases", json={"name": "L3"}, headers=headers)
    assert (reported.status_code, reported.json()["code"]) == (403, "ORIGIN_REJECTED")
    assert house.store.list() == ()


def test_a_proxys_statement_on_tls_is_trusted_only_if_configured(tmp_path: Path) -> None:
    says = {"X-Forwarded-Proto": "https", "X-Forwarded-For": "203.0.113.9"}
    with guarded(tmp_path / "a") as house:
        assert "Secure" not in enter(house, house.invited(), **says).headers["set-cookie"]
    settings = {"server": {"behind_proxy": "a proxy speaks TLS for this server"}}
    with guarded(tmp_path / "b", settings=settings) as house:
        cookie = enter(house, house.invited(), **says).headers["set-cookie"]
        assert cookie.startswith("__Host-coaxial-8000=")
        assert "Secure" in cookie
        assert "203.0.113.9" not in house.people.audit.complete_lines().decode()


def test_too_many_wrong_links_are_rejected_with_a_wait(house: Guarded) -> None:
    for _ in range(10):
        assert enter(house, "x").json()["code"] == "INVITATION_UNKNOWN"
    reported = enter(house, "x")
    assert (reported.status_code, reported.json()["code"]) == (429, "TOO_MANY_TRIES")
    assert reported.headers["retry-after"] == "60"
    assert enter(house, house.invited()).status_code == 200
    house.door.cookies.clear()
    assert house.door.get("/api/live", headers={"Authorization": "Bearer x"}).headers["retry-after"] == "60"


def test_what_is_changed_is_written_with_who_and_from_what_to_what(house: Guarded) -> None:
    operator = house.bearer()
    case = house.door.post("/api/cases", json={"name": "Doe, J."}, headers=operator).json()["id"]
    line = last_line(house)
    assert line["who"] == {**line["who"], "name": "operator", "role": "operator"}  # pyrefly: ignore[invalid-argument]
    assert (line["what"], line["status"]) == ("POST /api/cases", 201)
    assert line["changes"] == [{"what": "case", "case_id": case, "from": None, "to": "here"}]
    house.door.post(f"/api/cases/{case}/open", headers=operator)
    assert last_line(house)["of"] == {"case_id": case}
    assert "Doe" not in house.people.audit.complete_lines().decode()
    before = house.people.audit.head.count
    house.door.get("/api/cases", headers=operator)
    house.door.post("/api/alarms/screens", json={"screen": "theatre-01", "state": "armed"}, headers=operator)
    assert house.people.audit.head.count == before


def test_rejected_tries_are_written_and_opening_the_page_is_none(house: Guarded) -> None:
    house.door.get("/api/live")
    assert house.people.audit.head.count == 0
    house.door.post("/api/cases", json={"name": "L3"}, headers=house.bearer(Role.VIEWER))
    line = last_line(house)
    assert (line["what"], line["status"], line["code"]) == ("POST /api/cases", 403, "ROLE_REJECTED")
    house.door.get("/api/live", headers={"Authorization": "Bearer x"})
    assert last_line(house)["code"] == "SESSION_EXPIRED"
    enter(house, "x")
    assert last_line(house)["code"] == "INVITATION_UNKNOWN"


def test_an_acknowledgement_is_by_the_sessions_user_whatever_the_page_sends(house: Guarded) -> None:
    screen = house.bearer(Role.SCREEN)
    house.door.post("/api/alarms/pause", json={"by": "somebody else", "seconds": 10}, headers=screen)
    lines = house.door.get("/api/alarms/log", headers=house.bearer()).json()["lines"]
    assert "somebody else" not in json.dumps(lines)


def test_where_the_disk_is_full_it_is_said_what_was_done_and_nothing_more_is_begun(
    house: Guarded, monkeypatch: pytest.MonkeyPatch
) -> None:
    operator = house.bearer()

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(AuditLog, "_write", full)
    reported = house.door.post("/api/cases", json={"name": "one"}, headers=operator)
    assert (reported.status_code, reported.json()["code"]) == (507, "AUDIT_NOT_WRITTEN")
    assert len(house.store.list()) == 1
    reported = house.door.post("/api/cases", json={"name": "two"}, headers=operator)
    assert (reported.status_code, reported.json()["code"]) == (507, "STORE_FULL")
    assert len(house.store.list()) == 1
    # Actions that must not wait for a disk are executed.
    reported = house.door.post("/api/alarms/hold", json={}, headers=operator)
    assert reported.json()["code"] == "AUDIT_NOT_WRITTEN"
    seen = house.door.get("/api/alarms", headers=operator).json()["alarms"]
    assert [alarm["condition"] for alarm in seen] == ["HOLD_REQUESTED"]
    monkeypatch.undo()
    house.door.post("/api/cases", json={"name": "three"}, headers=operator)
    said = [json.loads(line)["what"] for line in house.people.audit.newest(10)]
    assert said == ["POST /api/cases", "POST /api/alarms/hold", "POST /api/cases"]


def test_a_session_that_ends_takes_its_sockets_and_pictures_with_it(house: Guarded) -> None:
    with served(house.app, begun=True) as port:
        viewer, other = house.token(Role.VIEWER), house.bearer(Role.VIEWER)
        headers = {"Authorization": f"Bearer {viewer}"}
        address = f"ws://127.0.0.1:{port}"
        with (
            connect(f"{address}/ws/live", additional_headers=headers, proxy=None) as live,
            connect(f"{address}/ws/view", additional_headers=headers, proxy=None) as view,
            connect(f"{address}/ws/live", additional_headers=other, proxy=None) as stays,
            httpx2.Client(base_url=f"http://127.0.0.1:{port}", timeout=10) as door,
            door.stream("GET", "/video/main.mjpg", headers=headers) as video,
        ):
            pictures = video.iter_raw()
            assert next(pictures)
            house.clock.passes(hours=1)
            house.people.end_session(viewer.partition(".")[0])
            for socket in (live, view):
                with pytest.raises(ConnectionClosed) as closed:
                    socket.recv(timeout=2)
                assert closed.value.rcvd is not None
                assert (closed.value.rcvd.code, closed.value.rcvd.reason) == (4401, "SESSION_EXPIRED")
            with pytest.raises(httpx2.HTTPError):
                for _ in pictures:
                    pass
            assert stays.ping().wait(5)
            with pytest.raises(InvalidStatus) as rejected:
                connect(f"{address}/ws/live", additional_headers=headers, proxy=None)
            assert rejected.value.response.status_code == 401
            house.clock.passes(hours=11)
            with pytest.raises(ConnectionClosed):
                stays.recv(timeout=2)


def test_a_socket_with_a_cookie_must_say_its_page(house: Guarded) -> None:
    with served(house.app, begun=True) as port:
        cookie = {"Cookie": f"coaxial-{port}={house.token(Role.VIEWER)}"}
        address, own = f"ws://127.0.0.1:{port}/ws/live", f"http://127.0.0.1:{port}"
        with connect(address, additional_headers={**cookie, "Origin": own}, proxy=None):
            pass
        for headers in (cookie, {**cookie, "Origin": "http://127.0.0.1:1"}):
            with pytest.raises(InvalidStatus) as rejected:
                connect(address, additional_headers=headers, proxy=None)
            assert rejected.value.response.status_code == 403


def test_without_sign_in_everything_is_open_and_still_logged(tmp_path: Path) -> None:
    with guarded(tmp_path / "home", required=False) as house:
        assert house.door.get("/api/session").json()["sign_in_required"] is False
        assert house.door.post("/api/cases", json={"name": "L3"}).status_code == 201
        assert last_line(house)["who"] == {"id": "anybody", "name": "this computer", "role": "operator"}
        reported = house.door.post("/api/people/invitations", json={"name": "x", "role": "viewer"})
        assert (reported.status_code, reported.json()["code"]) == (409, "SIGN_IN_OFF")
        assert enter(house, "x").json()["code"] == "SIGN_IN_OFF"


def test_what_was_done_for_somebody_who_has_gone_is_written(tmp_path: Path) -> None:
    async def left(*_: object) -> None:
        raise asyncio.CancelledError

    async def nobody(*_: object) -> None:
        raise AssertionError("there is nobody left to tell")

    log = AuditLog(tmp_path)
    entry = Entry(who=LOCAL_USER, what="POST /api/cases")

    async def ask() -> None:
        with pytest.raises(asyncio.CancelledError):
            await run_audited(left, {}, left, nobody, audit=log, entry=entry)  # pyrefly: ignore[bad-argument-type]

    asyncio.run(ask())
    assert log.head.count == 1


def test_an_invitation_is_a_link_and_a_picture_of_it(house: Guarded) -> None:
    enter(house, house.invited())
    requested = {"name": "Dr. Ito", "role": "supervisor", "lasts_h": 2}
    reported = house.door.post("/api/people/invitations", json=requested, headers=OWN).json()
    address, _, token = reported["link"].partition("#")
    assert address == f"http://{HOST}/enter"
    assert reported["qr_svg"].startswith("<svg")
    assert reported["is_reachable"] is False
    assert token not in house.people.audit.complete_lines().decode()
    everybody = house.door.get("/api/people").json()
    assert "Dr. Ito" in [one["name"] for one in everybody["invitations"]]
    assert [one["is_own"] for one in everybody["sessions"]] == [True]
    entered = enter(house, token).json()
    assert (entered["name"], entered["role"]) == ("Dr. Ito", "supervisor")


def test_an_operator_signs_in_on_a_full_disk_to_make_room(
    house: Guarded, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    operator, viewer = house.invited(), house.invited(Role.VIEWER)
    before = house.people.audit.head.count

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as disk:
        disk.setattr(AuditLog, "_write", full)
        disk.setattr("server.security.people.service.write_people", full)
        assert (reported := enter(house, viewer)).status_code == 507, reported.text
        reported = enter(house, operator)
        assert (reported.status_code, reported.json()["role"]) == (200, "operator")
        assert house.door.get("/api/cases").status_code == 200
        reported = house.door.post(
            "/api/people/invitations", json={"name": "x", "role": "viewer"}, headers=OWN
        )
        assert (reported.status_code, reported.json()["code"]) == (507, "STORE_FULL")
    house.people.audit.catch_up()
    assert house.people.audit.head.count > before
    # They are stored with the next change.
    house.invited(Role.VIEWER)
    again = people_of(tmp_path / "home" / "security", house.clock)
    assert [one.person.role for one in again.sessions()] == [Role.OPERATOR]


@pytest.mark.parametrize(
    "requested",
    [
        pytest.param({"name": "\u202eDr. Ito"}, id="a letter that turns the others"),
        pytest.param({"name": "\u200b"}, id="nothing that is seen"),
        pytest.param({"session_lasts_h": 1e-10}, id="over before it begins"),
    ],
)
def test_nobody_is_invited_whose_deeds_could_not_be_kept(
    house: Guarded, requested: dict[str, object]
) -> None:
    wanted = {"name": "Dr. Ito", "role": "viewer", **requested}
    reported = house.door.post("/api/people/invitations", json=wanted, headers=house.bearer())
    assert reported.status_code == 422
    assert reported.json()["remedy"]
    assert "Dr. Ito" not in [one.person.name for one, _ in house.people.invitations()]


def test_a_name_is_kept_in_the_one_way_to_write_it(house: Guarded) -> None:
    wanted = {"name": " Mu\u0308ller", "role": "viewer", "session_lasts_h": 0.05}
    reported = house.door.post("/api/people/invitations", json=wanted, headers=house.bearer()).json()
    assert reported["invitation"]["name"] == "M\u00fcller"
    assert enter(house, reported["link"].partition("#")[2]).json()["name"] == "M\u00fcller"


def test_invitations_are_taken_back_and_sessions_ended_by_the_operator(house: Guarded) -> None:
    operator, guest = house.bearer(), house.token(Role.VIEWER, single_use=False)
    session = guest.partition(".")[0]
    (invitation,) = [one.id for one, _ in house.people.invitations() if one.person.role is Role.VIEWER]
    gone = house.door.delete(f"/api/people/sessions/{session}", headers=operator)
    assert gone.status_code == 204
    assert house.door.delete(f"/api/people/sessions/{session}", headers=operator).status_code == 404
    assert house.door.delete(f"/api/people/invitations/{invitation}", headers=operator).status_code == 204
    reported = house.door.get("/api/live", headers={"Authorization": f"Bearer {guest}"})
    assert reported.json()["code"] == "SESSION_EXPIRED"


def test_the_log_is_read_and_taken_along_by_overseers(house: Guarded) -> None:
    supervisor = house.bearer(Role.SUPERVISOR)
    house.door.post("/api/cases", json={"name": "L3"}, headers=house.bearer())
    reported = house.door.get("/api/audit", headers=supervisor).json()
    assert reported["is_intact"]
    assert reported["lines"][-1]["what"] == "POST /api/cases"
    exported = house.door.get("/api/audit/export", headers=supervisor)
    assert exported.headers["content-disposition"].startswith("attachment")
    assert exported.content.startswith(house.people.audit.complete_lines().splitlines()[0])
    assert last_line(house)["what"] == "GET /api/audit/export"
