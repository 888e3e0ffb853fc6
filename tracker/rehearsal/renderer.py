"""Images of the theatre: the still scenery, and the moving drill drawn into it."""

from typing import TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array, Camera, Marker, Rigid, Tool, skew
from tracker.rehearsal.backdrop import Backdrops
from tracker.rehearsal.drill import (
    BOARD_HALF_MM,
    BOARD_PER_MM,
    BOARD_THICK_MM,
    PORTRAIT_END_MM,
    PORTRAIT_HALF_MM,
    PORTRAIT_PER_MM,
    PORTRAIT_START_MM,
    PROFILE_MM,
    RADIUS_MM,
    board_face,
    drill_bulge_mm,
    drill_portrait,
)
from tracker.rehearsal.events import EventKind
from tracker.rehearsal.exposure import Exposure
from tracker.rehearsal.lamp import TO_LAMP, lit, rod_shadow
from tracker.rehearsal.lens import NODE_PX, Box, RayGrid, box_around_all, looked_up, nodes_of
from tracker.rehearsal.lens import spread as spread_nodes
from tracker.rehearsal.placement import Room
from tracker.rehearsal.point_spread import DEFOCUS_PX, PointSpread, point_spread
from tracker.rehearsal.printed import PrintedPlane, Sampled
from tracker.rehearsal.reference import REFERENCE_HALF_MM
from tracker.rehearsal.reference_picture import board_layer, cloth_px, draw_cloth
from tracker.rehearsal.theatre import Theatre

Image8 = npt.NDArray[np.uint8]
Image32 = npt.NDArray[np.float32]
Square = TypeVar("Square")

MARGIN_PX = 2
STATION_MM = 8.0
# The marker is measured: two samples to a pixel's side leave little of its blur to softening before.
MARKER_SAMPLES = 2
SPEED_OVER_S = 0.002
# Only this much of the drill ever comes near the bone.
NEAR_BONE_MM = 78.0
PORTRAIT_ROWS = 2.0 * PORTRAIT_HALF_MM * PORTRAIT_PER_MM
NEAR_BONE_PX = (NEAR_BONE_MM - PORTRAIT_START_MM) * PORTRAIT_PER_MM
SHADOW_GROUND_MM, SHADOW_REACH_MM = 14.0, 260.0
# The board is wider than the body and throws most of its shadow.
SHADOW_PROFILE_MM = np.array([*PROFILE_MM[:17], 102, 102.5, 137.5, 138, 168])
SHADOW_RADIUS_MM = np.array([*RADIUS_MM[:16], 8.5, 8.5, 14.0, 14.0, 8.5, 8.5])


class Renderer:
    """Renders the theatre's images. Reads nothing but the theatre: same time, same image.

    Building it renders the still scenery (about a second); an image then costs some milliseconds. It keeps no
    state between images, so that they may be asked for in any order.
    """

    def __init__(self, theatre: Theatre, kept: Backdrops | None = None) -> None:
        self._theatre = theatre
        self.backdrops = kept if kept is not None and kept.show(theatre) else Backdrops(theatre)
        self._rays = self.backdrops.at(theatre.placement_at(0.0)).rays
        self._portrait = drill_portrait()
        self._bulge_mm = drill_bulge_mm(NEAR_BONE_MM)
        self._marker_board = PrintedPlane(
            board_face(theatre.marker.image),
            per_mm=BOARD_PER_MM,
            middle_px=(BOARD_HALF_MM * BOARD_PER_MM,) * 2,
        )

    def prepare(self) -> None:
        """Render all still scenery that will come, so that no image has to wait for it."""
        for placement in self._theatre.placements():
            self.backdrops.at(placement)

    def image_at(self, at_s: float) -> Image8:
        """The image (h, w, 3), BGR, whose exposure has its middle at this time."""
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
        """Lays a cloth over a marker."""
        cloth = cloth_px(self._theatre.camera, camera_from_square, half_mm)
        box = self._rays.box_around(cloth, _reach_px(spread))
        if box is not None:
            layer = np.zeros((box[3], box[2], 4), dtype=np.uint8)
            draw_cloth(layer, cloth - box[:2])
            exposure.lay_over(box, layer, spread)

    def _outline_px(self, camera_from_tool: Rigid[Camera, Tool]) -> Array:
        """Both sides (2, n, 2) of all of the drill's body that can be in the image."""
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
        """How fast the marker moves through the image."""
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
        """Lays the drill's body over the image, strip by strip, without what is in or behind the bone."""
        reach_px = 0 if spread is None else spread.reach_px
        strips = self._rays.strips_around(self._outline_px(camera_from_tool), _reach_px(spread))
        if not strips:
            return
        whole = self._rays.grown(box_around_all(strips), reach_px)
        on_portrait, depth = _on_portrait(self._rays, whole, camera_from_tool)
        for strip in strips:
            drawn = self._rays.grown(strip, reach_px)
            x, y, width, height = drawn
            nodes = nodes_of((x - whole[0], y - whole[1], width, height), margin=0)
            at = spread_nodes(on_portrait[nodes], 1)
            layer = looked_up(self._portrait, at)
            near = _near_bone(on_portrait[nodes])
            if near is not None:
                still = still_mm[y : y + height, x : x + width][near]
                self._hide_behind(layer[near], still, at[near], spread_nodes(depth[nodes], 1)[near])
            exposure.lay_over(strip, layer, spread, drawn=drawn)

    def _hide_behind(self, layer: Image8, still_mm: Image32, at: Image32, axis_mm: Image32) -> None:
        """Take from a layer (h, w, 4) what still things hide, where the axis has this depth."""
        rows, columns = still_mm.shape
        part = layer[:rows, :columns]
        bulge = looked_up(self._bulge_mm, at[:rows, :columns])
        before_mm = cv2.add(cv2.subtract(still_mm, axis_mm[:rows, :columns]), bulge)
        # From a third of a millimetre behind to a third before.
        seen = np.clip(before_mm * np.float32(1.5 * 255.0) + np.float32(127.5), 0.0, 255.0).astype(np.uint8)
        cv2.multiply(part, cv2.merge([seen] * 4), dst=part, scale=1.0 / 255.0)

    def _lay_board(
        self,
        exposure: Exposure,
        pose: Rigid[Camera, Marker],
        camera_from_room: Rigid[Camera, Room],
        sampled: Sampled,
        spread: PointSpread | None,
    ) -> None:
        """Lays the board with the marker over the body: exact through lens and perspective."""
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
        exposure.lay_over(box, layer, spread)

    def _cast_shadow(
        self,
        exposure: Exposure,
        room_from_tool: Rigid[Room, Tool],
        camera_from_room: Rigid[Camera, Room],
        points_mm: Image32,
    ) -> None:
        """The drill's soft shadow on the still scenery, whose places are `points_mm`."""
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
    """How far around something there is anything of it."""
    return MARGIN_PX if spread is None else MARGIN_PX + spread.reach_px


def _board_corners(z_mm: float) -> Array:
    return np.array([[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]]) * BOARD_HALF_MM + [0.0, 0.0, z_mm]


def _near_bone(on_portrait: Image32) -> tuple[slice, slice] | None:
    """Rows and columns of the pixels whose nodes may show what is near the bone; None if there are none."""
    column, row = on_portrait[..., 0], on_portrait[..., 1]
    near = (column < NEAR_BONE_PX) & (row > -NODE_PX) & (row < PORTRAIT_ROWS + NODE_PX)
    rows, columns = np.flatnonzero(near.any(axis=1)), np.flatnonzero(near.any(axis=0))
    if len(rows) == 0:
        return None
    # A node further on each side, without the one around the pixels.
    return _pixels(rows), _pixels(columns)


def _pixels(nodes: npt.NDArray[np.int64]) -> slice:
    return slice(max(int(nodes[0]) - 2, 0) * NODE_PX, (int(nodes[-1]) + 1) * NODE_PX)


def _on_portrait(rays: RayGrid, box: Box, camera_from_tool: Rigid[Camera, Tool]) -> tuple[Image32, Image32]:
    """Where the nodes of a rectangle pass the drill's axis.

    Returns:
        Column and row (rows, columns, 2) of the portrait, and the depth (rows, columns) of the axis in mm.
    """
    tip, back = camera_from_tool.translation_mm, -camera_from_tool.rotation[:, 2]
    slant = float(back @ tip)
    functions = np.stack([back, tip, skew(back) @ tip])
    toward, reach, beside = cv2.split(cv2.transform(rays.block(*box), functions))
    lean = np.maximum(rays.squares[nodes_of(box)] - toward * toward, np.float32(1e-6))
    depth = (reach - toward * slant) / lean
    column = (depth * toward - (slant + PORTRAIT_START_MM)) * PORTRAIT_PER_MM - 0.5
    row = (beside / np.sqrt(lean) + PORTRAIT_HALF_MM) * PORTRAIT_PER_MM - 0.5
    return np.asarray(cv2.merge([column, row]), dtype=np.float32), np.asarray(depth, dtype=np.float32)
