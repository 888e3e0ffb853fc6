"""The procedure as a state machine: each transition, and rejections of steps out of order."""

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from typing import Any, TypeAlias

import pytest

from server.errors import SetupOrderError
from server.procedure.registration_record import CheckRecord, RegistrationRecord
from server.procedure.state import Finding, StepName, StepState, derive_state, no_case
from server.procedure.state.check_finding import check_finding
from server.store import Document, DocumentKind
from server.texts import as_is, reason
from tests.procedure.conftest import Server
from tests.procedure.patient import (
    DRILL,
    SPARE,
    USED,
    Patient,
    activate,
    ready,
    states,
    tool_content,
    with_plan,
    with_tool,
)
from tests.procedure.test_camera_step import open_a_case
from tests.procedure.test_tool_step import calibrated
from tracker.registration import AnchoredTo, Method

ORDER = [step.value for step in StepName]
DONE, MISSING, FAILED = StepState.DONE, StepState.MISSING, StepState.FAILED
OLD, DUE = StepState.OUT_OF_DATE, StepState.DUE
Five: TypeAlias = tuple[StepState, StepState, StepState, StepState, StepState]


def found(*five: StepState) -> dict[StepName, Finding]:
    return {
        step: Finding(state=state, reason=reason("NOT_REGISTERED", {"vertebra": f"L{number}"}))
        for number, (step, state) in enumerate(zip(StepName, five, strict=False))
    }


@pytest.mark.parametrize(
    ("five", "next_step", "allowed"),
    [
        ((MISSING, MISSING, MISSING, MISSING, MISSING), "camera", "camera plan"),
        ((DONE, MISSING, MISSING, MISSING, MISSING), "tool", "camera tool plan"),
        ((DONE, DONE, MISSING, MISSING, MISSING), "plan", "camera tool plan"),
        ((MISSING, MISSING, DONE, MISSING, MISSING), "camera", "camera plan"),
        ((DONE, DONE, DONE, MISSING, MISSING), "register", "camera tool plan register"),
        ((DONE, DONE, DONE, OLD, MISSING), "register", "camera tool plan register"),
        ((DONE, DONE, DONE, DONE, MISSING), "check", "camera tool plan register check"),
        ((DONE, DONE, DONE, DONE, FAILED), "check", "camera tool plan register check"),
        ((DONE, DONE, DONE, DONE, OLD), "check", "camera tool plan register check"),
        ((DONE, DONE, DONE, DONE, DONE), "navigate", " ".join(ORDER)),
        ((DONE, DONE, DONE, DONE, DUE), "navigate", " ".join(ORDER)),
        ((FAILED, DONE, DONE, DONE, DONE), "camera", "camera plan"),
        ((DONE, OLD, DONE, DONE, DONE), "tool", "camera tool plan"),
        ((DONE, DONE, OLD, OLD, DONE), "plan", "camera tool plan"),
    ],
)
def test_a_step_waits_for_all_of_its_dependencies(five: Five, next_step: str, allowed: str) -> None:
    state = derive_state("case", found(*five))
    assert state.next_step == next_step
    assert [one.step for one in state.steps if one.allowed] == allowed.split()
    for one in state.steps:
        if one.allowed:
            state.require_earlier_steps(one.step)
            continue
        with pytest.raises(SetupOrderError) as caught:
            state.require_earlier_steps(one.step)
        waits_for = StepName(str(caught.value.context["waits_for"]))
        assert ORDER.index(waits_for) < ORDER.index(one.step)
        assert state.status(waits_for).finding.reason.message["en"] in caught.value.message
        assert caught.value.remedy
        assert caught.value.code == f"{waits_for.name}_{state.status(waits_for).finding.state.name}"


@pytest.mark.parametrize(
    ("check", "navigates"), [(MISSING, True), (DONE, True), (DUE, True), (FAILED, False), (OLD, False)]
)
def test_where_no_check_is_asked_for_a_failed_one_still_counts(check: StepState, navigates: bool) -> None:
    state = derive_state("case", found(DONE, DONE, DONE, DONE, check), check_required=False)
    assert state.status(StepName.NAVIGATE).allowed is navigates
    assert state.waits_for_check is not navigates


def test_without_a_case_nothing_may_be_done() -> None:
    state = no_case()
    for one in state.steps:
        assert not one.allowed
        with pytest.raises(SetupOrderError) as caught:
            state.require_earlier_steps(one.step)
        assert caught.value.code == "NO_CASE_OPEN"


NOW = datetime(2026, 11, 21, 12, 0, tzinfo=UTC)
HERE, BEFORE = "this run", "an earlier run"


@pytest.mark.parametrize(
    ("anchored_to", "registered_in", "check", "state"),
    [
        pytest.param("camera", HERE, None, MISSING, id="never-checked"),
        pytest.param("camera", BEFORE, None, OLD, id="never-checked-and-started-again"),
        pytest.param("reference", BEFORE, None, MISSING, id="beside-a-reference-never-checked"),
        pytest.param("camera", HERE, (HERE, 5, True), DONE, id="passed"),
        pytest.param("camera", HERE, (HERE, 5, False), FAILED, id="failed"),
        pytest.param("camera", HERE, (HERE, 30, True), DUE, id="half-an-hour-old"),
        pytest.param("camera", HERE, (HERE, 29, True), DONE, id="nearly-half-an-hour-old"),
        pytest.param("reference", BEFORE, (BEFORE, -3, True), DUE, id="made-in-the-future"),
        pytest.param("camera", BEFORE, (BEFORE, 5, True), OLD, id="started-again"),
        pytest.param("camera", BEFORE, (BEFORE, 5, False), FAILED, id="failed-and-started-again"),
        pytest.param("camera", BEFORE, (HERE, 5, True), DONE, id="checked-since-the-start"),
        pytest.param("reference", BEFORE, (BEFORE, 5, True), DONE, id="beside-a-reference-started-again"),
        pytest.param("reference", BEFORE, (BEFORE, 45, True), DUE, id="beside-a-reference-old"),
    ],
)
def test_a_check_holds_for_its_time_and_its_run(
    anchored_to: str, registered_in: str, check: tuple[str, float, bool] | None, state: StepState
) -> None:
    found = found_check(anchored_to, registered_in, check)
    assert found.state is state
    assert found.reason.message["de"]
    assert bool(found.reason.remedy["de"]) is (state is not DONE)


@pytest.mark.parametrize("clock_set_min", [-60.0, 60.0])
@pytest.mark.parametrize(("minutes", "state"), [(5.0, DONE), (45.0, DUE)])
def test_a_check_of_this_run_ages_by_the_image_clock(
    clock_set_min: float, minutes: float, state: StepState
) -> None:
    found = found_check("camera", HERE, (HERE, minutes, True), clock_set_min=clock_set_min)
    assert (found.state, found.numbers["age_min"]) == (state, minutes)


def found_check(
    anchored_to: str,
    registered_in: str,
    check: tuple[str, float, bool] | None,
    *,
    clock_set_min: float = 0.0,
) -> Finding:
    """The finding on a check of this run, age in minutes and result; the clock was set after it by some."""
    eye = [[float(row == column) for column in range(6)] for row in range(6)]
    registration = RegistrationRecord(
        vertebra="L3",
        method=Method.POINTS,
        anchored_to=AnchoredTo(anchored_to),
        anchor_from_vertebra=[row[:4] for row in eye[:4]],
        covariance=eye,
        run=registered_in,
        numbers={},
        made_from={},
    )
    document = None
    if check is not None:
        run, minutes, passed = check
        stored = CheckRecord(
            vertebra="L3",
            landmark=SPARE,
            tool="drill",
            distance_mm=1.0 if passed else 3.0,
            max_mm=2.0,
            passed=passed,
            run=run,
            from_s=6000.0 - 60.0 * minutes,
            off_lps_mm=[0.0, 0.0, 0.0],
            sd_mm=0.5,
            images=15,
        )
        document = Document(
            case_id="c",
            id="d",
            kind=DocumentKind.CHECK,
            name="registration of L3",
            version=1,
            made_at=(NOW - timedelta(minutes=minutes + clock_set_min)).isoformat(),
            made_by="ito",
            content=stored.model_dump(mode="json"),
        )
    return check_finding(
        registration=registration,
        title=as_is("it"),
        check=document,
        run=HERE,
        again_after_min=30,
        now=NOW,
        now_s=6000.0,
    )


def nothing(server: Server) -> None:
    pass


def case_only(server: Server) -> None:
    open_a_case(server)


def camera(server: Server) -> None:
    calibrated(server)


def tool(server: Server) -> None:
    with_tool(server, calibrated(server))


def plan(server: Server) -> None:
    case_id = calibrated(server)
    with_tool(server, case_id)
    with_plan(server, case_id)


def active(server: Server) -> None:
    ready(server)


def tool_without_axis(server: Server) -> None:
    case_id = calibrated(server)
    content = {**tool_content(), "axis_in_marker": None}
    server.store.put(case_id, DocumentKind.TOOL, "drill", content, made_by="test")


def inaccurate(server: Server) -> None:
    case_id = ready(server)
    now = server.store.current(case_id, DocumentKind.CAMERA, "main")
    values = {"passed": False, "limit_mm": 0.5, "maximum_error_mm": 0.9}
    server.store.put(
        case_id, DocumentKind.CHECK, "accuracy of the camera", values, made_by="test", depends_on=[now.id]
    )


def other_source(server: Server) -> None:
    case_id = calibrated(server)
    camera: Any = server.store.current(case_id, DocumentKind.CAMERA, "main").content["camera"]
    values = {"camera": {**camera, "source": "another"}}
    server.store.put(case_id, DocumentKind.CAMERA, "main", values, made_by="test")


@pytest.mark.parametrize(
    ("made", "register_code", "check_code", "states_then"),
    [
        (nothing, "NO_CASE_OPEN", "NO_CASE_OPEN", "missing missing missing missing missing missing"),
        (case_only, "CAMERA_MISSING", "CAMERA_MISSING", "missing missing missing missing missing missing"),
        (camera, "TOOL_MISSING", "TOOL_MISSING", "done missing missing missing missing missing"),
        (tool_without_axis, "TOOL_MISSING", "TOOL_MISSING", "done missing missing missing missing missing"),
        (tool, "PLAN_MISSING", "PLAN_MISSING", "done done missing missing missing missing"),
        (plan, "PLAN_MISSING", "PLAN_MISSING", "done done missing missing missing missing"),
        (inaccurate, "CAMERA_FAILED", "CAMERA_FAILED", "failed done done missing missing missing"),
        (
            other_source,
            "CAMERA_OUT_OF_DATE",
            "CAMERA_OUT_OF_DATE",
            "out_of_date missing missing missing missing missing",
        ),
        (active, None, "REGISTER_MISSING", "done done done missing missing missing"),
    ],
)
def test_a_step_out_of_order_is_rejected_with_a_remedy(
    server: Server,
    made: Callable[[Server], None],
    register_code: str | None,
    check_code: str,
    states_then: str,
) -> None:
    made(server)
    assert " ".join(states(server).values()) == states_then
    Patient(server=server).show(None)
    points = server.ask("POST", "/api/registration/points", 201 if register_code is None else 409, json=DRILL)
    check = server.ask("POST", "/api/registration/check", 409, json={**DRILL, "landmark": SPARE})
    assert check["code"] == check_code
    assert check["remedy"]
    if register_code is not None:
        assert points["code"] == register_code
        assert points["remedy"]


def test_what_is_not_there_is_rejected_by_name(server: Server) -> None:
    ready(server)
    patient = Patient(server=server)
    patient.show(None)

    def code(method: str, path: str, status: int, **sent: object) -> str:
        return str(server.ask(method, f"/api/registration{path}", status, json=sent)["code"])

    assert code("GET", "/points", 409) == "COLLECTION_MISSING"
    assert code("POST", "/points/conclusion", 409, made_by="ito") == "COLLECTION_MISSING"
    assert code("POST", "/points", 422, tool="awl") == "TOOL_UNKNOWN"
    assert code("POST", "/points", 409, tool="drill", vertebra="S1") == "VERTEBRA_UNKNOWN"
    server.ask("POST", "/api/registration/points", 201, json=DRILL)
    assert code("POST", "/points/captures", 409, landmark="nose") == "LANDMARK_UNKNOWN"
    assert code("PUT", "/points/use", 409, landmark=USED[0], used=False) == "LANDMARK_NOT_TOUCHED"
    assert code("POST", "/points/conclusion", 409, made_by="ito") == "POINTS_TOO_FEW"
    server.ask("DELETE", "/api/registration/points", 204)
    assert code("GET", "/points", 409) == "COLLECTION_MISSING"
    assert code("GET", "/check", 409) == "COLLECTION_MISSING"
    patient.register()
    activate(server, "L3", "right")
    server.ask("POST", "/api/registration/check", 201, json={**DRILL, "landmark": SPARE})
    assert code("POST", "/check/conclusion", 409, made_by="ito") == "CHECK_NOT_CAPTURED"
