"""Drawing of a drill (line, tip, depth marks, dashed extension) and of a marker's outline."""

import numpy as np

from server.number_format import format_number
from server.overlay.primitives import (
    DRILL_ORANGE,
    REGULAR,
    WHITE,
    Image,
    darken_box,
    dot,
    stroke,
    text,
    text_width_px,
)
from server.overlay.view import View, dashes, straight
from tracker.geometry import Array
from tracker.navigation import ToolPose
from tracker.pose import Seen, ToolModel

TICK_MM = 5.0
LONG_TICK_EVERY = 2
TICKED_MM = 60.0
DASH_MM = 2.0
# Ticks closer than this, of a drill that points at the camera, would merge and are not drawn.
MIN_TICK_GAP_PX = 4.0


def draw_drill(
    image: Image, view: View, tool: ToolModel, in_view: ToolPose, *, ahead_mm: float, scale: float
) -> None:
    """Draw the drill's line into the image: solid up to the tip, dashed for `ahead_mm` beyond it.

    Depth marks follow every 5 mm from the tip, every second one longer, as engraved on a drill. The mark at
    the entry ring shows the depth.
    """
    pose = in_view.camera_from_tool
    tip = pose.translation_mm
    direction = pose.rotate_directions([0.0, 0.0, 1.0])
    ahead = dashes(tip, tip + ahead_mm * direction, dash_mm=DASH_MM)
    stroke(image, view.runs_of(ahead), DRILL_ORANGE, width_px=1.6 * scale)
    shaft = view.runs(straight(tip, tip - tool.length_mm * direction, count=65))
    stroke(image, shaft, DRILL_ORANGE, width_px=3.0 * scale)
    ticks = _ticks(view, tip, direction, min(TICKED_MM, tool.length_mm), scale)
    stroke(image, ticks, DRILL_ORANGE, width_px=2.0 * scale)
    tip_px, shown = view.project(tip)
    if shown[0]:
        dot(image, tip_px[0], WHITE, radius_px=4.5 * scale)


def _ticks(view: View, tip: Array, direction: Array, length_mm: float, scale: float) -> list[Array]:
    """Return the depth marks (2, 2) in px, perpendicular to the drill's line in the image."""
    count = int(length_mm // TICK_MM)
    if count < 1:
        return []
    at_mm = np.arange(count + 1)[:, None] * TICK_MM
    px, shown = view.project(tip - at_mm * direction)
    ticks = []
    for index in range(1, count + 1):
        along = px[index] - px[index - 1]
        gap = float(np.hypot(*along))
        if not (shown[index] and shown[index - 1]) or gap < MIN_TICK_GAP_PX * scale:
            continue
        half = (9.0 if index % LONG_TICK_EVERY == 0 else 5.5) * scale
        across = np.array([-along[1], along[0]]) / gap * half
        ticks.append(np.array([px[index] - across, px[index] + across]))
    return ticks


def draw_marker(image: Image, name: str, seen: Seen, *, scale: float) -> None:
    """Draw the marker's outline, with name and score beside it."""
    corners = seen.corners_px
    if not np.isfinite(corners).all():
        return
    stroke(image, [np.vstack([corners, corners[:1]])], WHITE, width_px=1.6 * scale)
    words = f"{name}  {format_number(100.0 * seen.score_ratio, decimals=0)} %"
    size = 20.0 * scale
    width = text_width_px(words, size_px=size, weight=REGULAR)
    height_px, width_px = image.shape[:2]
    left = float(np.clip(corners[:, 0].min(), 4 * scale, max(4 * scale, width_px - width - 12 * scale)))
    above = corners[:, 1].min() - 10 * scale
    top_room = 56 * scale
    base = float(np.clip(above, top_room, max(top_room, height_px - 24 * scale)))
    darken_box(image, left - 4 * scale, base - size, left + width + 6 * scale, base + 6 * scale)
    text(image, words, (left + 1, base), WHITE, size_px=size, weight=REGULAR)
