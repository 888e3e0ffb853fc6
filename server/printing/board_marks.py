"""Marks of a calibration board, in mm: x right, y down, its first point at 0."""

from collections.abc import Iterator
from itertools import groupby, product

import numpy as np
import numpy.typing as npt

from server.printing.sheet import Disc, Fill, Mark, Point, rectangle
from tracker.camera.boards import AprilGridBoard, Board, CharucoBoard, CheckerBoard, DotBoard, DotLayout
from tracker.errors import InvalidInput

# Relative to the distance to the nearest other dot.
DOT_RATIO, FIDUCIAL_RATIO, MAX_DOT_RATIO = 0.5, 0.75, 0.85


def marks_of_board(board: Board, *, dot_mm: float | None = None) -> tuple[Mark, ...]:
    """Return the marks of a board.

    Args:
        board: The board.
        dot_mm: Diameter of its dots; default: half the distance to the next dot. Larger dots have 1.5 times
            this diameter.

    Raises:
        InvalidInput: BOARD_DOTS_UNPRINTABLE, dots would touch or have no width.
    """
    if isinstance(board, DotBoard):
        return tuple(_dots(board, dot_mm))
    if isinstance(board, CheckerBoard):
        return tuple(_checkers(board))
    if isinstance(board, AprilGridBoard):
        return tuple(_april_grid(board))
    return tuple(_charuco(board))


def bounding_box(marks: tuple[Mark, ...]) -> tuple[Point, Point]:
    """Return the corners of the marks with the smallest and the largest coordinates."""
    low, high = [], []
    for mark in marks:
        if isinstance(mark, Disc):
            low.append((mark.centre_mm[0] - mark.radius_mm, mark.centre_mm[1] - mark.radius_mm))
            high.append((mark.centre_mm[0] + mark.radius_mm, mark.centre_mm[1] + mark.radius_mm))
        elif isinstance(mark, Fill):
            low += mark.corners_mm
            high += mark.corners_mm
    return (min(x for x, _ in low), min(y for _, y in low)), (
        max(x for x, _ in high),
        max(y for _, y in high),
    )


def translated(mark: Mark, by_mm: Point) -> Mark:
    """Return the translated mark."""
    dx, dy = by_mm
    if isinstance(mark, Disc):
        x, y = mark.centre_mm
        return Disc(centre_mm=(x + dx, y + dy), radius_mm=mark.radius_mm)
    if isinstance(mark, Fill):
        return Fill(corners_mm=tuple((x + dx, y + dy) for x, y in mark.corners_mm), white=mark.white)
    raise TypeError(type(mark).__name__)


def _dots(board: DotBoard, dot_mm: float | None) -> Iterator[Disc]:
    # In an asymmetric grid the nearest dot is the diagonal one.
    nearest_mm = board.pitch_mm * (np.sqrt(2.0) if board.layout is DotLayout.ASYMMETRIC else 1.0)
    dot_mm = DOT_RATIO * nearest_mm if dot_mm is None else dot_mm
    large_mm = dot_mm * FIDUCIAL_RATIO / DOT_RATIO
    widest_mm = large_mm if board.fiducials else dot_mm
    if not 0.0 < widest_mm <= MAX_DOT_RATIO * nearest_mm:
        raise InvalidInput(
            "BOARD_DOTS_UNPRINTABLE",
            f"dots of {widest_mm:g} mm at a distance of {nearest_mm:.3g} mm cannot be separated, "
            f"allowed: above 0 to {MAX_DOT_RATIO * nearest_mm:.3g} mm",
            "Give a smaller --dot-mm, or a larger --pitch-mm; larger dots have 1.5 times --dot-mm.",
            {
                "dot_mm": dot_mm,
                "widest_mm": widest_mm,
                "nearest_mm": float(nearest_mm),
                "max_dot_mm": float(MAX_DOT_RATIO * nearest_mm),
            },
        )
    for index, (x, y, _) in enumerate(board.object_points_mm.tolist()):
        yield Disc(centre_mm=(x, y), radius_mm=(large_mm if index in board.fiducials else dot_mm) / 2.0)


def _checkers(board: CheckerBoard) -> Iterator[Fill]:
    side = board.square_mm
    for row, column in product(range(board.rows + 1), range(board.columns + 1)):
        if (row + column) % 2 == 0:
            yield Fill(corners_mm=rectangle((column - 1) * side, (row - 1) * side, side, side))


def _charuco(board: CharucoBoard) -> Iterator[Fill]:
    side, own = board.square_mm, board.opencv_board()
    markers = {}
    for number, corners in zip(np.ravel(own.getIds()), own.getObjPoints(), strict=True):
        column, row = np.floor(np.asarray(corners)[:, :2].mean(axis=0) / side).astype(int).tolist()
        markers[row, column] = int(number)
    for row, column in product(range(board.rows), range(board.columns)):
        if (row, column) not in markers:
            yield Fill(corners_mm=rectangle(column * side, row * side, side, side))
    margin = (side - board.marker_mm) / 2.0
    modules = board.opencv_dictionary.markerSize + 2
    for (row, column), number in markers.items():
        picture = np.asarray(board.opencv_dictionary.generateImageMarker(number, modules, borderBits=1))
        yield from _modules(
            picture > 127, (column * side + margin, row * side + margin), board.marker_mm / modules
        )


def _april_grid(board: AprilGridBoard) -> Iterator[Fill]:
    pitch_mm, gap_mm = board.tag_mm + board.gap_mm, board.gap_mm
    for row, column in product(range(board.rows + 1), range(board.columns + 1)):
        yield Fill(corners_mm=rectangle(column * pitch_mm - gap_mm, row * pitch_mm - gap_mm, gap_mm, gap_mm))
    for row, column in product(range(board.rows), range(board.columns)):
        white = board.white_modules(board.tag_at(column, row))
        yield from _modules(white, (column * pitch_mm, row * pitch_mm), board.tag_mm / len(white))


def _modules(white: npt.NDArray[np.bool_], at_mm: Point, module_mm: float) -> Iterator[Fill]:
    """Yield a black square, and its white modules as runs along rows and along columns.

    Both are drawn, because viewers show grey seams between adjacent runs of one kind.
    """
    left, top = at_mm
    count = white.shape[0]
    yield Fill(corners_mm=rectangle(left, top, count * module_mm, count * module_mm))
    for line, (first, length) in _runs(white):
        yield Fill(
            corners_mm=rectangle(
                left + first * module_mm, top + line * module_mm, length * module_mm, module_mm
            ),
            white=True,
        )
    for line, (first, length) in _runs(white.T):
        if length > 1:
            yield Fill(
                corners_mm=rectangle(
                    left + line * module_mm, top + first * module_mm, module_mm, length * module_mm
                ),
                white=True,
            )


def _runs(white: npt.NDArray[np.bool_]) -> Iterator[tuple[int, tuple[int, int]]]:
    """Yield line, start and length of each run."""
    for line, cells in enumerate(white.tolist()):
        for is_white, group in groupby(enumerate(cells), key=lambda cell: bool(cell[1])):
            run = [at for at, _ in group]
            if is_white:
                yield line, (run[0], len(run))
