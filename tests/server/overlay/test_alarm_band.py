"""The highest alarm is drawn into the picture."""

import numpy as np
import pytest

from server.overlay.alarm_band import draw_alarm_band
from tracker.navigation.alarms import Alarm, AlarmSnapshot, AlarmState, Condition, Measure


def alarm(condition: Condition) -> Alarm:
    return Alarm(
        number=1,
        condition=condition,
        state=AlarmState.ACTIVE,
        raised_at_s=0.0,
        measure=Measure(value=-0.4, limit=0.0, unit="mm"),
    )


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (640, 360), (360, 640), (60, 40)])
def test_the_band_is_drawn_into_any_picture_and_only_where_there_is_an_alarm(width: int, height: int) -> None:
    image = np.full((height, width, 3), 120, dtype=np.uint8)
    draw_alarm_band(image, AlarmSnapshot(), scale=height / 720)
    assert (image == 120).all()
    rings = AlarmSnapshot(alarms=(alarm(Condition.BREACH), alarm(Condition.CHECK_DUE)))
    draw_alarm_band(image, rings, scale=min(height / 720, width / 880))
    changed = np.argwhere((image != 120).any(axis=2))
    assert len(changed) > 0
    assert changed[:, 0].max() < height * 0.4
