"""Looks at what is inside an outline: a peek, a glance, and a closer look that moves it until it fits.

Templates compare each cell with the cells around it: a shadow or a highlight changes the correlation of the
whole picture, but not how a cell compares with its neighbours. All models share one set of outlines and one
sampling. The price is that a marker needs white paper around its square.

The likeliest outlines are moved by least squares until their inside fits a template, blurred by lens or
motion. Under motion blur or with a covered corner a true outline is off by a tenth of its side, and
unfitted a plain dark square correlates better than it; fitted, it ranks first in nine of ten images. It
costs 50 us an outline.
"""

from tracker.marker.looks.closer import STEPS, looked_closer
from tracker.marker.looks.glance import glance, likely
from tracker.marker.looks.templates import Template, Templates, templates_of

__all__ = ["STEPS", "Template", "Templates", "glance", "likely", "looked_closer", "templates_of"]
