"""A calibration board as it is described on the command line."""

from server.cli.board import indexes_of, size_of
from server.cli.board_words import Pattern
from tracker.camera.boards import Board, CharucoBoard, CheckerBoard, DotBoard, DotLayout
from tracker.errors import InvalidInput


def board_from_options(
    pattern: Pattern | None,
    *,
    size: str | None,
    pitch_mm: float | None,
    square_mm: float | None,
    marker_mm: float | None,
    dictionary: str,
    larger: str,
) -> Board:
    """The board that the options describe.

    Raises:
        InvalidInput: BOARD_INCOMPLETE, BOARD_SIZE_INVALID, BOARD_INDEXES_INVALID, BOARD_INVALID.
    """
    if pattern is None or size is None:
        raise _incomplete("--pattern" if pattern is None else "--size")
    columns, rows = size_of(size)
    if pattern in (Pattern.DOTS, Pattern.ASYMMETRIC_DOTS):
        if pitch_mm is None:
            raise _incomplete("--pitch-mm")
        layout = DotLayout.SYMMETRIC if pattern is Pattern.DOTS else DotLayout.ASYMMETRIC
        return DotBoard(
            columns=columns, rows=rows, pitch_mm=pitch_mm, layout=layout, fiducials=indexes_of(larger)
        )
    if square_mm is None:
        raise _incomplete("--square-mm")
    if pattern is Pattern.CHECKERBOARD:
        return CheckerBoard(columns=columns, rows=rows, square_mm=square_mm)
    if marker_mm is None:
        raise _incomplete("--marker-mm")
    return CharucoBoard(
        columns=columns, rows=rows, square_mm=square_mm, marker_mm=marker_mm, dictionary=dictionary
    )


def _incomplete(option: str) -> InvalidInput:
    return InvalidInput(
        "BOARD_INCOMPLETE",
        f"the board in the image is described without {option}",
        "Describe it as in --pattern dots --size 16x14 --pitch-mm 4.",
        {"missing": option},
    )
