"""Invariants of the alarms: deterministic, no chatter, silent without a condition."""

import math
import random
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.navigation.alarms.alarm_stream import RATE_HZ, Stream, good
from tracker.navigation.alarms import (
    ALARM_RULES,
    AlarmEngine,
    AlarmEvent,
    AlarmSnapshot,
    AlarmState,
    Change,
    Condition,
    Sound,
)

MINUTE_IMAGES = int(60 * RATE_HZ)


@cache
def played(seed: int) -> list[AlarmSnapshot]:
    """A minute in which everything happens, by this seed."""
    rng, engine, at_s, pictures = random.Random(seed), AlarmEngine(), 0.0, []
    for number in range(MINUTE_IMAGES):
        at_s += rng.choice((0.033, 0.033, 0.2))
        seen = good(
            number,
            at_s,
            clearance_mm=0.7 + 1.2 * math.sin(at_s) + rng.gauss(0.0, 0.1),
            breach_ratio=rng.random() * 0.1,
            past_depth_mm=rng.gauss(-0.5, 0.5),
            drill_unseen_s=rng.choice((0.0, 0.0, 1.5)),
            camera_works=rng.random() > 0.01,
            hold_requested_by=rng.choice(("", "", "Dr Sato")),
        )
        pictures.append(engine.step(seen, at_s))
        if rng.random() < 0.01:
            numbers = [alarm.number for alarm in engine.picture.alarms[:1]]
            pictures.append(engine.acknowledge(numbers, by="surgeon", at_s=at_s))
        if rng.random() < 0.01:
            pictures.append(engine.pause(rng.uniform(1.0, 120.0), by="nurse", at_s=at_s))
    return pictures


def test_a_recording_played_again_gives_the_same_alarms() -> None:
    first = played(3)
    assert played.__wrapped__(3) == first
    assert {event.change for picture in first for event in picture.events} >= {
        *(Change.RAISED, Change.ACKNOWLEDGED, Change.PAUSED, Change.PAUSE_BROKEN, Change.LATCHED),
    }
    assert played(4) != first


def test_the_alarms_of_an_image_are_consistent() -> None:
    for before, picture in pairwise(played(3)):
        assert len({alarm.condition for alarm in picture.alarms}) == len(picture.alarms)
        ranks = [alarm.priority.rank for alarm in picture.alarms]
        assert ranks == sorted(ranks, reverse=True)
        active = [alarm for alarm in picture.alarms if alarm.state is AlarmState.ACTIVE]
        paused = picture.paused_until_s > picture.at_s
        assert (picture.sound is Sound.SILENT) == (paused or not active)
        if active and not paused:
            assert picture.sound.value == active[0].priority.value
            assert picture.sound_number == active[0].number
        assert picture.pause_left_s <= 120.0
        # Whatever is seen has a line in the log.
        if picture.revision == before.revision:
            assert [(a.number, a.state) for a in picture.alarms] == [
                (a.number, a.state) for a in before.alarms
            ]


def onsets(events: list[AlarmEvent], condition: Condition) -> list[float]:
    return [event.at_s for event in events if event.condition is condition and event.change is Change.RAISED]


AT_ITS_THRESHOLD = [
    (Condition.BREACH, "clearance_mm", 0.0, 0.2),
    (Condition.CLEARANCE_LOW, "clearance_mm", 1.0, 0.2),
    (Condition.BREACH_LIKELY, "breach_ratio", 0.05, 0.02),
    (Condition.PAST_DEPTH, "past_depth_mm", 0.0, 0.2),
    (Condition.POSE_UNCERTAIN, "tip_sd_mm", 1.0, 0.1),
]


@pytest.mark.parametrize(("condition", "name", "limit", "noise"), AT_ITS_THRESHOLD)
def test_jitter_at_the_threshold_is_one_alarm_at_most(
    condition: Condition, name: str, limit: float, noise: float
) -> None:
    # On the side of the alarm, so that it would often be raised and go.
    off = 0.7 if name in {"breach_ratio", "past_depth_mm", "tip_sd_mm"} else -0.7
    stream, rng = Stream(), np.random.default_rng(7)
    for value in limit + noise * (off + rng.standard_normal(MINUTE_IMAGES)):
        stream.image(**{name: max(float(value), 0.0) if name == "breach_ratio" else float(value)})
    assert len(onsets(stream.events, condition)) <= 1


@settings(max_examples=20, deadline=None)
@given(
    clearances_mm=st.lists(st.floats(-3.0, 3.0), min_size=20, max_size=200),
    acknowledges=st.lists(st.booleans(), min_size=1, max_size=10),
    rate_hz=st.sampled_from([5.0, 15.0, 30.0, 60.0]),
)
def test_whatever_the_value_does_alarms_of_a_condition_keep_their_distance(
    clearances_mm: list[float], acknowledges: list[bool], rate_hz: float
) -> None:
    stream = Stream(rate_hz=rate_hz)
    for number, clearance_mm in enumerate(clearances_mm):
        stream.image(clearance_mm=clearance_mm)
        if acknowledges[number % len(acknowledges)] and number % 7 == 0:
            stream.acknowledge()
    for condition in (Condition.BREACH, Condition.CLEARANCE_LOW):
        for one, next_one in pairwise(onsets(stream.events, condition)):
            assert next_one - one >= ALARM_RULES[condition].clear_s - 1e-9


def test_no_alarm_in_minutes_of_good_drilling() -> None:
    stream, rng = Stream(), np.random.default_rng(11)
    images = 3 * MINUTE_IMAGES
    seconds = np.arange(images) / RATE_HZ
    # Down to 0.15 mm above the warning distance, by a hand that wanders, with the noise of a far marker.
    true_mm = 1.15 + 0.5 * (1.0 + np.sin(seconds / 7.0))
    clearance_mm = true_mm + 0.2 * rng.standard_normal(images)
    unseen_s = 0.0
    for number in range(images):
        # One image in twenty without the marker, now and then a hand before it for up to half a second.
        unseen_s = unseen_s + 1 / RATE_HZ if rng.random() < (0.9 if 0 < unseen_s < 0.5 else 0.05) else 0.0
        stream.image(clearance_mm=float(clearance_mm[number]), drill_unseen_s=unseen_s)
    assert stream.raised() == []
