"""Drawing of the headline, with a symbol and a colour for its tone."""

import cv2
import numpy as np

from server.overlay.primitives import (
    GREEN,
    RED,
    REGULAR,
    SEMIBOLD,
    WHITE,
    YELLOW,
    Box,
    Colour,
    Image,
    darken_box,
    stroke,
    text,
    text_width_px,
)
from server.texts import Headline, Language, Tone
from tracker.geometry import Array

# Sizes for an image 720 px high; they scale with the image.
TITLE_PX = 38.0
# The panel below needs the minimum; a longer title widens the box up to the maximum.
MIN_WIDTH_PX = 240.0
MAX_WIDTH_PX = 520.0
DETAIL_PX = 23.0
PADDING_PX = 12.0
ROW_PX = 52.0
DETAIL_ROW_PX = 28.0
HALF_SYMBOL_PX = 14.0

COLOURS = {
    Tone.GOOD: GREEN,
    Tone.CAUTION: YELLOW,
    Tone.WARNING: YELLOW,
    Tone.DANGER: RED,
    Tone.NONE: WHITE,
}

TURN = np.linspace(0.0, 2.0 * np.pi, 33)
# (right, down) in a square of side 2 centred on the origin.
DISC = np.stack([np.cos(TURN), np.sin(TURN)], axis=1)
TRIANGLE = np.array([[0.0, -1.0], [1.1, 0.9], [-1.1, 0.9], [0.0, -1.0]])
DIAMOND = np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
CROSS = [np.array([[-0.9, -0.9], [0.9, 0.9]]), np.array([[-0.9, 0.9], [0.9, -0.9]])]
SOLID = {Tone.GOOD: DISC, Tone.CAUTION: TRIANGLE}
OPEN = {Tone.WARNING: [DIAMOND], Tone.DANGER: CROSS, Tone.NONE: [0.6 * DISC]}


def draw_headline(
    image: Image, headline: Headline, language: Language, *, left_px: float, bottom_px: float, scale: float
) -> Box:
    """Draw the headline above `bottom_px`: symbol and title, with detail and event below them.

    Returns the covered box.
    """
    title = headline.title[language]
    rows = [words for words in (headline.detail[language], headline.event[language]) if words]
    pad, half = PADDING_PX * scale, HALF_SYMBOL_PX * scale
    start = left_px + 1.8 * pad + 2.0 * half
    needed = [start - left_px + text_width_px(title, size_px=TITLE_PX * scale, weight=SEMIBOLD) + pad]
    needed += [text_width_px(words, size_px=DETAIL_PX * scale, weight=REGULAR) + 2.0 * pad for words in rows]
    room = min(MAX_WIDTH_PX * scale, image.shape[1] - 2.0 * left_px)
    width = min(max(MIN_WIDTH_PX * scale, *needed), room)
    top = bottom_px - (ROW_PX + DETAIL_ROW_PX * len(rows)) * scale
    darken_box(image, left_px, top, left_px + width, bottom_px)
    colour = COLOURS[headline.tone]
    middle = np.array([left_px + pad + half, top + ROW_PX * scale / 2.0])
    _symbol(image, headline.tone, middle, half, colour)
    size = _fitting(title, TITLE_PX * scale, left_px + width - pad - start, SEMIBOLD)
    text(image, title, (start, top + 39.0 * scale), colour, size_px=size, weight=SEMIBOLD)
    for index, words in enumerate(rows):
        size = _fitting(words, DETAIL_PX * scale, width - 2.0 * pad, REGULAR)
        base = top + (ROW_PX + DETAIL_ROW_PX * (index + 1) - 11.0) * scale
        text(image, words, (left_px + pad, base), WHITE, size_px=size, weight=REGULAR)
    return Box(top_px=top, right_px=left_px + width)


def _fitting(words: str, size_px: float, room_px: float, weight: int) -> float:
    width = text_width_px(words, size_px=size_px, weight=weight)
    return size_px * min(1.0, room_px / max(width, 1.0))


def _symbol(image: Image, tone: Tone, middle_px: Array, half_px: float, colour: Colour) -> None:
    if tone in SOLID:
        corners = np.round(middle_px + half_px * SOLID[tone]).astype(np.int32)
        cv2.fillPoly(image, [corners], colour, cv2.LINE_AA)
        return
    stroke(image, [middle_px + half_px * run for run in OPEN[tone]], colour, width_px=0.3 * half_px)
