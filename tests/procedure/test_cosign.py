"""Co-signatures: of exactly one version, by another person, and required before navigation if configured."""

import itertools
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI

from server.app import AppParts, create_app
from server.errors import SetupOrderError
from server.procedure.state import Finding, MissingCosignature, StepName, StepState, derive_state
from server.procedure.state.cosignatures import (
    CosignTarget,
    SignatureRecord,
    content_sha256,
    signatures_of,
)
from server.security.audit import collect_changes
from server.store import CaseStore, DocumentKind, Home
from server.texts import reason
from tests.procedure.conftest import Server, serving
from tests.procedure.patient import Patient, plan_content, ready, with_plan, withheld
from tests.procedure.test_camera_step import open_a_case
from tests.server.supervision.signed_in_people import sign_people_in
from tracker.navigation import AbsentReason

SIGNATURES = "/api/supervision/signatures"
REQUIRED = {"supervision": {"cosign": {"plan": "required", "registration": "required"}}}


@pytest.fixture
def guarded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Server]]:
    """A server with users who are identified by a header."""

    def create(parts: AppParts) -> FastAPI:
        app = create_app(parts)
        sign_people_in(app)
        return app

    monkeypatch.setattr("tests.procedure.conftest.create_app", create)
    with ExitStack() as stack:
        yield lambda settings=None: stack.enter_context(serving(tmp_path / "home", settings))


def signable(server: Server, what: str) -> dict[str, Any]:
    reported = server.ask("GET", SIGNATURES, 200)["signable"]
    return next(dict(one) for one in reported if one["what"] == what)


def sign(server: Server, what: str, person: str, status: int = 201, document_id: str = "") -> Any:  # noqa: ANN401  JSON
    requested = {"what": what, "document_id": document_id or signable(server, what)["document_id"] or "none"}
    headers = {"x-person": person} if person else {}
    return server.ask("POST", SIGNATURES, status, json=requested, headers=headers)


def step(server: Server, name: str) -> dict[str, Any]:
    reported = server.ask("GET", "/api/procedure", 200)["steps"]
    return next(dict(one) for one in reported if one["step"] == name)


def planned(server: Server) -> str:
    """An open case with a plan."""
    case_id = open_a_case(server)
    with_plan(server, case_id)
    return case_id


def change_plan(server: Server, case_id: str, made_by: str = "ito") -> None:
    ct = server.store.current(case_id, DocumentKind.CT, "main")
    content = plan_content("L3", shift_mm=0.5)
    server.store.put(case_id, DocumentKind.PLAN, "main", content, made_by=made_by, depends_on=[ct.id])


def test_required_signatures_withhold_navigation_until_a_second_person_signed(
    guarded: Callable[..., Server],
) -> None:
    server = guarded(REQUIRED)
    ready(server)
    patient = Patient(server=server)
    # The plan lacks a signature; registration is allowed nevertheless.
    assert "not signed by a second person" in step(server, "plan")["missing_cosignature"]["message"]
    patient.register()
    patient.check()
    navigate = step(server, "navigate")
    assert (navigate["state"], navigate["allowed"]) == ("missing", False)
    assert "waits for a co-signature: plan 'main' version 1" in navigate["message"]
    assert navigate["remedy"].endswith("page.")
    assert withheld(server) is AbsentReason.NOT_COSIGNED
    sign(server, "plan", "s1")
    assert step(server, "plan")["missing_cosignature"] is None
    assert "registration 'L3'" in step(server, "navigate")["message"]
    assert withheld(server) is AbsentReason.NOT_COSIGNED
    (signature,) = sign(server, "registration", "s1")["signable"][1]["signatures"]
    assert (signature["by"], signature["second_person"]) == ("Dr Sato", True)
    assert server.ask("GET", "/api/procedure", 200)["may_navigate"]
    assert withheld(server) is None
    path = f"{SIGNATURES}/{signature['id']}"
    assert server.ask("DELETE", path, 409, headers={"x-person": "s2"})["code"] == "SIGNATURE_NOT_YOURS"
    server.ask("DELETE", path, 200, headers={"x-person": "s1"})
    assert withheld(server) is AbsentReason.NOT_COSIGNED
    sign(server, "registration", "s1")
    assert withheld(server) is None


def test_a_changed_plan_is_unsigned_at_once(guarded: Callable[..., Server]) -> None:
    server = guarded()
    case_id = planned(server)
    looked_at = signable(server, "plan")["document_id"]
    sign(server, "plan", "s1")
    assert signable(server, "plan")["is_cosigned"]
    change_plan(server, case_id)
    now = signable(server, "plan")
    assert (now["is_cosigned"], now["signatures"], now["was_signed"]) == (False, [], True)
    # The reviewed version is not the one that would be signed.
    rejected = sign(server, "plan", "s2", 409, document_id=looked_at)
    assert rejected["code"] == "SIGNED_VERSION_OLD"
    assert "version 2" in rejected["message"]


def test_who_made_it_cannot_co_sign_it(guarded: Callable[..., Server]) -> None:
    server = guarded()
    case_id = planned(server)
    change_plan(server, case_id, made_by=" ITO ")
    rejected = sign(server, "plan", "o1", 409)
    assert rejected["code"] == "SIGNED_BY_MAKER"
    assert rejected["remedy"]
    sign(server, "plan", "s1")


def test_several_sign_and_each_once(guarded: Callable[..., Server]) -> None:
    server = guarded()
    planned(server)
    sign(server, "plan", "s1")
    sign(server, "plan", "s2")
    reported = sign(server, "plan", "s1")["signable"][0]["signatures"]
    assert [one["by"] for one in reported] == ["Dr Sato", "Dr Kim"]
    assert [one["is_yours"] for one in reported] == [True, False]


def test_without_sign_in_a_signature_is_not_a_second_persons(server: Server) -> None:
    planned(server)
    reported = sign(server, "plan", "")["signable"][0]
    assert [(one["by"], one["second_person"]) for one in reported["signatures"]] == [("this computer", False)]
    assert not reported["is_cosigned"]


def test_what_is_not_there_is_not_signed(server: Server) -> None:
    assert sign(server, "plan", "", 409)["code"] == "NO_CASE_OPEN"
    planned(server)
    assert sign(server, "registration", "", 409)["code"] == "REGISTRATION_MISSING"
    assert signable(server, "registration")["document_id"] is None
    server.ask("DELETE", f"{SIGNATURES}/0123456789abcdef", 404)
    plan = signable(server, "plan")["document_id"]
    assert server.ask("DELETE", f"{SIGNATURES}/{plan}", 422)["code"] == "SIGNATURE_DOCUMENT_INVALID"


def test_a_content_that_was_changed_behind_the_store_is_not_signed(guarded: Callable[..., Server]) -> None:
    server = guarded()
    case_id = planned(server)
    sign(server, "plan", "s1")
    (document,) = server.store.all(case_id, DocumentKind.SIGNATURE)
    content = {**document.content, "content_sha256": "0" * 64}
    server.store.put(
        case_id,
        DocumentKind.SIGNATURE,
        document.name,
        content,
        made_by="Dr Sato",
        depends_on=document.depends_on,
    )
    assert not signable(server, "plan")["is_cosigned"]


def test_a_signature_that_came_in_with_an_archive_does_not_count(guarded: Callable[..., Server]) -> None:
    server = guarded()
    case_id = planned(server)
    sign(server, "plan", "s1")
    archive = server.door.get(f"/api/cases/{case_id}/archive").content
    taken = server.ask("POST", "/api/cases/archive", 201, content=archive)["id"]
    server.ask("POST", f"/api/cases/{taken}/open", 200)
    plan = signable(server, "plan")
    assert (plan["out_of_date"], plan["is_cosigned"], plan["signatures"]) == ("", False, [])
    documents = server.ask("GET", f"/api/cases/{taken}/documents", 200)["documents"]
    (withdrawn,) = [one["withdrawn"] for one in documents if one["kind"] == "signature"]
    assert "signed again here" in withdrawn["reason"]
    sign(server, "plan", "s1")
    assert signable(server, "plan")["is_cosigned"]


def test_who_took_an_archive_in_cannot_co_sign_what_they_may_have_written_into_it(
    guarded: Callable[..., Server],
) -> None:
    server = guarded()
    case_id = planned(server)
    change_plan(server, case_id, made_by="Dr Kim")
    archive = server.door.get(f"/api/cases/{case_id}/archive").content
    by_ito = {"x-person": "o1"}
    taken = server.ask("POST", "/api/cases/archive", 201, content=archive, headers=by_ito)["id"]
    server.ask("POST", f"/api/cases/{taken}/open", 200)
    plan = signable(server, "plan")
    assert plan["made_by"] == "Dr Kim, says the archive"
    assert (plan["imported"]["claimed_maker"], plan["imported"]["by"]) == ("Dr Kim", "ito")
    documents = server.ask("GET", f"/api/cases/{taken}/documents", 200)["documents"]
    assert {one["imported"]["by"] for one in documents} == {"ito"}
    assert all(one["made_by"].endswith(", says the archive") for one in documents)
    for person in ("o1", "s2"):
        rejected = sign(server, "plan", person, 409)
        assert rejected["code"] == "SIGNED_BY_MAKER"
        assert "made by Dr Kim, says the archive and imported by ito" in rejected["message"]
    sign(server, "plan", "s1")
    assert signable(server, "plan")["is_cosigned"]


def test_a_signature_states_who_invited_the_signer_and_whether_that_was_the_author(
    guarded: Callable[..., Server],
) -> None:
    server = guarded()
    case_id = planned(server)
    change_plan(server, case_id, made_by=" ITO ")
    sign(server, "plan", "s1")
    with collect_changes() as changes:
        reported = sign(server, "plan", "s3")["signable"][0]["signatures"]
    assert [(one["by"], one["invited_by"], one["invited_by_maker"]) for one in reported] == [
        ("Dr Sato", "", False),
        ("Dr Lee", "ito", True),
    ]
    (line,) = [dict(one) for one in changes if "invited_by" in one]
    assert line == {
        "what": "signature",
        "of": "plan 'main' version 2",
        "invited_by": "ito",
        "invited_by_maker": True,
        "from": None,
        "to": "signed",
    }
    # It counts: often the person who invites also plans. If somebody else made it, no note is added.
    assert signable(server, "plan")["is_cosigned"]
    change_plan(server, case_id, made_by="abe")
    (reported,) = sign(server, "plan", "s3")["signable"][0]["signatures"]
    assert (reported["invited_by"], reported["invited_by_maker"]) == ("ito", False)


def test_the_room_is_informed_of_a_signature_at_once(guarded: Callable[..., Server]) -> None:
    server = guarded()
    with server.door.websocket_connect("ws://127.0.0.1:8000/ws/room?view=supervisor&person=s2") as socket:

        def heard(true: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
            """The plan in the first message of this socket that has one."""
            plans: list[dict[str, Any]] = []

            def reported() -> bool:
                socket.send_json({"next": True})
                plans.extend((socket.receive_json()["signable"] or [])[:1])
                return bool(plans) and true(plans[-1])

            server.until(reported)
            return plans[-1]

        assert heard(lambda plan: plan["document_id"] is None)["signatures"] == []
        planned(server)
        made = heard(lambda plan: plan["document_id"] is not None)
        assert (made["title"], made["is_cosigned"]) == ("plan 'main' version 1", False)
        sign(server, "plan", "s1")
        signed = heard(lambda plan: plan["is_cosigned"])
        assert signed == signable(server, "plan")
        assert [(one["by"], one["is_yours"]) for one in signed["signatures"]] == [("Dr Sato", False)]
    german = "ws://127.0.0.1:8000/ws/room?view=supervisor&person=s2&lang=de"
    with server.door.websocket_connect(german) as socket:
        socket.send_json({"next": True})
        assert socket.receive_json()["signable"][0]["title"] == "Planung „main“ Version 1"


def test_only_navigation_waits_for_a_signature() -> None:
    done = Finding(state=StepState.DONE, reason=reason("NAVIGATION_ALLOWED"))
    findings = dict.fromkeys(StepName, done)
    del findings[StepName.NAVIGATE]
    lack = MissingCosignature(reason=reason("NOT_COSIGNED", {"title": "plan 'main' version 3"}))
    state = derive_state("case", findings, missing_cosignature={StepName.PLAN: lack})
    assert [one.step for one in state.steps if not one.allowed] == [StepName.NAVIGATE]
    state.require_earlier_steps(StepName.CHECK)
    with pytest.raises(SetupOrderError) as caught:
        state.require_earlier_steps(StepName.NAVIGATE)
    assert (caught.value.code, caught.value.remedy) == ("PLAN_NOT_COSIGNED", lack.reason.remedy["en"])
    missing = {
        **findings,
        StepName.TOOL: Finding(state=StepState.MISSING, reason=reason("NO_TOOL_CALIBRATED")),
    }
    waiting = derive_state("case", missing, missing_cosignature={StepName.PLAN: lack})
    assert "no tool" in waiting.status(StepName.NAVIGATE).finding.reason.message["en"]


def test_signatures_are_in_the_order_in_which_they_were_given_whatever_the_clock_was_set_to(
    tmp_path: Path,
) -> None:
    hours = itertools.count(20, -1)
    with (
        Home(tmp_path / "home") as home,
        CaseStore(home, clock=lambda: datetime(2026, 11, 21, next(hours), tzinfo=UTC)) as store,
    ):
        case = store.create("L4")
        plan = store.put(case.id, DocumentKind.PLAN, "main", {}, made_by="M. Ito")
        for signer in ("s2", "s1", "s3"):
            signed = SignatureRecord(
                what=CosignTarget.PLAN,
                document_id=plan.id,
                title=plan.title,
                content_sha256=content_sha256(plan),
                signer_id=signer,
                signer_role="supervisor",
                second_person=True,
            )
            content = signed.model_dump(mode="json")
            kind, name = DocumentKind.SIGNATURE, f"plan main by {signer}"
            store.put(case.id, kind, name, content, made_by=signer, depends_on=[plan.id])
        found = signatures_of(store, plan)
        assert [one.made_by for one, _ in found] == ["s2", "s1", "s3"]
