"""From where a viewer looks: from behind the patient, along the channel, or as the camera does.

Each view is sent as three hidden nodes, its eye, what it looks at, and what is up; `watch.js` puts the viewer
there. So a viewer changes the view without asking the server, and follows it when it moves.
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
# From far away under a narrow angle, so that a drill on its axis is a disc, as in the bull's-eye.
ALONG_MM = 500.0
NARROW_DEG = 11.0
USUAL_DEG = 40.0
# The frame of the camera itself is drawn up to here; the eye stands before it.
CAMERA_FRAME_MM = 45.0
# How far in front of the camera the patient usually is.
WORKING_MM = 300.0


class ViewName(StrEnum):
    """The views that there are."""

    BEHIND = "behind"
    CHANNEL = "channel"
    CAMERA = "camera"


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """Where a viewer stands, in the world of the scene, in mm."""

    position_mm: Array
    look_at_mm: Array
    up: Vector


ANGLE_DEG = {ViewName.BEHIND: USUAL_DEG, ViewName.CHANNEL: NARROW_DEG, ViewName.CAMERA: USUAL_DEG}


class ViewNodes:
    """The nodes of all views. Mutable: their places."""

    def __init__(self, scene: viser.SceneApi) -> None:
        self._nodes = {
            name: tuple(
                scene.add_frame(f"{VIEWS_NODE}/{name}_{part}", show_axes=False, visible=False)
                for part in ("eye", "look", "up")
            )
            for name in ViewName
        }

    def put(self, name: ViewName, view: View) -> None:
        """This is the view from now on."""
        up_mm = np.asarray(view.position_mm) + 100.0 * np.asarray(view.up)
        places = (view.position_mm, view.look_at_mm, up_mm)
        for node, place in zip(self._nodes[name], places, strict=True):
            node.position = vector(place)


def first_view(setup: Setup | None, surface: Surface | None) -> View:
    """From behind the patient, above and to the side, so that channel and drill are seen at once."""
    if setup is None or isinstance(setup.registration, Absent):
        # Camera's frame: stand behind the camera's shoulder and look where the drill works.
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
    """From outside along the channel, as the bull's-eye has it; None where no channel stands in the scene."""
    if setup is None or isinstance(setup.registration, Absent) or not isinstance(setup.channel, Channel):
        return None
    channel = setup.channel
    return View(
        position_mm=channel.entry_in_vertebra_mm - ALONG_MM * channel.axis_in_vertebra,
        look_at_mm=channel.entry_in_vertebra_mm,
        up=(0.0, 0.0, 1.0),
    )


def camera_view(world_from_camera: Rigid[World, Camera]) -> View:
    """As the camera sees the patient."""
    return View(
        position_mm=world_from_camera.move_points(np.array([0.0, 0.0, CAMERA_FRAME_MM])),
        look_at_mm=world_from_camera.move_points(np.array([0.0, 0.0, WORKING_MM])),
        up=vector(world_from_camera.rotate_directions(np.array([0.0, -1.0, 0.0]))),
    )
