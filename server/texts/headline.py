"""The headline: verdict of one image with the exceeded limit and the direction of correction.

The verdict depends on the figures of the image only. Alarms that are unacknowledged or not cleared are shown
next to it; it is green only without such alarms.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import isnan

from server.texts.alarms import alarm_title, is_unobserved
from server.texts.language import NO_TEXT, Language, Text, amount, clock_text, text_of
from server.texts.places import TOWARDS, WALLS, wall_text
from server.texts.states import STATES, UNSEEN
from tracker.navigation import (
    Absent,
    AbsentReason,
    Assessment,
    Correction,
    FigureName,
    NavigationSnapshot,
    Verdict,
)
from tracker.navigation.alarms import ALARM_RULES, Alarm, AlarmSnapshot, AlarmState, Kind, Presence, Priority
from tracker.navigation.clearance import WallSource
from tracker.pose import Seen, Unseen, is_twice_in_view

# A drill that is half a vertebra off the entry is carried or laid aside, and gets no correction. Higher: the
# headline corrects a drill that is laid aside; lower: it leads nobody from nearby to the entry.
MAX_CORRECTION_MM = 30.0


class Tone(StrEnum):
    """Colour of a headline; symbol and text carry the same information as the colour."""

    GOOD = "good"  # green: on path, and no alarm
    CAUTION = "caution"  # yellow: something is to be corrected, or an alarm is not acknowledged
    WARNING = "warning"  # yellow: a wall is near, or the figures are too uncertain
    DANGER = "danger"  # red: through the wall or too deep
    NONE = "none"  # nothing is assessed


TONES: Mapping[Verdict, Tone] = {
    Verdict.THROUGH_WALL: Tone.DANGER,
    Verdict.TOO_DEEP: Tone.DANGER,
    Verdict.UNCERTAIN: Tone.WARNING,
    Verdict.BREACH_LIKELY: Tone.WARNING,
    Verdict.SETUP_INSUFFICIENT: Tone.WARNING,
    Verdict.NEAR_WALL: Tone.WARNING,
    Verdict.CORRECT_ENTRY: Tone.CAUTION,
    Verdict.CORRECT_ANGLE: Tone.CAUTION,
    Verdict.CORRECT_END: Tone.CAUTION,
    Verdict.NOT_ASSESSED: Tone.NONE,
    Verdict.ON_PATH: Tone.GOOD,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Headline:
    """Headline of one image.

    Attributes:
        verdict: Verdict on the figures; None without figures.
        tone: Colour.
        title: "CORRECT 1.2 mm medial", "NO TRACKING".
        detail: The figure with its limit and what to do, or why there are no figures.
        event: Latching alarms whose condition is over and not acknowledged, is clearing, or cannot be
            observed now: "BREACH 10:41:13 not acknowledged". Empty without such alarms.
    """

    verdict: Verdict | None
    tone: Tone
    title: Text
    detail: Text
    event: Text


def headline_of(snapshot: NavigationSnapshot | None, alarms: AlarmSnapshot) -> Headline:
    """Return the headline of an image and the alarms of that moment; without an image, of the alarms only."""
    event = text_of(lambda language: _event(alarms, language))
    if snapshot is None:
        return Headline(verdict=None, tone=Tone.NONE, title=NO_IMAGE, detail=NO_TEXT, event=event)
    assessment = snapshot.assessments.get(snapshot.displayed_tool)
    if not isinstance(assessment, Assessment):
        reason, marker = absence_of(snapshot)
        return Headline(
            verdict=None,
            tone=Tone.NONE,
            title=text_of(lambda language: STATES[language][reason].title),
            detail=text_of(lambda language: _why(snapshot, reason, marker, language)),
            event=event,
        )
    several = f"{snapshot.displayed_tool}: " if len(snapshot.tools) > 1 else ""
    return Headline(
        verdict=assessment.verdict,
        tone=_tone(assessment.verdict, alarms),
        title=text_of(lambda language: several + _title(assessment, language)),
        detail=text_of(lambda language: _detail(assessment, language)),
        event=event,
    )


def verdict_title(verdict: Verdict, language: Language) -> str:
    """Return the title of a verdict without its figures, for a list whose entries may be seconds old."""
    return " ".join(re.sub(r"±?\{\w+\}", "", TITLES[language][verdict]).split())


def absence_of(snapshot: NavigationSnapshot) -> tuple[AbsentReason, str]:
    """Return why no tool has figures, and the marker concerned; empty if no marker is concerned."""
    for name, assessment in snapshot.assessments.items():
        if isinstance(assessment, Absent):
            return assessment.reason, snapshot.setup.tools[name].marker
    # No tool belongs to a marker: the first missing prerequisite is the reason.
    for marker, sighting in snapshot.sightings.items():
        if is_twice_in_view(sighting):
            return AbsentReason.MARKER_TWICE, marker
    if not any(isinstance(sighting, Seen) for sighting in snapshot.sightings.values()):
        return AbsentReason.MARKER_UNSEEN, next(iter(snapshot.sightings), "")
    if not snapshot.setup.camera_calibrated:
        return AbsentReason.CAMERA_NOT_CALIBRATED, ""
    return AbsentReason.TOOL_NOT_DEFINED, ""


def _why(snapshot: NavigationSnapshot, reason: AbsentReason, marker: str, language: Language) -> str:
    if reason is AbsentReason.MARKER_TWICE:
        twice = ", ".join(name for name, one in snapshot.sightings.items() if is_twice_in_view(one))
        return f"{twice}: {STATES[language][reason].detail}".removeprefix(": ")
    sighting = snapshot.sightings.get(marker)
    if reason is AbsentReason.MARKER_UNSEEN and isinstance(sighting, Unseen):
        return f"{marker}: {UNSEEN[language][sighting.reason]}"
    return STATES[language][reason].detail


def _tone(verdict: Verdict, alarms: AlarmSnapshot) -> Tone:
    tone = TONES[verdict]
    disturbed = any(
        alarm.priority is not Priority.LOW and alarm.kind is not Kind.ADVISORY for alarm in alarms.alarms
    )
    return Tone.CAUTION if tone is Tone.GOOD and disturbed else tone


def _title(assessment: Assessment, language: Language) -> str:
    figures, verdict = assessment.figures, assessment.verdict
    words = TITLES[language]
    if verdict is Verdict.CORRECT_ANGLE and not assessment.corrections:
        return ACROSS[language]
    if verdict is Verdict.CORRECT_END and isnan(figures[FigureName.END].value):
        return MISSES[language]
    if verdict is Verdict.CORRECT_ENTRY and figures[FigureName.ENTRY].value > MAX_CORRECTION_MM:
        return FAR_OFF[language].format(entry_mm=amount(figures[FigureName.ENTRY].value, "mm", language))
    of_channel = assessment.against is WallSource.CHANNEL
    if of_channel and verdict in CHANNEL_TITLES[language]:
        words = CHANNEL_TITLES[language]
    wall = assessment.wall
    return (
        words[verdict]
        .format(
            wall="" if wall is None else f"{WALLS[language][wall].upper()} ",
            wall_mm=amount(abs(figures[FigureName.WALL].value), "mm", language),
            past_mm=amount(-figures[FigureName.TO_GO].value, "mm", language),
            error_mm=amount(figures[FigureName.ERROR].value, "mm", language, decimals=2),
            risk=amount(figures[FigureName.RISK].value, "%", language),
            corrections=_corrections(
                assessment.corrections, "°" if verdict is Verdict.CORRECT_ANGLE else "mm", language
            ),
        )
        .rstrip()
    )


def _corrections(corrections: tuple[Correction, ...], unit: str, language: Language) -> str:
    """Return a text such as "1.2 mm medial, 0.8 mm caudal"; unknown amounts are left out."""
    return ", ".join(
        TOWARDS[language][correction.towards]
        if isnan(correction.amount)
        else f"{amount(correction.amount, unit, language)} {TOWARDS[language][correction.towards]}"
        for correction in corrections
    )


def _detail(assessment: Assessment, language: Language) -> str:
    figures, verdict = assessment.figures, assessment.verdict
    move = ""
    if assessment.corrections and verdict is Verdict.NEAR_WALL:
        move = MOVES[language].format(towards=_corrections(assessment.corrections, "", language))
    entry, angle, end = (figures[name] for name in (FigureName.ENTRY, FigureName.ANGLE, FigureName.END))
    if verdict is Verdict.CORRECT_END and isnan(end.value):
        return MISSES_DETAIL[language]
    return DETAILS[language][verdict].format(
        entry_mm=amount(entry.value, "mm", language),
        entry_limit=amount(entry.limit, "mm", language),
        angle_deg=amount(angle.value, "°", language),
        angle_limit=amount(angle.limit, "°", language),
        wall_limit=amount(figures[FigureName.WALL].limit, "mm", language),
        risk_limit=amount(figures[FigureName.RISK].limit, "%", language),
        end=amount(end.value, "%", language),
        end_limit=amount(end.limit, "%", language),
        end_wall=wall_text(assessment.end_wall, language),
        error_limit=amount(figures[FigureName.ERROR].limit, "mm", language, decimals=2),
        min_error_mm=amount(assessment.min_error_95_mm, "mm", language, decimals=2),
        move=move,
    )


def _event(alarms: AlarmSnapshot, language: Language) -> str:
    return " · ".join(
        part for alarm in alarms.alarms if (part := _one_event(alarm, alarms.unix_offset_s, language)) != ""
    )


def _one_event(alarm: Alarm, unix_offset_s: float, language: Language) -> str:
    # Other alarms end without an acknowledgement.
    if not ALARM_RULES[alarm.condition].latches or alarm.presence is Presence.YES:
        return ""
    title = alarm_title(alarm.condition)[language]
    if is_unobserved(alarm):
        return EVENTS[language]["lost"].format(title=title)
    at_s = alarm.raised_at_s if alarm.peak is None else alarm.peak.at_s
    time = clock_text(at_s + unix_offset_s)
    state = "latched" if alarm.state is AlarmState.LATCHED else "clearing"
    return EVENTS[language][state].format(title=title, time=time)


NO_IMAGE: Text = {"en": "NO IMAGE", "de": "KEIN BILD"}
ACROSS: Text = {"en": "DRILL ACROSS CHANNEL", "de": "BOHRER QUER ZUM KANAL"}
FAR_OFF: Text = {"en": "ENTRY {entry_mm} AWAY", "de": "EINTRITT {entry_mm} ENTFERNT"}
MISSES: Text = {"en": "MISSES PEDICLE", "de": "VERFEHLT PEDIKEL"}
MISSES_DETAIL: Text = {
    "en": "this direction does not lead into the pedicle",
    "de": "diese Richtung führt nicht in den Pedikel",
}
MOVES: Text = {"en": " · move {towards}", "de": " · nach {towards}"}
EVENTS: Mapping[Language, Mapping[str, str]] = {
    "en": {
        "latched": "{title} {time} not acknowledged",
        "clearing": "{title} {time} clearing",
        "lost": "{title} when last seen",
    },
    "de": {
        "latched": "{title} {time} nicht quittiert",
        "clearing": "{title} {time} klingt ab",
        "lost": "{title} bei letzter Sichtung",
    },
}
TITLES: Mapping[Language, Mapping[Verdict, str]] = {
    "en": {
        Verdict.THROUGH_WALL: "THROUGH {wall}WALL {wall_mm}",
        Verdict.TOO_DEEP: "TOO DEEP {past_mm}",
        Verdict.UNCERTAIN: "UNCERTAIN ±{error_mm}",
        Verdict.BREACH_LIKELY: "BREACH RISK {risk}",
        Verdict.SETUP_INSUFFICIENT: "SET-UP INSUFFICIENT ±{error_mm}",
        Verdict.NEAR_WALL: "NEAR {wall}WALL {wall_mm}",
        Verdict.CORRECT_ENTRY: "CORRECT {corrections}",
        Verdict.CORRECT_ANGLE: "AIM {corrections}",
        Verdict.CORRECT_END: "AIM {corrections}",
        Verdict.NOT_ASSESSED: "TRACKING",
        Verdict.ON_PATH: "ON PATH",
    },
    "de": {
        Verdict.THROUGH_WALL: "DURCH {wall}WAND {wall_mm}",
        Verdict.TOO_DEEP: "ZU TIEF {past_mm}",
        Verdict.UNCERTAIN: "UNSICHER ±{error_mm}",
        Verdict.BREACH_LIKELY: "DURCHBRUCHRISIKO {risk}",
        Verdict.SETUP_INSUFFICIENT: "AUFBAU REICHT NICHT ±{error_mm}",
        Verdict.NEAR_WALL: "NAHE {wall}WAND {wall_mm}",
        Verdict.CORRECT_ENTRY: "KORRIGIEREN {corrections}",
        Verdict.CORRECT_ANGLE: "RICHTEN {corrections}",
        Verdict.CORRECT_END: "RICHTEN {corrections}",
        Verdict.NOT_ASSESSED: "TRACKING",
        Verdict.ON_PATH: "AUF KURS",
    },
}
# Without a bone surface the verdict refers to the planned channel instead of a wall.
CHANNEL_TITLES: Mapping[Language, Mapping[Verdict, str]] = {
    "en": {
        Verdict.THROUGH_WALL: "OUTSIDE CHANNEL {wall_mm}",
        Verdict.NEAR_WALL: "NEAR CHANNEL EDGE {wall_mm}",
    },
    "de": {
        Verdict.THROUGH_WALL: "AUSSERHALB DES KANALS {wall_mm}",
        Verdict.NEAR_WALL: "NAHE AM KANALRAND {wall_mm}",
    },
}
DETAILS: Mapping[Language, Mapping[Verdict, str]] = {
    "en": {
        Verdict.THROUGH_WALL: "Stop. Withdraw the drill.",
        Verdict.TOO_DEEP: "Stop. Withdraw the drill.",
        Verdict.UNCERTAIN: "95 % error, limit {error_limit}",
        Verdict.BREACH_LIKELY: "within 2 mm, limit {risk_limit}",
        Verdict.SETUP_INSUFFICIENT: "95 % error, at best {min_error_mm} with this registration and tool, "
        "limit {error_limit}",
        Verdict.NEAR_WALL: "limit {wall_limit}{move}",
        Verdict.CORRECT_ENTRY: "entry {entry_mm}, limit {entry_limit}",
        Verdict.CORRECT_ANGLE: "angle {angle_deg}, limit {angle_limit}",
        Verdict.CORRECT_END: "at the end: {end_wall} {end}, limit {end_limit}",
        Verdict.NOT_ASSESSED: "no planned pedicle to compare with",
        Verdict.ON_PATH: "",
    },
    "de": {
        Verdict.THROUGH_WALL: "Anhalten. Bohrer zurückziehen.",
        Verdict.TOO_DEEP: "Anhalten. Bohrer zurückziehen.",
        Verdict.UNCERTAIN: "95-%-Fehler, Grenze {error_limit}",
        Verdict.BREACH_LIKELY: "innerhalb von 2 mm, Grenze {risk_limit}",
        Verdict.SETUP_INSUFFICIENT: "95-%-Fehler, mit Registrierung und Werkzeug bestenfalls "
        "{min_error_mm}, Grenze {error_limit}",
        Verdict.NEAR_WALL: "Grenze {wall_limit}{move}",
        Verdict.CORRECT_ENTRY: "Eintritt {entry_mm}, Grenze {entry_limit}",
        Verdict.CORRECT_ANGLE: "Winkel {angle_deg}, Grenze {angle_limit}",
        Verdict.CORRECT_END: "am Ende: {end_wall} {end}, Grenze {end_limit}",
        Verdict.NOT_ASSESSED: "kein geplanter Pedikel zum Vergleich",
        Verdict.ON_PATH: "",
    },
}
