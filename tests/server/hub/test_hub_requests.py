"""Supervisors act through the hub: with their own session at the theatre, once, soon, and no more."""

import asyncio
import json
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, cast

import pytest

from server.api.hub_requests import performer, rejected
from server.hub.connection import HubError
from server.hub.requester import RequestLine
from server.hub.requests import (
    MAX_AGE_S,
    HubAnswer,
    HubRequest,
    HubRequestOld,
    Tickets,
    answer_from,
    request_from,
)
from server.security import Role
from tests.server.conftest import make_instant, make_snapshot
from tests.server.security.guarded_app import Guarded, guarded

TOKEN = "0" * 12 + "." + "A" * 43
HOLD = HubRequest(method="POST", path="/api/alarms/hold", body="{}")


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Guarded]:
    with guarded(tmp_path_factory.mktemp("home")) as house:
        yield house


class Desk:
    """Counts what is performed; the clock is the test's."""

    def __init__(self) -> None:
        self.now_s, self.done = 100.0, 0
        self.tickets = Tickets(self.perform, clock=lambda: self.now_s)

    async def perform(self, _: HubRequest) -> HubAnswer:
        self.done += 1
        await asyncio.sleep(0)
        return HubAnswer(status=200, content_type="text/plain", token=None, body=str(self.done).encode())


def test_a_request_that_is_delivered_again_is_done_once_and_gets_the_same_answer() -> None:
    async def run() -> None:
        desk = Desk()
        ticket = desk.tickets.issue()
        both = await asyncio.gather(*(desk.tickets.answer(HOLD, ticket) for _ in range(2)))
        desk.now_s += MAX_AGE_S + 1.0
        later = await desk.tickets.answer(HOLD, ticket)
        assert ([one.body for one in both], later.body, desk.done) == ([b"1", b"1"], b"1", 1)

    asyncio.run(run())


def test_a_request_that_is_old_or_was_announced_to_another_run_is_not_done() -> None:
    async def run() -> None:
        desk = Desk()
        ticket = desk.tickets.issue()
        desk.now_s += MAX_AGE_S + 0.001
        for one in (ticket, "of another run", ""):
            with pytest.raises(HubRequestOld):
                await desk.tickets.answer(HOLD, one)
        assert desk.done == 0

    asyncio.run(run())


def test_requests_and_answers_survive_the_wire_and_show_no_token() -> None:
    request = HubRequest(method="POST", path="/api/session", token=TOKEN, body='{"ü": 1}', query="a=b")
    assert request_from(request.packed("t")) == (request, "t")
    assert TOKEN not in repr(request)
    answer = HubAnswer(status=201, content_type="image/png", token="", body=b"\n\x00")
    assert answer_from(answer.packed()) == answer
    for message in (b"", b"[]", b"{}", b'{"ticket": "t"}', b'{"ticket": "t", "else": 1}'):
        with pytest.raises(ValueError, match=r"."):
            request_from(message)


@pytest.mark.parametrize(
    "changed",
    [
        {"content_type": "text/html"},
        {"content_type": "text/javascript"},
        {"token": "a; Domain=example.org"},
        {"token": "a\r\nSet-Cookie: b=c"},
        {"status": 101},
    ],
)
def test_an_answer_that_could_act_in_the_browser_at_the_hub_is_none(changed: dict[str, Any]) -> None:
    answer = HubAnswer(status=200, content_type="application/json", token=TOKEN, body=b"<script>")
    assert answer_from(answer.packed()) == answer
    with pytest.raises(ValueError, match="not one of a theatre"):
        answer_from(replace(answer, **changed).packed())


def test_what_an_earlier_run_may_have_done_is_not_stated_as_not_done() -> None:
    deliveries: list[bytes] = []

    class Restarted(RequestLine):
        """A theatre that ends between a request and its answer, and rejects the second delivery."""

        async def _send(self, content: bytes) -> bytes:
            if not content:
                return b"ticket"
            deliveries.append(content)
            if len(deliveries) == 1:
                raise self._unanswered()
            old = HubRequestOld("HUB_REQUEST_OLD", "old", "", {"allowed_s": MAX_AGE_S})
            return rejected(old, "en").packed()

    with pytest.raises(HubError) as error:
        asyncio.run(Restarted(link=cast(Any, None), theatre="OR-3").ask(HOLD))
    assert (error.value.code, len(deliveries)) == ("HUB_NOT_CONFIRMED", 2)


def asked(house: Guarded, method: str, path: str, *, token: str = "", body: object = None) -> HubAnswer:
    text = "" if body is None else json.dumps(body)
    request = HubRequest(method=method, path=path, token=token, body=text)
    return asyncio.run(_perform(house, request))


async def _perform(house: Guarded, request: HubRequest) -> HubAnswer:
    return await performer(house.app, house.people)(request)


def code_of(answer: HubAnswer) -> str:
    return str(json.loads(answer.body)["code"])


def test_a_supervisor_signs_in_at_the_theatre_and_holds_there_under_their_own_name(house: Guarded) -> None:
    invitation = house.invited(Role.SUPERVISOR, name="Dr. Weber")
    entered = asked(house, "POST", "/api/session", body={"invitation": invitation})
    assert entered.status == 200
    assert entered.token
    held = asked(house, "POST", "/api/alarms/hold", token=entered.token, body={})
    assert held.status == 200
    room = json.loads(asked(house, "GET", "/api/supervision/room", token=entered.token).body)
    assert (room["hold"]["requested_by"], room["hold"]["is_yours"]) == (["Dr. Weber"], True)
    line = json.loads(house.people.audit.newest(1)[0])
    assert (line["what"], line["who"]["name"], line["address"]) == (
        "POST /api/alarms/hold",
        "Dr. Weber",
        "hub",
    )
    left = asked(house, "DELETE", "/api/session", token=entered.token)
    assert (left.status, left.token) == (204, "")
    again = asked(house, "POST", "/api/alarms/release", token=entered.token, body={})
    assert (again.status, code_of(again)) == (401, "SESSION_EXPIRED")


def test_a_mark_through_the_hub_is_in_the_room_under_its_authors_name(house: Guarded) -> None:
    snapshot = make_snapshot()
    house.live.publish(make_instant(1, snapshot=snapshot))
    token = house.token(Role.SUPERVISOR, name="Dr. Weber")
    point = {
        "at": [10.0, 20.0],
        "image_number": snapshot.image_number,
        "captured_at_s": snapshot.captured_at_s,
    }
    marked = asked(house, "POST", "/api/supervision/marks", token=token, body={"point": point})
    assert marked.status == 204
    room = json.loads(asked(house, "GET", "/api/supervision/room", token=token).body)
    ((seat, name),) = [(one["seat"], one["name"]) for one in room["pointers"]]
    assert (seat, name) == (room["you"]["seat"], "Dr. Weber")
    for role in (Role.VIEWER, Role.SCREEN):
        refused = house.door.post("/api/supervision/marks", headers=house.bearer(role), json={"lift": True})
        assert refused.status_code == 403


def test_without_a_session_at_the_theatre_nothing_is_done(house: Guarded) -> None:
    for token in ("", TOKEN):
        assert asked(house, "POST", "/api/alarms/hold", token=token, body={}).status == 401


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("POST", "/api/cases"),
        ("PUT", "/api/plan"),
        ("POST", "/api/alarms/acknowledgement"),
        ("GET", "/api/people"),
        ("GET", "/api/cases/1/archive"),
        ("POST", "/api/procedure/confirmation"),
        ("POST", "/api/alarms/hold/"),
        ("TRACE", "/api/plan"),
    ],
)
def test_other_routes_are_not_possible_through_the_hub(house: Guarded, method: str, path: str) -> None:
    answer = asked(house, method, path, token=house.token(Role.SUPERVISOR), body={})
    assert (answer.status, code_of(answer)) == (403, "HUB_REQUEST_REJECTED")


@pytest.mark.parametrize("role", [Role.OPERATOR, Role.VIEWER, Role.SCREEN, Role.CAMERA])
def test_other_roles_cannot_be_used_through_the_hub(house: Guarded, role: Role) -> None:
    answer = asked(house, "GET", "/api/plan", token=house.token(role))
    assert (answer.status, code_of(answer)) == (403, "HUB_SUPERVISORS_ONLY")
    invitation = house.invited(role)
    entered = asked(house, "POST", "/api/session", body={"invitation": invitation})
    assert (entered.status, code_of(entered)) == (403, "HUB_SUPERVISORS_ONLY")
    for token in (TOKEN, house.token(Role.SUPERVISOR)):
        beside = asked(house, "POST", "/api/session", token=token, body={"invitation": invitation})
        assert (beside.status, code_of(beside)) == (403, "HUB_SUPERVISORS_ONLY")
    # It was not used up.
    assert house.people.sign_in(invitation, address="test")[0].person.role is role
