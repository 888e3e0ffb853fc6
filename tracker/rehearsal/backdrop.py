"""The still scenery as the camera sees it."""

from dataclasses import replace

import cv2
import numpy as np
import numpy.typing as npt

from tracker.rehearsal.exposure import Exposure
from tracker.rehearsal.lens import Box, RayGrid
from tracker.rehearsal.placement import Placement
from tracker.rehearsal.point_spread import DEFOCUS_PX
from tracker.rehearsal.reference import reference_board_mm
from tracker.rehearsal.scenery import still_scenery
from tracker.rehearsal.sensor import Sensor
from tracker.rehearsal.settings import BoardKind, Scene, Skill, TheatreSettings
from tracker.rehearsal.theatre import Theatre

Image8 = npt.NDArray[np.uint8]
Image32 = npt.NDArray[np.float32]

# Around the reference's board: what its marker's edges are measured in.
REFERENCE_MARGIN_PX = 8


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
        # The light changes every few images.
        self._lit: tuple[float, Image8] = (1.0, self._picture)
        self._still_noise = self._sensor.still_noise(self._picture)
        self._reference_box = _reference_box(theatre, placement, rays)

    def expose(self, at_s: float) -> Exposure:
        """The image of this time, for now without what moves."""
        exposure = Exposure(self._sensor, self._lit_at(at_s), self._still_noise, at_s)
        if self._reference_box is not None:
            # A marker is measured: its noise must not be one that was there before.
            exposure.refresh(self._reference_box)
        return exposure

    def _lit_at(self, at_s: float) -> Image8:
        """The picture in the light of this time; nobody may draw into it."""
        flicker = self._sensor.flicker_at(at_s)
        if flicker != self._lit[0]:
            lit = cv2.convertScaleAbs(self._picture, alpha=flicker)
            self._lit = (flicker, np.asarray(lit, dtype=np.uint8))
        return self._lit[1]


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


def _reference_box(theatre: Theatre, placement: Placement, rays: RayGrid) -> Box | None:
    if theatre.reference is None:
        return None
    pose = placement.camera_from_vertebra @ theatre.reference_from_vertebra.inverse
    px = theatre.camera.px_from_camera(pose.move_points(reference_board_mm()))
    return rays.box_around(px, REFERENCE_MARGIN_PX)
