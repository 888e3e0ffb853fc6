"""Alarms as the engine provides them, for tests of their texts."""

from dataclasses import replace

from tracker.navigation.alarms import Alarm, AlarmState, Condition, Measure, Peak, Site
from tracker.navigation.clearance import WallSource
from tracker.navigation.directions import Wall

NOON_S = 1_700_000_000.0
MEDIAL = Site(depth_mm=29.0, wall=Wall.MEDIAL, against=WallSource.BONE)


def mm(value: float, limit: float = 0.0) -> Measure:
    return Measure(value=value, limit=limit, unit="mm")


def peak(value: float, *, at_s: float = 3.0) -> Peak:
    return Peak(measure=mm(value), severity=-value, at_s=at_s, site=MEDIAL)


def alarm(condition: Condition, state: AlarmState = AlarmState.ACTIVE, **changes: object) -> Alarm:
    return replace(Alarm(number=1, condition=condition, state=state, raised_at_s=2.0), **changes)  # pyrefly: ignore[bad-argument-type]  # any field of it


def breach(**changes: object) -> Alarm:
    """Now 0.4 mm through, or 7.3 mm away; the worst was 0.8 mm."""
    values: dict[str, object] = {
        "measure": mm(-0.4),
        "site": MEDIAL,
        "peak": peak(-0.8),
    }
    return replace(alarm(Condition.BREACH), **{**values, **changes})  # pyrefly: ignore[bad-argument-type]  # any field of it
