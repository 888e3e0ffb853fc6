"""Rendering of theatre images: static scenery with the moving drill."""

from typing import TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array, Camera, Marker, Rigid, Tool
from tracker.rehearsal.backdrop import Backdrops, StillStore
from tracker.rehearsal.drill import (
    BOARD_HALF_MM,
    BOARD_PER_MM,
    BOARD_THICK_MM,
    PORTRAIT_END_MM,
    PORTRAIT_START_MM,
    PROFILE_MM,
    RADIUS_MM,
    board_face,
    drill_portrait,
)
from tracker.rehearsal.events import EventKind
from tracker.rehearsal.exposure import Exposure
from tracker.rehearsal.lamp import TO_LAMP, lit, rod_shadow
from tracker.rehearsal.layer_kernels import Axis, draw_body
from tracker.rehearsal.lens import NODE_PX
from tracker.rehearsal.placement import Room
from tracker.rehearsal.point_spread import DEFOCUS_PX, PointSpread, point_spread
from tracker.rehearsal.printed_plane import PrintedPlane, Sampled
from tracker.rehearsal.reference import REFERENCE_HALF_MM
from tracker.rehearsal.reference_renderer import board_layer, cloth_px, draw_cloth
from tracker.rehearsal.strips import Strips, strips_around
from tracker.rehearsal.theatre import Theatre

Image8 = npt.NDArray[np.uint8]
Image32 = npt.NDArray[np.float32]
Square = TypeVar("Square")

MARGIN_PX = 2
STATION_MM = 8.0
# The tracker measures the marker: fewer samples double its edge error, to 0.004 px.
MARKER_SAMPLES = 3
SPEED_OVER_S = 0.002
SHADOW_GROUND_MM, SHADOW_REACH_MM = 14.0, 260.0
# The board is wider than the body and casts most of its shadow.
SHADOW_PROFILE_MM = np.array([*PROFILE_MM[:17], 102, 102.5, 137.5, 138, 168])
SHADOW_RADIUS_MM = np.array([*RADIUS_MM[:16], 8.5, 8.5, 14.0, 14.0, 8.5, 8.5])


class Renderer:
    """Renders the theatre's images; deterministic in time.

    The constructor renders the static scenery (about a second); an image then takes some milliseconds. There
    is no state between images, so they may be requested in any order.
    """

    def __init__(
        self, theatre: Theatre, cached: Backdrops | None = None, store: StillStore | None = None
    ) -> None:
        self._theatre = theatre
        self.backdrops = cached if cached is not None and cached.show(theatre) else Backdrops(theatre, store)
        self._rays = self.backdrops.rays
        self._portrait = drill_portrait()
        self._marker_board = PrintedPlane(
            board_face(theatre.marker.image),
            per_mm=BOARD_PER_MM,
            middle_px=(BOARD_HALF_MM * BOARD_PER_MM,) * 2,
        )
        # Compiles or loads the kernels, so that no image is delayed.
        self.image_at(0.0)

    def prepare(self) -> None:
        """Render all static scenery in advance, so that no image is delayed."""
        for placement in self._theatre.placements():
            self.backdrops.at(placement)

    def image_at(self, at_s: float) -> Image8:
        """Return the image (h, w, 3), BGR, whose exposure is centred at this time."""
        theatre = self._theatre
        placement, marker = theatre.placement_at(at_s), theatre.camera_from_marker_at(at_s)
        tool, room = marker @ theatre.tool.marker_from_tool, placement.camera_from_room
        backdrop = self.backdrops.at(placement)
        exposure = backdrop.expose(at_s)
        self._cast_shadow(exposure, room.inverse @ tool, room, backdrop.points_mm)
        blur = theatre.settings.blur
        sampled = self._marker_board.sampled(
            theatre.camera,
            marker,
            blur_px2=(DEFOCUS_PX * blur) ** 2,
            fewest=MARKER_SAMPLES,
        )
        # The body's outline is drawn about as soft as the marker.
        spread = point_spread(blur, self._speed_px_s(at_s, marker), sampled.drawn_px2)
        self._lay_body(exposure, tool, backdrop.depth_mm, spread)
        self._lay_board(exposure, marker, room, sampled, spread)
        if theatre.is_on(EventKind.DRILL_HIDDEN, at_s):
            self._lay_cloth(exposure, marker, BOARD_HALF_MM, spread)
        if theatre.reference is not None and theatre.is_on(EventKind.REFERENCE_HIDDEN, at_s):
            reference = placement.camera_from_vertebra @ theatre.reference_from_vertebra.inverse
            self._lay_cloth(exposure, reference, REFERENCE_HALF_MM, point_spread(blur, np.zeros(2)))
        return exposure.image

    def _lay_cloth(
        self,
        exposure: Exposure,
        camera_from_square: Rigid[Camera, Square],
        half_mm: float,
        spread: PointSpread | None,
    ) -> None:
        """Draw a cloth over a marker."""
        cloth = cloth_px(self._theatre.camera, camera_from_square, half_mm)
        box = self._rays.box_around(cloth, _reach_px(spread))
        if box is not None:
            strips = Strips.of_box(box)
            layer = strips.blank()
            draw_cloth(layer, cloth - box[:2])
            exposure.lay_over(strips, layer, spread)

    def _outline_px(self, camera_from_tool: Rigid[Camera, Tool]) -> Array:
        """Return both sides (2, n, 2) of the drill body in the image."""
        stations = np.arange(PORTRAIT_START_MM, PORTRAIT_END_MM, STATION_MM)
        half = np.interp(stations, [PORTRAIT_START_MM, 40.0, 96.0, 180.0, 200.0], [4.0, 5.0, 10.0, 10.0, 4.0])
        sides = np.zeros((2, len(stations), 3))
        sides[..., 0] = half * np.array([[1.0], [-1.0]])
        sides[..., 2] = -stations
        in_camera = camera_from_tool.move_points(sides.reshape(-1, 3)).reshape(sides.shape)
        ahead = (in_camera[..., 2] > 50.0).all(axis=0)
        px = self._theatre.camera.px_from_camera(in_camera[:, ahead].reshape(-1, 3))
        return px.reshape(2, -1, 2)

    def _speed_px_s(self, at_s: float, camera_from_marker: Rigid[Camera, Marker]) -> Array:
        """Return the image velocity of the marker."""
        later = self._theatre.camera_from_marker_at(at_s, late_s=SPEED_OVER_S)
        ends = np.stack([camera_from_marker.translation_mm, later.translation_mm])
        px = self._theatre.camera.px_from_camera(ends)
        return np.asarray((px[1] - px[0]) / SPEED_OVER_S, dtype=np.float64)

    def _lay_body(
        self,
        exposure: Exposure,
        camera_from_tool: Rigid[Camera, Tool],
        still_mm: Image32,
        spread: PointSpread | None,
    ) -> None:
        """Draw the drill body, except what is in or behind the bone."""
        outline_px = self._outline_px(camera_from_tool)
        strips = strips_around(outline_px, _reach_px(spread), self._rays)
        if strips is None:
            return
        margin_px = 0 if spread is None else -(-spread.reach_px // NODE_PX) * NODE_PX
        drawn = strips.grown(margin_px)
        layer = drawn.blank()
        axis = Axis(camera_from_tool.translation_mm, -camera_from_tool.rotation[:, 2])
        draw_body(layer, drawn.places, self._rays.nodes, self._portrait, axis, still_mm)
        exposure.lay_over(strips, layer, spread, margin_px=margin_px)

    def _lay_board(
        self,
        exposure: Exposure,
        pose: Rigid[Camera, Marker],
        camera_from_room: Rigid[Camera, Room],
        sampled: Sampled,
        spread: PointSpread | None,
    ) -> None:
        """Draw the board with the marker over the body, with exact perspective and distortion."""
        camera = self._theatre.camera
        if float(pose.rotation[:, 2] @ pose.translation_mm) >= 0.0:
            return
        back_px = camera.px_from_camera(pose.move_points(_board_corners(-BOARD_THICK_MM)))
        front_px = self._marker_board.outline_px(camera, pose)
        box = self._rays.box_around(np.concatenate([front_px, back_px]), _reach_px(spread))
        if box is None:
            return
        facing = camera_from_room.rotation.T @ pose.rotation[:, 2]
        layer = board_layer(
            self._marker_board,
            sampled,
            box=box,
            rays=self._rays,
            pose=pose,
            front_px=front_px,
            back_px=back_px,
            brightness=float(lit(facing[None])[0]),
        )
        exposure.lay_over(Strips.of_box(box), layer, spread)

    def _cast_shadow(
        self,
        exposure: Exposure,
        room_from_tool: Rigid[Room, Tool],
        camera_from_room: Rigid[Camera, Room],
        points_mm: Image32,
    ) -> None:
        """Draw the drill's soft shadow on the static scenery at `points_mm`."""
        tip, back = room_from_tool.translation_mm, -room_from_tool.rotation[:, 2]
        stations = tip + np.linspace(0.0, 168.0, 12)[:, None] * back
        above = (stations[:, 1] - SHADOW_GROUND_MM) / TO_LAMP[1]
        stations = stations[above < SHADOW_REACH_MM]
        above = np.maximum(above[above < SHADOW_REACH_MM], 0.0)
        ground = camera_from_room.move_points(stations - above[:, None] * TO_LAMP)
        ground = ground[ground[:, 2] > 50.0]
        box = self._rays.box_around(self._theatre.camera.px_from_camera(ground), 48) if len(ground) else None
        if box is None:
            return
        x, y, width, height = box
        blocks = np.s_[y // NODE_PX : (y + height) // NODE_PX, x // NODE_PX : (x + width) // NODE_PX]
        points = points_mm[blocks]
        taken = rod_shadow(points.reshape(-1, 3), tip, back, SHADOW_PROFILE_MM, SHADOW_RADIUS_MM)
        left = cv2.convertScaleAbs(taken.reshape(points.shape[:2]), alpha=-255.0, beta=255.0)
        wide = cv2.resize(left, (width, height), interpolation=cv2.INTER_LINEAR)
        exposure.dim(box, np.asarray(wide, dtype=np.uint8))


def _reach_px(spread: PointSpread | None) -> int:
    """Return the radius of a spread."""
    return MARGIN_PX if spread is None else MARGIN_PX + spread.reach_px


def _board_corners(z_mm: float) -> Array:
    return np.array([[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]]) * BOARD_HALF_MM + [0.0, 0.0, z_mm]
