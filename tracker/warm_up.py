"""Compile all hot loops ahead, so that nothing compiles in theatre: `python -m tracker.warm_up`."""

import numpy as np

from tracker.camera import CameraModel
from tracker.edges import GreyImage
from tracker.marker import MarkerModel, candidate_rounds, explanation_of, templates_of
from tracker.pipeline import Tracker

SIDE_PX = 64
LEFT_PX, TOP_PX = 70, 50


def warm_up() -> None:
    """Search for a marker in a picture of it and track it once: every compiled loop runs."""
    image = np.full((240, 320), 200, np.uint8)
    marker = np.zeros((SIDE_PX, SIDE_PX), np.uint8)
    marker[16:48, 16:32] = 255
    marker[32:48, 16:48] = 255
    image[TOP_PX : TOP_PX + SIDE_PX, LEFT_PX : LEFT_PX + SIDE_PX] = np.where(marker > 0, 200, 20)
    camera = CameraModel(
        matrix=np.array([[400.0, 0.0, 159.5], [0.0, 400.0, 119.5], [0.0, 0.0, 1.0]]),
        distortion=np.zeros(5),
        size_wh_px=(320, 240),
    )
    model = MarkerModel.from_image(marker, side_mm=25.0, name="warm-up")
    tracker = Tracker(camera=camera, models=[model])
    tracker.search(image)
    _explain(model, image)
    # A search stops at the first round that finds it; here every round must run, with more outlines than
    # are looked at closely.
    image[150:230, 20:300] = np.tile(np.kron([[200, 200], [200, 20]], np.ones((10, 10))), (4, 14))
    for _ in candidate_rounds(image, templates_of((model,))):
        pass
    for at_s in (0.0, 0.03, 0.06):
        tracker.step(image, captured_at_s=at_s)


def _explain(model: MarkerModel, image: GreyImage) -> None:
    """Ask what explains a square that no light explains: half in shadow, with a spot of full brightness."""
    lit = image.astype(np.float64) * np.where(np.arange(image.shape[1]) < LEFT_PX + 0.6 * SIDE_PX, 1.0, 0.4)
    lit[TOP_PX + 2 : TOP_PX + 14, LEFT_PX + 20 : LEFT_PX + 44] = 255.0
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]) * SIDE_PX
    corners += np.array([LEFT_PX - 0.5, TOP_PX - 0.5])
    explanation_of(np.rint(lit).astype(np.uint8), model.square, corners, side_px=float(SIDE_PX))


if __name__ == "__main__":
    warm_up()
