"""What one image says of the drill, in a word with a shape and a colour of its own."""

import cv2
import numpy as np

from server.overlay.ink import (
    REGULAR,
    SEMIBOLD,
    WHITE,
    Colour,
    Image,
    ground,
    stroke,
    text,
    text_width_px,
)
from server.overlay.words import VerdictSaid
from tracker.geometry import Array
from tracker.navigation import Verdict

# For an image 720 px high; all of it grows with the image.
WORD_PX = 38.0
DETAIL_PX = 23.0
PADDING_PX = 12.0
ROW_PX = 52.0
DETAIL_ROW_PX = 28.0
HALF_SYMBOL_PX = 14.0

# BGR. To an eye that does not tell red from green, word and shape say the same.
GREEN: Colour = (176, 224, 111)
YELLOW: Colour = (77, 216, 255)
RED: Colour = (110, 110, 255)
COLOURS = {Verdict.ON: GREEN, Verdict.OFF: YELLOW, Verdict.UNSURE: YELLOW, Verdict.THROUGH: RED}

TURN = np.linspace(0.0, 2.0 * np.pi, 33)
# Right and down, within a square of 1 to each side of its middle.
SOLID = {
    Verdict.ON: np.stack([np.cos(TURN), np.sin(TURN)], axis=1),
    Verdict.OFF: np.array([[0.0, -1.0], [1.1, 0.9], [-1.1, 0.9], [0.0, -1.0]]),
}
OPEN = {
    Verdict.UNSURE: [np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])],
    Verdict.THROUGH: [np.array([[-0.9, -0.9], [0.9, 0.9]]), np.array([[-0.9, 0.9], [0.9, -0.9]])],
}


def draw_verdict(
    image: Image, said: VerdictSaid, *, left_px: float, bottom_px: float, width_px: float, scale: float
) -> None:
    """Draw the verdict into a box of this width: symbol and word, and under them what is to be known."""
    rows_px = (ROW_PX + (DETAIL_ROW_PX if said.detail else 0.0)) * scale
    top = bottom_px - rows_px
    ground(image, left_px, top, left_px + width_px, bottom_px)
    colour, half = COLOURS[said.verdict], HALF_SYMBOL_PX * scale
    pad = PADDING_PX * scale
    _symbol(image, said.verdict, np.array([left_px + pad + half, top + ROW_PX * scale / 2.0]), half, colour)
    start = left_px + 1.8 * pad + 2.0 * half
    room = left_px + width_px - pad - start
    size = _fitting(said.word, WORD_PX * scale, room, SEMIBOLD)
    text(image, said.word, (start, top + 39.0 * scale), colour, size_px=size, weight=SEMIBOLD)
    if said.detail:
        size = _fitting(said.detail, DETAIL_PX * scale, width_px - 2.0 * pad, REGULAR)
        text(
            image, said.detail, (left_px + pad, bottom_px - 11.0 * scale), WHITE, size_px=size, weight=REGULAR
        )


def _fitting(words: str, size_px: float, room_px: float, weight: int) -> float:
    width = text_width_px(words, size_px=size_px, weight=weight)
    return size_px * min(1.0, room_px / max(width, 1.0))


def _symbol(image: Image, verdict: Verdict, middle_px: Array, half_px: float, colour: Colour) -> None:
    if verdict in SOLID:
        corners = np.round(middle_px + half_px * SOLID[verdict]).astype(np.int32)
        cv2.fillPoly(image, [corners], colour, cv2.LINE_AA)
        return
    stroke(image, [middle_px + half_px * run for run in OPEN[verdict]], colour, width_px=0.3 * half_px)
