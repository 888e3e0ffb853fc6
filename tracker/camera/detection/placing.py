"""Which part of its board a regular grid of points is, and how it is turned."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.camera.detection.lattice import Cells
from tracker.camera.detection.view import Sureness
from tracker.geometry import Array

# Turns by quarters, as [x, y] @ turn; a board is never seen mirrored.
TURNS = tuple(
    np.array(turn) for turn in (((1, 0), (0, 1)), ((0, 1), (-1, 0)), ((-1, 0), (0, -1)), ((0, -1), (1, 0)))
)

# A line at the rim of a grid is no part of it when it holds so little of what an average line holds.
EMPTY_LINE_RATIO = 0.34


@dataclass(frozen=True, slots=True, kw_only=True)
class Placed:
    """A grid placed on its board.

    Attributes:
        ids: (n,) point of the board for each point of the grid.
        sureness: whether another place would do as well.
        misfits: how many points have the wrong look there (a large dot for a small one, a wrong colour).
    """

    ids: npt.NDArray[np.int64]
    sureness: Sureness
    misfits: int


def placed(
    cells: Cells,
    px: Array,
    looks: npt.NDArray[np.int64],
    board: npt.NDArray[np.int64],
    board_looks: npt.NDArray[np.int64],
    *,
    quarters_swap_looks: bool = False,
) -> Placed | None:
    """The best place of grid cells (n, 2) on a board, or None where they fit nowhere.

    Args:
        cells: where each point stands in its grid, from 0.
        px: (n, 2) its place in the image: where all places do equally well, the first row runs to the right.
        looks: (n,) what each point looks like; -1 where that cannot be told.
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
    rivals = [one for one in found if one[0] <= fewest + max(1, len(cells) // 100) * (fewest > 0)]
    best = min(rivals, key=lambda one: (one[0], round(one[1], 1), one[2], one[1]))
    return Placed(ids=best[3], sureness=_sureness([one[4] for one in rivals]), misfits=fewest)


def within(cells: Cells, columns: int, rows: int) -> tuple[Cells, npt.NDArray[np.bool_]]:
    """Cells counted from 0, and which are kept: lines at the rim that hold next to nothing are no board's."""
    most = sorted((columns, rows))
    kept = np.ones(len(cells), dtype=bool)
    while True:
        inside = cells[kept]
        low, high = inside.min(axis=0), inside.max(axis=0)
        size = high - low + 1
        if min(size) <= most[0] and max(size) <= most[1]:
            break
        lines = [(axis, end) for axis in (0, 1) for end in (low[axis], high[axis])]
        counts = [int((inside[:, axis] == end).sum()) for axis, end in lines]
        axis, end = lines[int(np.argmin(counts))]
        if min(counts) > EMPTY_LINE_RATIO * len(inside) / float(size[axis]):
            break
        kept &= cells[:, axis] != end
    inside = cells[kept]
    return inside - inside.min(axis=0), kept


def _sureness(quarters: list[int]) -> Sureness:
    """How sure a place is among rivals that are turned so; one place for each turn is one whole board."""
    if len(quarters) == 1:
        return Sureness.CERTAIN
    return Sureness.HALF_TURN if len(set(quarters)) == len(quarters) else Sureness.PLACE


def _way_right(cells: Cells, px: Array) -> float:
    """How far rows are from running to the right in the image: 0 for right, 2 for left."""
    design = np.column_stack([cells, np.ones(len(cells))])
    affine, *_ = np.linalg.lstsq(design, px, rcond=None)
    return float(1.0 - affine[0, 0] / (np.linalg.norm(affine[0]) + 1e-12))
