"""Find the position and rotation of a detected grid on its board."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.camera.detection.lattice import Cells
from tracker.camera.detection.view import PlacementAmbiguity
from tracker.geometry import Array

# Turns by quarters, as [x, y] @ turn; a board is never seen mirrored.
TURNS = tuple(
    np.array(turn) for turn in (((1, 0), (0, 1)), ((0, 1), (-1, 0)), ((-1, 0), (0, -1)), ((0, -1), (1, 0)))
)

# A line at the rim of a grid is no part of it when it holds so little of what an average line holds.
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
    looks: npt.NDArray[np.int64],
    board: npt.NDArray[np.int64],
    board_looks: npt.NDArray[np.int64],
    *,
    quarters_swap_looks: bool = False,
) -> BoardPlacement | None:
    """Return the best placement of grid cells (n, 2) on a board, or None where they fit nowhere.

    Args:
        cells: where each point stands in its grid, from 0.
        px: (n, 2) its place in the image: where all places do equally well, the first row runs to the right.
        looks: (n,) what each point looks like; -1 where that is unknown.
        board: (rows, columns) the id of the board's point at each cell, -1 where there is none.
        board_looks: (points,) what each point of the board looks like.
        quarters_swap_looks: a quarter turn makes 0 of 1 and 1 of 0, as the colours around a corner do.
    """
    found: list[tuple[int, float, int, npt.NDArray[np.int64], int]] = []
    for quarter, turn in enumerate(TURNS):
        swap = quarters_swap_looks and quarter % 2 == 1
        turned_looks = np.where(looks < 0, looks, 1 - looks) if swap else looks
        turned = cells @ turn
        turned = turned - turned.min(axis=0)
        size = turned.max(axis=0) + 1
        way = _way_right(turned, px)
        for shift_y in range(board.shape[0] - int(size[1]) + 1):
            for shift_x in range(board.shape[1] - int(size[0]) + 1):
                ids = board[turned[:, 1] + shift_y, turned[:, 0] + shift_x]
                if (ids < 0).any():
                    continue
                misfits = int(((turned_looks >= 0) & (board_looks[ids] != turned_looks)).sum())
                off_middle = abs(2 * shift_x + int(size[0]) - board.shape[1]) + abs(
                    2 * shift_y + int(size[1]) - board.shape[0]
                )
                found.append((misfits, way, off_middle, ids, quarter))
    if not found:
        return None
    fewest = min(one[0] for one in found)
    # A single dot that glare made larger must not decide.
    candidates = [one for one in found if one[0] <= fewest + max(1, len(cells) // 100) * (fewest > 0)]
    best = min(candidates, key=lambda one: (one[0], round(one[1], 1), one[2], one[1]))
    return BoardPlacement(
        ids=best[3], ambiguity=_ambiguity_of([one[4] for one in candidates]), misfits=fewest
    )


def trim_to_board(cells: Cells, columns: int, rows: int) -> tuple[Cells, npt.NDArray[np.bool_]]:
    """Cells counted from 0, and which are kept: lines at the rim that hold next to nothing are no board's."""
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


def _way_right(cells: Cells, px: Array) -> float:
    """Return the deviation of the rows from pointing right in the image: 0 for right, 2 for left."""
    design = np.column_stack([cells, np.ones(len(cells))])
    affine, *_ = np.linalg.lstsq(design, px, rcond=None)
    return float(1.0 - affine[0, 0] / (np.linalg.norm(affine[0]) + 1e-12))
