"""The alarm of the highest priority at the upper edge of the image: marks, title and numbers."""

from collections.abc import Mapping

from server.overlay.primitives import REGULAR, SEMIBOLD, WHITE, Box, Image, darken_box, text, text_width_px
from server.texts import Language, Text, alarm_text
from tracker.navigation.alarms import AlarmSnapshot, AlarmState, Presence, Priority

# BGR; the text repeats the priority, because one man in twelve is colour-blind.
COLOURS = {Priority.HIGH: (110, 110, 255), Priority.MEDIUM: (77, 216, 255), Priority.LOW: (242, 211, 111)}
# The font has no triangles: as many exclamation marks as the page has marks.
MARKS = {Priority.HIGH: "!!!", Priority.MEDIUM: "!!", Priority.LOW: "!"}
STATES: Mapping[AlarmState, Text] = {
    AlarmState.ACKNOWLEDGED: {"en": "acknowledged", "de": "quittiert"},
    AlarmState.LATCHED: {"en": "over, not acknowledged", "de": "vorbei, nicht quittiert"},
}
TOP_PX = 44.0
STATE_PX = 40.0
SENTENCE_PX = 22.0
STATE_ROW_PX, SENTENCE_ROW_PX = 58.0, 31.0
FIRST_BASE_PX, SENTENCE_BASE_PX = 42.0, 32.0
PADDING_PX = 14.0


def draw_alarm_band(
    image: Image,
    alarms: AlarmSnapshot,
    *,
    scale: float,
    language: Language = "en",
    beside: Box | None = None,
) -> None:
    """Draw the first alarm and the number of further alarms; nothing without an alarm.

    Args:
        image: Modified in place.
        alarms: Present alarms.
        scale: 1 for an image 720 px high.
        language: Language of the text.
        beside: Box at the left that must not be covered; the band moves to its right if they would overlap.
    """
    top = alarms.top
    if top is None:
        return
    words = alarm_text(top, unix_offset_s=alarms.unix_offset_s)
    more = f"  +{len(alarms.alarms) - 1}" if len(alarms.alarms) > 1 else ""
    # A latched condition can be present again.
    is_over = top.state is AlarmState.LATCHED and top.presence is not Presence.YES
    has_state = is_over or top.state is AlarmState.ACKNOWLEDGED
    known = f" ({STATES[top.state][language]})" if has_state else ""
    # An alarm whose condition is over has neither marks nor colour.
    marks, colour = ("", WHITE) if is_over else (f"{MARKS[top.priority]} ", COLOURS[top.priority])
    rows = [(f"{marks}{words.title[language]}{known}{more}", STATE_PX, SEMIBOLD)]
    rows += [
        (line, SENTENCE_PX, REGULAR) for line in (words.sentence[language], words.remedy[language]) if line
    ]
    above, pad = TOP_PX * scale, PADDING_PX * scale
    below = above + (STATE_ROW_PX + SENTENCE_ROW_PX * (len(rows) - 1)) * scale
    meets = beside is not None and beside.top_px < below
    left_most = (beside.right_px if beside is not None and meets else 0.0) + pad
    room = image.shape[1] - 3.0 * pad - left_most
    widths = [text_width_px(line, size_px=size * scale, weight=weight) for line, size, weight in rows]
    width = min(max(widths), room)
    middle = max(image.shape[1] / 2.0, left_most + pad + width / 2.0)
    darken_box(image, middle - width / 2.0 - pad, above, middle + width / 2.0 + pad, below)
    for index, ((line, size, weight), wide) in enumerate(zip(rows, widths, strict=True)):
        fitting = size * scale * min(1.0, room / max(wide, 1.0))
        base = above + (FIRST_BASE_PX + SENTENCE_BASE_PX * index) * scale
        at = (middle - min(wide, room) / 2.0, base)
        text(image, line, at, colour if index == 0 else WHITE, size_px=fitting, weight=weight)
