"""Contradictions between headline, figures, alarms, overlay, wire and log at one moment.

The rules are stated independently, from the digits and words alone, without reading the program's intent.

"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf

from server.number_format import NOT_KNOWN, format_number
from server.overlay import panel_of
from server.stream.alarm_messages import AlarmMessage
from server.stream.assessment_messages import AssessmentMessage, FigureMessage
from server.stream.snapshot_messages import SnapshotMessage
from tests.server.texts.random_drilling import Moment
from tracker.navigation import FigureName, Verdict
from tracker.navigation.alarms import AlarmState, Condition, Presence

# From an image with a breach to its alarm: two images, or 80 ms and the next evaluation.
MAX_UNANNOUNCED = 2
INSTRUCTION = re.compile(r"Stop\.|Anhalten\.")
DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d)")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
PHYSIOLOGICAL = {
    Condition.BREACH,
    Condition.PAST_DEPTH,
    Condition.BREACH_LIKELY,
    Condition.CLEARANCE_LOW,
}

OF_ERROR = {Condition.POSE_UNCERTAIN, Condition.SETUP_INSUFFICIENT}


@dataclass(slots=True)
class ContradictionCheck:
    """Checks moment after moment, and fails at the first contradiction in it or with those before it.

    Attributes:
        through_images: number of successive images that have shown a breach without its alarm.
        deepest: by number of a breach's alarm, the smallest clearance shown while it was raised.
        shown_before: smallest clearance shown since the last moment without a breach.
        again: number of alarms raised while an earlier one of their kind was not acknowledged.

    """

    through_images: int = 0
    deepest: dict[int, float] = field(default_factory=dict)
    shown_before: float = inf
    again: int = 0

    def check(self, moment: Moment) -> None:
        assessments = _assessments(moment.message.snapshot)
        self._headline(moment, assessments)
        for alarm in moment.message.alarms.alarms:
            self._alarm(alarm, moment, assessments)
        self._breach_is_announced(moment, assessments)
        self._worst(moment, assessments)
        self._log(moment)
        if moment.snapshot is not None and moment.message.snapshot is not None:
            _overlay(moment, moment.message.snapshot)

    def _headline(self, moment: Moment, assessments: Mapping[str, AssessmentMessage]) -> None:
        headline = moment.message.headline
        shown = moment.message.snapshot.displayed_tool if moment.message.snapshot else None
        if shown is None:
            assert headline.verdict is None
            assert not assessments
        else:
            assessment = assessments[shown]
            assert headline.verdict is assessment.verdict
            _verdict_fits(assessment)
            severity = max(each.verdict.severity for each in assessments.values())
            assert assessment.verdict.severity == severity, "the worst of several drills is shown"
            assert _numbers(headline.title.en) <= _digits(assessment)
            assert _numbers(headline.title.en) == _numbers(headline.title.de)
            assert _numbers(headline.detail.en) == _numbers(headline.detail.de)
        in_danger = headline.verdict in (Verdict.THROUGH_WALL, Verdict.TOO_DEEP)
        assert bool(INSTRUCTION.search(headline.detail.en)) == in_danger
        loud = [one for one in moment.message.alarms.alarms if one.priority != "low"]
        assert (headline.tone == "good") == (headline.verdict is Verdict.ON_PATH and not loud)
        not_present = [
            one
            for one in moment.message.alarms.alarms
            if one.condition in (Condition.BREACH, Condition.PAST_DEPTH) and one.presence is not Presence.YES
        ]
        assert bool(headline.event.en) == bool(not_present)
        for alarm in not_present:
            assert alarm.title.en in headline.event.en
            assert alarm.title.de in headline.event.de

    def _alarm(
        self, alarm: AlarmMessage, moment: Moment, assessments: Mapping[str, AssessmentMessage]
    ) -> None:
        sentence, remedy = alarm.sentence.en, alarm.remedy.en
        assert _numbers(sentence) == _numbers(alarm.sentence.de)
        assert bool(remedy) == bool(alarm.remedy.de)
        if alarm.presence is Presence.NO or alarm.state is AlarmState.LATCHED:
            assert alarm.presence is Presence.YES or not remedy, "what is over instructs nobody"
        if alarm.presence is Presence.YES and alarm.condition in PHYSIOLOGICAL:
            assert " was " not in f" {sentence.lower()}", "what is there is not moment in the past tense"
        elif alarm.condition in PHYSIOLOGICAL:
            assert "was " in sentence.lower(), "what is not there is moment in the past tense"
        if moment.snapshot is None or alarm.condition not in PHYSIOLOGICAL | OF_ERROR:
            return
        name, is_over = _FIGURE_OF[alarm.condition]
        figures = [getattr(each.figures, name) for each in assessments.values()]
        known = [figure for figure in figures if figure.value is not None]
        if alarm.presence is Presence.YES and alarm.measure is not None:
            assert any(is_over(figure) for figure in known), f"{sentence} beside {known}"
            digits = {_text(abs(figure.value or 0.0), name) for figure in known if is_over(figure)}
            assert any(text in sentence for text in digits), f"{sentence} beside {digits}"
        if alarm.presence is Presence.NO and alarm.condition in (Condition.BREACH, Condition.PAST_DEPTH):
            assert not any(is_over(figure) for figure in known), f"{sentence} beside {known}"
        if alarm.presence is Presence.UNKNOWN and alarm.condition in PHYSIOLOGICAL:
            all_seen = len(assessments) == len(moment.snapshot.tools)
            assert not (known and all_seen), "of a drill that is seen, it is known"

    def _breach_is_announced(self, moment: Moment, assessments: Mapping[str, AssessmentMessage]) -> None:
        if moment.snapshot is None:
            return
        through = any(each.verdict is Verdict.THROUGH_WALL for each in assessments.values())
        is_raised = any(
            one.condition is Condition.BREACH and one.state is not AlarmState.LATCHED
            for one in moment.alarms.alarms
        )
        self.through_images = self.through_images + 1 if through and not is_raised else 0
        assert self.through_images < MAX_UNANNOUNCED

    def _worst(self, moment: Moment, assessments: Mapping[str, AssessmentMessage]) -> None:
        """The worst value of a breach is the smallest clearance shown while it was raised."""
        if moment.snapshot is None:
            return
        walls = [one.figures.wall.value for one in assessments.values()]
        now = min((wall for wall in walls if wall is not None), default=inf)
        alarms = moment.message.alarms.alarms
        breaches = {one.number: one for one in alarms if one.condition is Condition.BREACH}
        for number, alarm in breaches.items():
            if alarm.state is not AlarmState.LATCHED:
                before = self.deepest.get(number, min(now, self.shown_before))
                self.deepest[number] = min(before, now)
            assert alarm.worst is not None
            assert alarm.worst.value <= self.deepest[number] + 1e-9
        self.shown_before = min(self.shown_before, now) if now < 0.0 and not breaches else inf

    def _log(self, moment: Moment) -> None:
        by_number = {one.number: one for one in moment.message.alarms.alarms}
        for line in moment.lines:
            change, condition = line["change"], line.get("condition")
            if condition is None:
                continue
            sentence = line["sentence"]
            assert isinstance(sentence, dict)
            if change == "raised":
                shown = by_number[_number(line)]
                # The log line is of this occurrence; the screen also names earlier ones.
                for language, word in (("en", "Earlier"), ("de", "Zuvor")):
                    own, reported = sentence[language], getattr(shown.sentence, language)
                    is_again = shown.earlier_worst is not None
                    assert reported.startswith(f"{own} {word} ") if is_again else reported == own
                self.again += 1 if shown.earlier_worst is not None else 0
            if condition == Condition.BREACH and change == "latched":
                assert line["presence"] != Presence.YES
                assert "was " in sentence["en"].lower()
                assert format_number(abs(_worst(line))) in sentence["en"]


def _assessments(snapshot: SnapshotMessage | None) -> Mapping[str, AssessmentMessage]:
    if snapshot is None:
        return {}
    return {
        tool.name: tool.assessment
        for tool in snapshot.tools
        if isinstance(tool.assessment, AssessmentMessage)
    }


def _verdict_fits(assessment: AssessmentMessage) -> None:
    """The rule of the headline, from the digits of the figures alone."""
    f = assessment.figures
    over = {
        "wall": f.wall.value is not None and _less(f.wall, f.wall.limit),
        "deep": f.to_go.status != "outside" and _less(f.to_go, 0.0),
        "error": _over(f.error),
        "risk": _over(f.risk),
        "entry": f.entry.value is None or _over(f.entry),
        "angle": _over(f.angle),
        "end": f.end.status == "over",
    }
    if assessment.verdict is Verdict.ON_PATH:
        assert not any(over.values()), over
    if f.wall.value is not None and f.wall.value < 0.0:
        assert assessment.verdict is Verdict.THROUGH_WALL
    else:
        assert assessment.verdict is not Verdict.THROUGH_WALL
    assert (assessment.verdict is Verdict.ON_PATH) == (not any(over.values()))
    named = {
        Verdict.TOO_DEEP: "deep",
        Verdict.UNCERTAIN: "error",
        Verdict.SETUP_INSUFFICIENT: "error",
        Verdict.BREACH_LIKELY: "risk",
        Verdict.NEAR_WALL: "wall",
        Verdict.CORRECT_ENTRY: "entry",
        Verdict.CORRECT_ANGLE: "angle",
        Verdict.CORRECT_END: "end",
    }
    if assessment.verdict in named:
        assert over[named[assessment.verdict]]
    if assessment.verdict in (Verdict.UNCERTAIN, Verdict.SETUP_INSUFFICIENT):
        min_mm = assessment.min_error_95_mm
        assert f.error.limit is not None
        is_out_of_reach = min_mm is not None and min_mm > f.error.limit
        assert is_out_of_reach == (assessment.verdict is Verdict.SETUP_INSUFFICIENT)


def _overlay(moment: Moment, snapshot: SnapshotMessage) -> None:
    """Words and digits in the video equal those of the wire, in both languages."""
    assert moment.snapshot is not None
    for language in ("en", "de"):
        panel = panel_of(moment.snapshot, moment.alarms, language)
        headline = moment.message.headline
        for field_name in ("title", "detail", "event"):
            assert getattr(panel.headline, field_name)[language] == getattr(
                getattr(headline, field_name), language
            )
        assert panel.headline.tone == headline.tone
        if snapshot.displayed_tool is None:
            assert panel.readings == ()
            continue
        figures = _assessments(snapshot)[snapshot.displayed_tool].figures
        shown: Sequence[FigureMessage] = [
            getattr(figures, name) for name in ("entry", "angle", "depth", "to_go", "wall")
        ]
        assert [reading.value.replace(",", ".") for reading in panel.readings] == [
            NOT_KNOWN if figure.value is None else format_number(figure.value) for figure in shown
        ]


def _over(figure: FigureMessage) -> bool:
    return figure.value is not None and figure.limit is not None and figure.value > figure.limit


def _less(figure: FigureMessage, than: float | None) -> bool:
    return figure.value is not None and than is not None and figure.value < than


def _text(value: float, name: str) -> str:
    decimals = {"risk": 0, "error": 2}.get(name, 1)
    return format_number(value, decimals=decimals)


def _numbers(text: str) -> set[str]:
    return set(NUMBER.findall(DECIMAL_COMMA.sub(".", text)))


def _digits(assessment: AssessmentMessage) -> set[str]:
    """Every number that a headline may contain: unsigned figures, corrections, 95 and 2."""
    digits = {"95", "2"}
    for name in FigureName:
        value = getattr(assessment.figures, name.value).value
        if value is not None:
            digits.add(_text(abs(value), name.value))
    return digits | {format_number(one.amount) for one in assessment.corrections if one.amount is not None}


def _number(line: Mapping[str, object]) -> int:
    number = line["number"]
    assert isinstance(number, int)
    return number


def _worst(line: Mapping[str, object]) -> float:
    worst = line["worst"]
    assert isinstance(worst, float)
    return worst


_FIGURE_OF: Mapping[Condition, tuple[str, Callable[[FigureMessage], bool]]] = {
    Condition.BREACH: ("wall", lambda figure: _less(figure, 0.0)),
    Condition.PAST_DEPTH: ("to_go", lambda figure: _less(figure, 0.0) and figure.status != "outside"),
    Condition.BREACH_LIKELY: ("risk", _over),
    Condition.CLEARANCE_LOW: ("wall", lambda figure: _less(figure, figure.limit) and not _less(figure, 0.0)),
    Condition.POSE_UNCERTAIN: ("error", _over),
    Condition.SETUP_INSUFFICIENT: ("error", _over),
}
