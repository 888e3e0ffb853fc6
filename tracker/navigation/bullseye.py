"""The bull's-eye view: the drill projected onto the plane across the channel, seen from behind."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.navigation.directions import channel_directions
from tracker.plan import Channel
from tracker.plan.pedicle import Side

# The axis of a drill across the channel (89.4 degrees) intersects the planes metres away.
MIN_ALONG = 0.01
# 95 % point of chi-square with two degrees of freedom.
CHI_SQUARE_95 = 5.991


@dataclass(frozen=True, slots=True, kw_only=True)
class BullseyeView:
    """Positions in the plane across the channel: (right, up) in mm from its axis.

    The viewer stands behind a prone patient and looks along the channel: the patient's left is on the left,
    the head is up.

    Attributes:
        tip_mm: (2,), the drill's tip.
        at_entry_mm: (2,), intersection of the drill's axis with the entry plane; not finite if there is none.
        at_target_mm: (2,), intersection of the drill's axis with the plane of the planned end.
        medial_is_right: whether medial is to the right.
        view_from_vertebra: (2, 3), rows are the unit vectors of right and up; projects other points into the
            view.
    """

    tip_mm: Array
    at_entry_mm: Array
    at_target_mm: Array
    medial_is_right: bool
    view_from_vertebra: Array

    def across_mm2(self, covariance_mm2: Array) -> Array:
        """Project a covariance (3, 3) from the vertebra frame into this view, (2, 2)."""
        return np.asarray(self.view_from_vertebra @ covariance_mm2 @ self.view_from_vertebra.T)

    def place_mm(self, point_in_vertebra_mm: Array, channel: Channel) -> Array:
        """Project a point of the vertebra frame into this view, (2,)."""
        return np.asarray(self.view_from_vertebra @ (point_in_vertebra_mm - channel.entry_in_vertebra_mm))

    def half_axes_95_mm(self, covariance_mm2: Array) -> Array:
        """Return the half axes (2, 2), as rows, of the 95 % ellipse of a covariance (3, 3)."""
        return half_axes_95_mm(self.across_mm2(covariance_mm2))


def half_axes_95_mm(covariance_mm2: Array) -> Array:
    """Return the half axes (2, 2), as rows, of the 95 % ellipse of a covariance (2, 2) of the view."""
    values, vectors = np.linalg.eigh(covariance_mm2)
    return np.asarray(np.sqrt(np.maximum(values, 0.0) * CHI_SQUARE_95)[:, None] * vectors.T)


def bullseye_view(
    vertebra_from_tool: Rigid[Vertebra, Tool], channel: Channel, side: Side | None = None
) -> BullseyeView:
    """Project the drill onto the plane across the channel; `side` is that of the plan, if known."""
    across = channel_directions(channel, side)
    right = np.cross(across.axis, across.cranial)
    view = np.stack([right, across.cranial])
    tip = vertebra_from_tool.translation_mm - channel.entry_in_vertebra_mm
    direction = vertebra_from_tool.rotate_directions([0.0, 0.0, 1.0])
    along = float(direction @ across.axis)
    depth = float(tip @ across.axis)
    at_entry = at_target = np.full(2, np.inf)
    if along > MIN_ALONG:
        at_entry = view @ (tip - direction * (depth / along))
        at_target = view @ (tip + direction * ((channel.length_mm - depth) / along))
    places = (view @ tip, at_entry, at_target, view)
    for array in places:
        array.setflags(write=False)
    return BullseyeView(
        tip_mm=places[0],
        at_entry_mm=places[1],
        at_target_mm=places[2],
        medial_is_right=bool(right @ across.medial > 0.0),
        view_from_vertebra=view,
    )
