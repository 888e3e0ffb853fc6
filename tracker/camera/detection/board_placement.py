"""Find the position and rotation of a detected grid on its board."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.camera.detection.lattice import Cells
from tracker.camera.detection.view import PlacementAmbiguity
from tracker.geometry import Array

# Rotations by 90 degrees, as [x, y] @ turn, without reflections.
TURNS = tuple(
    np.array(turn) for turn in (((1, 0), (0, 1)), ((0, 1), (-1, 0)), ((-1, 0), (0, -1)), ((0, -1), (1, 0)))
)

# A border line of a grid is removed if it contains less than this ratio of the points of an average line.
EMPTY_LINE_RATIO = 0.34


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardPlacement:
    """A grid placed on its board.

    Attributes:
        ids: (n,) point of the board for each point of the grid.
        ambiguity: whether another placement fits equally well.
        misfits: number of points with the wrong label (a large dot for a small one, a wrong colour).
    """

    ids: npt.NDArray[np.int64]
    ambiguity: PlacementAmbiguity
    misfits: int


def place_on_board(
    cells: Cells,
    px: Array,
    labels: npt.NDArray[np.int64],
    board: npt.NDArray[np.int64],
    board_labels: npt.NDArray[np.int64],
    *,
    quarter_turn_swaps_labels: bool = False,
) -> BoardPlacement | None:
    """Return the best placement of grid cells (n, 2) on a board; None if there is none.

    Args:
        cells: grid cell of each point, from 0.
        px: (n, 2), pixels; among equally good placements, the first row runs to the right in the image.
        labels: (n,), label of each point; -1 if unknown.
        board: (rows, columns), id of the board's point at each cell, -1 if there is none.
        board_labels: (points,), label of each point of the board.
        quarter_turn_swaps_labels: whether a rotation by 90 degrees exchanges the labels 0 and 1, as for the
            colours around a corner.
    """
    found: list[tuple[int, float, int, npt.NDArray[np.int64], int]] = []
    for quarter, turn in enumerate(TURNS):
        swap = quarter_turn_swaps_labels and quarter % 2 == 1
        turned_labels = np.where(labels < 0, labels, 1 - labels) if swap else labels
        turned = cells @ turn
        turned = turned - turned.min(axis=0)
        size = turned.max(axis=0) + 1
        deviation = _deviation_from_right(turned, px)
        for shift_y in range(board.shape[0] - int(size[1]) + 1):
            for shift_x in range(board.shape[1] - int(size[0]) + 1):
                ids = board[turned[:, 1] + shift_y, turned[:, 0] + shift_x]
                if (ids < 0).any():
                    continue
                misfits = int(((turned_labels >= 0) & (board_labels[ids] != turned_labels)).sum())
                off_middle = abs(2 * shift_x + int(size[0]) - board.shape[1]) + abs(
                    2 * shift_y + int(size[1]) - board.shape[0]
                )
                found.append((misfits, deviation, off_middle, ids, quarter))
    if not found:
        return None
    fewest = min(one[0] for one in found)
    # A single dot that glare enlarged must not decide.
    candidates = [one for one in found if one[0] <= fewest + max(1, len(cells) // 100) * (fewest > 0)]
    best = min(candidates, key=lambda one: (one[0], round(one[1], 1), one[2], one[1]))
    return BoardPlacement(
        ids=best[3], ambiguity=_ambiguity_of([one[4] for one in candidates]), misfits=fewest
    )


def trim_to_board(cells: Cells, columns: int, rows: int) -> tuple[Cells, npt.NDArray[np.bool_]]:
    """Return cells counted from 0 and the inlier mask; nearly empty lines at the border are removed."""
    maximum = sorted((columns, rows))
    retained = np.ones(len(cells), dtype=bool)
    while True:
        inside = cells[retained]
        low, high = inside.min(axis=0), inside.max(axis=0)
        size = high - low + 1
        if min(size) <= maximum[0] and max(size) <= maximum[1]:
            break
        lines = [(axis, end) for axis in (0, 1) for end in (low[axis], high[axis])]
        counts = [int((inside[:, axis] == end).sum()) for axis, end in lines]
        axis, end = lines[int(np.argmin(counts))]
        if min(counts) > EMPTY_LINE_RATIO * len(inside) / float(size[axis]):
            break
        retained &= cells[:, axis] != end
    inside = cells[retained]
    return inside - inside.min(axis=0), retained


def _ambiguity_of(quarters: list[int]) -> PlacementAmbiguity:
    """Return the ambiguity of the equally good placements, given by their quarter turns."""
    if len(quarters) == 1:
        return PlacementAmbiguity.NONE
    return PlacementAmbiguity.HALF_TURN if len(set(quarters)) == len(quarters) else PlacementAmbiguity.PLACE


def _deviation_from_right(cells: Cells, px: Array) -> float:
    """Return the deviation of the rows from pointing right in the image: 0 for right, 2 for left."""
    design = np.column_stack([cells, np.ones(len(cells))])
    affine, *_ = np.linalg.lstsq(design, px, rcond=None)
    return float(1.0 - affine[0, 0] / (np.linalg.norm(affine[0]) + 1e-12))
