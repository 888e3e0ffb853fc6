"""Whether the planned screw can be navigated, with the plan and with the registration, through the API."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from server.store import DocumentKind
from tests.procedure.conftest import Server
from tests.procedure.patient import LANDMARKS, Patient, activate, plan_content, with_tool
from tests.procedure.test_tool_step import calibrated
from tracker.plan import PedicleMeasure, PedicleRecord, ScrewPlan, plan_from_mapping, plan_to_mapping
from tracker.plan.pedicle import PedicleSpread
from tracker.plan.screw import BoneAlong, clearance_of, tolerance_of

AROUND = np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False)
WIDTH_MM = 7.5
SCREW_MM = 6.5


def pedicle_of(channel: Any) -> PedicleMeasure:  # noqa: ANN401  Channel
    """A round pedicle of 7.5 mm around the channel, its isthmus 18 mm behind the entry."""
    axis = channel.axis_in_vertebra
    across = np.cross(axis, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    up = np.cross(across, axis)
    isthmus = channel.entry_in_vertebra_mm + 18.0 * axis
    return PedicleMeasure(
        side="left",
        width_mm=WIDTH_MM,
        height_mm=WIDTH_MM,
        transverse_deg=0.0,
        sagittal_deg=0.0,
        length_mm=55.0,
        isthmus_lps_mm=isthmus,
        axis_lps=axis,
        entry_lps_mm=channel.entry_in_vertebra_mm,
        front_lps_mm=channel.entry_in_vertebra_mm + 55.0 * axis,
        outline_lps_mm=isthmus
        + 0.5 * WIDTH_MM * (np.cos(AROUND)[:, None] * across + np.sin(AROUND)[:, None] * up),
        seed_lps_mm=isthmus,
        cortex_mm=1.0,
        sd=PedicleSpread(
            width_mm=0.1, height_mm=0.1, transverse_deg=0.3, sagittal_deg=0.3, length_mm=0.3, isthmus_mm=0.1
        ),
    )


def content(*, diameter_mm: float = SCREW_MM, landmarks: int = len(LANDMARKS)) -> dict[str, Any]:
    """The patient's plan with a screw on the left."""
    plan = plan_from_mapping(plan_content("L3"))
    (vertebra,) = plan.vertebrae
    left, right = vertebra.channels
    measure = pedicle_of(left.channel)
    screw = ScrewPlan(
        diameter_mm=diameter_mm,
        length_mm=40.0,
        clearance=clearance_of(left.channel, measure, diameter_mm=diameter_mm, length_mm=40.0),
        bone=BoneAlong(along_mm=np.zeros(1), hu=np.zeros(1), mean_hu=0.0, min_hu=0.0, inside_ratio=1.0),
        tolerance=tolerance_of(left.channel, measure, diameter_mm=diameter_mm),
    )
    with_screw = replace(
        vertebra,
        pedicles=(PedicleRecord(measured=measure),),
        channels=(replace(left, screws=(screw,)), right),
        landmarks=vertebra.landmarks[:landmarks],
    )
    return plan_to_mapping(replace(plan, vertebrae=(with_screw,)))


def planned(server: Server, **of: Any) -> str:  # noqa: ANN401  numbers
    """An open case with camera, tool, and a plan with this screw as the active channel."""
    case_id = calibrated(server)
    with_tool(server, case_id)
    ct = server.store.put(case_id, DocumentKind.CT, "main", {}, made_by="test")
    server.store.put(case_id, DocumentKind.PLAN, "main", content(**of), made_by="test", depends_on=[ct.id])
    activate(server)
    return case_id


def checked(server: Server) -> Any:  # noqa: ANN401  JSON
    return server.ask("GET", "/api/procedure", 200)["setup_check"]


def test_before_a_registration_the_planned_landmarks_are_judged(server: Server) -> None:
    planned(server)
    check = checked(server)
    # 7.5 mm less 6.5 mm, on each side.
    assert check["found"]["tolerance_mm"] == pytest.approx(0.5, abs=0.02)
    assert check["found"]["suffices"] is False
    # Landmarks localised to 0.7 mm along each axis.
    assert 0.9 < check["found"]["error_95_mm"] < 3.0
    more = [one for one in check["remedies"] if one["kind"] == "more_landmarks"]
    assert [one["landmarks"] for one in more] == [7, 9, 13]
    errors = [check["found"]["error_95_mm"], *(one["expected"]["error_95_mm"] for one in more)]
    assert errors == sorted(errors, reverse=True)
    assert len(set(errors)) == 4
    (thinner,) = (one for one in check["remedies"] if one["kind"] == "thinner_screw")
    leaves_mm = 0.5 * (WIDTH_MM - thinner["diameter_mm"])
    assert thinner["expected"]["tolerance_mm"] == pytest.approx(leaves_mm, abs=0.02)
    described = {name: check[name] for name in ("basis", "method", "vertebra", "side", "diameter_mm", "tool")}
    assert described == {
        "basis": "landmarks",
        "method": None,
        "vertebra": "L3",
        "side": "left",
        "diameter_mm": SCREW_MM,
        "tool": None,
    }


def test_too_few_landmarks_and_no_screw_get_no_expectation(server: Server) -> None:
    planned(server, landmarks=3)
    assert checked(server) is None
    activate(server, side="right")
    assert checked(server) is None


@pytest.mark.parametrize(("diameter_mm", "suffices"), [(SCREW_MM, False), (4.0, True)])
def test_a_registration_is_judged_by_its_own_covariance_and_blocks_nothing(
    server: Server, diameter_mm: float, suffices: bool
) -> None:
    planned(server, diameter_mm=diameter_mm)
    patient = Patient(server=server)
    patient.register()
    check = checked(server)
    assert (check["basis"], check["method"], check["tool"]) == ("registration", "points", "drill")
    assert check["found"]["suffices"] is suffices
    kinds = [one["kind"] for one in check["remedies"]]
    if suffices:
        assert kinds == []
    else:
        assert kinds[0] == "more_landmarks"
        assert kinds[-1] == "thinner_screw"
        assert check["remedies"][0]["landmarks"] == 6
        assert check["remedies"][0]["expected"]["error_95_mm"] < check["found"]["error_95_mm"]
        thinner = check["remedies"][-1]
        assert thinner["expected"]["suffices"]
        assert thinner["diameter_mm"] < SCREW_MM
    patient.check()
    assert server.ask("GET", "/api/procedure", 200)["may_navigate"]


def test_another_plan_is_checked_again_and_an_unchanged_one_is_not(
    server: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    case_id = planned(server)
    first = checked(server)
    computed: list[str] = []
    monkeypatch.setattr(
        "server.procedure.setup_check.check_of_landmarks",
        lambda *_given, **_named: computed.append("again"),
    )
    assert checked(server) == first
    assert computed == []
    ct = server.store.current(case_id, DocumentKind.CT, "main")
    thinner = content(diameter_mm=5.0)
    server.store.put(case_id, DocumentKind.PLAN, "main", thinner, made_by="test", depends_on=[ct.id])
    activate(server)
    assert checked(server) is None
    assert computed == ["again"]


def test_a_tip_that_was_calibrated_since_the_registration_cancels_nothing(server: Server) -> None:
    case_id = planned(server)
    Patient(server=server).register()
    before_mm = checked(server)["found"]["error_95_mm"]
    before = server.adopted[-1].registration
    assert before is not None
    assert before.tool == "drill"
    store = server.store
    registered = store.latest(case_id, DocumentKind.REGISTRATION, "L3")
    tool = store.latest(case_id, DocumentKind.TOOL, "drill")
    assert registered is not None
    assert tool is not None
    # As with a tool of the settings that the case had not calibrated.
    depends_on = [one for one in registered.depends_on if one != tool.id]
    assert len(depends_on) < len(registered.depends_on)
    store.put(
        case_id, DocumentKind.REGISTRATION, "L3", registered.content, made_by="test", depends_on=depends_on
    )
    assert checked(server)["found"]["error_95_mm"] > before_mm
    # Navigation agrees.
    adopted = server.adopted[-1].registration
    assert adopted is not None
    assert adopted.tool == ""
