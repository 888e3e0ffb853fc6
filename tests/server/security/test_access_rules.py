"""Access of every role to every route, exactly as in the table."""

import re
from collections.abc import Iterator

import pytest
from starlette.testclient import WebSocketDenialResponse

from server.config import Config
from server.hub.connection import HubAddress
from server.hub.subjects import Hospital
from server.hub_app import create_hub_app
from server.security import Role
from server.security.access_rules import ACCESS_RULES, Rule
from tests.server.security.guarded_app import HOST, Guarded, addresses_of, guarded

# Written down a second time, so that a rule that slips into a wider group is noticed.
VIEWERS_MAY = {
    "GET /api/session",
    "DELETE /api/session",
    "GET /api/dashboard",
    "GET /api/live",
    "GET /api/alarms",
    "GET /api/alarms/sound/{priority}.wav",
    "GET /api/procedure",
    "GET /video/{camera}.mjpg",
    "GET /api/supervision/room",
    "GET /api/supervision/signatures",
    "WS /ws/room",
    "WS /ws/live",
    "WS /ws/view",
    "GET /scene",
    "GET /scene/",
    "WS /scene",
    "WS /scene/",
}
CAMERAS_MAY = {
    "GET /health",
    "GET /api/session",
    "POST /api/session",
    "DELETE /api/session",
    "WS /ws/camera",
}
SUPERVISORS_DO = {
    "PUT /api/recordings/{name}/scenes/{key}",
    "POST /api/recordings/{name}/comments",
    "DELETE /api/session",
    "POST /api/session",
    "POST /api/alarms/hold",
    "POST /api/alarms/release",
    # At the hub, which passes them on: the theatre decides.
    "POST /at/{theatre}/api/session",
    "DELETE /at/{theatre}/api/session",
    "POST /at/{theatre}/api/alarms/hold",
    "POST /at/{theatre}/api/alarms/release",
}
SCREENS_DO = {
    "DELETE /api/session",
    "POST /api/session",
    *(f"POST /api/alarms/{what}" for what in ("acknowledgement", "pause", "resumption", "screens")),
}


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Guarded]:
    with guarded(tmp_path_factory.mktemp("home")) as house:
        yield house


@pytest.fixture(scope="module")
def bearers(house: Guarded) -> dict[Role, dict[str, str]]:
    return {role: house.bearer(role) for role in Role}


def test_the_table_holds_every_address_that_the_application_has_and_no_other(house: Guarded) -> None:
    listed = {(rule.method, rule.template) for rule in ACCESS_RULES}
    assert len(listed) == len(ACCESS_RULES), "an address stands in two groups"
    hub = create_hub_app(Config(), HubAddress(url="nats://localhost", hospital=Hospital("clinic")), None)
    served = addresses_of(house.app) | addresses_of(hub)
    assert not served - listed, "server/security/access_rules.py lacks them; they are denied to everybody"
    assert not listed - served, "server/security/access_rules.py lists them, and no router serves them"
    schema = house.app.openapi()["paths"] | hub.openapi()["paths"]
    documented = {(method.upper(), path) for path, methods in schema.items() for method in methods}
    scenes = {"/scene", "/scene/", "/scene/review/{key}/"}
    silent = scenes | {"/api/docs", "/api/openapi.json", "/ws/live", "/ws/room", "/ws/view"}
    # Socket addresses of other modules are not documented either.
    assert {
        one for one in listed if one[0] != "WS" and one[1] not in silent and "/at/" not in one[1]
    } == documented


def test_what_each_role_may_is_what_was_agreed() -> None:
    def may(role: Role, *, read: bool) -> set[str]:
        return {
            rule.name
            for rule in ACCESS_RULES
            if role in rule.roles and (rule.method in {"GET", "WS"}) == read
        }

    everything = {rule.name for rule in ACCESS_RULES}
    assert may(Role.OPERATOR, read=True) | may(Role.OPERATOR, read=False) == everything
    assert may(Role.SUPERVISOR, read=True) == may(Role.OPERATOR, read=True) - {"WS /ws/camera"}
    viewer = may(Role.VIEWER, read=True) | may(Role.VIEWER, read=False)
    assert viewer - {"GET /health", "POST /api/session"} >= VIEWERS_MAY
    assert may(Role.SCREEN, read=True) == may(Role.VIEWER, read=True)
    # Roles of other modules are added here by name.
    assert {one for one in may(Role.SUPERVISOR, read=False) if "/supervision" not in one} == SUPERVISORS_DO
    assert may(Role.SCREEN, read=False) == SCREENS_DO
    camera = may(Role.CAMERA, read=True) | may(Role.CAMERA, read=False)
    assert camera == CAMERAS_MAY
    assert {rule.name for rule in ACCESS_RULES if rule.is_public} == {"GET /health", "POST /api/session"}


def answer_to(house: Guarded, rule: Rule, headers: dict[str, str]) -> tuple[int, str]:
    """Status and code of the answer; allowed requests change nothing."""
    path = re.sub(r"\{[a-z_]+\}", "none", rule.template)
    if rule.method == "WS":
        try:
            with house.door.websocket_connect(f"ws://{HOST}{path}", headers=headers, subprotocols=["none"]):
                return 101, ""
        except WebSocketDenialResponse as denied:
            return denied.status_code, str(denied.json()["code"])
        except Exception:  # noqa: BLE001  closed by the socket's own room, which is past the guard
            return 101, ""
    answer = house.door.request(rule.method, path, headers=headers, follow_redirects=False)
    is_ours = "json" in answer.headers.get("content-type", "") and answer.status_code >= 400
    return answer.status_code, str(answer.json().get("code", "")) if is_ours else ""


@pytest.mark.parametrize("rule", ACCESS_RULES, ids=lambda rule: rule.name)
def test_each_address_admits_exactly_the_roles_of_the_table(
    house: Guarded, bearers: dict[Role, dict[str, str]], rule: Rule
) -> None:
    status, code = answer_to(house, rule, {})
    if rule.is_public:
        assert (status, code) != (401, "SESSION_NEEDED")
    else:
        assert (status, code) == (401, "SESSION_NEEDED")
    for role in Role:
        signs_out = rule.name == "DELETE /api/session"
        status, code = answer_to(house, rule, house.bearer(role) if signs_out else bearers[role])
        if role in rule.roles:
            assert code not in {"ROLE_REJECTED", "SESSION_NEEDED", "SESSION_EXPIRED"}, (role, status, code)
        else:
            assert (status, code) == (403, "ROLE_REJECTED"), role


def test_without_a_session_every_address_gives_the_same_answer(house: Guarded) -> None:
    assert house.door.get("/health").json() == {
        "status": "degraded",
        "process": None,
        "source": None,
        "image_age_ms": None,
        "sinks": [],
    }


@pytest.mark.parametrize(
    "path",
    [
        "//api/cases",
        "/api//cases",
        "/api/cases/",
        "/API/cases",
        "/api/cases%2f",
        "/assets/../api/cases",
        "/assets/%2e%2e/%2e%2e/api/cases",
        "/enter/..%2f..%2fapi/cases",
        "/api/cases%0a",
        "/api/cases;/assets/x.js",
        "/api/nothing",
        "/scene/../metrics",
        "/video",
    ],
)
def test_no_way_of_writing_an_address_leads_past_the_guard(house: Guarded, path: str) -> None:
    for method in ("GET", "HEAD", "OPTIONS", "POST", "TRACE", "get"):
        answer = house.door.request(method, path, follow_redirects=False)
        shows_page = "text/html" in answer.headers.get("content-type", "")
        allowed = shows_page and method in {"GET", "HEAD"}
        assert answer.status_code == 401 or allowed, (method, answer.text[:200])


def test_head_is_allowed_as_get_is(house: Guarded) -> None:
    assert house.door.head("/metrics").status_code == 401
    assert house.door.head("/metrics", headers=house.bearer(Role.VIEWER)).status_code == 403


def test_with_a_session_a_missing_address_is_reported(house: Guarded) -> None:
    reported = house.door.get("/api/nothing", headers=house.bearer())
    assert (reported.status_code, reported.json()["code"]) == (404, "NOT_FOUND")
    reported = house.door.put("/api/cases", headers=house.bearer())
    assert (reported.status_code, reported.json()["code"]) == (405, "METHOD_NOT_ALLOWED")
