"""Looks at what is inside an outline: a peek, a glance, and a closer look that moves it until it fits."""

from tracker.marker.looks.closer import STEPS, looked_closer
from tracker.marker.looks.glance import glance, likely
from tracker.marker.looks.templates import Template, Templates, templates_of

__all__ = ["STEPS", "Template", "Templates", "glance", "likely", "looked_closer", "templates_of"]
