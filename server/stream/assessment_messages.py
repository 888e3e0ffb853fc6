"""The figures of a drill as they are shown, and the headline, as they go over the wire."""

from typing import Literal

from server.stream.message import Message, finite
from server.stream.place_messages import AbsentMessage, absent_message
from server.texts import Headline, Text, Tone
from tracker.navigation import (
    Absent,
    Assessment,
    Correction,
    Direction,
    Figure,
    FigureName,
    Lag,
    Status,
    Verdict,
)
from tracker.navigation.clearance import MeasuredAgainst
from tracker.navigation.directions import Wall


class TextMessage(Message):
    """A text in every language."""

    en: str
    de: str


class FigureMessage(Message):
    """One number as it is shown: rounded, and compared with its limit after that."""

    value: float | None
    """Null where it does not exist: outside the bone, or of a drill across the channel."""
    limit: float | None
    """Null where there is none."""
    error_95: float | None
    """Half width of the 95 % interval; null where it is not known."""
    status: Status


class FiguresMessage(Message):
    """The figures; see `tracker.navigation.FigureName` for their units."""

    entry: FigureMessage
    angle: FigureMessage
    depth: FigureMessage
    to_go: FigureMessage
    wall: FigureMessage
    risk: FigureMessage
    end: FigureMessage
    error: FigureMessage


class CorrectionMessage(Message):
    """One component of a correction."""

    amount: float | None
    """mm or deg; null where only the direction is known."""
    towards: Direction


class LagMessage(Message):
    """How far the shown tip may lag behind one that moves; beside the figures, and in no verdict."""

    speed_mm_s: float | None
    """Of the tip in the vertebra, 0 at rest; null where it is not known yet."""
    latency_ms: float | None
    """From light to page, 99 % are within; null where it was not measured."""
    margin_mm: float | None
    """Product of both, to be added to the 95 % error; null where either is not known."""


class AssessmentMessage(Message):
    """All figures of a drill, and the verdict that follows from them."""

    kind: Literal["assessment"] = "assessment"
    verdict: Verdict
    figures: FiguresMessage
    corrections: list[CorrectionMessage]
    """How to correct what is over its limit, the larger component first."""
    wall: Wall | None
    """The nearest wall; null while the drill is outside the bone."""
    end_wall: Wall | None
    """The wall that the screw would come nearest to; null where it misses the pedicle."""
    against: MeasuredAgainst | None
    """What the wall was measured against; null where none is known."""
    lag: LagMessage | None
    """Null where nobody looked for it."""


class HeadlineMessage(Message):
    """What stands in the largest letters: the verdict of the figures, or why there are none."""

    verdict: Verdict | None
    """Null where there are no figures."""
    tone: Tone
    title: TextMessage
    detail: TextMessage
    event: TextMessage
    """Alarms that are over and not acknowledged, being cleared, or not tracked now; empty without any."""


def assessment_message(assessment: Assessment | Absent) -> AssessmentMessage | AbsentMessage:
    """The message of the figures of a drill."""
    if isinstance(assessment, Absent):
        return absent_message(assessment)
    figures = {name.value: _figure(assessment.figures[name]) for name in FigureName}
    return AssessmentMessage(
        verdict=assessment.verdict,
        figures=FiguresMessage(**figures),
        corrections=[_correction(correction) for correction in assessment.corrections],
        wall=assessment.wall,
        end_wall=assessment.end_wall,
        against=assessment.against,
        lag=_lag(assessment.lag),
    )


def _lag(lag: Lag | None) -> LagMessage | None:
    if lag is None:
        return None
    return LagMessage(
        speed_mm_s=finite(lag.speed_mm_s), latency_ms=finite(lag.latency_ms), margin_mm=finite(lag.margin_mm)
    )


def headline_message(headline: Headline) -> HeadlineMessage:
    """The message of a headline."""
    return HeadlineMessage(
        verdict=headline.verdict,
        tone=headline.tone,
        title=text_message(headline.title),
        detail=text_message(headline.detail),
        event=text_message(headline.event),
    )


def text_message(text: Text) -> TextMessage:
    """The message of a text."""
    return TextMessage(en=text["en"], de=text["de"])


def _figure(figure: Figure) -> FigureMessage:
    return FigureMessage(
        value=finite(figure.value),
        limit=finite(figure.limit),
        error_95=finite(figure.error_95),
        status=figure.status,
    )


def _correction(correction: Correction) -> CorrectionMessage:
    return CorrectionMessage(amount=finite(correction.amount), towards=correction.towards)
