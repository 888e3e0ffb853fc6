"""Texts of walls and directions."""

from collections.abc import Mapping

from server.texts.language import Language
from tracker.navigation import Direction
from tracker.navigation.alarms import Site
from tracker.navigation.clearance import WallSource
from tracker.navigation.directions import Wall

# "medial wall", "mediale Wand".
WALLS: Mapping[Language, Mapping[Wall, str]] = {
    "en": {wall: wall.value for wall in Wall},
    "de": {
        Wall.MEDIAL: "mediale",
        Wall.LATERAL: "laterale",
        Wall.CRANIAL: "kraniale",
        Wall.CAUDAL: "kaudale",
        Wall.ANTERIOR: "vordere",
    },
}
# "CORRECT 1.2 mm medial", "AIM 2.0° caudal".
TOWARDS: Mapping[Language, Mapping[Direction, str]] = {
    "en": {**{direction: direction.value for direction in Direction}, Direction.POSTERIOR: "back"},
    "de": {
        Direction.MEDIAL: "medial",
        Direction.LATERAL: "lateral",
        Direction.CRANIAL: "kranial",
        Direction.CAUDAL: "kaudal",
        Direction.POSTERIOR: "zurück",
    },
}


def wall_text(wall: Wall | None, language: Language) -> str:
    """Return a text such as "medial wall"; "wall" if unknown."""
    noun = {"en": "wall", "de": "Wand"}[language]
    return noun if wall is None else f"{WALLS[language][wall]} {noun}"


def through_text(site: Site | None, language: Language) -> str:
    """Return what a drill has passed: a wall of the bone, or the planned channel without a bone surface."""
    if site is not None and site.against is WallSource.CHANNEL:
        return {"en": "outside the planned channel", "de": "außerhalb des geplanten Kanals"}[language]
    wall = wall_text(None if site is None else site.wall, language)
    return {"en": f"through the {wall}", "de": f"durch die {wall}"}[language]


def near_text(site: Site | None, language: Language) -> str:
    """Return the wall, or the edge of the channel without a bone surface."""
    if site is not None and site.against is WallSource.CHANNEL:
        return {"en": "edge of the planned channel", "de": "Rand des geplanten Kanals"}[language]
    return wall_text(None if site is None else site.wall, language)
