"""Headline, figures, alarms, overlay, wire and log never contradict each other."""

from collections import Counter
from dataclasses import replace

import pytest

from server.texts import alarm_text
from tests.server.texts.contradictions import ContradictionCheck
from tests.server.texts.random_drilling import RandomDrilling, state_of
from tracker.navigation import Verdict, assessment
from tracker.navigation.alarms import AlarmState, Condition, Presence

IMAGES = 500
SEEDS = range(2)


def test_no_moment_of_a_random_drilling_contradicts_itself() -> None:
    verdicts: Counter[Verdict | None] = Counter()
    breaches: Counter[tuple[AlarmState, Presence]] = Counter()
    states = set()
    again = 0
    for seed in SEEDS:
        check = ContradictionCheck()
        for moment in RandomDrilling(seed).moments(IMAGES):
            check.check(moment)
            states.add(state_of(moment))
            verdicts[moment.message.headline.verdict] += 1
            breaches.update(
                (alarm.state, alarm.presence)
                for alarm in moment.alarms.alarms
                if alarm.condition is Condition.BREACH
            )
        again += check.again
    # Without events the test would prove nothing.
    assert set(verdicts) == {None, *Verdict} - {Verdict.NOT_ASSESSED}
    assert set(breaches) >= {
        (AlarmState.ACTIVE, Presence.YES),
        (AlarmState.ACTIVE, Presence.NO),
        (AlarmState.ACTIVE, Presence.UNKNOWN),
        (AlarmState.ACKNOWLEDGED, Presence.YES),
        (AlarmState.LATCHED, Presence.NO),
    }
    assert len(states) > 150
    assert again > 0


@pytest.mark.parametrize("wrong", [Verdict.ON_PATH, Verdict.CORRECT_ENTRY])
def test_a_verdict_that_is_wrong_on_purpose_is_found(wrong: Verdict, monkeypatch: pytest.MonkeyPatch) -> None:
    right = assessment._verdict
    monkeypatch.setattr(
        assessment,
        "_verdict",
        lambda *known: wrong if right(*known) is Verdict.NEAR_WALL else right(*known),
    )
    with pytest.raises(AssertionError):
        _check_all()


def test_an_alarm_that_tells_the_present_number_of_what_is_over_is_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Once it was "the drill is through the wall: 7.3 mm", with the wall 7.3 mm away."""
    monkeypatch.setattr(
        "server.stream.alarm_messages.alarm_text",
        lambda alarm, **when: alarm_text(replace(alarm, presence=Presence.YES), **when),
    )
    with pytest.raises(AssertionError):
        _check_all()


def _check_all() -> None:
    for seed in SEEDS:
        check = ContradictionCheck()
        for moment in RandomDrilling(seed).moments(IMAGES):
            check.check(moment)
