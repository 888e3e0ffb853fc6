"""A glance at what is inside an outline: enough to let most outlines go before any edge is matched."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.marker.kernels import even_light, sample_quads
from tracker.marker.model import MarkerModel
from tracker.marker.outline import Quads

Float32 = npt.NDArray[np.float32]

# A square is seen as 12x12 cells and one more of its white paper all round.
CELLS, RING = 12, 1
ROWS = CELLS + 2 * RING
# The models' pictures as they are, and as a lens out of focus or a hand in motion leaves them.
BLURS_CELLS = (0.0, 1.2)
# A cell is judged beside those around it: as many as see the border and the paper at once.
AROUND_CELLS = 3
# What differs less than this is even: noise, and folds in the paper.
LEAST_SD_GREY, LEAST_SD_RATIO = 1.0, 0.1


def templates_of(models: tuple[MarkerModel, ...]) -> Float32:
    """The models as pictures (m, blurs, 4, cells), turned by 0..3 quarters, mean 0 and length 1.

    Turn k is the picture of an occurrence whose first corner is corner k of the model.
    """
    out = np.empty((len(models), len(BLURS_CELLS), 4, ROWS * ROWS), np.float32)
    for m, model in enumerate(models):
        for b, blur in enumerate(BLURS_CELLS):
            small = _small(model, blur)
            for turn in range(4):
                # np.rot90 turns the picture to the left, so that its right-hand corner comes to the top left.
                out[m, b, turn] = np.rot90(small, turn).ravel()
    even_light(out.reshape(-1, ROWS * ROWS), ROWS, AROUND_CELLS, LEAST_SD_GREY, LEAST_SD_RATIO)
    return out


def _small(model: MarkerModel, blur_cells: float) -> npt.NDArray[np.float64]:
    """The model on its white paper, a pixel a cell."""
    cells = cv2.resize(model.square, (CELLS, CELLS), interpolation=cv2.INTER_AREA).astype(np.float64)
    paper = float(np.percentile(model.square, 98))
    wide = np.pad(cells, CELLS, constant_values=paper)
    if blur_cells > 0.0:
        wide = np.asarray(cv2.GaussianBlur(wide, (0, 0), blur_cells), dtype=np.float64)
    return wide[CELLS - RING : 2 * CELLS + RING, CELLS - RING : 2 * CELLS + RING]


def glance(image: GreyImage, quads: Quads, templates: Float32) -> Float32:
    """Correlation (q, m, 4) of what is inside each outline with each model at each turn, -1..1."""
    models, blurs, turns, cells = templates.shape
    seen = sample_quads(image, quads, CELLS, RING)
    even_light(seen, ROWS, AROUND_CELLS, LEAST_SD_GREY, LEAST_SD_RATIO)
    alike = seen @ templates.reshape(-1, cells).T
    return np.asarray(alike.reshape(len(quads), models, blurs, turns).max(axis=2), dtype=np.float32)
