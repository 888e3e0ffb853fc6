"""Viewpoints of the scene: from behind the patient, along the channel, or from the camera.

Each view is sent as three hidden nodes (eye, target, up) that `watch.js` applies. A viewer can therefore
change the view without a request, and follows a moving view.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import viser

from server.scene.nodes import Vector, World, vector
from tracker.geometry import Array, Camera, Rigid
from tracker.navigation import Absent, Setup
from tracker.plan import Channel, Surface

VIEWS_NODE = "/views"
# Distant eye with a narrow field of view, so that a drill on the axis is a disc, as in the bull's-eye.
ALONG_MM = 500.0
NARROW_DEG = 11.0
USUAL_DEG = 40.0
# Length of the drawn camera frustum; the eye is in front of it.
CAMERA_FRAME_MM = 45.0
# Usual distance of the patient from the camera.
WORKING_MM = 300.0


class ViewName(StrEnum):
    """Available views."""

    BEHIND = "behind"
    CHANNEL = "channel"
    CAMERA = "camera"


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """A viewpoint in the world of the scene, in mm."""

    position_mm: Array
    look_at_mm: Array
    up: Vector


ANGLE_DEG = {ViewName.BEHIND: USUAL_DEG, ViewName.CHANNEL: NARROW_DEG, ViewName.CAMERA: USUAL_DEG}


class ViewNodes:
    """The nodes of all views. Mutable."""

    def __init__(self, scene: viser.SceneApi) -> None:
        self._nodes = {
            name: tuple(
                scene.add_frame(f"{VIEWS_NODE}/{name}_{part}", show_axes=False, visible=False)
                for part in ("eye", "look", "up")
            )
            for name in ViewName
        }

    def put(self, name: ViewName, view: View) -> None:
        """Set a view."""
        up_mm = np.asarray(view.position_mm) + 100.0 * np.asarray(view.up)
        places = (view.position_mm, view.look_at_mm, up_mm)
        for node, place in zip(self._nodes[name], places, strict=True):
            node.position = vector(place)


def first_view(setup: Setup | None, surface: Surface | None) -> View:
    """Return a view from behind the patient, above and to the side, that shows channel and drill."""
    if setup is None or isinstance(setup.registration, Absent):
        # In the camera frame: from behind and beside the camera towards the drill.
        return View(
            position_mm=np.array([-260.0, -220.0, -180.0]),
            look_at_mm=np.array([0.0, 0.0, WORKING_MM]),
            up=(0.0, -1.0, 0.0),
        )
    look_at, away_mm, side = np.zeros(3), 170.0, 1.0
    if surface is not None:
        low, high = surface.vertices_mm.min(axis=0), surface.vertices_mm.max(axis=0)
        look_at, away_mm = (low + high) / 2, max(away_mm, 1.45 * float(np.linalg.norm(high - low)))
    if isinstance(setup.channel, Channel):
        side = 1.0 if setup.channel.entry_in_vertebra_mm[0] >= look_at[0] else -1.0
        look_at = setup.channel.entry_in_vertebra_mm
    direction = np.array([0.75 * side, 0.95, 0.6])
    return View(
        position_mm=look_at + away_mm * direction / np.linalg.norm(direction),
        look_at_mm=look_at,
        up=(0.0, 0.0, 1.0),
    )


def channel_view(setup: Setup | None) -> View | None:
    """Return the view from outside along the channel, as in the bull's-eye; None without a channel."""
    if setup is None or isinstance(setup.registration, Absent) or not isinstance(setup.channel, Channel):
        return None
    channel = setup.channel
    return View(
        position_mm=channel.entry_in_vertebra_mm - ALONG_MM * channel.axis_in_vertebra,
        look_at_mm=channel.entry_in_vertebra_mm,
        up=(0.0, 0.0, 1.0),
    )


def camera_view(world_from_camera: Rigid[World, Camera]) -> View:
    """Return the view of the camera on the patient."""
    return View(
        position_mm=world_from_camera.move_points(np.array([0.0, 0.0, CAMERA_FRAME_MM])),
        look_at_mm=world_from_camera.move_points(np.array([0.0, 0.0, WORKING_MM])),
        up=vector(world_from_camera.rotate_directions(np.array([0.0, -1.0, 0.0]))),
    )
