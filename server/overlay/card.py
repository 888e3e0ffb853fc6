"""Pictures with a message, shown instead of an image, and the message of an external tracker's picture."""

from collections.abc import Mapping

import numpy as np

from server.overlay.panel_readings import RESEARCH_SOFTWARE
from server.overlay.primitives import (
    DRILL_ORANGE,
    QUIET,
    REGULAR,
    SEMIBOLD,
    WHITE,
    Image,
    text,
    text_width_px,
)
from server.texts import Language

BACKGROUND = 28
TITLE_PX = 60.0
LINE_PX = 30.0
NOTICE_PX = 17.0
MAX_LINES = 5
NO_CAMERA: Mapping[Language, tuple[str, str]] = {
    "en": ("NO CAMERA PICTURE", "an external tracker measures"),
    "de": ("KEIN KAMERABILD", "ein externes Trackingsystem misst"),
}


def draw_card(*, size_wh_px: tuple[int, int], title: str, lines: tuple[str, ...]) -> Image:
    """Return a dark picture with a title and at most five rows of sentences below it, wrapped at words."""
    width, height = size_wh_px
    card: Image = np.full((height, width, 3), BACKGROUND, dtype=np.uint8)
    scale = min(height / 720.0, width / 1000.0)
    room = width - 80.0 * scale
    rows = [row for line in lines for row in _wrapped(line, room, LINE_PX * scale)][:MAX_LINES]
    base = height / 2.0 - (len(rows) * 44.0 - 40.0) / 2.0 * scale
    title_size = _fitting(title, TITLE_PX * scale, room)
    _centred(card, title, base, title_size, SEMIBOLD, DRILL_ORANGE)
    for index, row in enumerate(rows):
        _centred(card, row, base + (62.0 + 44.0 * index) * scale, LINE_PX * scale, REGULAR, WHITE)
    _centred(card, RESEARCH_SOFTWARE, height - 20.0 * scale, NOTICE_PX * scale, REGULAR, QUIET)
    return card


def draw_no_camera(image: Image, language: Language, *, scale: float) -> None:
    """State in the blank picture of an external tracker that there is no camera; above its middle."""
    title, detail = NO_CAMERA[language]
    base = image.shape[0] / 2.0 - 80.0 * scale
    _centred(image, title, base, LINE_PX * scale, SEMIBOLD, WHITE)
    _centred(image, detail, base + 40.0 * scale, LINE_PX * scale, REGULAR, QUIET)


def _fitting(words: str, size_px: float, room_px: float) -> float:
    width = text_width_px(words, size_px=size_px, weight=SEMIBOLD)
    return size_px * min(1.0, room_px / max(width, 1.0))


def _wrapped(sentence: str, room_px: float, size_px: float) -> list[str]:
    """Wrap a sentence at words; a word that is longer than a row, such as a path, is broken."""
    rows = [""]
    for word in sentence.split():
        longer = f"{rows[-1]} {word}".strip()
        if text_width_px(longer, size_px=size_px, weight=REGULAR) <= room_px:
            rows[-1] = longer
            continue
        if rows[-1]:
            rows.append("")
        per_row = max(8, int(len(word) * room_px / text_width_px(word, size_px=size_px, weight=REGULAR)))
        pieces = [word[at : at + per_row] for at in range(0, len(word), per_row)]
        rows[-1] = pieces[0]
        rows.extend(pieces[1:])
    return rows


def _centred(
    card: Image, words: str, base: float, size: float, weight: int, colour: tuple[int, int, int]
) -> None:
    width = text_width_px(words, size_px=size, weight=weight)
    text(card, words, ((card.shape[1] - width) / 2.0, base), colour, size_px=size, weight=weight)
