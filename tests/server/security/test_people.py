"""Invitations and sessions: who can sign in, for how long, and who no longer can."""

import errno
import json
import os
import re
import threading
from datetime import timedelta
from pathlib import Path

import pytest

from server.security import PeopleService, Role
from server.security.people import Token, retention
from server.security.people.service import PEOPLE_FILE, NewInvitation
from server.security.rejections import (
    InvitationRejected,
    PeopleRejected,
    PersonUnknown,
    SessionRejected,
    TooManyTries,
)
from server.store import StoreError
from tests.server.security.guarded_app import Clock, people_of

HERE = "192.0.2.7"


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def service(tmp_path: Path, clock: Clock) -> PeopleService:
    return people_of(tmp_path, clock)


def invited(service: PeopleService, *, role: Role = Role.VIEWER, single_use: bool = True) -> str:
    wanted = NewInvitation(name="Dr. Ito", role=role, lasts=timedelta(hours=1), single_use=single_use)
    return service.invite(wanted, by="test")[1].text


def test_an_invitation_lets_in_once_with_its_name_and_role(service: PeopleService) -> None:
    link = invited(service, role=Role.SUPERVISOR)
    session, token = service.sign_in(link, address=HERE)
    assert service.session_of(token.text, address=HERE) == session
    assert (session.person.name, session.person.role) == ("Dr. Ito", Role.SUPERVISOR)
    with pytest.raises(InvitationRejected) as rejected:
        service.sign_in(link, address=HERE)
    assert rejected.value.code == "INVITATION_USED"


def test_who_invited_somebody_is_known_of_them_over_a_restart(tmp_path: Path, clock: Clock) -> None:
    link = invited(people_of(tmp_path, clock))
    _, token = people_of(tmp_path, clock).sign_in(link, address=HERE)
    assert people_of(tmp_path, clock).session_of(token.text, address=HERE).person.invited_by == "test"
    # A legacy invitation without a stored author.
    link, file = invited(people_of(tmp_path, clock)), tmp_path / PEOPLE_FILE
    older = json.loads(file.read_bytes())
    for one in (*older["invitations"], *older["sessions"]):
        del one["person"]["invited_by"]
    file.write_text(json.dumps(older))
    assert people_of(tmp_path, clock).sign_in(link, address=HERE)[0].person.invited_by == "test"
    assert people_of(tmp_path, clock).session_of(token.text, address=HERE).person.invited_by == ""


def test_one_for_many_lets_in_many_as_the_same_person_until_its_time_is_over(
    service: PeopleService, clock: Clock
) -> None:
    link = invited(service, single_use=False)
    first, second = service.sign_in(link, address=HERE)[0], service.sign_in(link, address=HERE)[0]
    assert first.id != second.id
    assert first.person == second.person
    clock.passes(hours=1)
    with pytest.raises(InvitationRejected) as rejected:
        service.sign_in(link, address=HERE)
    assert rejected.value.code == "INVITATION_EXPIRED"


def test_a_withdrawn_invitation_admits_nobody_and_keeps_its_sessions(service: PeopleService) -> None:
    link = invited(service, single_use=False)
    session, _ = service.sign_in(link, address=HERE)
    service.revoke(session.invitation_id)
    assert service.is_valid(session.id)
    with pytest.raises(InvitationRejected) as rejected:
        service.sign_in(link, address=HERE)
    assert rejected.value.code == "INVITATION_REVOKED"


def test_a_session_ends_by_the_clock_and_when_somebody_ends_it(service: PeopleService, clock: Clock) -> None:
    session, token = service.sign_in(invited(service), address=HERE)
    other, other_token = service.sign_in(invited(service), address=HERE)
    service.end_session(other.id)
    assert not service.is_valid(other.id)
    clock.passes(hours=11, minutes=59)
    assert service.is_valid(session.id)
    clock.passes(minutes=1)
    for shown in (token, other_token):
        with pytest.raises(SessionRejected) as rejected:
            service.session_of(shown.text, address=HERE)
        assert rejected.value.code == "SESSION_EXPIRED"
    with pytest.raises(PersonUnknown):
        service.end_session(session.id)


def test_sessions_and_invitations_outlast_a_restart_and_the_disk_opens_nothing(
    service: PeopleService, tmp_path: Path, clock: Clock
) -> None:
    link = invited(service, single_use=False)
    session, token = service.sign_in(link, address=HERE)
    again = people_of(tmp_path, clock)
    assert again.session_of(token.text, address=HERE) == session
    assert again.sign_in(link, address=HERE)[0].person == session.person
    stored = tmp_path / "people.json"
    assert stored.stat().st_mode & 0o077 == 0
    for secret in (link, token.text):
        assert Token.read(secret) is not None
        assert secret.partition(".")[2] not in stored.read_text()


def test_a_right_name_with_a_wrong_secret_opens_nothing(service: PeopleService) -> None:
    session, token = service.sign_in(invited(service), address=HERE)
    wrong = f"{session.id}.{'A' * 43}"
    assert wrong != token.text
    with pytest.raises(SessionRejected):
        service.session_of(wrong, address=HERE)


def test_failed_logins_are_limited_by_address_and_wait_a_minute(service: PeopleService, clock: Clock) -> None:
    link = invited(service)
    for number in range(10):
        with pytest.raises(InvitationRejected):
            service.sign_in(f"{number:012x}.{'A' * 43}", address=HERE)
        clock.passes(seconds=1)
    with pytest.raises(TooManyTries) as reported:
        service.sign_in("x", address=HERE)
    assert reported.value.context == {"wait_s": 50}
    with pytest.raises(TooManyTries):
        service.session_of("nonsense", address=HERE)
    # That delays neither other addresses, nor valid links, nor existing sessions.
    with pytest.raises(InvitationRejected):
        service.sign_in("x", address="192.0.2.8")
    session, token = service.sign_in(link, address=HERE)
    assert service.session_of(token.text, address=HERE) == session
    with pytest.raises(InvitationRejected) as used:
        service.sign_in(link, address=HERE)
    assert used.value.code == "INVITATION_USED"
    clock.passes(seconds=50)
    with pytest.raises(InvitationRejected):
        service.sign_in("x", address=HERE)


def test_failed_logins_from_everywhere_are_limited_together(service: PeopleService) -> None:
    for number in range(100):
        with pytest.raises(SessionRejected):
            service.session_of("x", address=f"192.0.2.{number}")
    with pytest.raises(TooManyTries):
        service.session_of("x", address="198.51.100.1")


def test_neighbours_in_one_network_of_the_new_kind_count_as_one(service: PeopleService) -> None:
    for number in range(10):
        with pytest.raises(SessionRejected):
            service.session_of("x", address=f"2001:db8::{number}")
    with pytest.raises(TooManyTries):
        service.session_of("x", address="2001:db8::ffff")
    with pytest.raises(SessionRejected):
        service.session_of("x", address="2001:db8:0:1::1")


def test_the_operators_link_comes_until_an_operator_is_in_and_the_old_one_ends(
    service: PeopleService, clock: Clock
) -> None:
    first = service.operator_token(wanted=False)
    second = service.operator_token(wanted=False)
    assert first is not None
    assert second is not None
    with pytest.raises(InvitationRejected) as rejected:
        service.sign_in(first.text, address=HERE)
    assert rejected.value.code == "INVITATION_REVOKED"
    session, _ = service.sign_in(second.text, address=HERE)
    assert session.person.role is Role.OPERATOR
    assert service.operator_token(wanted=False) is None
    assert service.operator_token(wanted=True) is not None
    clock.passes(hours=13)
    assert service.operator_token(wanted=False) is not None


def test_what_ended_long_ago_is_forgotten(service: PeopleService, tmp_path: Path, clock: Clock) -> None:
    service.sign_in(invited(service), address=HERE)
    clock.passes(days=4)
    invited(service)
    stored = json.loads((tmp_path / "people.json").read_text())
    assert (len(stored["sessions"]), len(stored["invitations"])) == (0, 1)


def test_a_damaged_file_is_reported(service: PeopleService, tmp_path: Path, clock: Clock) -> None:
    invited(service)
    stored = (tmp_path / "people.json").read_text()
    for damaged in (
        '{"form": 1, "invitations": [{}]}',
        "[" * 100_000,
        stored.replace('"uses": 0', '"uses": 1e999'),
        re.sub(r'"person": \{[^}]*\}', '"person": "Ito"', stored),
    ):
        (tmp_path / "people.json").write_text(damaged)
        with pytest.raises(StoreError) as reported:
            people_of(tmp_path, clock)
        assert reported.value.code == "PEOPLE_DAMAGED"


def test_ended_sessions_make_room_and_the_operator_gets_in_however_many_there_are(
    service: PeopleService, tmp_path: Path, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(retention, "MAX_RECORDS", 12)
    link = invited(service, single_use=False)
    active, _ = service.sign_in(link, address=HERE)
    for _ in range(30):
        clock.passes(seconds=1)
        last = service.end_session(service.sign_in(link, address=HERE)[0].id)
    there = json.loads((tmp_path / "people.json").read_text())
    assert len(there["sessions"]) + len(there["invitations"]) == 12
    assert {active.id, last.id} <= {one["id"] for one in there["sessions"]}
    # Used links are removed too; only when valid ones fill the limit is an invitation rejected.
    service.sign_in(invited(service), address=HERE)
    for _ in range(9):
        invited(service)
    with pytest.raises(PeopleRejected) as reported:
        invited(service)
    assert reported.value.code == "TOO_MANY_PEOPLE"
    with pytest.raises(PeopleRejected):
        service.sign_in(link, address=HERE)
    service.end_session(active.id)
    invited(service)
    again = people_of(tmp_path, clock)
    token = again.operator_token(wanted=False)
    assert token is not None
    assert again.sign_in(token.text, address=HERE)[0].person.role is Role.OPERATOR


def test_one_link_lets_in_twenty_at_a_time(service: PeopleService) -> None:
    link = invited(service, single_use=False)
    sessions = [service.sign_in(link, address=HERE)[0] for _ in range(20)]
    with pytest.raises(InvitationRejected) as rejected:
        service.sign_in(link, address=HERE)
    assert rejected.value.code == "INVITATION_FULL"
    assert "20 sessions are signed in by this link" in rejected.value.message
    assert all(service.is_valid(one.id) for one in sessions)
    service.end_session(sessions[0].id)
    service.sign_in(link, address=HERE)
    service.sign_in(invited(service), address=HERE)


def test_one_link_signs_in_forty_times_an_hour_and_its_audit_lines_end_there(
    service: PeopleService, clock: Clock
) -> None:
    lasting = NewInvitation(name="Hall", role=Role.VIEWER, lasts=timedelta(hours=3), single_use=False)
    link, other = service.invite(lasting, by="test")[1].text, service.invite(lasting, by="test")[1].text
    for _ in range(40):
        clock.passes(seconds=30)
        session, token = service.sign_in(link, address=HERE)
        service.end_session(session.id)
    session, token = service.sign_in(other, address=HERE)
    with pytest.raises(TooManyTries) as reported:
        service.sign_in(link, address=HERE)
    assert reported.value.code == "TOO_MANY_SIGN_INS"
    assert reported.value.message == (
        "this link was used for 40 sign-ins within 60 min; the next is possible in 41 min"
    )
    assert reported.value.context["wait_s"] == 3600 - 39 * 30
    assert reported.value.remedy
    # Existing sessions continue, and other links are accepted.
    assert service.session_of(token.text, address=HERE) == session
    clock.passes(seconds=3600 - 39 * 30)
    service.sign_in(link, address=HERE)
    # A rejected attempt does not extend the wait; each attempt expires separately.
    with pytest.raises(TooManyTries) as reported:
        service.sign_in(link, address=HERE)
    assert reported.value.context["wait_s"] == 30


def test_nobody_waits_at_the_door_while_the_disk_is_slow(
    service: PeopleService, monkeypatch: pytest.MonkeyPatch
) -> None:
    link = invited(service, single_use=False)
    session, token = service.sign_in(link, address=HERE)
    writing, may_go_on = threading.Event(), threading.Event()

    def slow(*_: object) -> None:
        writing.set()
        may_go_on.wait(60.0)

    monkeypatch.setattr("server.security.people.service.write_people", slow)
    seen: list[object] = []

    def ask() -> None:
        seen.extend([service.session_of(token.text, address=HERE) == session, service.is_valid(session.id)])

    entering = threading.Thread(target=service.sign_in, args=(link,), kwargs={"address": HERE})
    asking = threading.Thread(target=ask, daemon=True)
    entering.start()
    try:
        assert writing.wait(60.0)
        asking.start()
        asking.join(10.0)
        assert seen == [True, True]
    finally:
        may_go_on.set()
        entering.join()


def test_a_nearly_full_disk_keeps_the_old_file_and_reports_it(
    service: PeopleService, tmp_path: Path, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    link = invited(service, single_use=False)
    before, write, room = (tmp_path / "people.json").read_bytes(), os.write, [200]

    def nearly_full(descriptor: int, content: bytes) -> int:
        if room[0] == 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        written = write(descriptor, bytes(content)[: room[0]])
        room[0] -= written
        return written

    monkeypatch.setattr(os, "write", nearly_full)
    with pytest.raises(StoreError) as reported:
        service.sign_in(link, address=HERE)
    assert reported.value.code == "STORE_FULL"
    assert (tmp_path / "people.json").read_bytes() == before
    assert [one.name for one in tmp_path.glob(".*")] == []
    monkeypatch.setattr(os, "write", lambda descriptor, content: write(descriptor, bytes(content)[:7]))
    people_of(tmp_path, clock).sign_in(link, address=HERE)
    assert len(people_of(tmp_path, clock).sessions()) == 1


def test_a_token_is_not_shown_where_it_is_printed() -> None:
    token = Token.new()
    assert token.secret not in f"{token} {token!r}"
