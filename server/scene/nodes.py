"""What stands in the scene: bone, channel, camera, drills. Colours and sizes are decided here.

The world of the scene is the vertebra's frame when plan and patient are registered. When they are not, nobody
knows where the bone and the channel are, so they are not drawn, and the world is the camera's frame.
"""

import math

import numpy as np
import viser
from viser.transforms import SO3

from tracker.camera import CameraModel
from tracker.geometry import Array, rotation_between
from tracker.navigation import ScrewSize
from tracker.plan import Channel, Surface
from tracker.pose import ToolModel

BONE_NODE = "/vertebra"
CHANNEL_NODE = "/channel"

BONE = (244, 228, 196)
SCREW = (190, 200, 212)
CHANNEL = (64, 140, 255)
CHANNEL_OPACITY = 0.4
DRILL = (255, 138, 31)
BURR = (255, 200, 120)
CAMERA = (140, 156, 172)

CAMERA_SIZE_MM = 40.0
AXIS_RADIUS_MM = 0.35
CHANNEL_LEAD_MM = 60.0  # how far the channel's axis is drawn out of the bone, towards the hand
DRILL_LEAD_MM = 60.0  # how far the drill's axis is drawn ahead of its tip
VIEW_ANGLE_RAD = math.radians(40.0)
ORIENTATION = {
    "L": (1, 0, 0),
    "R": (-1, 0, 0),
    "P": (0, 1, 0),
    "A": (0, -1, 0),
    "S": (0, 0, 1),
    "I": (0, 0, -1),
}

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


class World:
    """The frame of the scene: the vertebra's when registered, else the camera's."""


def quaternion(rotation: Array) -> Quaternion:
    """(w, x, y, z) of a rotation matrix (3, 3)."""
    w, x, y, z = (float(v) for v in SO3.from_matrix(rotation).wxyz)
    return w, x, y, z


def vector(values: Array) -> Vector:
    """Three plain numbers."""
    x, y, z = (float(v) for v in values)
    return x, y, z


def add_bone(scene: viser.SceneApi, root: str, surface: Surface) -> None:
    """The vertebra, translucent so that the channel is seen inside, with letters for its sides."""
    scene.add_mesh_simple(
        f"{root}{BONE_NODE}",
        np.asarray(surface.vertices_mm, dtype=np.float32),
        np.asarray(surface.faces, dtype=np.uint32),
        color=BONE,
        opacity=0.45,
        cast_shadow=False,
        receive_shadow=False,
    )
    low, high = surface.vertices_mm.min(axis=0), surface.vertices_mm.max(axis=0)
    centre, reach = (low + high) / 2, (high - low) / 2 + 8.0
    for letter, side in ORIENTATION.items():
        scene.add_label(
            f"{root}/side_{letter}",
            letter,
            position=vector(centre + reach * np.asarray(side)),
            anchor="center-center",
            font_screen_scale=1.0,
        )


def add_channel(scene: viser.SceneApi, root: str, channel: Channel) -> None:
    """The planned channel, and its axis drawn on towards the hand that shall find it."""
    axis = channel.axis_in_vertebra
    turned = quaternion(rotation_between([0.0, 0.0, 1.0], axis))
    middle = (channel.entry_in_vertebra_mm + channel.target_in_vertebra_mm) / 2
    scene.add_cylinder(
        f"{root}{CHANNEL_NODE}",
        radius=channel.radius_mm,
        height=channel.length_mm,
        color=CHANNEL,
        # The drill is to be seen inside, and how unsure its tip is.
        opacity=CHANNEL_OPACITY,
        wxyz=turned,
        position=vector(middle),
        cast_shadow=False,
        receive_shadow=False,
    )
    scene.add_cylinder(
        f"{root}/channel_axis",
        radius=AXIS_RADIUS_MM,
        height=CHANNEL_LEAD_MM,
        color=CHANNEL,
        wxyz=turned,
        position=vector(channel.entry_in_vertebra_mm - axis * CHANNEL_LEAD_MM / 2),
        cast_shadow=False,
        receive_shadow=False,
    )


def add_screw(scene: viser.SceneApi, root: str, channel: Channel, screw: ScrewSize) -> None:
    """The planned screw in its channel."""
    axis = channel.axis_in_vertebra
    scene.add_cylinder(
        f"{root}/screw",
        radius=screw.radius_mm,
        height=screw.length_mm,
        color=SCREW,
        opacity=0.55,
        wxyz=quaternion(rotation_between([0.0, 0.0, 1.0], axis)),
        position=vector(channel.entry_in_vertebra_mm + axis * screw.length_mm / 2),
        cast_shadow=False,
        receive_shadow=False,
    )


def add_camera(scene: viser.SceneApi, root: str, camera: CameraModel) -> viser.CameraFrustumHandle:
    """The camera that sees the marker, hidden until an image says where it is."""
    width, height = camera.size_wh_px
    return scene.add_camera_frustum(
        f"{root}/camera",
        fov=2 * math.atan(height / (2 * float(camera.matrix[1, 1]))),
        aspect=(width / float(camera.matrix[0, 0])) / (height / float(camera.matrix[1, 1])),
        scale=CAMERA_SIZE_MM,
        thickness=0.5,
        color=CAMERA,
        visible=False,
        cast_shadow=False,
        receive_shadow=False,
    )


def add_tool(scene: viser.SceneApi, node: str, tool: ToolModel) -> viser.FrameHandle:
    """A drill, hidden: its shaft behind the tip, the burr at the tip, and its axis drawn on ahead.

    The frame's origin is the tip and its +z the drilling direction.
    """
    frame = scene.add_frame(node, show_axes=False, visible=False)
    burr_mm = 1.25 * tool.radius_mm
    shaft_mm = max(tool.length_mm - burr_mm, burr_mm)
    for part, radius_mm, length_mm, middle_mm in (
        # The shaft ends inside the burr, whose foremost point is the tip.
        ("shaft", tool.radius_mm, shaft_mm, -burr_mm - shaft_mm / 2),
        ("axis", AXIS_RADIUS_MM, DRILL_LEAD_MM, DRILL_LEAD_MM / 2),
    ):
        scene.add_cylinder(
            f"{node}/{part}",
            radius=radius_mm,
            height=length_mm,
            color=DRILL,
            position=(0.0, 0.0, middle_mm),
            cast_shadow=False,
            receive_shadow=False,
        )
    scene.add_icosphere(
        f"{node}/burr",
        radius=burr_mm,
        color=BURR,
        position=(0.0, 0.0, -burr_mm),
        cast_shadow=False,
        receive_shadow=False,
    )
    return frame


def add_reference(scene: viser.SceneApi, root: str) -> viser.FrameHandle:
    """The marker on the patient, hidden until an image shows it: its three axes and what it is."""
    frame = scene.add_frame(f"{root}/reference", axes_length=14.0, axes_radius=0.7, visible=False)
    scene.add_label(f"{root}/reference/name", "REF", position=(0.0, -16.0, 0.0), anchor="center-center")
    return frame
