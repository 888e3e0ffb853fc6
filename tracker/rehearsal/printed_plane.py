"""A printed plane, drawn with exact perspective and lens distortion."""

from dataclasses import dataclass
from typing import TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Rigid
from tracker.rehearsal.lens import Box, RayGrid, looked_up, spread

Image8 = npt.NDArray[np.uint8]
Frame = TypeVar("Frame")

# Samples per pixel side. With few samples, the face is low-pass filtered first.
MIN_SAMPLES, MAX_SAMPLES = 1, 4
# With a Gaussian of half the sample spacing, the sub-sample position moves an edge by up to 0.002 px.
SOFT_PER_SAMPLE = 0.5
SOFTER = 2.0**0.25
OUTLINE_POINTS = 8
# OpenCV's antialiased polygons extend beyond their outlines by this width on each side.
FILLED_BEYOND_PX = 0.67


@dataclass(frozen=True, slots=True, kw_only=True)
class Sampled:
    """A printed face, resampled for one distance and tilt.

    Attributes:
        face: (h, w) uint8, softened for its samples.
        samples: to a pixel's side.
        drawn_px2: variance of the blur that it is drawn with, beyond that of a pixel's square.
    """

    face: Image8
    samples: int
    drawn_px2: float


class PrintedPlane:
    """A picture in a plane: x to the right and y up on the printed face, z out of it.

    Args:
        face: (h, w) uint8, grey, row 0 on top.
        per_mm: its pixels to a millimetre.
        middle_px: position (x, y) of the plane's origin in the face, from its top left corner.
    """

    def __init__(self, face: Image8, *, per_mm: float, middle_px: tuple[float, float]) -> None:
        self._face = face
        self._per_mm = per_mm
        self._middle_px = np.array(middle_px)
        self._softened: dict[int, Image8] = {}

    def sampled(
        self,
        camera: CameraModel,
        camera_from_plane: Rigid[Camera, Frame],
        *,
        blur_px2: float = 0.0,
        fewest: int = MIN_SAMPLES,
    ) -> Sampled:
        """Return the face with as few samples as a blur of this variance allows."""
        height, width = self._face.shape
        middle = (np.array([width, height]) / 2.0 - self._middle_px) * [1.0, -1.0]
        three = np.zeros((3, 3))
        three[:, :2] = (middle + np.array([[0, 0], [1, 0], [0, 1]])) / self._per_mm
        px = camera.px_from_camera(camera_from_plane.move_points(three))
        largest, smallest = np.linalg.svd(px[1:] - px[0], compute_uv=False)
        for samples in range(fewest, MAX_SAMPLES):
            level = int(np.ceil(np.log(SOFT_PER_SAMPLE / samples / smallest) / np.log(SOFTER)))
            # Bilinear interpolation between pixels of the face adds a variance of 1/6 on average.
            face_px2 = SOFTER ** (2 * level) + 1.0 / 6.0
            drawn_px2 = float(largest * smallest * face_px2 - 1.0 / (12.0 * samples**2))
            if drawn_px2 <= blur_px2:
                return Sampled(face=self._softened_at(level), samples=samples, drawn_px2=drawn_px2)
        return Sampled(face=self._face, samples=MAX_SAMPLES, drawn_px2=0.0)

    def outline_px(self, camera: CameraModel, camera_from_plane: Rigid[Camera, Frame]) -> Array:
        """Return the outline (n, 2) in the image, with distorted sides."""
        height, width = self._face.shape
        corners = np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])
        ratio = (np.arange(OUTLINE_POINTS) / OUTLINE_POINTS)[:, None]
        sides = [a + ratio * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
        xy = (np.concatenate(sides) - self._middle_px) * [1.0, -1.0] / self._per_mm
        return camera.px_from_camera(camera_from_plane.move_points(np.column_stack([xy, np.zeros(len(xy))])))

    def draw(
        self, sampled: Sampled, box: Box, rays: RayGrid, camera_from_plane: Rigid[Camera, Frame]
    ) -> Image8:
        """Return grey values (h, w) over a rectangle of the image; the border is replicated.

        The face must point to the camera.
        """
        pose = camera_from_plane
        plane = np.column_stack([pose.rotation[:, :2], pose.translation_mm])
        # The map from a ray to the plane and to the face.
        face_from_plane = np.array(
            [
                [self._per_mm, 0.0, self._middle_px[0] - 0.5],
                [0.0, -self._per_mm, self._middle_px[1] - 0.5],
                [0.0, 0.0, 1.0],
            ]
        )
        on_face = cv2.transform(rays.block(*box), face_from_plane @ np.linalg.inv(plane))
        x, y, scale = cv2.split(on_face)
        column, row = (spread(np.divide(one, scale, dtype=np.float32), sampled.samples) for one in (x, y))
        # Its border is one grey all around.
        grey = looked_up(sampled.face, column, row, float(sampled.face[0, 0]))
        if sampled.samples == 1:
            return grey
        return np.asarray(cv2.resize(grey, box[2:], interpolation=cv2.INTER_AREA), dtype=np.uint8)

    def _softened_at(self, level: int) -> Image8:
        if level not in self._softened:
            soft = cv2.GaussianBlur(self._face, (0, 0), SOFTER**level, borderType=cv2.BORDER_REPLICATE)
            self._softened[level] = np.asarray(soft, dtype=np.uint8)
        return self._softened[level]


def covered_px(outline_px: Array, box: Box) -> Image8:
    """Return the coverage of each pixel (h, w) of a rectangle by an outline (n, 2), clockwise."""
    along = np.roll(outline_px, -1, axis=0) - np.roll(outline_px, 1, axis=0)
    inwards = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1, keepdims=True)
    coverage = np.zeros((box[3], box[2]), dtype=np.uint8)
    fixed = np.rint((outline_px + FILLED_BEYOND_PX * inwards - box[:2]) * 16).astype(np.int32)
    cv2.fillPoly(coverage, [fixed.reshape(-1, 1, 2)], 255, cv2.LINE_AA, 4)
    return coverage
