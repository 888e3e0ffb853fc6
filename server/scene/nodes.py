"""Nodes of the scene with their colours and sizes: bone, channel, camera, drills.

The world of the scene is the vertebra frame if plan and patient are registered. Otherwise the positions of
bone and channel are unknown, so that they are not drawn, and the world is the camera frame.
"""

import math

import numpy as np
import viser
from viser.transforms import SO3

from tracker.camera import CameraModel
from tracker.geometry import Array, rotation_between
from tracker.navigation import PlacedScrew, ScrewSize
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
CHANNEL_LEAD_MM = 60.0  # extension of the channel's axis outside the bone
DRILL_LEAD_MM = 60.0  # extension of the drill's axis ahead of its tip
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
    """The frame of the scene: the vertebra frame if registered, otherwise the camera frame."""


def quaternion(rotation: Array) -> Quaternion:
    """Return the quaternion (w, x, y, z) of a rotation matrix (3, 3)."""
    w, x, y, z = (float(v) for v in SO3.from_matrix(rotation).wxyz)
    return w, x, y, z


def vector(values: Array) -> Vector:
    """Return three Python floats."""
    x, y, z = (float(v) for v in values)
    return x, y, z


def add_bone(scene: viser.SceneApi, root: str, surface: Surface) -> None:
    """Add the vertebra, translucent so that the channel is visible inside, with letters for its sides."""
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
    """Add the planned channel with its axis, extended outside the bone."""
    axis = channel.axis_in_vertebra
    turned = quaternion(rotation_between([0.0, 0.0, 1.0], axis))
    middle = (channel.entry_in_vertebra_mm + channel.target_in_vertebra_mm) / 2
    scene.add_cylinder(
        f"{root}{CHANNEL_NODE}",
        radius=channel.radius_mm,
        height=channel.length_mm,
        color=CHANNEL,
        # Translucent, so that the drill and its uncertainty are visible inside.
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
    """Add the planned screw in its channel."""
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


def add_placed_screw(scene: viser.SceneApi, name: str, screw: PlacedScrew) -> None:
    """Add a placed screw, opaque."""
    along = screw.tip_in_vertebra_mm - screw.head_in_vertebra_mm
    length_mm = float(np.linalg.norm(along))
    scene.add_cylinder(
        name,
        radius=screw.radius_mm,
        height=length_mm,
        color=SCREW,
        wxyz=quaternion(rotation_between([0.0, 0.0, 1.0], along / length_mm)),
        position=vector((screw.head_in_vertebra_mm + screw.tip_in_vertebra_mm) / 2),
        cast_shadow=False,
        receive_shadow=False,
    )


def add_camera(scene: viser.SceneApi, root: str, camera: CameraModel) -> viser.CameraFrustumHandle:
    """Add the camera, hidden until its pose is known."""
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
    """Add a hidden drill: shaft behind the tip, burr at the tip, and its axis extended ahead.

    The origin of its frame is the tip, and +z is the drilling direction.
    """
    frame = scene.add_frame(node, show_axes=False, visible=False)
    burr_mm = 1.25 * tool.radius_mm
    shaft_mm = max(tool.length_mm - burr_mm, burr_mm)
    for part, radius_mm, length_mm, middle_mm in (
        # The shaft ends inside the burr; the tip is the foremost point of the burr.
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
    """Add the axes and the label of the marker on the patient, hidden until an image shows the marker."""
    frame = scene.add_frame(f"{root}/reference", axes_length=14.0, axes_radius=0.7, visible=False)
    scene.add_label(f"{root}/reference/name", "REF", position=(0.0, -16.0, 0.0), anchor="center-center")
    return frame
