"""A glance at what is inside an outline: enough to let most outlines go before any edge is matched."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.marker.kernels import correlate
from tracker.marker.model import MarkerModel
from tracker.marker.outline import Quads

CELLS = 12


def templates_of(models: tuple[MarkerModel, ...]) -> npt.NDArray[np.float32]:
    """The models as pictures of 12x12 cells (m, 4, 144), turned by 0..3 quarters, mean 0 and length 1.

    Turn k is the picture of an occurrence whose first corner is corner k of the model.
    """
    out = np.empty((len(models), 4, CELLS * CELLS), np.float32)
    for m, model in enumerate(models):
        small = cv2.resize(model.square, (CELLS, CELLS), interpolation=cv2.INTER_AREA).astype(np.float64)
        for turn in range(4):
            # np.rot90 turns the picture to the left, so that its right-hand corner comes to the top left.
            flat = np.rot90(small, turn).ravel()
            flat = flat - flat.mean()
            out[m, turn] = flat / np.linalg.norm(flat)
    return out


def glance(image: GreyImage, quads: Quads, templates: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Correlation (q, m, 4) of the inside of each outline with each model at each turn, -1..1."""
    return np.asarray(correlate(image, quads, templates), dtype=np.float32)
