"""The still scenery as the camera sees it, and how something that moves is laid over it."""

from dataclasses import replace

import cv2
import numpy as np
import numpy.typing as npt

from tracker.rehearsal.lens import Box, RayGrid
from tracker.rehearsal.placement import Placement
from tracker.rehearsal.scenery import still_scenery
from tracker.rehearsal.sensor import DEFOCUS_PX, Sensor
from tracker.rehearsal.settings import BoardKind, Scene, Skill, TheatreSettings
from tracker.rehearsal.theatre import Theatre

Image8 = npt.NDArray[np.uint8]
Image32 = npt.NDArray[np.float32]


class Backdrop:
    """The theatre without what moves; building it takes about a second.

    Attributes:
        rays: of the camera.
        depth_mm: (h, w) float32 along the optical axis, of the nearest still thing.
        points_mm: (h/4, w/4, 3) float32, where the middle of each 4x4 block lies, in the room's frame.
    """

    def __init__(self, theatre: Theatre, placement: Placement, rays: RayGrid, sensor: Sensor) -> None:
        self.rays = rays
        self._sensor = sensor
        scenery = still_scenery(theatre, rays, placement)
        self.depth_mm, self.points_mm = scenery.depth_mm, scenery.points_mm
        picture = scenery.picture * self._sensor.gain[..., None]
        sigma = DEFOCUS_PX * theatre.settings.blur
        if sigma > 0.05:
            picture = np.asarray(cv2.GaussianBlur(picture, (0, 0), sigma), dtype=np.float32)
        self._picture: Image8 = np.rint(np.clip(picture, 0.0, 1.0) * 255.0).astype(np.uint8)
        self._sigmas = self._sensor.sigmas(self._picture)

    def picture(self) -> Image8:
        """The picture (h, w, 3), BGR, to draw into."""
        return self._picture.copy()

    def lay_over(self, image: Image8, box: Box, layer: Image8, kernel: Image32 | None) -> None:
        """Lay something that moves over a part of the picture, in place.

        Args:
            image: the picture.
            box: the part.
            layer: (h, w, 4) of that part, premultiplied, sharp.
            kernel: what defocus and motion make of a point in it; None leaves it sharp.
        """
        if kernel is not None:
            soft = cv2.filter2D(layer, -1, kernel, borderType=cv2.BORDER_REPLICATE)
            layer = np.asarray(soft, dtype=np.uint8)
        x, y, width, height = box
        part = image[y : y + height, x : x + width]
        layer = layer[: part.shape[0], : part.shape[1]]
        gain = self._sensor.gain[y : y + height, x : x + width]
        coverage = cv2.merge([255 - layer[..., 3]] * 3)
        behind = cv2.multiply(part, coverage, scale=1.0 / 255.0)
        colour = cv2.multiply(cv2.cvtColor(layer, cv2.COLOR_BGRA2BGR), cv2.merge([gain] * 3), dtype=cv2.CV_8U)
        cv2.add(behind, colour, dst=part)

    def read_out(self, image: Image8, box: Box | None, at_s: float) -> Image8:
        """The picture as the sensor gives it at this time, when nothing but this part of it has changed."""
        sigmas = self._sigmas
        if box is not None:
            x, y, width, height = box
            sigmas = sigmas.copy()
            part = np.s_[y : y + height, x : x + width]
            sigmas[part] = self._sensor.sigmas(image[part])
        return self._sensor.read_out(image, sigmas, at_s)


class Backdrops:
    """The still scenery of each place that camera and patient are in, rendered when it is first needed."""

    def __init__(self, theatre: Theatre) -> None:
        self._theatre = theatre
        self._stage = _stage(theatre.settings)
        self._rays = RayGrid(theatre.camera)
        self._sensor = Sensor(theatre.settings)
        self._kept: dict[bytes, Backdrop] = {}

    def at(self, placement: Placement) -> Backdrop:
        """The scenery there."""
        if placement.key not in self._kept:
            self._kept[placement.key] = Backdrop(self._theatre, placement, self._rays, self._sensor)
        return self._kept[placement.key]

    def show(self, theatre: Theatre) -> bool:
        """Whether they are of this theatre, whatever is played in it."""
        return _stage(theatre.settings) == self._stage


def _stage(settings: TheatreSettings) -> TheatreSettings:
    """The settings without what is played."""
    return replace(settings, scene=Scene.OPERATION, board=BoardKind.DOTS, skill=Skill.WANDERING, events=())
