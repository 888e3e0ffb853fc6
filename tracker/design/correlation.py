"""Normalised correlation of a marker with background squares, its own rotations and its mirror image."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.design.places import GRID_CELLS, Cells32, Places, normalised_row
from tracker.edges import GreyImage

QUARTER_TURNS = 4


def rotated_rows(square: GreyImage) -> Cells32:
    """Return a marker picture (n, n) in its four rotations (4, cells), mean 0, norm 1; flat rows are 0.

    Rotation k is the view in an outline whose first corner is corner k of the marker.
    """
    small = cv2.resize(square, (GRID_CELLS, GRID_CELLS), interpolation=cv2.INTER_AREA)
    rows = [normalised_row(np.rot90(small, turn)) for turn in range(QUARTER_TURNS)]
    return np.stack([np.zeros(GRID_CELLS * GRID_CELLS, np.float32) if row is None else row for row in rows])


def own_correlation(square: GreyImage) -> float:
    """Return the maximum correlation of a marker with its own rotations and its mirror image, -1..1."""
    rows, mirrored = rotated_rows(square), rotated_rows(np.ascontiguousarray(square[:, ::-1]))
    return float(max((rows[1:] @ rows[0]).max(), (mirrored @ rows[0]).max()))


def background_correlation(rows: Cells32, places: Places) -> npt.NDArray[np.float32]:
    """Return each marker's (m, 4, cells) maximum correlation over the places (m,), -1 without places."""
    if len(places) == 0:
        return np.full(len(rows), -1.0, np.float32)
    flat = rows.reshape(-1, rows.shape[-1])
    best = np.full(len(flat), -1.0, np.float32)
    # In blocks, to bound the memory for a long video.
    for start in range(0, len(places), 4096):
        best = np.maximum(best, (flat @ places.cells[start : start + 4096].T).max(axis=1))
    return np.asarray(best.reshape(len(rows), -1).max(axis=1))


def best_correlated_places(rows: Cells32, places: Places, *, count: int) -> list[tuple[int, int, float]]:
    """Return the places with the highest correlation to a marker (4, cells): index, turn, correlation."""
    correlation = places.cells @ rows.T
    order = np.argsort(-correlation, axis=None, kind="stable")[:count]
    return [
        (
            int(flat) // QUARTER_TURNS,
            int(flat) % QUARTER_TURNS,
            float(correlation[int(flat) // QUARTER_TURNS, int(flat) % QUARTER_TURNS]),
        )
        for flat in order
    ]
