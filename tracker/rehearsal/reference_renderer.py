"""Rendering of the patient reference: a printed board on a steel post, and an occluding cloth."""

from typing import TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Reference, Rigid, Vertebra
from tracker.rehearsal.drill import BOARD_EDGE_GREY, BOARD_PER_MM, BOARD_THICK_MM, board_face
from tracker.rehearsal.lamp import lit
from tracker.rehearsal.lens import Box, RayGrid
from tracker.rehearsal.placement import Placement, Room
from tracker.rehearsal.printed_plane import MAX_SAMPLES, PrintedPlane, Sampled, covered_px
from tracker.rehearsal.reference import (
    CLAMP_IN_VERTEBRA_MM,
    REFERENCE_HALF_MM,
    REFERENCE_SIDE_MM,
    reference_board_mm,
)
from tracker.rehearsal.rods import Rod, rod_between
from tracker.rehearsal.solids import Solid, ball, joined, tube

Image8 = npt.NDArray[np.uint8]
Image32 = npt.NDArray[np.float32]
Square = TypeVar("Square")

# It faces the lamp more than the drill's board; white must not saturate.
PAPER = 0.84
POST_RADIUS_MM, CLAMP_RADIUS_MM = 2.2, 4.6
POST_COLOUR, CLAMP_COLOUR = (0.72, 0.71, 0.70), (0.40, 0.36, 0.34)
# A cloth with eight uneven corners, in halves of the board that it covers, and its fold.
CLOTH = np.array(
    [[-1.45, 1.1], [-0.4, 1.5], [0.8, 1.3], [1.5, 0.7], [1.3, -0.8], [0.5, -1.5], [-0.7, -1.3], [-1.4, -0.6]]
)
CUTS = 2
CLOTH_BGR, FOLD_BGR = (120, 112, 44), (96, 88, 32)


def post(reference_from_vertebra: Rigid[Reference, Vertebra]) -> Solid:
    """Return clamp and post (in the vertebra's frame), from the spinous process to the back of the board."""
    points = _post_line(reference_from_vertebra)
    rings = np.interp(np.linspace(0, 2, 60), [0, 1, 2], [0, 1, 2])
    line = np.stack([np.interp(rings, [0, 1, 2], points[:, i]) for i in range(3)], axis=1)
    clamp = ball(points[0], CLAMP_RADIUS_MM, colour=CLAMP_COLOUR, gloss=0.7)
    joint = ball(points[1], POST_RADIUS_MM * 1.5, colour=CLAMP_COLOUR, gloss=0.7)
    return joined([clamp, joint, tube(line, np.full(60, POST_RADIUS_MM), colour=POST_COLOUR, gloss=0.9)])


def reference_rods(
    reference_from_vertebra: Rigid[Reference, Vertebra], room_from_vertebra: Rigid[Room, Vertebra]
) -> list[Rod]:
    """Return its shadow casters: the post's two parts, and the board."""
    clamp, knee, back = room_from_vertebra.move_points(_post_line(reference_from_vertebra))
    to_room = room_from_vertebra @ reference_from_vertebra.inverse
    low, high = to_room.move_points(np.array([[0, -1, 0], [0, 1, 0]]) * REFERENCE_HALF_MM)
    return [
        rod_between(clamp, knee, POST_RADIUS_MM),
        rod_between(knee, back, POST_RADIUS_MM),
        rod_between(low, high, REFERENCE_HALF_MM),
    ]


def lay_reference(
    picture: Image32,
    depth_mm: Image32,
    *,
    marker_image: Image8,
    camera: CameraModel,
    rays: RayGrid,
    placement: Placement,
    reference_from_vertebra: Rigid[Reference, Vertebra],
) -> None:
    """Draw the board with its marker into the static picture and its depth, in place."""
    pose = placement.camera_from_vertebra @ reference_from_vertebra.inverse
    if float(pose.rotation[:, 2] @ pose.translation_mm) >= 0.0:
        return
    front = camera.px_from_camera(pose.move_points(reference_board_mm()))
    back = camera.px_from_camera(pose.move_points(reference_board_mm(-BOARD_THICK_MM)))
    box = rays.box_around(np.concatenate([front, back]), 4)
    if box is None:
        return
    face = board_face(_at_board_scale(marker_image), REFERENCE_HALF_MM)
    plane = PrintedPlane(face, per_mm=BOARD_PER_MM, middle_px=(REFERENCE_HALF_MM * BOARD_PER_MM,) * 2)
    facing = placement.camera_from_room.rotation.T @ pose.rotation[:, 2]
    outline = plane.outline_px(camera, pose)
    layer = board_layer(
        plane,
        plane.sampled(camera, pose, fewest=MAX_SAMPLES),
        box=box,
        rays=rays,
        pose=pose,
        front_px=outline,
        back_px=back,
        brightness=PAPER * float(lit(facing[None])[0]),
    )
    x, y, width, height = box
    part = np.s_[y : y + height, x : x + width]
    rows, columns = picture[part].shape[:2]
    light = layer[:rows, :columns].astype(np.float32) / 255.0
    picture[part] *= 1.0 - light[..., 1:]
    picture[part] += light[..., :1]
    nearer = np.where(light[..., 1] > 0.5, np.float32(pose.translation_mm[2]), np.float32(np.inf))
    np.minimum(depth_mm[part], nearer, out=depth_mm[part])


def board_layer(
    plane: PrintedPlane,
    sampled: Sampled,
    *,
    box: Box,
    rays: RayGrid,
    pose: Rigid[Camera, Square],
    front_px: Array,
    back_px: Array,
    brightness: float,
) -> Image8:
    """Return grey and coverage (h, w, 2), premultiplied, of a thick board that faces the camera.

    Args:
        plane: the printed face.
        sampled: the same, resampled for `pose`.
        box: rectangle of the image that the layer covers.
        rays: of the camera.
        pose: of the face.
        front_px: (n, 2) outline of the face.
        back_px: (n, 2) corners of the board's back.
        brightness: of white.
    """
    layer = np.zeros((box[3], box[2], 2), dtype=np.uint8)
    hull = cv2.convexHull(_fixed(np.concatenate([front_px, back_px]) - box[:2]))
    cv2.fillConvexPoly(layer, hull, (round(255 * BOARD_EDGE_GREY), 255), cv2.LINE_AA, 4)
    inner = rays.box_around(front_px, 1)
    if inner is None:
        return layer
    coverage = covered_px(front_px, inner)
    ink = cv2.multiply(plane.draw(sampled, inner, rays, pose), coverage, scale=brightness / 255.0)
    x, y, width, height = inner[0] - box[0], inner[1] - box[1], inner[2], inner[3]
    part = layer[y : y + height, x : x + width]
    under = cv2.multiply(part, cv2.merge([255 - coverage] * 2), scale=1.0 / 255.0)
    cv2.add(under, cv2.merge([ink, coverage]), dst=part)
    return layer


def cloth_px(camera: CameraModel, camera_from_square: Rigid[Camera, Square], half_mm: float) -> Array:
    """Return the outline (n, 2) of a cloth over a square board."""
    outline = CLOTH * half_mm
    for _ in range(CUTS):
        # Each corner cut off: the outline becomes round.
        after = np.roll(outline, -1, axis=0)
        outline = np.stack([0.75 * outline + 0.25 * after, 0.25 * outline + 0.75 * after], axis=1)
        outline = outline.reshape(-1, 2)
    corners = np.column_stack([outline, np.full(len(outline), 3.0)])
    return camera.px_from_camera(camera_from_square.move_points(corners))


def draw_cloth(layer: Image8, outline_px: Array) -> None:
    """Draw the cloth with its fold into a layer (h, w, 4), in place."""
    cv2.fillPoly(layer, [_fixed(outline_px)], (*CLOTH_BGR, 255), cv2.LINE_AA, 4)
    middle = outline_px.mean(axis=0)
    # Three folds, each a narrow wedge from the middle to the hem.
    for start in range(0, len(outline_px), len(outline_px) // 3):
        hem = [outline_px[(start + step) % len(outline_px)] for step in (0, 1, 2)]
        cv2.fillPoly(layer, [_fixed(np.stack([middle, *hem]))], (*FOLD_BGR, 255), cv2.LINE_AA, 4)


def _post_line(reference_from_vertebra: Rigid[Reference, Vertebra]) -> Array:
    """Return clamp, knee and the centre of the board's back (3, 3), in the vertebra's frame."""
    back = reference_from_vertebra.inverse.move_points(np.array([0.0, 0.0, -BOARD_THICK_MM - POST_RADIUS_MM]))
    knee = 0.45 * CLAMP_IN_VERTEBRA_MM + 0.55 * back + np.array([0.0, 8.0, 0.0])
    return np.stack([CLAMP_IN_VERTEBRA_MM, knee, back])


def _at_board_scale(marker_image: Image8) -> Image8:
    side = round(REFERENCE_SIDE_MM * BOARD_PER_MM)
    return np.asarray(cv2.resize(marker_image, (side, side), interpolation=cv2.INTER_AREA), dtype=np.uint8)


def _fixed(px: Array) -> npt.NDArray[np.int32]:
    return np.rint(px * 16).astype(np.int32).reshape(-1, 1, 2)
