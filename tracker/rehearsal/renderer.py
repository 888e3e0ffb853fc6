"""Images of the theatre: the still scenery, and the moving drill drawn into it."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array, Camera, Rigid, Tool
from tracker.rehearsal.backdrop import Backdrop, Backdrops
from tracker.rehearsal.drill import (
    BOARD_EDGE_GREY,
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
    drill_portrait,
)
from tracker.rehearsal.events import EventKind
from tracker.rehearsal.lamp import TO_LAMP, lit, rod_shadow
from tracker.rehearsal.lens import NODE_PX, Box, spread
from tracker.rehearsal.printed import PrintedPlane
from tracker.rehearsal.reference import REFERENCE_HALF_MM
from tracker.rehearsal.reference_picture import cloth_px, draw_cloth
from tracker.rehearsal.sensor import spread_kernel
from tracker.rehearsal.theatre import Theatre, Truth

Image8 = npt.NDArray[np.uint8]
Image32 = npt.NDArray[np.float32]

SPEED_OVER_S = 0.004
# Only this much of the drill ever comes near the bone.
NEAR_BONE_MM = 78.0
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
        truth = self._theatre.truth_at(at_s)
        backdrop = self.backdrops.at(self._theatre.placement_at(at_s))
        image = backdrop.picture()
        self._cast_shadow(image, truth, backdrop.points_mm)
        kernel = spread_kernel(self._theatre.settings.blur, self._speed_px_s(truth))
        reach_px = 4 if kernel is None else 4 + kernel.shape[0] // 2
        box = self._rays.box_around(self._outline_px(truth), reach_px)
        if box is not None:
            layer = self._body(box, truth, backdrop.depth_mm)
            self._add_board(layer, box, truth)
            if self._theatre.is_on(EventKind.DRILL_HIDDEN, at_s):
                cloth = cloth_px(self._theatre.camera, truth.camera_from_marker, BOARD_HALF_MM)
                draw_cloth(layer, cloth - box[:2])
            backdrop.lay_over(image, box, layer, kernel)
        covered = self._cover_reference(image, truth, backdrop)
        return backdrop.read_out(image, _both(box, covered), at_s)

    def _cover_reference(self, image: Image8, truth: Truth, backdrop: Backdrop) -> Box | None:
        """Lays a cloth over the reference while it is hidden; answers with what of the image has changed."""
        pose = truth.camera_from_reference
        if pose is None or not self._theatre.is_on(EventKind.REFERENCE_HIDDEN, truth.at_s):
            return None
        cloth = cloth_px(self._theatre.camera, pose, REFERENCE_HALF_MM)
        box = self._rays.box_around(cloth, 8)
        if box is not None:
            layer = np.zeros((box[3], box[2], 4), dtype=np.uint8)
            draw_cloth(layer, cloth - box[:2])
            backdrop.lay_over(image, box, layer, spread_kernel(self._theatre.settings.blur, np.zeros(2)))
        return box

    def _outline_px(self, truth: Truth) -> Array:
        """Points (n, 2) around everything of the drill that can be in the image."""
        to_camera = truth.camera_from_tool
        stations = np.array([PORTRAIT_START_MM, 40.0, 96.0, 180.0, PORTRAIT_END_MM])
        half = np.array([4.0, 5.0, 10.0, 10.0, 4.0])
        axis = np.stack([np.zeros(5), np.zeros(5), -stations], axis=1)
        reach = np.stack([half, np.zeros(5), np.zeros(5)], axis=1)
        board = _board_corners(0.0)
        points = np.concatenate(
            [axis + reach, axis - reach, self._theatre.tool.marker_from_tool.inverse.move_points(board)]
        )
        in_camera = to_camera.move_points(points)
        return self._theatre.camera.px_from_camera(in_camera[in_camera[:, 2] > 50.0])

    def _speed_px_s(self, truth: Truth) -> Array:
        """How fast the marker moves through the image."""
        ends = []
        for step in (-SPEED_OVER_S / 2.0, SPEED_OVER_S / 2.0):
            pose = (
                self._theatre.camera_from_tool_at(truth.at_s + step)
                @ self._theatre.tool.marker_from_tool.inverse
            )
            ends.append(self._theatre.camera.px_from_camera(pose.translation_mm)[0])
        return np.asarray((ends[1] - ends[0]) / SPEED_OVER_S, dtype=np.float64)

    def _body(self, box: Box, truth: Truth, still_mm: Image32) -> Image8:
        """The drill's body (h, w, 4), premultiplied, without what is hidden in or behind the bone."""
        rays = self._rays.block(*box)
        where = spread(_along_across_depth(rays, truth.camera_from_tool), 1)
        along, across, depth = (np.ascontiguousarray(where[..., i]) for i in range(3))
        column = (along - np.float32(PORTRAIT_START_MM)) * np.float32(PORTRAIT_PER_MM) - np.float32(0.5)
        row = (across + np.float32(PORTRAIT_HALF_MM)) * np.float32(PORTRAIT_PER_MM) - np.float32(0.5)
        layer = np.asarray(cv2.remap(self._portrait, column, row, cv2.INTER_LINEAR), dtype=np.uint8)
        x, y, _, _ = box
        still = still_mm[y : y + layer.shape[0], x : x + layer.shape[1]]
        self._hide_behind_bone(layer, still, along, across, depth)
        return layer

    def _hide_behind_bone(
        self, layer: Image8, still_mm: Image32, along: Image32, across: Image32, depth: Image32
    ) -> None:
        near = np.flatnonzero((along < NEAR_BONE_MM).any(axis=1) & (layer[..., 3].any(axis=1)))
        if len(near) == 0:
            return
        rows = slice(int(near[0]), int(near[-1]) + 1)
        still = still_mm[rows]
        at = np.s_[rows.start : rows.start + still.shape[0], : still.shape[1]]
        radius = np.interp(along[at], PROFILE_MM, RADIUS_MM).astype(np.float32)
        front = depth[at] - np.sqrt(np.maximum(radius**2 - across[at] ** 2, 0.0))
        seen = np.clip((still - front) * 1.5 + 0.5, 0.0, 1.0)
        seen[along[at] > NEAR_BONE_MM] = 1.0
        layer[at] = cv2.multiply(layer[at], cv2.merge([seen] * 4), dtype=cv2.CV_8U)

    def _add_board(self, layer: Image8, box: Box, truth: Truth) -> None:
        """Draws the board with the marker over the body: exact through lens and perspective."""
        pose = truth.camera_from_marker
        if float(pose.rotation[:, 2] @ pose.translation_mm) >= 0.0:
            return
        front = self._theatre.camera.px_from_camera(pose.move_points(_board_corners(0.0)))
        inner = self._rays.box_around(front, 2)
        if inner is None:
            return
        self._add_board_edge(layer, box, truth, front)
        brightness = float(lit((truth.camera_from_room.rotation.T @ pose.rotation[:, 2])[None])[0])
        self._marker_board.draw(layer, box, inner, self._rays, pose, brightness)

    def _add_board_edge(self, layer: Image8, box: Box, truth: Truth, front_px: Array) -> None:
        """The board's thickness: the outline of its front and back together, in one grey."""
        back = truth.camera_from_marker.move_points(_board_corners(-BOARD_THICK_MM))
        both = np.concatenate([front_px, self._theatre.camera.px_from_camera(back)]) - [box[0], box[1]]
        hull = cv2.convexHull(np.rint(both * 16).astype(np.int32).reshape(-1, 1, 2))
        grey = round(255 * BOARD_EDGE_GREY)
        cv2.fillConvexPoly(layer, hull, (grey, grey, grey, 255), cv2.LINE_AA, 4)

    def _cast_shadow(self, image: Image8, truth: Truth, points_mm: Image32) -> None:
        """The drill's soft shadow on the still scenery, whose places are `points_mm`."""
        room_from_tool = truth.camera_from_room.inverse @ truth.camera_from_tool
        tip, back = room_from_tool.translation_mm, -room_from_tool.rotation[:, 2]
        stations = tip + np.linspace(0.0, 168.0, 12)[:, None] * back
        above = (stations[:, 1] - SHADOW_GROUND_MM) / TO_LAMP[1]
        stations = stations[above < SHADOW_REACH_MM]
        above = np.maximum(above[above < SHADOW_REACH_MM], 0.0)
        ground = truth.camera_from_room.move_points(stations - above[:, None] * TO_LAMP)
        ground = ground[ground[:, 2] > 50.0]
        box = self._rays.box_around(self._theatre.camera.px_from_camera(ground), 48) if len(ground) else None
        if box is None:
            return
        x, y, width, height = box
        blocks = np.s_[y // NODE_PX : (y + height) // NODE_PX, x // NODE_PX : (x + width) // NODE_PX]
        points = points_mm[blocks]
        taken = rod_shadow(points.reshape(-1, 3), tip, back, SHADOW_PROFILE_MM, SHADOW_RADIUS_MM)
        left = np.rint((1.0 - taken.reshape(points.shape[:2])) * 255.0).astype(np.uint8)
        wide = cv2.resize(left, (width, height), interpolation=cv2.INTER_LINEAR)
        part = image[y : y + height, x : x + width]
        wide = wide[: part.shape[0], : part.shape[1]]
        cv2.multiply(part, cv2.merge([wide] * 3), dst=part, scale=1.0 / 255.0)


def _both(one: Box | None, other: Box | None) -> Box | None:
    """A rectangle around both."""
    if one is None or other is None:
        return one or other
    x, y = min(one[0], other[0]), min(one[1], other[1])
    right, bottom = max(one[0] + one[2], other[0] + other[2]), max(one[1] + one[3], other[1] + other[3])
    return x, y, right - x, bottom - y


def _board_corners(z_mm: float) -> Array:
    return np.array([[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]]) * BOARD_HALF_MM + [0.0, 0.0, z_mm]


def _along_across_depth(rays: Image32, camera_from_tool: Rigid[Camera, Tool]) -> Image32:
    """For each ray, where it passes the drill's axis: mm from the tip backwards, mm beside it, depth mm."""
    tip, back = camera_from_tool.translation_mm, -camera_from_tool.rotation[:, 2]
    functions = np.stack([back, tip, np.cross(back, tip)], axis=1)
    values = rays.astype(np.float64) @ functions
    square = np.einsum("...i,...i->...", rays, rays).astype(np.float64)
    lean = np.maximum(square - values[..., 0] ** 2, 1e-9)
    depth = (values[..., 1] - values[..., 0] * float(back @ tip)) / lean
    along = depth * values[..., 0] - float(back @ tip)
    across = values[..., 2] / np.sqrt(lean)
    return np.dstack([along, across, depth]).astype(np.float32)
