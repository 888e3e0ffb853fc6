"""Drawing of the planned channel, a cylinder with rings and a dashed axis, and of placed screws."""

import numpy as np

from server.overlay.primitives import PLACED_GREY, PLAN_BLUE, Image, stroke
from server.overlay.view import View, dashes, straight
from tracker.geometry import Camera, Rigid, Vertebra, cylinder_ring_mm, cylinder_silhouette_mm
from tracker.navigation import PlacedScrew
from tracker.plan import Channel

DASH_MM = 2.5


def draw_channel(
    image: Image, view: View, camera_from_vertebra: Rigid[Camera, Vertebra], channel: Channel, scale: float
) -> None:
    """Draw the channel into the image: outline, rings at entry (thicker) and target, axis."""
    entry = camera_from_vertebra.move_points(channel.entry_in_vertebra_mm)
    target = camera_from_vertebra.move_points(channel.target_in_vertebra_mm)
    axis = camera_from_vertebra.rotate_directions(channel.axis_in_vertebra)
    axis_dashes = view.runs_of(dashes(entry, target, dash_mm=DASH_MM))
    stroke(image, axis_dashes, PLAN_BLUE, width_px=1.8 * scale)
    outline = [
        straight(start, end) for start, end in cylinder_silhouette_mm(entry, target, channel.radius_mm)
    ]
    outline.append(cylinder_ring_mm(target, axis, channel.radius_mm))
    stroke(image, view.runs_of(outline), PLAN_BLUE, width_px=2.0 * scale)
    entry_ring = view.runs(cylinder_ring_mm(entry, axis, channel.radius_mm))
    stroke(image, entry_ring, PLAN_BLUE, width_px=3.0 * scale)


def draw_placed_screw(
    image: Image, view: View, camera_from_vertebra: Rigid[Camera, Vertebra], screw: PlacedScrew, scale: float
) -> None:
    """Draw a placed screw into the image: its outline, and rings at both ends."""
    head = camera_from_vertebra.move_points(screw.head_in_vertebra_mm)
    tip = camera_from_vertebra.move_points(screw.tip_in_vertebra_mm)
    axis = (tip - head) / np.linalg.norm(tip - head)
    outline = [straight(start, end) for start, end in cylinder_silhouette_mm(head, tip, screw.radius_mm)]
    outline += [cylinder_ring_mm(end, axis, screw.radius_mm) for end in (head, tip)]
    stroke(image, view.runs_of(outline), PLACED_GREY, width_px=2.0 * scale)
