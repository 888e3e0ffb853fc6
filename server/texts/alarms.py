"""An alarm in words: what is, what was, what is not tracked, and what to do.

Only an alarm whose condition is present has a present tense and an instruction. One that is being cleared, or
is over and not acknowledged, is told in the past tense with its worst value, place and time.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isfinite

from server.texts.controls import control_name, setting
from server.texts.language import NO_TEXT, Language, Text, amount, clock_text, text_of
from server.texts.phrases import PHRASES
from server.texts.places import near_text, through_text
from tracker.navigation.alarms import TRAITS, Alarm, AlarmState, Condition, Kind, Measure, Showing, Site


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmText:
    """The words of one alarm.

    Attributes:
        title: in capitals, to be read from afar: "BREACH".
        sentence: what is or was, in numbers.
        remedy: what to do; empty where there is nothing to be done but to acknowledge.
        known: who has acknowledged it; empty where nobody has.
    """

    title: Text
    sentence: Text
    remedy: Text
    known: Text


def alarm_title(condition: Condition) -> Text:
    """Its name in capitals."""
    return text_of(lambda language: PHRASES[language][condition].title)


def alarm_text(alarm: Alarm, *, unix_offset_s: float, of_now: bool = True) -> AlarmText:
    """The words of one alarm.

    Args:
        alarm: as the engine has it.
        unix_offset_s: to be added to the alarm's times to have them as Unix time.
        of_now: to be read at this moment; a line of the log is read later, and says nothing of then.
    """
    return AlarmText(
        title=alarm_title(alarm.condition),
        sentence=text_of(lambda language: _sentence(alarm, language, unix_offset_s, of_now=of_now)),
        remedy=text_of(lambda language: _remedy(alarm, language)),
        known=text_of(lambda language: KNOWN[language].format(by=alarm.acknowledged_by))
        if alarm.acknowledged_by
        else NO_TEXT,
    )


def without_live_figures(alarm: Alarm) -> Alarm:
    """The alarm beside figures that are too old to be shown: what figures show is not known then."""
    trait = TRAITS[alarm.condition]
    is_of_figures = trait.kind is Kind.PHYSIOLOGICAL or trait.of_newest_image
    if is_of_figures and alarm.presence is not Showing.UNKNOWN:
        return replace(alarm, presence=Showing.UNKNOWN)
    return alarm


def _sentence(alarm: Alarm, language: Language, unix_offset_s: float, *, of_now: bool) -> str:
    # A line of the log is of one occurrence; those before it have lines of their own.
    earlier = _earlier(alarm, language, unix_offset_s) if of_now else ""
    return _own_sentence(alarm, language, unix_offset_s, of_now=of_now) + earlier


def _own_sentence(alarm: Alarm, language: Language, unix_offset_s: float, *, of_now: bool) -> str:
    phrases = PHRASES[language][alarm.condition]
    fields = _fields(alarm, language, unix_offset_s)
    if alarm.presence is Showing.YES:
        if alarm.measure is None and phrases.bare:
            return phrases.bare.format(**fields)
        return phrases.present.format(**fields)
    if is_lost(alarm):
        return (phrases.lost or LOST[language]).format(**fields)
    if alarm.peak is None and phrases.bare_past:
        return phrases.bare_past.format(**fields)
    # That it is over is said of what is measured now, and of nothing else.
    is_measured = of_now and alarm.presence is Showing.NO
    return phrases.past.format(**fields) + (phrases.over if is_measured else "")


def _earlier(alarm: Alarm, language: Language, unix_offset_s: float) -> str:
    """The worst of the occurrences before it that nobody has acknowledged."""
    peak = alarm.earlier_peak
    if peak is None:
        return ""
    return EARLIER[language].format(
        value=_size(peak.measure, None), time=clock_text(peak.at_s + unix_offset_s)
    )


def is_lost(alarm: Alarm) -> bool:
    """Whether it was there when it was last seen, and nobody sees whether it still is."""
    return alarm.presence is Showing.UNKNOWN and alarm.state is not AlarmState.LATCHED


def _remedy(alarm: Alarm, language: Language) -> str:
    phrases = PHRASES[language][alarm.condition]
    if alarm.presence is Showing.YES:
        return phrases.remedy
    return phrases.lost_remedy if is_lost(alarm) else ""


def _fields(alarm: Alarm, language: Language, unix_offset_s: float) -> Mapping[str, str]:
    # As the figure that it is about: the 95 % error has two decimals.
    decimals = 2 if alarm.condition is Condition.POSE_UNCERTAIN else None
    peak = alarm.peak
    worst_site = None if peak is None else peak.site
    return {
        "value": _size(alarm.measure, decimals),
        "limit": ""
        if alarm.measure is None
        else amount(alarm.measure.limit, alarm.measure.unit, decimals=decimals),
        "worst": "" if peak is None else _size(peak.measure, decimals),
        "through": through_text(alarm.site, language),
        "worst_through": through_text(worst_site, language),
        "near": near_text(alarm.site, language),
        "worst_near": near_text(worst_site, language),
        "at": _depth(alarm.site, language),
        "worst_at": _depth(worst_site, language),
        "tool": "" if alarm.site is None or not alarm.site.tool else f"{alarm.site.tool}: ",
        "worst_tool": "" if worst_site is None or not worst_site.tool else f"{worst_site.tool}: ",
        "time": "" if peak is None else clock_text(peak.at_s + unix_offset_s),
        "by": alarm.by or SOMEBODY[language],
        "control": control_name(alarm.control, language),
        "calibrated": "" if alarm.measure is None else setting(alarm.control, alarm.measure.limit, language),
        "set": "" if alarm.measure is None else setting(alarm.control, alarm.measure.value, language),
    }


def _size(measure: Measure | None, decimals: int | None) -> str:
    """How deep, how far, how long: without a sign, because the sentence says on which side of the limit."""
    return "" if measure is None else amount(abs(measure.value), measure.unit, decimals=decimals)


def _depth(site: Site | None, language: Language) -> str:
    if site is None or not isfinite(site.depth_mm):
        return ""
    depth = amount(site.depth_mm, "mm")
    return {"en": f" at {depth} depth", "de": f" in {depth} Tiefe"}[language]


KNOWN: Text = {"en": "Acknowledged by {by}.", "de": "Quittiert von {by}."}
SOMEBODY: Text = {"en": "A colleague", "de": "Ein Kollege"}
EARLIER: Text = {"en": " Earlier {value}, {time}.", "de": " Zuvor {value}, {time}."}
LOST: Text = {"en": "Not known: no live figures.", "de": "Nicht bekannt: keine aktuellen Werte."}
