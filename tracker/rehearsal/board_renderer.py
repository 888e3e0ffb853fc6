"""Images of the theatre while a calibration board is held before its camera."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array, Camera, Pattern, Rigid
from tracker.rehearsal.backdrop import Backdrops
from tracker.rehearsal.boards import BOARD_FROM_KIND, BoardHand, printed
from tracker.rehearsal.sensor import spread_kernel
from tracker.rehearsal.theatre import Theatre

Image8 = npt.NDArray[np.uint8]

SPEED_OVER_S = 0.004
EDGE_GREY = 150
# White paper in the theatre's lamp: the more it turns away the darker it is.
BRIGHTEST, DARKEST = 0.93, 0.6
# Of y and z: a plane is drawn with y up and its face turned to the viewer.
FACE_FROM_PATTERN = np.diag([1.0, -1.0, -1.0])


class BoardRenderer:
    """Renders a board that a hand holds still in one place after the other. Same time, same image."""

    def __init__(self, theatre: Theatre, kept: Backdrops | None = None) -> None:
        self._theatre = theatre
        self._camera = theatre.camera
        self._blur = theatre.settings.blur
        self.backdrops = kept if kept is not None and kept.show(theatre) else Backdrops(theatre)
        self.prepare()
        self._printed = printed(BOARD_FROM_KIND[theatre.settings.board])
        self._plane = self._printed.plane
        self._hand = BoardHand(self._printed, theatre.camera, theatre.settings.seed)

    def prepare(self) -> None:
        """Render all still scenery that will come, so that no image has to wait for it."""
        for placement in self._theatre.placements():
            self.backdrops.at(placement)

    def camera_from_board_at(self, at_s: float) -> Rigid[Camera, Pattern]:
        """What is true: where the board is at this time."""
        return self._hand.camera_from_board_at(at_s)

    def image_at(self, at_s: float) -> Image8:
        """The image (h, w, 3), BGR, whose exposure has its middle at this time."""
        pose = self.camera_from_board_at(at_s)
        backdrop = self.backdrops.at(self._theatre.placement_at(at_s))
        image = backdrop.picture()
        corners_px = self._camera.px_from_camera(pose.move_points(self._printed.corners_mm))
        kernel = spread_kernel(self._blur, self._speed_px_s(at_s))
        reach_px = 4 if kernel is None else 4 + kernel.shape[0] // 2
        rays = backdrop.rays
        box, inner = rays.box_around(corners_px, reach_px), rays.box_around(corners_px, 2)
        if box is not None and inner is not None:
            layer = np.zeros((box[3], box[2], 4), dtype=np.uint8)
            outline = np.rint((corners_px - [box[0], box[1]]) * 16).astype(np.int32)
            cv2.fillConvexPoly(layer, outline, (EDGE_GREY, EDGE_GREY, EDGE_GREY, 255), cv2.LINE_AA, 4)
            face: Rigid[Camera, Pattern] = Rigid(
                rotation=pose.rotation @ FACE_FROM_PATTERN, translation_mm=pose.translation_mm
            )
            self._plane.draw(layer, box, inner, rays, face, self._brightness(pose))
            backdrop.lay_over(image, box, layer, kernel)
        return backdrop.read_out(image, box, at_s)

    def _brightness(self, pose: Rigid[Camera, Pattern]) -> float:
        return DARKEST + (BRIGHTEST - DARKEST) * float(np.clip(pose.rotation[2, 2], 0.0, 1.0))

    def _speed_px_s(self, at_s: float) -> Array:
        """How fast the middle of the board moves through the image."""
        middle = self._printed.corners_mm.mean(axis=0)
        ends = [
            self._camera.px_from_camera(self.camera_from_board_at(at_s + step).move_points(middle))[0]
            for step in (-SPEED_OVER_S / 2.0, SPEED_OVER_S / 2.0)
        ]
        return np.asarray((ends[1] - ends[0]) / SPEED_OVER_S, dtype=np.float64)
