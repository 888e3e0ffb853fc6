"""Messages of the displayed figures of a drill, and of the headline."""

from typing import Literal

from server.number_format import finite
from server.stream.message import Message
from server.stream.pose_messages import AbsentMessage, absent_message
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
from tracker.navigation.clearance import WallSource
from tracker.navigation.directions import Wall


class TextMessage(Message):
    """A text in every language."""

    en: str
    de: str


class FigureMessage(Message):
    """One displayed number: rounded, then compared with its limit."""

    value: float | None
    """Null where it is undefined: outside the bone, or for a drill across the channel."""
    limit: float | None
    """Null without a limit."""
    error_95: float | None
    """Half width of the 95 % interval; null where unknown."""
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
    """How far the displayed tip may lag behind a moving one; beside the figures, in no verdict."""

    speed_mm_s: float | None
    """Of the tip in the vertebra, 0 at rest; null while unknown."""
    latency_ms: float | None
    """From light to page, 99th percentile; null where it was not measured."""
    margin_mm: float | None
    """Product of both, to be added to the 95 % error; null where either is unknown."""


class AssessmentMessage(Message):
    """All figures of a drill, and their verdict."""

    kind: Literal["assessment"] = "assessment"
    verdict: Verdict
    figures: FiguresMessage
    corrections: list[CorrectionMessage]
    """Corrections for values over their limit, the larger component first."""
    wall: Wall | None
    """The nearest wall; null while the drill is outside the bone."""
    end_wall: Wall | None
    """The wall nearest to the planned screw; null where it misses the pedicle."""
    against: WallSource | None
    """What the wall was measured against; null where unknown."""
    lag: LagMessage | None
    """Null where it is not measured."""
    min_error_95_mm: float | None
    """The least error that registration and tool allow on the channel; null where unknown."""


class HeadlineMessage(Message):
    """The headline: the verdict of the figures, or why there are none."""

    verdict: Verdict | None
    """Null without figures."""
    tone: Tone
    title: TextMessage
    detail: TextMessage
    event: TextMessage
    """Alarms that are past and not acknowledged, being cleared, or not tracked now; empty without any."""


def assessment_message(assessment: Assessment | Absent) -> AssessmentMessage | AbsentMessage:
    """Return the message of the figures of a drill."""
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
        min_error_95_mm=finite(assessment.min_error_95_mm),
    )


def _lag(lag: Lag | None) -> LagMessage | None:
    if lag is None:
        return None
    return LagMessage(
        speed_mm_s=finite(lag.speed_mm_s), latency_ms=finite(lag.latency_ms), margin_mm=finite(lag.margin_mm)
    )


def headline_message(headline: Headline) -> HeadlineMessage:
    """Return the message of a headline."""
    return HeadlineMessage(
        verdict=headline.verdict,
        tone=headline.tone,
        title=text_message(headline.title),
        detail=text_message(headline.detail),
        event=text_message(headline.event),
    )


def text_message(text: Text) -> TextMessage:
    """Return the message of a text."""
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
