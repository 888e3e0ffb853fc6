"""Drawing of the planned channel: a cylinder with rings and a dashed axis."""

from server.overlay.primitives import PLAN_BLUE, Image, stroke
from server.overlay.view import View, dashes, straight
from tracker.geometry import Camera, Rigid, Vertebra, cylinder_ring_mm, cylinder_silhouette_mm
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
