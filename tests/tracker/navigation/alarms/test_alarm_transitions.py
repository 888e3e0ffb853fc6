"""State transitions of one condition and of the whole engine."""

import itertools
from math import inf

import pytest

from tracker.navigation.alarms.evidence import GONE, UNKNOWN, Evidence, Measure, Presence
from tracker.navigation.alarms.occurrence import (
    AlarmState,
    Occurrence,
    Peak,
    StepContext,
    acknowledged,
    advanced,
)
from tracker.navigation.alarms.rules import ALARM_RULES, AlarmRule, Condition, Kind, Priority

N, A, K, L = AlarmState.NORMAL, AlarmState.ACTIVE, AlarmState.ACKNOWLEDGED, AlarmState.LATCHED
SHOWS = Evidence(presence=Presence.YES)
HALF = Measure(value=0.5, limit=0.0, unit="mm")


def made(state: AlarmState, *, showing_s: float = inf, gone_s: float = inf) -> Occurrence:
    return Occurrence(
        state=state,
        present_since_s=100.0 - showing_s if showing_s < inf else inf,
        absent_since_s=100.0 - gone_s if gone_s < inf else inf,
    )


def trait(*, latches: bool, persists_when_unknown: bool) -> AlarmRule:
    return AlarmRule(
        priority=Priority.HIGH,
        kind=Kind.PHYSIOLOGICAL,
        latches=latches,
        persists_when_unknown=persists_when_unknown,
        confirm_s=1.0,
        clear_s=1.0,
    )


# Next state by observation and elapsed time; where it matters, by (latches, holds).
OVER: dict[tuple[AlarmState, Evidence], AlarmState | dict[tuple[bool, bool], AlarmState]] = {
    (N, SHOWS): A,
    (N, GONE): N,
    (N, UNKNOWN): {(False, True): A, (True, True): A, (False, False): N, (True, False): N},
    (A, SHOWS): A,
    (A, GONE): {(False, False): N, (False, True): N, (True, False): L, (True, True): L},
    (A, UNKNOWN): {(False, False): N, (False, True): A, (True, False): L, (True, True): A},
    (K, SHOWS): K,
    (K, GONE): N,
    (K, UNKNOWN): {(False, False): N, (False, True): K, (True, False): N, (True, True): K},
    (L, SHOWS): A,
    (L, GONE): L,
    (L, UNKNOWN): {(False, False): L, (False, True): A, (True, False): L, (True, True): A},
}


@pytest.mark.parametrize("state", AlarmState)
@pytest.mark.parametrize("evidence", [SHOWS, GONE, UNKNOWN], ids=["shows", "gone", "unknown"])
@pytest.mark.parametrize("latches", [False, True], ids=["", "latches"])
@pytest.mark.parametrize("persists_when_unknown", [False, True], ids=["", "persists_when_unknown"])
def test_each_state_with_each_evidence(
    state: AlarmState, evidence: Evidence, latches: bool, persists_when_unknown: bool
) -> None:
    traits = trait(latches=latches, persists_when_unknown=persists_when_unknown)
    ends = OVER[state, evidence]
    ended = ends if isinstance(ends, AlarmState) else ends[latches, persists_when_unknown]
    just = advanced(made(state, showing_s=0.9, gone_s=0.9), evidence, traits, StepContext(at_s=100.0))
    assert just.state is state, "a moment before its time is over nothing changes"
    over = advanced(made(state, showing_s=1.0, gone_s=1.0), evidence, traits, StepContext(at_s=100.0))
    assert over.state is ended


@pytest.mark.parametrize("state", [N, L], ids=str)
def test_a_presence_that_ends_unconfirmed_leaves_nothing(state: AlarmState) -> None:
    pending = Occurrence(
        state=state,
        present_since_s=99.9,
        present_images=1,
        pending_peak=Peak(measure=HALF, severity=0.5, at_s=99.9),
    )
    traits = trait(latches=True, persists_when_unknown=True)
    assert advanced(pending, GONE, traits, StepContext(at_s=100.0)) == Occurrence(state=state)


@pytest.mark.parametrize(("state", "becomes"), [(N, N), (A, K), (K, K), (L, N)], ids=str)
def test_each_state_when_it_is_acknowledged(state: AlarmState, becomes: AlarmState) -> None:
    assert acknowledged(made(state), by="surgeon").state is becomes


def test_only_what_is_acknowledged_and_clearly_worse_sounds_again() -> None:
    traits = trait(latches=True, persists_when_unknown=True)
    known = Occurrence(state=K, peak=Peak(measure=HALF, severity=0.5, at_s=0.0), acknowledged_severity=0.5)
    for depth_mm, becomes in ((0.4, K), (1.49, K), (1.5, A)):
        evidence = Evidence(presence=Presence.YES, measure=HALF, severity=depth_mm)
        moment = StepContext(at_s=1.0, realarm_after_mm=1.0)
        assert advanced(known, evidence, traits, moment).state is becomes, depth_mm


def test_every_condition_has_its_priority_of_the_table() -> None:
    assert set(ALARM_RULES) == set(Condition)
    by_priority = {
        priority: {condition for condition in Condition if ALARM_RULES[condition].priority is priority}
        for priority in Priority
    }
    assert by_priority[Priority.HIGH] == {
        *(Condition.BREACH, Condition.PAST_DEPTH, Condition.CAMERA_MOVED, Condition.REFERENCE_MOVED),
        *(Condition.REGISTRATION_OUT_OF_DATE, Condition.CALIBRATION_OUT_OF_DATE, Condition.CAMERA_CHANGED),
    }
    assert by_priority[Priority.LOW] == {
        *(Condition.CHECK_DUE, Condition.NO_ARMED_SCREEN, Condition.DISK_NEARLY_FULL),
        *(Condition.VIEWER_LOST, Condition.RECORDING_STOPPED),
    }
    assert {condition for condition in Condition if ALARM_RULES[condition].latches} == {
        Condition.BREACH,
        Condition.PAST_DEPTH,
    }
    assert {condition for condition in Condition if ALARM_RULES[condition].kind is Kind.ADVISORY} == {
        Condition.HOLD_REQUESTED
    }


@pytest.mark.parametrize(
    ("was", "evidence", "image"),
    list(itertools.product(AlarmState, [SHOWS, GONE, UNKNOWN], [False, True])),
)
def test_no_moment_acknowledges_by_itself(was: AlarmState, evidence: Evidence, image: bool) -> None:
    for traits in ALARM_RULES.values():
        moment = StepContext(at_s=1e9, new_image=image, image_gap_s=1.0)
        now = advanced(made(was, showing_s=0.0, gone_s=0.0), evidence, traits, moment)
        assert now.state is not K or was is K
