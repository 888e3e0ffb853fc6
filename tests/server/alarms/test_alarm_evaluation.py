"""Alarms are a function of their calls: a recorded state and the same later calls give the same alarms."""

import pytest

from server.alarms import AlarmService
from server.alarms.evaluation import AlarmEvaluation, AlarmState, AlarmStep
from server.config import Config
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.recording_file import decoded_value, encoded_value
from tests.server.texts.drilled_rod import concluded, seen_at, setup_of
from tests.tracker.navigation.assessed import drill_reference
from tracker.navigation import Assessment, FigureName, Status
from tracker.navigation.alarms import AlarmInputHistory, AlarmSnapshot, alarm_inputs

RUNNING = ProcessStatus(state=ProcessState.RUNNING)
LOST = SourceStatus(name="camera 0", state=SourceState.RECONNECTING)
WELL = SourceStatus(name="camera 0", state=SourceState.RUNNING)


def test_the_steps_after_a_state_give_the_same_alarms_again() -> None:
    now_s = [100.0]
    service = AlarmService(Config(), clock=lambda: now_s[0])
    service.report_screen("theatre", armed=True)
    service.request_hold(by="Ben")
    steps: list[tuple[AlarmStep, AlarmSnapshot]] = []
    states: list[AlarmState] = []
    service.record_steps(
        lambda step, picture: steps.append((step, picture)), lambda state, _: states.append(state)
    )
    for source in (LOST, LOST, WELL, WELL):
        now_s[0] += 0.5
        service.observe(None, source, RUNNING)
    service.acknowledge([one.number for one in service.picture.alarms], by="Anna")
    service.pause(20.0, by="Anna")
    service.release_hold(by="Ben")
    service.resume(by="Anna")
    service.set_recording_runs(runs=False)
    now_s[0] += 20.0
    assert service.picture.alarms
    service.record_steps(None)
    service.picture  # noqa: B018  a step that is not recorded

    other = AlarmEvaluation.restored(decoded_value(encoded_value(states[0])))
    again = [other.apply(step) for step, _ in steps]
    without_offset = [(one.revision, one.alarms, one.events, one.sound, one.sound_number) for one in again]
    assert without_offset == [
        (one.revision, one.alarms, one.events, one.sound, one.sound_number) for _, one in steps
    ]
    assert len({one.revision for one in again}) > 4


def test_a_state_does_not_change_with_the_alarms() -> None:
    service = AlarmService(Config(), clock=lambda: 5.0)
    states: list[AlarmState] = []
    service.record_steps(None, lambda state, _: states.append(state))
    before = encoded_value(states[0])
    service.request_hold(by="Ben")
    assert encoded_value(states[0]) == before


def test_a_second_drill_at_no_wall_hides_no_risk_of_the_first() -> None:
    stands = setup_of(("awl", "drill"))
    places = {"awl": (30.0, 40.0, 0.0, 0.0, 0.0, 1.0), "drill": (30.0, 2.4, 0.0, 0.0, 0.0, 12.0)}
    snapshot = concluded(
        stands,
        drill_reference(),
        {name: seen_at(where, stands.tools[name]) for name, where in places.items()},
        number=1,
        captured_at_s=10.0,
    )
    inputs = alarm_inputs(snapshot, AlarmInputHistory(), now_s=10.0, fresh_s=0.5, put_away_after_s=5.0)
    assessed = snapshot.assessments["drill"]
    assert isinstance(assessed, Assessment)
    risk = assessed.figures[FigureName.RISK]
    assert risk.status is Status.OVER
    assert inputs.breach_ratio == pytest.approx(risk.value / 100.0)
    assert inputs.risk_site is not None
    assert inputs.risk_site.tool == "drill"
