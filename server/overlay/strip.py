"""The strip below an image of a recording: states that it is not live, and its time."""

import numpy as np

from server.overlay.primitives import (
    REGULAR,
    SEMIBOLD,
    WHITE,
    YELLOW,
    Image,
    darken_box,
    text,
    text_width_px,
)
from server.texts import Language, Text

RECORDING: Text = {"en": "RECORDING", "de": "AUFZEICHNUNG"}
NOT_LIVE: Text = {"en": "not live", "de": "nicht live"}

# For an image 720 px high.
HEIGHT_PX = 36.0
TITLE_PX, WORDS_PX, NOTE_PX = 24.0, 19.0, 26.0
PADDING_PX = 16.0
# BGR. No part of the live page has a strip of this colour.
GROUND = (92, 44, 28)
BASE_RATIO = 0.7
NOTE_BASE_PX = 84.0


def with_strip(image: Image, words: str, *, note: str = "", language: Language = "en") -> Image:
    """Return the image with a strip added below it.

    Args:
        image: (h, w, 3), BGR.
        words: Number and time of the image.
        note: What is missing from the image, drawn into it; empty if nothing is missing.
        language: Language of "RECORDING, not live".

    Returns:
        (h + strip, w, 3); the height of the strip depends only on the size of the image.
    """
    height, width = image.shape[:2]
    scale = min(height / 720.0, width / 880.0)
    strip_px = max(12, round(HEIGHT_PX * scale))
    drawn: Image = np.full((height + strip_px, width, 3), GROUND, dtype=np.uint8)
    drawn[:height] = image
    title, base = RECORDING[language], height + BASE_RATIO * strip_px
    left = PADDING_PX * scale
    end = text(drawn, title, (left, base), WHITE, size_px=TITLE_PX * scale, weight=SEMIBOLD)
    rest = f"{NOT_LIVE[language]} · {words}"
    space_px = width - end - 2.0 * left
    wide_px = text_width_px(rest, size_px=WORDS_PX * scale, weight=REGULAR)
    size_px = WORDS_PX * scale * min(1.0, space_px / max(wide_px, 1.0))
    text(drawn, rest, (end + left, base), WHITE, size_px=size_px, weight=REGULAR)
    if note:
        _draw_note(drawn, note, scale)
    return drawn


def _draw_note(image: Image, note: str, scale: float) -> None:
    width = image.shape[1]
    wide_px = text_width_px(note, size_px=NOTE_PX * scale, weight=SEMIBOLD)
    size_px = NOTE_PX * scale * min(1.0, (width - 4.0 * PADDING_PX * scale) / max(wide_px, 1.0))
    wide_px = min(wide_px, width - 4.0 * PADDING_PX * scale)
    left, base, pad = (width - wide_px) / 2.0, NOTE_BASE_PX * scale, PADDING_PX * scale
    darken_box(image, left - pad, base - NOTE_PX * scale - pad / 2.0, left + wide_px + pad, base + pad / 2.0)
    text(image, note, (left, base), YELLOW, size_px=size_px, weight=SEMIBOLD)
