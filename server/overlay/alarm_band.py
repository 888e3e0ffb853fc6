"""The alarm of the highest priority, burned into the picture: marks, word and numbers, at its upper edge."""

from server.overlay.alarm_words import MARKS, alarm_words
from server.overlay.ink import REGULAR, SEMIBOLD, WHITE, Image, ground, text, text_width_px
from tracker.navigation.alarms import AlarmPicture, AlarmState, Priority

# BGR; the words say the same, because colour alone says nothing to one man in twelve.
COLOURS = {Priority.HIGH: (110, 110, 255), Priority.MEDIUM: (77, 216, 255), Priority.LOW: (242, 211, 111)}
TOP_PX = 44.0
STATE_PX = 40.0
SENTENCE_PX = 22.0
PADDING_PX = 14.0


def draw_alarm_band(image: Image, alarms: AlarmPicture, *, scale: float) -> None:
    """Draw the first alarm, and how many more there are; nothing when there is none."""
    top = alarms.top
    if top is None:
        return
    words = alarm_words(top)
    more = f"  +{len(alarms.alarms) - 1}" if len(alarms.alarms) > 1 else ""
    known = " (acknowledged)" if top.state is AlarmState.ACKNOWLEDGED else ""
    # The font has no triangles: as many exclamation marks as the page has marks.
    head = f"{'!' * len(MARKS[top.priority.value])} {words.state}{known}{more}"
    rows = ((head, STATE_PX, SEMIBOLD, COLOURS[top.priority]), (words.sentence, SENTENCE_PX, REGULAR, WHITE))
    room = image.shape[1] - 4.0 * PADDING_PX * scale
    widths = [text_width_px(words, size_px=size * scale, weight=weight) for words, size, weight, _ in rows]
    width = min(max(widths), room)
    left, above = (image.shape[1] - width) / 2.0, TOP_PX * scale
    pad = PADDING_PX * scale
    ground(image, left - pad, above, left + width + pad, above + 90.0 * scale)
    for (said, size, weight, colour), wide, base in zip(rows, widths, (42.0, 76.0), strict=True):
        fitting = size * scale * min(1.0, room / max(wide, 1.0))
        at = ((image.shape[1] - min(wide, room)) / 2.0, above + base * scale)
        text(image, said, at, colour, size_px=fitting, weight=weight)
