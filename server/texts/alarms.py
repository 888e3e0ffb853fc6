"""Texts of an alarm: sentence, remedy and acknowledgement.

An alarm whose condition is present has a sentence in the present tense and an instruction. An alarm that is
clearing or latched has a sentence in the past tense with its worst value, its place and time.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isfinite

from server.texts.controls import control_name, setting
from server.texts.language import NO_TEXT, Language, Text, amount, clock_text, text_of
from server.texts.phrases import PHRASES
from server.texts.places import near_text, through_text
from tracker.navigation.alarms import ALARM_RULES, Alarm, AlarmState, Condition, Kind, Measure, Presence, Site

# Of figures with other digits than their unit: the 95 % error is compared with the room in a pedicle.
DECIMALS = {Condition.POSE_UNCERTAIN: 2, Condition.SETUP_INSUFFICIENT: 2, Condition.FOCAL_LENGTH_DOUBTFUL: 1}


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmText:
    """Texts of one alarm.

    Attributes:
        title: In capitals, readable from a distance: "BREACH".
        sentence: Present or past state with numbers.
        remedy: What to do; empty if it only has to be acknowledged.
        known: Who acknowledged it; empty if nobody has.
    """

    title: Text
    sentence: Text
    remedy: Text
    known: Text


def alarm_title(condition: Condition) -> Text:
    """Return the title in capitals."""
    return text_of(lambda language: PHRASES[language][condition].title)


def alarm_text(alarm: Alarm, *, unix_offset_s: float, of_now: bool = True) -> AlarmText:
    """Return the texts of an alarm.

    Args:
        alarm: The alarm.
        unix_offset_s: Unix time minus monotonic time of the alarm.
        of_now: For display now; False for the log, which is read later.
    """
    return AlarmText(
        title=alarm_title(alarm.condition),
        sentence=text_of(lambda language: _sentence(alarm, language, unix_offset_s, of_now=of_now)),
        remedy=text_of(lambda language: _remedy(alarm, language)),
        known=text_of(lambda language: KNOWN[language].format(by=alarm.acknowledged_by))
        if alarm.acknowledged_by
        else NO_TEXT,
    )


def with_unknown_presence(alarm: Alarm) -> Alarm:
    """Return the alarm with unknown presence if it depends on figures; used while figures are stale."""
    trait = ALARM_RULES[alarm.condition]
    is_of_figures = trait.kind is Kind.PHYSIOLOGICAL or trait.needs_current_image
    if is_of_figures and alarm.presence is not Presence.UNKNOWN:
        return replace(alarm, presence=Presence.UNKNOWN)
    return alarm


def _sentence(alarm: Alarm, language: Language, unix_offset_s: float, *, of_now: bool) -> str:
    # A log line describes one occurrence; earlier ones have their own lines.
    earlier = _earlier(alarm, language, unix_offset_s) if of_now else ""
    return _own_sentence(alarm, language, unix_offset_s, of_now=of_now) + earlier


def _own_sentence(alarm: Alarm, language: Language, unix_offset_s: float, *, of_now: bool) -> str:
    phrases = PHRASES[language][alarm.condition]
    fields = _fields(alarm, language, unix_offset_s)
    if alarm.presence is Presence.YES:
        if alarm.measure is None and phrases.bare:
            return phrases.bare.format(**fields)
        return phrases.present.format(**fields)
    if is_unobserved(alarm):
        return (phrases.lost or LOST[language]).format(**fields)
    if alarm.peak is None and phrases.bare_past:
        return phrases.bare_past.format(**fields)
    # The end of the condition is only stated if it is measured now.
    is_measured = of_now and alarm.presence is Presence.NO
    return phrases.past.format(**fields) + (phrases.over if is_measured else "")


def _earlier(alarm: Alarm, language: Language, unix_offset_s: float) -> str:
    """Return the text on the worst earlier occurrence that is not acknowledged."""
    peak = alarm.earlier_peak
    if peak is None:
        return ""
    return EARLIER[language].format(
        value=_size(peak.measure, None, language), time=clock_text(peak.at_s + unix_offset_s)
    )


def is_unobserved(alarm: Alarm) -> bool:
    """Return whether the condition was present when last observed and cannot be observed now."""
    return alarm.presence is Presence.UNKNOWN and alarm.state is not AlarmState.LATCHED


def _remedy(alarm: Alarm, language: Language) -> str:
    phrases = PHRASES[language][alarm.condition]
    if alarm.presence is Presence.YES:
        return phrases.remedy
    return phrases.lost_remedy if is_unobserved(alarm) else ""


def _fields(alarm: Alarm, language: Language, unix_offset_s: float) -> Mapping[str, str]:
    decimals = DECIMALS.get(alarm.condition)
    peak = alarm.peak
    worst_site = None if peak is None else peak.site
    return {
        "value": _size(alarm.measure, decimals, language),
        "limit": ""
        if alarm.measure is None
        else amount(alarm.measure.limit, alarm.measure.unit, language, decimals=decimals),
        "worst": "" if peak is None else _size(peak.measure, decimals, language),
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


def _size(measure: Measure | None, decimals: int | None, language: Language) -> str:
    """Return the absolute value with its unit; the sentence states the side of the limit."""
    if measure is None:
        return ""
    return amount(abs(measure.value), measure.unit, language, decimals=decimals)


def _depth(site: Site | None, language: Language) -> str:
    if site is None or not isfinite(site.depth_mm):
        return ""
    depth = amount(site.depth_mm, "mm", language)
    return {"en": f" at {depth} depth", "de": f" in {depth} Tiefe"}[language]


KNOWN: Text = {"en": "Acknowledged by {by}.", "de": "Quittiert von {by}."}
SOMEBODY: Text = {"en": "A colleague", "de": "Ein Kollege"}
EARLIER: Text = {"en": " Earlier {value}, {time}.", "de": " Zuvor {value}, {time}."}
LOST: Text = {"en": "Not known: no live numbers.", "de": "Nicht bekannt: keine aktuellen Werte."}
