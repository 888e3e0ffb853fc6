"""A simulated operating theatre with ground truth: moving objects, rendered images, exact poses."""

from tracker.rehearsal.anatomy import Needle
from tracker.rehearsal.events import Event, EventKind
from tracker.rehearsal.landmarks import Landmark
from tracker.rehearsal.motion import Phase
from tracker.rehearsal.renderer import Renderer
from tracker.rehearsal.settings import BoardKind, Scene, Skill, TheatreSettings
from tracker.rehearsal.theatre import Theatre, Truth

__all__ = [
    "BoardKind",
    "Event",
    "EventKind",
    "Landmark",
    "Needle",
    "Phase",
    "Renderer",
    "Scene",
    "Skill",
    "Theatre",
    "TheatreSettings",
    "Truth",
]
