"""How much a marker looks like the squares of a background, and like itself turned or mirrored."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.design.places import CELLS, Cells32, Places, unit_row
from tracker.edges import GreyImage

TURNS = 4


def turned_rows(square: GreyImage) -> Cells32:
    """A marker's picture (n, n) at its four turns (4, cells), mean 0 and length 1; flat ones are zero.

    Turn k is what is seen in an outline whose first corner is corner k of the marker.
    """
    small = cv2.resize(square, (CELLS, CELLS), interpolation=cv2.INTER_AREA)
    rows = [unit_row(np.rot90(small, turn)) for turn in range(TURNS)]
    return np.stack([np.zeros(CELLS * CELLS, np.float32) if row is None else row for row in rows])


def own_correlation(square: GreyImage) -> float:
    """The best correlation of a marker with its own quarter turns and with its mirror image, -1..1."""
    rows, mirrored = turned_rows(square), turned_rows(np.ascontiguousarray(square[:, ::-1]))
    return float(max((rows[1:] @ rows[0]).max(), (mirrored @ rows[0]).max()))


def background_correlation(rows: Cells32, places: Places) -> npt.NDArray[np.float32]:
    """The best correlation of each marker (m, 4, cells) with any of the places (m,), -1 without places."""
    if len(places) == 0:
        return np.full(len(rows), -1.0, np.float32)
    flat = rows.reshape(-1, rows.shape[-1])
    best = np.full(len(flat), -1.0, np.float32)
    # In parts, so that a long video needs no more memory than a short one.
    for start in range(0, len(places), 4096):
        best = np.maximum(best, (flat @ places.cells[start : start + 4096].T).max(axis=1))
    return np.asarray(best.reshape(len(rows), -1).max(axis=1))


def likeliest_places(rows: Cells32, places: Places, *, count: int) -> list[tuple[int, int, float]]:
    """The places that look most like a marker (4, cells): index, turn, correlation; the likeliest first."""
    correlation = places.cells @ rows.T
    order = np.argsort(-correlation, axis=None, kind="stable")[:count]
    return [
        (int(flat) // TURNS, int(flat) % TURNS, float(correlation[int(flat) // TURNS, int(flat) % TURNS]))
        for flat in order
    ]
