"""Static scenery in camera view, rendered once and reused."""

from dataclasses import dataclass, replace
from typing import Protocol

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

# Margin around the reference's board in which its marker's edges are measured.
REFERENCE_MARGIN_PX = 8
# The default light flickers over 9 levels; 12 pictures of 1280x720 take 33 MB.
MAX_LIT_PICTURES = 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Still:
    """Render of the static theatre in mean illumination.

    Attributes:
        picture: (h, w, 3) uint8, BGR.
        depth_mm: (h, w) float32 along the optical axis, of the nearest static object.
        points_mm: (h/4, w/4, 3) float32, centre of each 4x4 block in the room's frame.
    """

    picture: Image8
    depth_mm: Image32
    points_mm: Image32

    @property
    def size_wh_px(self) -> tuple[int, int]:
        """Return width and height of the picture."""
        height, width = self.picture.shape[:2]
        return width, height


class StillStore(Protocol):
    """Cache of renders across program starts. It may lose entries, and never returns another entry."""

    def load(self, key: bytes) -> Still | None:
        """Return the render stored under this key; None if it is missing or unreadable."""

    def save(self, key: bytes, still: Still) -> None:
        """Store the render, if possible."""


class Backdrop:
    """The static theatre as the camera's sensor records it.

    Attributes:
        depth_mm: as in `Still`.
        points_mm: as in `Still`.
    """

    def __init__(self, still: Still, sensor: Sensor, reference_box: Box | None) -> None:
        self._sensor = sensor
        self.depth_mm, self.points_mm = still.depth_mm, still.points_mm
        self._picture = still.picture
        self._lit: dict[float, Image8] = {1.0: self._picture}
        self._still_noise = self._sensor.still_noise(self._picture)
        self._reference_box = reference_box

    def expose(self, at_s: float) -> Exposure:
        """Return an exposure of the scenery at this time, without the moving objects."""
        exposure = Exposure(self._sensor, self._lit_at(at_s), self._still_noise, at_s)
        if self._reference_box is not None:
            # The tracker measures this marker: its noise must be independent in each image.
            exposure.refresh(self._reference_box)
        return exposure

    def _lit_at(self, at_s: float) -> Image8:
        """Return the picture in the illumination of this time; read-only."""
        flicker = self._sensor.flicker_at(at_s)
        if flicker not in self._lit:
            if len(self._lit) == MAX_LIT_PICTURES:
                del self._lit[next(iter(self._lit))]
            lit = cv2.convertScaleAbs(self._picture, alpha=flicker)
            self._lit[flicker] = np.asarray(lit, dtype=np.uint8)
        return self._lit[flicker]


class Backdrops:
    """Static scenery for each placement of camera and patient, rendered on first use.

    Args:
        theatre: whose scenery it is.
        store: cache across program starts; rendering one takes about a second.

    Attributes:
        rays: of the camera.
    """

    def __init__(self, theatre: Theatre, store: StillStore | None = None) -> None:
        self._theatre = theatre
        self._store = store
        self._static_settings = _static_settings(theatre.settings)
        self.rays = RayGrid(theatre.camera)
        self._sensor = Sensor(theatre.settings)
        self._retained: dict[bytes, Backdrop] = {}

    def at(self, placement: Placement) -> Backdrop:
        """Return the scenery of a placement."""
        if placement.key not in self._retained:
            box = _reference_box(self._theatre, placement, self.rays)
            self._retained[placement.key] = Backdrop(self._still(placement), self._sensor, box)
        return self._retained[placement.key]

    def _still(self, placement: Placement) -> Still:
        if self._store is None:
            return self._rendered(placement)
        key = repr(self._static_settings).encode() + placement.key
        still = self._store.load(key)
        if still is None or still.size_wh_px != self._static_settings.size_wh_px:
            still = self._rendered(placement)
            self._store.save(key, still)
        return still

    def _rendered(self, placement: Placement) -> Still:
        scenery = still_scenery(self._theatre, self.rays, placement)
        picture = scenery.picture * self._sensor.gain[..., None]
        sigma = DEFOCUS_PX * self._static_settings.blur
        if sigma > 0.05:
            picture = np.asarray(cv2.GaussianBlur(picture, (0, 0), sigma), dtype=np.float32)
        return Still(
            picture=np.rint(np.clip(picture, 0.0, 1.0) * 255.0).astype(np.uint8),
            depth_mm=scenery.depth_mm,
            points_mm=scenery.points_mm,
        )

    def show(self, theatre: Theatre) -> bool:
        """Return whether the renders belong to this theatre, independent of its motion."""
        return _static_settings(theatre.settings) == self._static_settings


def _static_settings(settings: TheatreSettings) -> TheatreSettings:
    """Return the settings without the simulated motion."""
    return replace(settings, scene=Scene.OPERATION, board=BoardKind.DOTS, skill=Skill.WANDERING, events=())


def _reference_box(theatre: Theatre, placement: Placement, rays: RayGrid) -> Box | None:
    if theatre.reference is None:
        return None
    pose = placement.camera_from_vertebra @ theatre.reference_from_vertebra.inverse
    px = theatre.camera.px_from_camera(pose.move_points(reference_board_mm()))
    return rays.box_around(px, REFERENCE_MARGIN_PX)
