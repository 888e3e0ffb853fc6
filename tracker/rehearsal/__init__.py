"""A theatre that exists only in software, with known truth: it moves, is rendered, and knows what is true."""

from tracker.rehearsal.anatomy import Needle
from tracker.rehearsal.motion import Phase
from tracker.rehearsal.renderer import Renderer
from tracker.rehearsal.settings import BoardKind, Scene, TheatreSettings
from tracker.rehearsal.theatre import Theatre, Truth

__all__ = ["BoardKind", "Needle", "Phase", "Renderer", "Scene", "Theatre", "TheatreSettings", "Truth"]
