"""Texts and numbers of the panel: the assessed figures, or the reason for their absence."""

from collections.abc import Mapping
from dataclasses import dataclass

from server.texts import METHODS, Headline, Language, headline_of
from server.texts.language import amount, number_text
from server.texts.places import WALLS
from tracker.navigation import Absent, Assessment, Figure, FigureName, NavigationSnapshot, Status, ToolPose
from tracker.navigation.alarms import QUIET, AlarmSnapshot

RESEARCH_SOFTWARE = "research software, not a medical device"

LABELS: Mapping[Language, Mapping[FigureName, str]] = {
    "en": {
        FigureName.ENTRY: "ENTRY",
        FigureName.ANGLE: "ANGLE",
        FigureName.DEPTH: "DEPTH",
        FigureName.TO_GO: "TO GO",
        FigureName.WALL: "WALL",
    },
    "de": {
        FigureName.ENTRY: "EINTRITT",
        FigureName.ANGLE: "WINKEL",
        FigureName.DEPTH: "TIEFE",
        FigureName.TO_GO: "REST",
        FigureName.WALL: "WAND",
    },
}
UNITS = {FigureName.ANGLE: "°"}
LIMIT: Mapping[Language, str] = {"en": "limit {}", "de": "Grenze {}"}
OUTSIDE: Mapping[Language, str] = {"en": "outside bone", "de": "außerhalb"}
REGISTERED: Mapping[Language, str] = {"en": "registered by {}", "de": "registriert über {}"}
OF_REHEARSAL = "rehearsal's "
SIDES = {"left": "links", "right": "rechts"}
IMAGE: Mapping[Language, str] = {
    "en": f"image {{}} · {RESEARCH_SOFTWARE}",
    "de": "Bild {} · Forschungssoftware, kein Medizinprodukt",
}
STEADIED: Mapping[Language, str] = {
    "en": "smoothed · {} ms delay",
    "de": "geglättet · {} ms verzögert",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """One figure of the panel, as shown."""

    label: str
    value: str
    unit: str
    hint: str = ""
    status: Status = Status.WITHIN


@dataclass(frozen=True, slots=True, kw_only=True)
class Panel:
    """Content of the panel: headline, figures of a tool if it has any, and a note about them."""

    headline: Headline
    language: Language = "en"
    readings: tuple[Reading, ...] = ()
    note: str = ""


def small_print_of(snapshot: NavigationSnapshot, language: Language) -> tuple[str, str]:
    """Return plan and registration, empty if there is no plan, and image number with the notice."""
    setup = snapshot.setup
    plan = ""
    if setup.camera_calibrated and not isinstance(setup.channel, Absent):
        plan = channel_name(setup.channel.name, language)
        if not isinstance(setup.registration, Absent):
            method = METHODS[setup.registration.method][language]
            plan += f" · {REGISTERED[language].format(method)}"
    return plan, IMAGE[language].format(snapshot.image_number)


def channel_name(name: str, language: Language) -> str:
    """Return the name of a channel; only one made by this program, a level and a side, is translated."""
    level, _, side = name.rpartition(" ")
    if language == "en" or not level or side not in SIDES:
        return name
    if level.startswith(OF_REHEARSAL):
        return f"{level.removeprefix(OF_REHEARSAL)} {SIDES[side]} · Probebetrieb"
    return f"{level} {SIDES[side]}"


def panel_of(snapshot: NavigationSnapshot, alarms: AlarmSnapshot = QUIET, language: Language = "en") -> Panel:
    """Return the panel of one image, for the tool with the most severe verdict."""
    headline, tool = headline_of(snapshot, alarms), snapshot.displayed_tool
    assessment = snapshot.assessments.get(tool)
    if not isinstance(assessment, Assessment):
        return Panel(headline=headline, language=language)
    return Panel(
        headline=headline,
        language=language,
        readings=tuple(
            _reading(name, assessment.figures[name], assessment, language) for name in LABELS[language]
        ),
        note=_note(snapshot.tools[tool], language),
    )


def _reading(name: FigureName, figure: Figure, assessment: Assessment, language: Language) -> Reading:
    unit = UNITS.get(name, "mm")
    hint = ""
    if name is FigureName.WALL:
        wall = assessment.wall
        hint = OUTSIDE[language] if figure.status is Status.OUTSIDE else ""
        hint = WALLS[language][wall] if wall is not None else hint
    elif name in (FigureName.ENTRY, FigureName.ANGLE) and figure.status is not Status.UNLIMITED:
        hint = LIMIT[language].format(amount(figure.limit, "°" if unit == "°" else "", language))
    return Reading(
        label=LABELS[language][name],
        value=number_text(figure.value, language),
        unit=unit,
        hint=hint,
        status=figure.status,
    )


def _note(tool: ToolPose | Absent, language: Language) -> str:
    """Return the note on smoothing and its delay; empty without smoothing."""
    if isinstance(tool, Absent) or tool.lag_ms <= 0.0:
        return ""
    return STEADIED[language].format(max(round(tool.lag_ms), 1))
