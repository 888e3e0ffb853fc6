"""Compile all hot loops ahead, so that nothing compiles in theatre: `python -m tracker.warm_up`."""

import numpy as np

from tracker.camera import CameraModel
from tracker.marker import MarkerModel, explanation_of
from tracker.pipeline import Tracker
from tracker.pipeline.practice import PracticePicture, practice_picture


def warm_up() -> None:
    """Track a marker in a practice picture, after the tracker itself has practised: every loop runs."""
    camera = CameraModel(
        matrix=np.array([[400.0, 0.0, 159.5], [0.0, 400.0, 119.5], [0.0, 0.0, 1.0]]),
        distortion=np.zeros(5),
        size_wh_px=(320, 240),
    )
    marker = np.zeros((64, 64), np.uint8)
    marker[16:48, 16:32] = 255
    marker[32:48, 16:48] = 255
    model = MarkerModel.from_image(marker, side_mm=25.0, name="warm-up")
    picture = practice_picture(model.square, size_wh_px=camera.size_wh_px)
    tracker = Tracker(camera=camera, models=[model])
    for at_s in (0.0, 0.03, 0.06):
        tracker.step(picture.image, captured_at_s=at_s)
    _explain(model, picture)


def _explain(model: MarkerModel, picture: PracticePicture) -> None:
    """Ask what explains a square that no light explains: half in shadow, with a spot of full brightness."""
    side = picture.side_px
    left, top = np.ceil(picture.corners_px[0]).astype(int).tolist()
    shaded = np.where(np.arange(picture.image.shape[1]) < left + 0.6 * side, 1.0, 0.4)
    lit = picture.image.astype(np.float64) * shaded
    lit[top + 2 : top + side // 4, left + side // 3 : left + 2 * side // 3] = 255.0
    explanation_of(np.rint(lit).astype(np.uint8), model.square, picture.corners_px, side_px=float(side))


if __name__ == "__main__":
    warm_up()
