"""Detection of dot grids: symmetric or asymmetric, with or without larger dots, complete or partial."""

import numpy as np
import numpy.typing as npt

from tracker.camera.boards import DotBoard, DotLayout
from tracker.camera.detection.blobs import WINDOW_RATIOS, Blobs, GreyImage, dark_blobs
from tracker.camera.detection.board_placement import place_on_board, trim_to_board
from tracker.camera.detection.lattice import BASES, Cells, Lattice, largest_lattice, step_lengths_px
from tracker.camera.detection.view import BoardNotFound, BoardView, NotFoundReason
from tracker.geometry import Array

MIN_DOTS = 12
LARGER_AREA_RATIO = 1.6
# Between an ellipse (4/3) and a square (1.4); applied to spots that are large enough to show their shape.
MAX_FOURTH_MOMENT = 1.368
MIN_AREA_FOR_SHAPE_PX2 = 60.0


def find_dots(grey: GreyImage, board: DotBoard) -> BoardView | BoardNotFound:
    """Return the dots of the board in an image, or why they are not found."""
    seen = _best_grid(grey, board)
    if seen is None:
        return BoardNotFound(reason=NotFoundReason.NO_POINTS, sentence="no dots that stand in a grid")
    blobs, lattice = seen
    needed = min(MIN_DOTS, board.columns * board.rows)
    if len(lattice.members) < needed:
        return BoardNotFound(
            reason=NotFoundReason.TOO_FEW_POINTS,
            sentence=f"{len(lattice.members)} dots stand in a grid, at least {needed} are needed",
            seen_points=len(lattice.members),
        )
    fourth = float(np.median(blobs.fourth_moments[lattice.members]))
    px, areas_px2 = blobs.centres_px[lattice.members], blobs.areas_px2[lattice.members]
    if fourth > MAX_FOURTH_MOMENT and float(np.median(areas_px2)) > MIN_AREA_FOR_SHAPE_PX2:
        return BoardNotFound(
            reason=NotFoundReason.NO_POINTS,
            sentence=f"{len(px)} spots stand in a grid, and they are square and not round",
            seen_points=len(px),
        )
    _, cell_areas_px2 = step_lengths_px(px, lattice.cells)
    share = areas_px2 / cell_areas_px2
    larger = share > LARGER_AREA_RATIO * float(np.median(share))
    labels = larger.astype(np.int64) if board.fiducials else np.full(len(px), -1, dtype=np.int64)
    board_labels = np.zeros(board.columns * board.rows, dtype=np.int64)
    board_labels[list(board.fiducials)] = 1
    cells, retained = _on_board(lattice.cells, board)
    px, labels, share, larger = px[retained], labels[retained], share[retained], larger[retained]
    place = place_on_board(cells, px, labels, _cells_of(board), board_labels)
    if place is None:
        wide, high = cells.max(axis=0) + 1
        return BoardNotFound(
            reason=NotFoundReason.OTHER_SIZE,
            sentence=f"a grid of {wide} x {high} steps, and the board has {board.columns} x {board.rows}",
            seen_points=len(cells),
        )
    expected = int(board_labels[place.ids].sum())
    if board.fiducials and place.misfits > max(1, expected // 2):
        return BoardNotFound(
            reason=NotFoundReason.OTHER_FIDUCIALS,
            sentence=f"{int(larger.sum())} larger dots are seen, and {place.misfits} dots differ in size "
            f"from the board with larger dots {list(board.fiducials)}",
            seen_points=len(cells),
        )
    return BoardView(
        ids=place.ids,
        object_points_mm=board.object_points_mm[place.ids],
        image_points_px=px,
        dot_radii_mm=_radii_mm(share, larger, board),
        ambiguity=place.ambiguity,
    )


def larger_dots(view: BoardView) -> npt.NDArray[np.int64]:
    """Return the ids of dots that are larger than most in this view."""
    radii = view.dot_radii_mm
    return np.asarray(view.ids[radii > np.sqrt(LARGER_AREA_RATIO) * float(np.median(radii))])


def _best_grid(grey: GreyImage, board: DotBoard) -> tuple[Blobs, Lattice] | None:
    """Return the grid with most dots over several threshold windows, dark dots before light ones."""
    best: tuple[Blobs, Lattice] | None = None
    whole = board.columns * board.rows
    for image in (grey, 255 - grey):
        for ratio in WINDOW_RATIOS:
            blobs = dark_blobs(image, window_ratio=ratio)
            lattice = largest_lattice(blobs.centres_px)
            if len(lattice.members) >= MIN_DOTS // 2 and (
                best is None or len(lattice.members) > len(best[1].members)
            ):
                best = blobs, lattice
            if best is not None and len(best[1].members) == whole:
                return best
        if best is not None and len(best[1].members) >= MIN_DOTS:
            return best
    return best


def _on_board(cells: Cells, board: DotBoard) -> tuple[Cells, npt.NDArray[np.bool_]]:
    """Return cells in steps of the board's pitch and the inlier mask, without stray lines at the border."""
    asymmetric = board.layout is DotLayout.ASYMMETRIC
    if asymmetric:
        cells = max((_across(cells, basis) for basis in BASES), key=_fill)
    return trim_to_board(cells, 2 * board.columns if asymmetric else board.columns, board.rows)


def _across(cells: Cells, basis: npt.NDArray[np.int64]) -> Cells:
    """Return cells along rows and columns of an asymmetric board, whose nearest dots are on its diagonals."""
    diagonal = np.rint(cells @ np.linalg.inv(basis)).astype(np.int64)
    return np.column_stack([diagonal[:, 0] - diagonal[:, 1], diagonal[:, 0] + diagonal[:, 1]])


def _fill(cells: Cells) -> float:
    """Return the filled share of the cells' bounding rectangle; low for a diagonal basis."""
    return len(cells) / float(np.prod(cells.max(axis=0) - cells.min(axis=0) + 1))


def _cells_of(board: DotBoard) -> npt.NDArray[np.int64]:
    """Return the id of the dot at each cell, -1 where there is none."""
    steps = np.rint(board.object_points_mm[:, :2] / board.pitch_mm).astype(int)
    cells = np.full((steps[:, 1].max() + 1, steps[:, 0].max() + 1), -1, dtype=np.int64)
    cells[steps[:, 1], steps[:, 0]] = np.arange(len(steps))
    return cells


def _radii_mm(share: Array, larger: npt.NDArray[np.bool_], board: DotBoard) -> Array:
    """Return the median radius of the small and of the larger dots, because single radii are noisy."""
    asymmetric = board.layout is DotLayout.ASYMMETRIC
    cell_mm2 = (2.0 if asymmetric else 1.0) * board.pitch_mm**2
    small = float(np.median(share[~larger])) if (~larger).any() else float(np.median(share))
    large = float(np.median(share[larger])) if larger.any() else small
    return np.sqrt(np.where(larger, large, small) * cell_mm2 / np.pi)
