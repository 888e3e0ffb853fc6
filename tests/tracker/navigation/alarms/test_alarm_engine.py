"""The alarm engine, as seen by its user."""

import pytest

from tests.tracker.navigation.alarms.alarm_stream import Stream, good
from tracker.camera import CameraControl, ControlChange
from tracker.errors import InvalidInput
from tracker.navigation.alarms import (
    NOT_KNOWN,
    AlarmEngine,
    AlarmInputs,
    AlarmState,
    Change,
    Condition,
    Presence,
    Priority,
    Sound,
)
from tracker.photometric import FocalLengthError

UNSEEN = {
    "clearance_mm": NOT_KNOWN,
    "breach_ratio": NOT_KNOWN,
    "past_depth_mm": NOT_KNOWN,
    "tip_sd_mm": NOT_KNOWN,
}
HIGHS = {"clearance_mm": -0.4}


def test_a_breach_sounds_with_the_second_image_that_shows_it() -> None:
    stream = Stream()
    assert stream.images(1.0).alarms == ()
    assert stream.image(clearance_mm=-0.2).sound is Sound.SILENT
    picture = stream.image(clearance_mm=-0.3)
    assert picture.sound is Sound.HIGH
    top = picture.top
    assert top is not None
    assert (top.condition, top.state) == (Condition.BREACH, AlarmState.ACTIVE)
    assert top.measure is not None
    assert (top.measure.value, top.measure.limit, top.measure.unit) == (-0.3, 0.0, "mm")


def test_one_spoilt_image_is_no_breach() -> None:
    stream = Stream()
    stream.images(1.0)
    stream.image(clearance_mm=-3.0)
    assert stream.images(2.0).alarms == ()


@pytest.mark.parametrize("rate_hz", [2.0, 5.0, 10.0, 12.0])
def test_of_a_slow_camera_the_first_image_is_enough(rate_hz: float) -> None:
    stream = Stream(rate_hz=rate_hz)
    stream.images(2.0)
    assert stream.image(clearance_mm=-0.2).sound is Sound.HIGH


def test_a_breach_with_no_image_after_it_sounds_within_its_budget() -> None:
    stream = Stream()
    stream.images(1.0)
    seen_at_s = stream.at_s + 1 / 30
    stream.image(clearance_mm=-0.2)
    stream.silence(0.15, clearance_mm=-0.2)
    raised = next(event for event in stream.events if event.condition is Condition.BREACH)
    assert raised.at_s - seen_at_s <= 0.15


def test_a_breach_stays_in_sight_until_it_is_acknowledged_and_its_sound_stops_when_it_clears() -> None:
    stream = Stream()
    stream.images(0.2, clearance_mm=-0.8)
    assert stream.images(0.5).sound is Sound.HIGH, "not yet sure that it is gone"
    picture = stream.images(1.0)
    assert picture.sound is Sound.SILENT
    assert [(alarm.condition, alarm.state) for alarm in picture.alarms] == [
        (Condition.BREACH, AlarmState.LATCHED)
    ]
    peak = picture.alarms[0].peak
    assert peak is not None
    assert peak.measure.value == -0.8
    assert stream.images(60.0).alarms[0].state is AlarmState.LATCHED
    assert stream.acknowledge().alarms == ()
    assert stream.events[-1].by == "surgeon"


def test_a_breach_that_is_over_stays_above_lower_alarms_until_it_is_acknowledged() -> None:
    stream = Stream()
    stream.images(0.2, clearance_mm=-0.8)
    stream.images(2.0)
    picture = stream.images(30.0, armed_screens=0, clearance_mm=0.5)
    assert [(alarm.condition, alarm.state) for alarm in picture.alarms] == [
        (Condition.BREACH, AlarmState.LATCHED),
        (Condition.CLEARANCE_LOW, AlarmState.ACTIVE),
        (Condition.NO_ARMED_SCREEN, AlarmState.ACTIVE),
    ]
    assert picture.sound is Sound.MEDIUM, "what is over is silent"


def test_a_breach_that_comes_again_has_its_own_time_and_worst_value_and_the_one_before_stays_in_sight() -> (
    None
):
    stream = Stream()
    stream.images(0.2, clearance_mm=-1.2)
    first_s = stream.at_s
    stream.images(60.0)
    stream.images(0.2, clearance_mm=-0.3)
    second_s = stream.at_s
    alarm = stream.images(2.0).alarms[0]
    assert alarm.peak is not None
    assert alarm.earlier_peak is not None
    assert alarm.state is AlarmState.LATCHED
    assert [alarm.peak.measure.value, alarm.earlier_peak.measure.value] == [-0.3, -1.2]
    assert alarm.peak.at_s == pytest.approx(second_s, abs=0.2)
    assert alarm.earlier_peak.at_s == pytest.approx(first_s, abs=0.2)
    # Of several before it the worst stays.
    stream.images(0.2, clearance_mm=-0.5)
    alarm = stream.images(2.0).alarms[0]
    assert alarm.peak is not None
    assert alarm.earlier_peak is not None
    assert [alarm.peak.measure.value, alarm.earlier_peak.measure.value] == [-0.5, -1.2]
    assert stream.acknowledge().alarms == ()
    stream.images(0.2, clearance_mm=-0.4)
    assert stream.images(2.0).alarms[0].earlier_peak is None, "what was acknowledged is not told again"


def test_one_image_that_shows_a_latched_breach_leaves_its_worst_value() -> None:
    stream = Stream()
    stream.images(0.2, clearance_mm=-0.4)
    stream.images(2.0)
    stream.image(clearance_mm=-2.0)
    alarm = stream.images(2.0).alarms[0]
    assert alarm.peak is not None
    assert alarm.peak.measure.value == -0.4
    assert alarm.earlier_peak is None


def test_an_acknowledged_breach_is_silent_and_sounds_again_when_it_gets_deeper() -> None:
    stream = Stream()
    stream.images(0.2, clearance_mm=-0.5)
    assert stream.acknowledge("M. Ito").sound is Sound.SILENT
    picture = stream.images(60.0, clearance_mm=-0.9)
    assert picture.sound is Sound.SILENT
    assert picture.alarms[0].acknowledged_by == "M. Ito"
    picture = stream.image(clearance_mm=-1.6)
    assert picture.sound is Sound.HIGH
    assert picture.alarms[0].acknowledged_by == ""
    assert stream.events[-1].change is Change.WORSE


def test_a_drill_that_is_not_seen_does_not_end_its_breach() -> None:
    stream = Stream()
    stream.images(0.2, clearance_mm=-0.5)
    picture = stream.images(30.0, **UNSEEN, drill_unseen_s=5.0)
    assert picture.sound is Sound.HIGH
    assert {alarm.condition for alarm in picture.alarms} == {Condition.BREACH, Condition.DRILL_UNSEEN}


def test_a_breach_that_is_gone_when_navigation_ends_is_kept_in_sight() -> None:
    stream = Stream()
    stream.images(0.2, clearance_mm=-0.5)
    picture = stream.images(2.0, clearance_mm=-0.5, navigating=False)
    assert picture.sound is Sound.SILENT
    assert picture.alarms[0].state is AlarmState.LATCHED


def test_what_was_raised_after_they_looked_is_not_acknowledged() -> None:
    stream = Stream()
    seen = [alarm.number for alarm in stream.images(1.0, clearance_mm=0.5).alarms]
    stream.images(0.2, clearance_mm=-0.5)
    picture = stream.command(lambda engine: engine.acknowledge(seen, by="x", at_s=stream.at_s))
    states = {alarm.condition: alarm.state for alarm in picture.alarms}
    assert states == {Condition.BREACH: AlarmState.ACTIVE, Condition.CLEARANCE_LOW: AlarmState.ACKNOWLEDGED}


def test_the_highest_sounds_alone_and_the_lower_ones_stay_listed() -> None:
    stream = Stream()
    assert stream.images(1.0, free_disk_mb=10.0).sound is Sound.LOW
    assert stream.images(1.0, free_disk_mb=10.0, hold_requested_by="Dr Sato").sound is Sound.MEDIUM
    picture = stream.images(1.0, free_disk_mb=10.0, hold_requested_by="Dr Sato", **HIGHS)
    assert picture.sound is Sound.HIGH
    assert [alarm.priority for alarm in picture.alarms] == [Priority.HIGH, Priority.MEDIUM, Priority.LOW]
    assert picture.alarms[1].by == "Dr Sato"


def test_a_pause_silences_shows_its_time_and_ends_by_itself() -> None:
    stream = Stream()
    stream.images(1.0, **HIGHS)
    picture = stream.command(lambda engine: engine.pause(60.0, by="nurse", at_s=stream.at_s))
    assert (picture.sound, picture.pause_left_s) == (Sound.SILENT, 60.0)
    assert picture.alarms[0].state is AlarmState.ACTIVE, "a pause acknowledges nothing"
    picture = stream.images(59.9, **HIGHS)
    assert picture.sound is Sound.SILENT
    assert picture.pause_left_s == pytest.approx(0.1)
    picture = stream.images(0.2, **HIGHS)
    assert (picture.sound, picture.pause_left_s) == (Sound.HIGH, 0.0)
    assert stream.events[-1].change is Change.PAUSE_OVER


@pytest.mark.parametrize("seconds", [120.1, 0.0, -5.0, float("inf"), float("nan")])
def test_no_pause_is_longer_than_two_minutes(seconds: float) -> None:
    with pytest.raises(InvalidInput, match="allowed is more than 0 and up to 120 s") as rejected:
        AlarmEngine().pause(seconds, by="nurse", at_s=1.0)
    assert rejected.value.code == "ALARM_PAUSE_TOO_LONG"


@pytest.mark.parametrize(
    ("new", "sound"),
    [
        pytest.param(HIGHS, Sound.HIGH, id="higher"),
        pytest.param({"hold_requested_by": "Dr Sato"}, Sound.MEDIUM, id="another of the same"),
        pytest.param({"free_disk_mb": 1.0}, Sound.MEDIUM, id="another, lower: all sound again"),
    ],
)
def test_what_is_new_breaks_a_pause(new: dict[str, object], sound: Sound) -> None:
    stream = Stream()
    stream.images(1.0, clearance_mm=0.5)
    stream.command(lambda engine: engine.pause(120.0, by="nurse", at_s=stream.at_s))
    assert stream.images(1.0, clearance_mm=0.5).sound is Sound.SILENT
    picture = stream.images(0.2, **{"clearance_mm": 0.5, **new})
    assert (picture.sound, picture.paused_until_s) == (sound, 0.0)
    assert Change.PAUSE_BROKEN in {event.change for event in stream.events}


def test_what_comes_and_goes_in_a_pause_does_not_break_it_unless_it_is_high() -> None:
    stream = Stream()
    stream.images(1.0, clearance_mm=0.5)
    stream.command(lambda engine: engine.pause(120.0, by="nurse", at_s=stream.at_s))
    stream.images(3.0)
    assert stream.images(1.0, clearance_mm=0.5).sound is Sound.SILENT
    stream.images(1.0, **HIGHS)
    stream.command(lambda engine: engine.pause(120.0, by="nurse", at_s=stream.at_s))
    assert stream.images(3.0).alarms[0].state is AlarmState.LATCHED
    assert stream.images(1.0, **HIGHS).sound is Sound.HIGH, "a second breach is a new one"


def test_a_pause_can_be_ended() -> None:
    stream = Stream()
    stream.images(1.0, **HIGHS)
    stream.command(lambda engine: engine.pause(120.0, by="nurse", at_s=stream.at_s))
    picture = stream.command(lambda engine: engine.resume(by="nurse", at_s=stream.at_s))
    assert picture.sound is Sound.HIGH


ALARMING: dict[Condition, dict[str, object]] = {
    Condition.BREACH: {"clearance_mm": -0.1},
    Condition.PAST_DEPTH: {"past_depth_mm": 0.2},
    Condition.BREACH_LIKELY: {"breach_ratio": 0.2},
    Condition.CLEARANCE_LOW: {"clearance_mm": 0.7},
    Condition.DRILL_UNSEEN: {**UNSEEN, "drill_unseen_s": 1.2},
    Condition.REFERENCE_UNSEEN: {"reference_unseen_s": 1.2},
    Condition.MARKER_TWICE: {"markers_unique": False},
    Condition.CAMERA_STALLED: {"camera_silent_s": 0.7},
    Condition.CAMERA_GONE: {"camera_works": False},
    Condition.TRACKING_STOPPED: {"tracker_works": False},
    Condition.POSE_UNCERTAIN: {"tip_sd_mm": 1.4},
    Condition.SETUP_INSUFFICIENT: {"tip_sd_mm": 1.4, "setup_sufficient": False},
    Condition.POSE_JUMPED: {"pose_steady": False},
    Condition.CAMERA_MOVED: {"camera_in_place": False},
    Condition.REFERENCE_MOVED: {"reference_in_place": False},
    Condition.CAMERA_CHANGED: {
        "camera_change": ControlChange(control=CameraControl.FOCUS, calibrated=120, now=135)
    },
    Condition.FOCAL_LENGTH_DOUBTFUL: {"focal_length_error": FocalLengthError(0.021, 0.003)},
    Condition.REGISTRATION_OUT_OF_DATE: {"registration_current": False},
    Condition.CALIBRATION_OUT_OF_DATE: {"calibration_current": False},
    Condition.CHECK_DUE: {"check_age_s": 1801.0},
    Condition.NO_ARMED_SCREEN: {"armed_screens": 0},
    Condition.DISK_NEARLY_FULL: {"free_disk_mb": 1999.0},
    Condition.VIEWER_LOST: {"lost_screens": 1},
    Condition.RECORDING_STOPPED: {"recording_runs": False},
    Condition.HOLD_REQUESTED: {"hold_requested_by": "Dr Sato"},
}


@pytest.mark.parametrize(
    "condition",
    [
        Condition.DRILL_UNSEEN,
        Condition.REFERENCE_UNSEEN,
        Condition.MARKER_TWICE,
        Condition.POSE_UNCERTAIN,
        Condition.SETUP_INSUFFICIENT,
        Condition.POSE_JUMPED,
    ],
)
def test_what_only_a_new_image_shows_is_not_claimed_of_an_old_one(condition: Condition) -> None:
    stream = Stream()
    (alarm,) = stream.images(6.0, **ALARMING[condition]).alarms
    assert alarm.presence is Presence.YES
    (alarm,) = stream.silence(0.1, image_current=False, **ALARMING[condition]).alarms
    assert alarm.presence is Presence.UNKNOWN
    picture = stream.silence(2.0, image_current=False, **ALARMING[condition])
    assert [alarm.condition for alarm in picture.alarms] == [Condition.CAMERA_STALLED]


@pytest.mark.parametrize("condition", Condition)
def test_each_condition_is_raised_and_goes(condition: Condition) -> None:
    stream = Stream(rate_hz=15.0)
    assert stream.images(1.0).alarms == ()
    picture = stream.images(6.0, **ALARMING[condition])
    assert [alarm.condition for alarm in picture.alarms] == [condition]
    stream.acknowledge()
    assert stream.images(12.0).alarms == ()


@pytest.mark.parametrize("condition", Condition)
def test_before_navigation_few_alarms_are_heard(condition: Condition) -> None:
    stream = Stream(rate_hz=15.0)
    picture = stream.images(10.0, **ALARMING[condition], navigating=False)
    outside_navigation = {
        *(Condition.FOCAL_LENGTH_DOUBTFUL, Condition.DISK_NEARLY_FULL),
        *(Condition.RECORDING_STOPPED, Condition.HOLD_REQUESTED),
    }
    assert {alarm.condition for alarm in picture.alarms} == {condition} & outside_navigation


@pytest.mark.parametrize(
    ("error", "shows"),
    [
        pytest.param(FocalLengthError(-0.021, 0.003), True, id="too short"),
        pytest.param(FocalLengthError(0.021, 0.006), False, id="may be chance"),
        pytest.param(FocalLengthError(0.009, 0.001), False, id="too small to matter"),
    ],
)
def test_a_focal_length_is_doubtful_where_its_error_is_large_and_no_chance(
    error: FocalLengthError, shows: bool
) -> None:
    picture = Stream().images(1.0, focal_length_error=error)
    assert [alarm.condition for alarm in picture.alarms] == [Condition.FOCAL_LENGTH_DOUBTFUL] * shows


def test_an_empty_set_up_is_silent() -> None:
    engine = AlarmEngine()
    for second in range(100):
        assert engine.step(AlarmInputs(navigating=False), float(second)).alarms == ()


def test_a_drill_that_was_put_away_is_not_missed() -> None:
    stream = Stream()
    stream.images(2.0, **UNSEEN, drill_unseen_s=2.0)
    assert stream.images(3.0, **UNSEEN, drill_unseen_s=200.0, drill_put_away=True).alarms == ()


def test_an_acknowledged_drill_may_stay_away_and_is_missed_again_the_next_time() -> None:
    stream = Stream()
    stream.images(2.0, **UNSEEN, drill_unseen_s=2.0)
    stream.acknowledge()
    assert stream.images(60.0, **UNSEEN, drill_unseen_s=60.0).sound is Sound.SILENT
    assert stream.images(2.0).alarms == ()
    assert stream.images(2.0, **UNSEEN, drill_unseen_s=2.0).sound is Sound.MEDIUM


def test_a_camera_that_falls_silent_is_reported_without_any_image() -> None:
    stream = Stream()
    stream.images(1.0)
    picture = stream.silence(0.7)
    assert [alarm.condition for alarm in picture.alarms] == [Condition.CAMERA_STALLED]
    assert picture.sound is Sound.MEDIUM
    raised = next(event for event in stream.events if event.change is Change.RAISED)
    assert raised.at_s - (stream.at_s - 0.7) <= 0.56


@pytest.mark.parametrize("nothing", [float("nan")])
def test_a_clearance_that_is_no_number_is_not_good_news(nothing: float) -> None:
    stream = Stream()
    stream.images(0.5, clearance_mm=-0.5)
    assert stream.images(5.0, clearance_mm=nothing).sound is Sound.HIGH
    stream = Stream()
    assert stream.images(5.0, tip_sd_mm=nothing, breach_ratio=nothing).sound is Sound.MEDIUM


def test_time_that_goes_back_changes_nothing() -> None:
    stream = Stream()
    stream.images(1.0, **HIGHS)
    picture = stream.engine.step(good(10_000, 1.0), 1.0)
    assert picture.sound is Sound.HIGH
    assert picture.at_s == stream.at_s
