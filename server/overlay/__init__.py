"""The overlay: navigation results drawn into a copy of the image, encoded once for all viewers.

panel_readings.py  texts and numbers of the panel (pure: snapshot -> text)
view.py            points in the camera frame -> visible polylines in pixels
primitives.py      lines with a dark halo, text on a dark background
channel.py, drill.py, panel.py, bullseye.py, headline.py, alarm_band.py   drawn elements
draw.py            all elements in order
card.py            picture shown instead of an image
strip.py           strip below an image of a recording
"""

from server.overlay.bullseye import reach_of
from server.overlay.card import draw_card
from server.overlay.draw import OverlayContent, draw_overlay, encode_jpeg
from server.overlay.panel_readings import Panel, Reading, panel_of
from server.overlay.strip import with_strip

__all__ = [
    "OverlayContent",
    "Panel",
    "Reading",
    "draw_card",
    "draw_overlay",
    "encode_jpeg",
    "panel_of",
    "reach_of",
    "with_strip",
]
