"""The bull's-eye: view of the drill along the channel, in an inset of the video."""

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

# From the centre to the border, at least this or twice the channel's radius; points beyond it are clamped.
MIN_EXTENT_MM = 7.0
CROSS_MM, SQUARE_MM = 0.8, 0.45
LETTER_PX = 17.0
LETTER_MARGIN_PX = 18.0
# BGR.
DIM = (120, 120, 120)
TURN = np.linspace(0.0, 2.0 * np.pi, 49)
CIRCLE = np.stack([np.cos(TURN), np.sin(TURN)], axis=1)
SQUARE = SQUARE_MM * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])


def reach_of(channel: Channel) -> float:
    """Return the distance in mm from the centre of a bull's-eye to its border, for the video and the page."""
    return max(MIN_EXTENT_MM, 2.0 * channel.radius_mm)


@dataclass(frozen=True, slots=True, kw_only=True)
class Inset:
    """A square of the image that shows the surroundings of the channel's axis.

    Attributes:
        left_px: Left edge of the square.
        top_px: Upper edge of the square.
        side_px: Side of the square.
        extent_mm: Distance from the centre to the border.
        scale: Scale of lines and letters, 1 for an image 720 px high.
    """

    left_px: float
    top_px: float
    side_px: float
    extent_mm: float
    scale: float

    def px(self, view_mm: Array) -> Array:
        """Return the pixels (..., 2) of points (..., 2) of the view (mm to the right and up)."""
        per_mm = (self.side_px / 2.0 - LETTER_MARGIN_PX * self.scale) / self.extent_mm
        middle = np.array([self.left_px, self.top_px]) + self.side_px / 2.0
        return np.asarray(middle + np.asarray(view_mm) * [per_mm, -per_mm])


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """Content of the inset.

    Attributes:
        seen: The drill in the view along the channel.
        channel_radius_mm: Radius of the planned channel.
        drill_radius_mm: Radius of the drill.
        tip_covariance_mm2: (2, 2), covariance of the tip in the view; None if unknown.
    """

    seen: BullseyeView
    channel_radius_mm: float
    drill_radius_mm: float
    tip_covariance_mm2: Array | None = None


def draw_bullseye(image: Image, inset: Inset, target: Target) -> None:
    """Draw the view along the channel into a square of the image.

    The blue circle is the channel, the cross its axis. The orange ring is the drill at its tip, in true size.
    The orange line runs from the drill's entry to its predicted end, a small square; it is a point for a
    drill parallel to the channel. The thin white ellipse is the 95 % confidence region of the tip.
    """
    scale, seen, extent_mm = inset.scale, target.seen, inset.extent_mm
    left, top, side = (max(round(px), 0) for px in (inset.left_px, inset.top_px, inset.side_px))
    # Drawn into a view of the square, so that nothing extends beyond its border.
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
    axis_mm = np.stack(
        [_clamped(place, seen.tip_mm, extent_mm) for place in (seen.at_entry_mm, seen.at_target_mm)]
    )
    stroke(image, [inset.px(axis_mm)], DRILL_ORANGE, width_px=2.0 * scale)
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
    """Clamp a point to the extent along its line from the tip; return the tip if no point of it is inside."""
    if not np.isfinite(place_mm).all():
        return tip_mm
    direction = place_mm - tip_mm
    a, b, c = float(direction @ direction), float(direction @ tip_mm), float(tip_mm @ tip_mm) - extent_mm**2
    if a < 1e-12:
        return place_mm
    farthest = (-b + np.sqrt(max(b * b - a * c, 0.0))) / a
    return np.asarray(tip_mm + min(1.0, farthest) * direction)


def _inside(ring_mm: Array, extent_mm: float) -> Array:
    """Return the ring with points outside clamped to the border."""
    away = np.linalg.norm(ring_mm, axis=1, keepdims=True)
    return np.asarray(ring_mm * np.minimum(1.0, extent_mm / np.maximum(away, 1e-9)))


def _arrow(image: Image, inset: Inset, tip_mm: Array) -> None:
    direction = tip_mm / np.hypot(*tip_mm)
    across = 0.13 * inset.extent_mm * np.array([-direction[1], direction[0]])
    back = 0.78 * inset.extent_mm * direction
    head = np.stack([back + across, inset.extent_mm * direction, back - across])
    stroke(image, [inset.px(head)], DRILL_ORANGE, width_px=3.0 * inset.scale)


def _letters(image: Image, inset: Inset) -> None:
    """Draw the patient's directions at the border as on a CT: left, right, and S for superior."""
    size = LETTER_PX * inset.scale
    gap = 5.0 * inset.scale
    middle, right = inset.top_px + inset.side_px / 2.0 + 0.35 * size, inset.left_px + inset.side_px
    text(image, "L", (inset.left_px + gap, middle), QUIET, size_px=size, weight=REGULAR)
    width = text_width_px("R", size_px=size, weight=REGULAR)
    text(image, "R", (right - width - gap, middle), QUIET, size_px=size, weight=REGULAR)
    width = text_width_px("S", size_px=size, weight=REGULAR)
    at = (inset.left_px + (inset.side_px - width) / 2.0, inset.top_px + size)
    text(image, "S", at, QUIET, size_px=size, weight=REGULAR)
