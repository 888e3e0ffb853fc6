"""Every alarm in words, and burned into the picture."""

import numpy as np
import pytest

from server.overlay.alarm_band import draw_alarm_band
from server.overlay.alarm_words import alarm_sentence, alarm_words
from tracker.navigation.alarms import Alarm, AlarmPicture, AlarmState, Condition, Measure


def alarm(condition: Condition, state: AlarmState = AlarmState.ACTIVE, **values: float) -> Alarm:
    measure = Measure(value=values["value"], limit=values["limit"], unit="mm") if values else None
    worst = Measure(value=values["worst"], limit=values["limit"], unit="mm") if "worst" in values else measure
    return Alarm(number=1, condition=condition, state=state, raised_at_s=0.0, measure=measure, worst=worst)


@pytest.mark.parametrize(
    ("told", "sentence"),
    [
        pytest.param(
            alarm(Condition.BREACH, value=-0.44, limit=0.0),
            "BREACH: the drill is 0.4 mm through the pedicle wall. Stop and draw the drill back.",
            id="how far through",
        ),
        pytest.param(
            alarm(Condition.BREACH, AlarmState.LATCHED, value=1.2, limit=0.0, worst=-0.8),
            "BREACH: the drill is 0.8 mm through the pedicle wall; it is over. Stop and draw the drill back.",
            id="how far it was, once it is over",
        ),
        pytest.param(
            alarm(Condition.CLEARANCE_LOW, value=0.66, limit=1.0),
            "NEAR THE WALL: bone left beside the drill: 0.7 mm, limit 1.0 mm. "
            "Turn the drill back towards the channel's axis.",
            id="what was allowed",
        ),
    ],
)
def test_an_alarm_says_what_happened_in_numbers_and_what_to_do(told: Alarm, sentence: str) -> None:
    assert alarm_sentence(told) == sentence


@pytest.mark.parametrize("condition", Condition)
def test_every_condition_has_words_with_and_without_a_number(condition: Condition) -> None:
    for told in (alarm(condition), alarm(condition, value=0.3, limit=0.5)):
        words = alarm_words(told)
        assert words.state.isupper()
        assert words.sentence[0].islower()
        assert not words.sentence.endswith(".")
        assert words.remedy.endswith(".")


def test_states_are_told_apart() -> None:
    assert len({alarm_words(alarm(condition)).state for condition in Condition}) == len(Condition)


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (640, 360), (360, 640), (60, 40)])
def test_the_band_is_drawn_into_any_picture_and_only_where_there_is_an_alarm(width: int, height: int) -> None:
    image = np.full((height, width, 3), 120, dtype=np.uint8)
    draw_alarm_band(image, AlarmPicture(), scale=height / 720)
    assert (image == 120).all()
    rings = AlarmPicture(alarms=(alarm(Condition.BREACH, value=-0.4, limit=0.0), alarm(Condition.CHECK_DUE)))
    draw_alarm_band(image, rings, scale=min(height / 720, width / 880))
    changed = np.argwhere((image != 120).any(axis=2))
    assert len(changed) > 0
    assert changed[:, 0].max() < height * 0.4
