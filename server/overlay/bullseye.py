"""The bull's-eye: the drill as it is seen along the channel, in an inset of the video."""

from dataclasses import dataclass, replace

import cv2
import numpy as np

from server.overlay.primitives import (
    DRILL_ORANGE,
    PLAN_BLUE,
    QUIET,
    REGULAR,
    WHITE,
    Image,
    darken_box,
    dot,
    stroke,
    text,
    text_width_px,
)
from tracker.geometry import Array
from tracker.navigation import BullseyeView, half_axes_95_mm
from tracker.plan import Channel

# From the middle to the border: this, or twice the channel; what lies beyond is an arrow at the border.
MIN_EXTENT_MM = 7.0
CROSS_MM, SQUARE_MM = 0.8, 0.45
LETTER_PX = 17.0
LETTER_MARGIN_PX = 18.0
# BGR; a border that nobody needs to read.
DIM = (120, 120, 120)
TURN = np.linspace(0.0, 2.0 * np.pi, 49)
CIRCLE = np.stack([np.cos(TURN), np.sin(TURN)], axis=1)
SQUARE = SQUARE_MM * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])


def reach_of(channel: Channel) -> float:
    """How many mm a bull's-eye shows from its middle to its border, burned in or drawn by the page."""
    return max(MIN_EXTENT_MM, 2.0 * channel.radius_mm)


@dataclass(frozen=True, slots=True, kw_only=True)
class Inset:
    """A square of the image that shows mm around the channel's axis.

    Attributes:
        left_px: of the square; likewise top_px and side_px.
        extent_mm: from its middle to the border.
        scale: of all that is drawn, 1 for an image 720 px high.
    """

    left_px: float
    top_px: float
    side_px: float
    extent_mm: float
    scale: float

    def px(self, view_mm: Array) -> Array:
        """Pixels (..., 2) of places (..., 2) of the view, right and up in mm."""
        per_mm = (self.side_px / 2.0 - LETTER_MARGIN_PX * self.scale) / self.extent_mm
        middle = np.array([self.left_px, self.top_px]) + self.side_px / 2.0
        return np.asarray(middle + np.asarray(view_mm) * [per_mm, -per_mm])


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """What is drawn into the inset.

    Attributes:
        seen: the drill in the view along the channel.
        channel_radius_mm: of the plan.
        drill_radius_mm: of the drill.
        tip_covariance_mm2: (2, 2) of the tip in the view; None where it is not known.
    """

    seen: BullseyeView
    channel_radius_mm: float
    drill_radius_mm: float
    tip_covariance_mm2: Array | None = None


def draw_bullseye(image: Image, inset: Inset, target: Target) -> None:
    """Draw the view along the channel into a square of the image.

    The blue circle is the channel, its cross the axis; the orange ring is the drill at its tip, in its true
    size; the orange line runs from where it came in to where it would end, which is a small square. So a
    parallel drill is a point, and one that is off in angle a line. A thin white ellipse holds the tip with
    95 in 100.
    """
    scale, seen, extent_mm = inset.scale, target.seen, inset.extent_mm
    left, top, side = (max(round(px), 0) for px in (inset.left_px, inset.top_px, inset.side_px))
    # In a window of its own, so that nothing reaches over its border.
    image = image[top : top + side, left : left + side]
    inset = replace(inset, left_px=0.0, top_px=0.0)
    darken_box(image, 0, 0, side, side)
    cv2.polylines(image, [np.round(inset.px(extent_mm * CIRCLE)).astype(np.int32)], True, DIM, 1, cv2.LINE_AA)
    stroke(image, [inset.px(target.channel_radius_mm * CIRCLE)], PLAN_BLUE, width_px=2.4 * scale)
    arms = CROSS_MM * np.array([[[-1.0, 0.0], [1.0, 0.0]], [[0.0, -1.0], [0.0, 1.0]]])
    stroke(image, [inset.px(arm) for arm in arms], PLAN_BLUE, width_px=1.6 * scale)
    _letters(image, inset)
    if float(np.hypot(*seen.tip_mm)) > extent_mm:
        _arrow(image, inset, seen.tip_mm)
        return
    way = np.stack(
        [_clamped(place, seen.tip_mm, extent_mm) for place in (seen.at_entry_mm, seen.at_target_mm)]
    )
    stroke(image, [inset.px(way)], DRILL_ORANGE, width_px=2.0 * scale)
    if float(np.hypot(*seen.at_target_mm)) <= extent_mm:
        stroke(image, [inset.px(seen.at_target_mm + SQUARE)], DRILL_ORANGE, width_px=2.0 * scale)
    if target.tip_covariance_mm2 is not None:
        ring = CIRCLE @ half_axes_95_mm(target.tip_covariance_mm2)
        stroke(image, [inset.px(_inside(seen.tip_mm + ring, extent_mm))], WHITE, width_px=1.0 * scale)
    stroke(
        image, [inset.px(seen.tip_mm + target.drill_radius_mm * CIRCLE)], DRILL_ORANGE, width_px=2.6 * scale
    )
    dot(image, inset.px(seen.tip_mm), WHITE, radius_px=3.0 * scale)


def _clamped(place_mm: Array, tip_mm: Array, extent_mm: float) -> Array:
    """Clamp a place to the extent along its line from the tip; return the tip itself where there is none."""
    if not np.isfinite(place_mm).all():
        return tip_mm
    way = place_mm - tip_mm
    a, b, c = float(way @ way), float(way @ tip_mm), float(tip_mm @ tip_mm) - extent_mm**2
    if a < 1e-12:
        return place_mm
    farthest = (-b + np.sqrt(max(b * b - a * c, 0.0))) / a
    return np.asarray(tip_mm + min(1.0, farthest) * way)


def _inside(ring_mm: Array, extent_mm: float) -> Array:
    """A ring with what lies beyond reach put onto the border."""
    away = np.linalg.norm(ring_mm, axis=1, keepdims=True)
    return np.asarray(ring_mm * np.minimum(1.0, extent_mm / np.maximum(away, 1e-9)))


def _arrow(image: Image, inset: Inset, tip_mm: Array) -> None:
    way = tip_mm / np.hypot(*tip_mm)
    across = 0.13 * inset.extent_mm * np.array([-way[1], way[0]])
    back = 0.78 * inset.extent_mm * way
    head = np.stack([back + across, inset.extent_mm * way, back - across])
    stroke(image, [inset.px(head)], DRILL_ORANGE, width_px=3.0 * inset.scale)


def _letters(image: Image, inset: Inset) -> None:
    """The patient's directions at the border, as on a CT: left and right, and S for the head."""
    size = LETTER_PX * inset.scale
    gap = 5.0 * inset.scale
    middle, right = inset.top_px + inset.side_px / 2.0 + 0.35 * size, inset.left_px + inset.side_px
    text(image, "L", (inset.left_px + gap, middle), QUIET, size_px=size, weight=REGULAR)
    width = text_width_px("R", size_px=size, weight=REGULAR)
    text(image, "R", (right - width - gap, middle), QUIET, size_px=size, weight=REGULAR)
    width = text_width_px("S", size_px=size, weight=REGULAR)
    at = (inset.left_px + (inset.side_px - width) / 2.0, inset.top_px + size)
    text(image, "S", at, QUIET, size_px=size, weight=REGULAR)
