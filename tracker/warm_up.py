"""Compile all hot loops ahead, so that nothing compiles in theatre: `python -m tracker.warm_up`."""

import numpy as np

from tracker.camera import CameraModel
from tracker.marker import MarkerModel
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
    tracker = Tracker(camera=camera, models=[MarkerModel.from_image(marker, side_mm=25.0, name="warm-up")])
    tracker.search(image)
    for at_s in (0.0, 0.03, 0.06):
        tracker.step(image, captured_at_s=at_s)


if __name__ == "__main__":
    warm_up()
