"""Rendering of a calibration board in the theatre."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array, Camera, Pattern, Rigid
from tracker.rehearsal.backdrop import Backdrops, StillStore
from tracker.rehearsal.boards import BOARD_FROM_KIND, BoardHand, printed
from tracker.rehearsal.point_spread import DEFOCUS_PX, point_spread
from tracker.rehearsal.printed_plane import covered_px
from tracker.rehearsal.strips import Strips
from tracker.rehearsal.theatre import Theatre

Image8 = npt.NDArray[np.uint8]

SPEED_OVER_S = 0.004
MARGIN_PX = 2
# Brightness of white paper in the theatre's lamp, facing it and turned away.
MAX_BRIGHTNESS, MIN_BRIGHTNESS = 0.93, 0.6
# Of y and z: a plane is drawn with y up and its face turned to the viewer.
FACE_FROM_PATTERN = np.diag([1.0, -1.0, -1.0])


class BoardRenderer:
    """Renders a board that a hand presents in a sequence of fixed poses. Deterministic in time."""

    def __init__(
        self, theatre: Theatre, cached: Backdrops | None = None, store: StillStore | None = None
    ) -> None:
        self._theatre = theatre
        self._camera = theatre.camera
        self._blur = theatre.settings.blur
        self.backdrops = cached if cached is not None and cached.show(theatre) else Backdrops(theatre, store)
        self.prepare()
        self._rays = self.backdrops.rays
        self._printed = printed(BOARD_FROM_KIND[theatre.settings.board])
        self._plane = self._printed.plane
        self._hand = BoardHand(self._printed, theatre.camera, theatre.settings.seed)

    def prepare(self) -> None:
        """Render all static scenery in advance, so that no image is delayed."""
        for placement in self._theatre.placements():
            self.backdrops.at(placement)

    def camera_from_board_at(self, at_s: float) -> Rigid[Camera, Pattern]:
        """Return the true board pose at this time."""
        return self._hand.camera_from_board_at(at_s)

    def image_at(self, at_s: float) -> Image8:
        """Return the image (h, w, 3), BGR, whose exposure is centred at this time."""
        pose = self.camera_from_board_at(at_s)
        exposure = self.backdrops.at(self._theatre.placement_at(at_s)).expose(at_s)
        face: Rigid[Camera, Pattern] = Rigid(
            rotation=pose.rotation @ FACE_FROM_PATTERN, translation_mm=pose.translation_mm
        )
        sampled = self._plane.sampled(self._camera, face, blur_px2=(DEFOCUS_PX * self._blur) ** 2)
        spread = point_spread(self._blur, self._speed_px_s(at_s), sampled.drawn_px2)
        outline = self._plane.outline_px(self._camera, face)
        box = self._rays.box_around(outline, MARGIN_PX if spread is None else MARGIN_PX + spread.reach_px)
        if box is not None:
            coverage = covered_px(outline, box)
            grey = self._plane.draw(sampled, box, self._rays, face)
            ink = cv2.multiply(grey, coverage, scale=self._brightness(pose) / 255.0)
            layer = np.asarray(cv2.merge([ink, coverage]), dtype=np.uint8)
            exposure.lay_over(Strips.of_box(box), layer, spread)
        return exposure.image

    def _brightness(self, pose: Rigid[Camera, Pattern]) -> float:
        return MIN_BRIGHTNESS + (MAX_BRIGHTNESS - MIN_BRIGHTNESS) * float(
            np.clip(pose.rotation[2, 2], 0.0, 1.0)
        )

    def _speed_px_s(self, at_s: float) -> Array:
        """Return the image velocity of the board's centre."""
        middle = self._printed.corners_mm.mean(axis=0)
        ends = [
            self._camera.px_from_camera(self.camera_from_board_at(at_s + step).move_points(middle))[0]
            for step in (-SPEED_OVER_S / 2.0, SPEED_OVER_S / 2.0)
        ]
        return np.asarray((ends[1] - ends[0]) / SPEED_OVER_S, dtype=np.float64)
