"""Drawing of the panel of figures and of the small print."""

from server.overlay.panel_readings import Panel, Reading, small_print_of
from server.overlay.primitives import (
    DRILL_ORANGE,
    QUIET,
    RED,
    REGULAR,
    SEMIBOLD,
    WHITE,
    YELLOW,
    Image,
    darken_box,
    text,
    text_width_px,
)
from server.texts import Language
from tracker.navigation import NavigationSnapshot, Status

# Sizes for an image 720 px high; they scale with the image.
MARGIN_PX = 16.0
WIDTH_PX = 240.0
ROW_PX = 57.0
NUMBER_PX = 49.0
UNIT_PX = 22.0
LABEL_PX = 19.0
STATE_PX = 40.0
DETAIL_PX = 24.0
SMALL_PX = 17.0
PADDING_PX = 14.0
NOTE_PX = 24.0
# Width of a label beside its number; a longer number is drawn smaller.
MIN_LABEL_PX = 62.0
FIGURE_COLOURS = {Status.OVER: YELLOW, Status.THROUGH: RED}


def draw_panel(image: Image, panel: Panel, *, scale: float) -> float:
    """Draw the panel in the lower left corner: one reading per row, or the state as text.

    The wound is in the middle of the image. Returns the upper edge of the panel in px.
    """
    left, bottom = MARGIN_PX * scale, float(image.shape[0] - MARGIN_PX * scale)
    if panel.readings:
        note_px = NOTE_PX if panel.note else 0.0
        top = float(bottom - (ROW_PX * len(panel.readings) + 6.0 + note_px) * scale)
        darken_box(image, left, top, left + WIDTH_PX * scale, bottom)
        if panel.note:
            at = (left + PADDING_PX * scale, bottom - 9.0 * scale)
            text(image, panel.note, at, QUIET, size_px=SMALL_PX * scale, weight=REGULAR)
        for index, reading in enumerate(panel.readings):
            _draw_reading(image, reading, left + PADDING_PX * scale, top + ROW_PX * index * scale, scale)
        return top
    headline, language = panel.headline, panel.language
    rows = [(headline.title[language], STATE_PX * scale, SEMIBOLD, DRILL_ORANGE)]
    details = [words for words in (headline.detail[language], headline.event[language]) if words]
    rows += [(words, DETAIL_PX * scale, REGULAR, WHITE) for words in details]
    width = max(text_width_px(words, size_px=size, weight=weight) for words, size, weight, _ in rows)
    top = float(bottom - (62.0 + 34.0 * len(details)) * scale)
    darken_box(image, left, top, left + width + 2.0 * PADDING_PX * scale, bottom)
    base = top + 46.0 * scale
    for words, size, weight, colour in rows:
        text(image, words, (left + PADDING_PX * scale, base), colour, size_px=size, weight=weight)
        base += 36.0 * scale
    return top


def _draw_reading(image: Image, reading: Reading, left: float, top: float, scale: float) -> None:
    """Draw one row: label on the left with the hint below it, number on the right."""
    right = left + (WIDTH_PX - 1.6 * PADDING_PX) * scale
    # A degree sign is set directly after its number; the numbers still share one column.
    is_degree = reading.unit == "°"
    unit_size, gap = (NUMBER_PX * scale, scale) if is_degree else (UNIT_PX * scale, 5.0 * scale)
    unit_width = text_width_px("mm", size_px=UNIT_PX * scale, weight=REGULAR) + 5.0 * scale
    width = text_width_px(reading.value, size_px=NUMBER_PX * scale, weight=SEMIBOLD)
    # A number that is too long is drawn smaller, never truncated.
    room = right - left - unit_width - MIN_LABEL_PX * scale
    number_size = NUMBER_PX * scale * min(1.0, room / max(width, 1.0))
    start = right - unit_width - min(width, room)
    base = top + 46.0 * scale
    colour = FIGURE_COLOURS.get(reading.status, WHITE)
    end = text(image, reading.value, (start, base), colour, size_px=number_size, weight=SEMIBOLD)
    text(image, reading.unit, (end + gap, base), QUIET, size_px=unit_size, weight=REGULAR)
    lines = [(reading.label, LABEL_PX, SEMIBOLD), (reading.hint, SMALL_PX, REGULAR)]
    for (words, size, weight), raised in zip(lines, (20.0 if reading.hint else 0.0, 0.0), strict=True):
        if words:
            wide = text_width_px(words, size_px=size * scale, weight=weight)
            fitting = size * scale * min(1.0, (start - left - 6.0 * scale) / max(wide, 1.0))
            text(image, words, (left, base - raised * scale), QUIET, size_px=fitting, weight=weight)


def draw_small_print(image: Image, snapshot: NavigationSnapshot, *, language: Language, scale: float) -> None:
    """Draw the small print: plan and registration on the left, image and notice on the right."""
    size = SMALL_PX * scale
    base = (MARGIN_PX + SMALL_PX) * scale
    plan, words = small_print_of(snapshot, language)
    if plan:
        _small(image, plan, MARGIN_PX * scale, base, size, scale)
    width = text_width_px(words, size_px=size, weight=REGULAR)
    _small(image, words, image.shape[1] - width - (MARGIN_PX + 6.0) * scale, base, size, scale)


def _small(image: Image, words: str, left: float, base: float, size: float, scale: float) -> None:
    width = text_width_px(words, size_px=size, weight=REGULAR)
    pad = 6.0 * scale
    darken_box(image, left - pad, base - size - pad * 0.3, left + width + pad, base + pad)
    text(image, words, (left, base), QUIET, size_px=size, weight=REGULAR)
