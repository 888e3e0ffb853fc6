"""The overlay: what is known, burned into a copy of the image, and encoded once for all who watch.

words.py    which words and numbers the panel shows       (pure: snapshot -> text)
view.py     points of the camera's frame -> runs of pixels that may be drawn
ink.py      lines with a dark halo, text on a dark ground
channel.py, drill.py, panel.py, bullseye.py, headline.py, alarm_band.py   what is drawn
draw.py     all of it in order
card.py     the picture that says that there is no picture
strip.py    the strip under an image of a recording
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
