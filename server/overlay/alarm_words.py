"""An alarm in words: what happened in numbers, what was allowed, and what to do."""

from collections.abc import Callable
from dataclasses import dataclass

from server.shown import shown_number
from tracker.navigation.alarms import Alarm, AlarmState, Condition, Measure

MARKS = {"high": "▲▲▲", "medium": "▲▲", "low": "▲"}


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmWords:
    """What is said of an alarm.

    Attributes:
        state: in capitals, to be read from far: "BREACH".
        sentence: what happened, in numbers, without its full stop.
        remedy: what to do.
    """

    state: str
    sentence: str
    remedy: str


def alarm_words(alarm: Alarm) -> AlarmWords:
    """The words of one alarm."""
    state, tell, remedy = _WORDS[alarm.condition]
    latched = alarm.state is AlarmState.LATCHED
    sentence = tell(alarm.worst if latched else alarm.measure, alarm)
    return AlarmWords(state=state, sentence=f"{sentence}; it is over" if latched else sentence, remedy=remedy)


def alarm_sentence(alarm: Alarm) -> str:
    """Everything in one line: state, numbers, remedy."""
    words = alarm_words(alarm)
    return f"{words.state}: {words.sentence}. {words.remedy}"


def _number(value: float, unit: str) -> str:
    decimals = 0 if unit in ("MB", "min", "") else 1
    return f"{shown_number(value, decimals=decimals)}{' ' if unit else ''}{unit}"


def _through(measure: Measure | None, alarm: Alarm) -> str:
    del alarm
    if measure is None:
        return "the drill is through the pedicle wall"
    return f"the drill is {_number(max(-measure.value, 0.0), 'mm')} through the pedicle wall"


def _past(measure: Measure | None, alarm: Alarm) -> str:
    del alarm
    if measure is None:
        return "the tip is past the planned end"
    return f"the tip is {_number(max(measure.value, 0.0), 'mm')} past the planned end"


def _over(what: str) -> Callable[[Measure | None, Alarm], str]:
    """A sentence with the number and its limit behind it."""

    def tell(measure: Measure | None, alarm: Alarm) -> str:
        del alarm
        if measure is None:
            return what
        return f"{what}: {_number(measure.value, measure.unit)}, limit {_number(measure.limit, measure.unit)}"

    return tell


def _plain(what: str) -> Callable[[Measure | None, Alarm], str]:
    def tell(measure: Measure | None, alarm: Alarm) -> str:
        del measure, alarm
        return what

    return tell


def _hold(measure: Measure | None, alarm: Alarm) -> str:
    del measure
    return f"{alarm.by or 'a colleague'} asks to hold"


_Telling = Callable[[Measure | None, Alarm], str]
_WORDS: dict[Condition, tuple[str, _Telling, str]] = {
    Condition.BREACH: ("BREACH", _through, "Stop and draw the drill back."),
    Condition.PAST_DEPTH: ("TOO DEEP", _past, "Stop and draw the drill back."),
    Condition.BREACH_LIKELY: (
        "BREACH LIKELY",
        _over("chance of being through the wall"),
        "Stop, and steady the drill in full view of the camera.",
    ),
    Condition.CLEARANCE_LOW: (
        "NEAR THE WALL",
        _over("bone left beside the drill"),
        "Turn the drill back towards the channel's axis.",
    ),
    Condition.DRILL_UNSEEN: (
        "DRILL NOT SEEN",
        _over("its marker is not seen"),
        "Bring the marker into view; acknowledge if the drill is put away.",
    ),
    Condition.REFERENCE_UNSEEN: (
        "PATIENT NOT SEEN",
        _over("the patient's marker is not seen"),
        "Clear the view of the patient's marker.",
    ),
    Condition.CAMERA_STALLED: ("NO IMAGE", _over("no image came"), "Wait; look at the camera's cable."),
    Condition.CAMERA_GONE: (
        "CAMERA GONE",
        _plain("no images come from the camera"),
        "Look at the camera and its cable; it is tried again by itself.",
    ),
    Condition.POSE_UNCERTAIN: (
        "POSE UNCERTAIN",
        _over("the tip is not sure enough for this pedicle"),
        "Show the marker nearer, steadier, more tilted.",
    ),
    Condition.POSE_JUMPED: (
        "POSE UNRESOLVED",
        _plain("two poses explain the image, or it jumped"),
        "Hold the drill still, and tilt its marker towards the camera.",
    ),
    Condition.CAMERA_MOVED: (
        "CAMERA MOVED",
        _plain("the camera has moved since the registration"),
        "Stop, and register again.",
    ),
    Condition.REFERENCE_MOVED: (
        "PATIENT MARKER MOVED",
        _plain("the patient's marker has moved since the registration"),
        "Stop, fix it, and register again.",
    ),
    Condition.REGISTRATION_OUT_OF_DATE: (
        "REGISTRATION OUT OF DATE",
        _plain("what the registration stands on was changed"),
        "Stop, and register again.",
    ),
    Condition.CALIBRATION_OUT_OF_DATE: (
        "CALIBRATION OUT OF DATE",
        _plain("the calibration no longer holds"),
        "Stop, calibrate again, then register again.",
    ),
    Condition.CHECK_DUE: (
        "CHECK DUE",
        _over("since the last check on anatomy"),
        "Put the tip on a landmark that was not used, and check.",
    ),
    Condition.NO_ARMED_SCREEN: (
        "NO SOUND",
        _plain("no screen has its sound armed"),
        "Touch the alarm band of the theatre screen once.",
    ),
    Condition.DISK_NEARLY_FULL: ("DISK NEARLY FULL", _over("room left for cases"), "Make room on the disk."),
    Condition.VIEWER_LOST: (
        "SCREEN LOST",
        _plain("a screen with armed sound has gone"),
        "Look whether the theatre screen still shows the page.",
    ),
    Condition.RECORDING_STOPPED: (
        "NOT RECORDED",
        _plain("what happens now is not written to the disk"),
        "Look whether the disk is full or gone.",
    ),
    Condition.HOLD_ASKED: ("HOLD ASKED", _hold, "Talk to them before going on."),
}
