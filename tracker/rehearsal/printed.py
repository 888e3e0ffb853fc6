"""Something printed on a flat board, drawn exactly through lens and perspective."""

from typing import TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Camera, Rigid
from tracker.rehearsal.lens import Box, RayGrid, spread

Image8 = npt.NDArray[np.uint8]
Frame = TypeVar("Frame")

# To a pixel's side: what is printed has sharp edges.
SAMPLES = 4


class PrintedPlane:
    """A picture in a plane: x to the right and y up on the printed face, z out of it.

    Args:
        face: (h, w) uint8, grey, row 0 on top.
        per_mm: its pixels to a millimetre.
        middle_px: where the plane's origin lies in it, from its top left corner, x and y.
    """

    def __init__(self, face: Image8, *, per_mm: float, middle_px: tuple[float, float]) -> None:
        self._face = face
        self._whole = np.full_like(face, 255)
        self._per_mm = np.float32(per_mm)
        self._middle_px = np.array(middle_px, dtype=np.float32)

    def draw(
        self,
        layer: Image8,
        box: Box,
        inner: Box,
        rays: RayGrid,
        camera_from_plane: Rigid[Camera, Frame],
        brightness: float,
    ) -> None:
        """Draw it over a layer, in place.

        Args:
            layer: (h, w, 4), premultiplied, of the rectangle `box` of the image.
            box: of the layer.
            inner: where the plane is to be drawn, inside of `box`.
            rays: of the camera.
            camera_from_plane: where the plane is; its face must be turned to the camera.
            brightness: of white.
        """
        pose = camera_from_plane
        plane = np.column_stack([pose.rotation[:, :2], pose.translation_mm])
        on_plane = rays.block(*inner) @ np.linalg.inv(plane).T.astype(np.float32)
        mm = on_plane[..., :2] / on_plane[..., 2:]
        half = np.float32(0.5)
        column = spread(mm[..., :1] * self._per_mm + (self._middle_px[0] - half), SAMPLES)
        row = spread((self._middle_px[1] - half) - mm[..., 1:] * self._per_mm, SAMPLES)
        grey = cv2.remap(self._face, column, row, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
        inside = cv2.remap(self._whole, column, row, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
        size = inner[2:]
        shade = cv2.resize(grey, size, interpolation=cv2.INTER_AREA).astype(np.float32) * brightness
        coverage = cv2.resize(inside, size, interpolation=cv2.INTER_AREA)
        x, y = inner[0] - box[0], inner[1] - box[1]
        part = layer[y : y + size[1], x : x + size[0]]
        under = cv2.multiply(part, cv2.merge([255 - coverage] * 4), scale=1.0 / 255.0)
        ink = np.clip(np.rint(shade), 0, 255).astype(np.uint8)
        cv2.add(under, cv2.merge([ink, ink, ink, coverage]), dst=part)
