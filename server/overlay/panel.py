"""The panel of numbers in its fixed place, and the small print."""

from server.overlay.ink import (
    DRILL_ORANGE,
    QUIET,
    REGULAR,
    SEMIBOLD,
    WHITE,
    Image,
    ground,
    text,
    text_width_px,
)
from server.overlay.words import RESEARCH_SOFTWARE, Panel, Reading
from tracker.navigation import Absent, NavigationSnapshot

# For an image 720 px high; all of it grows with the image.
MARGIN_PX = 16.0
HEIGHT_PX = 96.0
COLUMN_PX = 214.0
NUMBER_PX = 56.0
UNIT_PX = 26.0
LABEL_PX = 19.0
STATE_PX = 40.0
DETAIL_PX = 24.0
SMALL_PX = 17.0


def draw_panel(image: Image, panel: Panel, *, scale: float) -> None:
    """Draw the panel at the bottom left: readings in columns, or the state in words."""
    top = image.shape[0] - (MARGIN_PX + HEIGHT_PX) * scale
    left = MARGIN_PX * scale
    if panel.readings:
        width = COLUMN_PX * len(panel.readings) * scale
        ground(image, left, top, left + width, top + HEIGHT_PX * scale)
        for index, reading in enumerate(panel.readings):
            _draw_reading(image, reading, left + (COLUMN_PX * index + 14.0) * scale, top, scale)
        return
    width = max(
        text_width_px(panel.state, size_px=STATE_PX * scale, weight=SEMIBOLD),
        text_width_px(panel.detail, size_px=DETAIL_PX * scale, weight=REGULAR) if panel.detail else 0.0,
    )
    ground(image, left, top, left + width + 32.0 * scale, top + HEIGHT_PX * scale)
    state_base = top + (46.0 if panel.detail else 62.0) * scale
    at = left + 14.0 * scale
    text(image, panel.state, (at, state_base), DRILL_ORANGE, size_px=STATE_PX * scale, weight=SEMIBOLD)
    if panel.detail:
        base = (at, top + 80.0 * scale)
        text(image, panel.detail, base, WHITE, size_px=DETAIL_PX * scale, weight=REGULAR)


def _draw_reading(image: Image, reading: Reading, left: float, top: float, scale: float) -> None:
    room = (COLUMN_PX - 20.0) * scale
    label_size = LABEL_PX * scale
    text(image, reading.label, (left, top + 24.0 * scale), QUIET, size_px=label_size, weight=SEMIBOLD)
    if reading.unit == "°":
        # Where a degree sign belongs: high, and close to its number.
        text_unit, unit_size, gap = "°", NUMBER_PX * scale, 1.0 * scale
    else:
        text_unit, unit_size, gap = reading.unit, UNIT_PX * scale, 6.0 * scale
    unit_room = text_width_px(text_unit, size_px=unit_size, weight=REGULAR) + gap + 2.0 * scale
    width = text_width_px(reading.value, size_px=NUMBER_PX * scale, weight=SEMIBOLD)
    # A number too long for its column is written smaller, never cut.
    shrink = min(1.0, (room - unit_room) / max(width, 1.0))
    base = top + 80.0 * scale
    number_size = NUMBER_PX * scale * shrink
    end = text(image, reading.value, (left, base), WHITE, size_px=number_size, weight=SEMIBOLD)
    text(image, text_unit, (end + gap, base), QUIET, size_px=unit_size, weight=REGULAR)


def draw_small_print(image: Image, snapshot: NavigationSnapshot, *, scale: float) -> None:
    """Draw what must be there and must not disturb: plan and registration left, image and notice right."""
    setup = snapshot.setup
    size = SMALL_PX * scale
    base = (MARGIN_PX + SMALL_PX) * scale
    if setup.camera_calibrated and not isinstance(setup.channel, Absent):
        plan = setup.channel.name
        if not isinstance(setup.camera_from_vertebra, Absent):
            plan += f" · registered by {setup.registered_by}"
        _small(image, plan, MARGIN_PX * scale, base, size, scale)
    words = f"image {snapshot.image_number} · {RESEARCH_SOFTWARE}"
    width = text_width_px(words, size_px=size, weight=REGULAR)
    _small(image, words, image.shape[1] - width - (MARGIN_PX + 6.0) * scale, base, size, scale)


def _small(image: Image, words: str, left: float, base: float, size: float, scale: float) -> None:
    width = text_width_px(words, size_px=size, weight=REGULAR)
    pad = 6.0 * scale
    ground(image, left - pad, base - size - pad * 0.3, left + width + pad, base + pad)
    text(image, words, (left, base), QUIET, size_px=size, weight=REGULAR)
