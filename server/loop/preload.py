"""Loaded once into the process that all tracking processes are forked from, so that a restart is quick.

Importing it loads the tracker and runs it once on a drawn square, which loads or compiles what it compiles.
No thread may be left running here: a forked child would lack it, and wait for it for ever.
"""

import signal

from server.loop.parent import die_with_parent

# Ctrl+C goes to the whole process group; only the server may act on it.
signal.signal(signal.SIGINT, signal.SIG_IGN)
die_with_parent()

import contextlib  # noqa: E402  the lines above come before everything that takes time

import cv2  # noqa: E402
import numpy as np  # noqa: E402

import server.loop.worker  # noqa: E402, F401  loaded here so that no child has to
import tracker.rehearsal  # noqa: E402, F401
from tracker.camera import CameraModel  # noqa: E402
from tracker.errors import NavigationError  # noqa: E402
from tracker.marker import MarkerModel  # noqa: E402
from tracker.pipeline import Tracker  # noqa: E402

__all__ = ["warm_up"]


def warm_up() -> None:
    """Run the tracker once on images of a square."""
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    picture = np.zeros((64, 64), dtype=np.uint8)
    picture[16:40, 16:32] = 255
    picture[40:48, 16:48] = 255
    image = np.full((240, 320), 255, dtype=np.uint8)
    image[60:188, 90:218] = cv2.resize(picture, (128, 128), interpolation=cv2.INTER_NEAREST)
    blurred = np.asarray(cv2.GaussianBlur(image, (0, 0), 1.0), dtype=np.uint8)
    focal = 400.0
    camera = CameraModel(
        matrix=np.array([[focal, 0.0, 159.5], [0.0, focal, 119.5], [0.0, 0.0, 1.0]]),
        distortion=np.zeros(5),
        size_wh_px=(320, 240),
    )
    with contextlib.suppress(NavigationError):
        tracker = Tracker(
            camera=camera, models=[MarkerModel.from_image(picture, side_mm=25.0, name="square")]
        )
        for number in range(3):
            tracker.step(blurred, captured_at_s=number / 30.0)
    cv2.setNumThreads(threads)


# A fault of the tracker is told by the first tracking process, with its traceback, not by this silent one.
with contextlib.suppress(Exception):
    warm_up()
