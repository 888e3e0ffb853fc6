"""Calibration board from command-line options."""

import re
from dataclasses import fields

from server.cli.board_names import SIZE_COUNTS, BoardOptions, Layout, Pattern
from tracker.camera import (
    AprilGridBoard,
    Board,
    CharucoBoard,
    CharucoLayout,
    CheckerBoard,
    DotBoard,
    DotLayout,
)
from tracker.errors import InvalidInput


def boards_of(given: BoardOptions) -> tuple[Board, ...]:
    """Return the board and, with --inset, the checkerboard inside it.

    Raises:
        InvalidInput: BOARD_OPTION_MISSING, BOARD_OPTION_UNUSED, BOARD_OPTION_INVALID or BOARD_INVALID.
    """
    board = _board_of(given)
    if given.inset is None:
        if given.inset_square_mm is not None:
            raise _unused(given, "inset_square_mm")
        return (board,)
    inner_columns, inner_rows = size_of("--inset", given.inset)
    square_mm = _needed(given, "inset_square_mm")
    return board, CheckerBoard(columns=inner_columns, rows=inner_rows, square_mm=square_mm)


def described(board: Board) -> dict[str, object]:
    """Return the board as stored in a camera file."""
    size = [board.columns, board.rows]
    if isinstance(board, DotBoard):
        return {
            "pattern": Pattern.DOTS.value,
            "size": size,
            "pitch_mm": board.pitch_mm,
            "layout": board.layout.value,
            "fiducials": list(board.fiducials),
        }
    if isinstance(board, CheckerBoard):
        return {"pattern": Pattern.CHECKERBOARD.value, "size": size, "square_mm": board.square_mm}
    if isinstance(board, AprilGridBoard):
        return {
            "pattern": Pattern.APRILGRID.value,
            "size": size,
            "tag_mm": board.tag_mm,
            "gap_mm": board.gap_mm,
        }
    return {
        "pattern": Pattern.CHARUCO.value,
        "size": size,
        "square_mm": board.square_mm,
        "marker_mm": board.marker_mm,
        "dictionary": board.dictionary,
        "layout": board.layout.value if board.layout else None,
    }


def size_of(option: str, text: str) -> tuple[int, int]:
    """Parse "14x16" into columns and rows.

    Raises:
        InvalidInput: BOARD_OPTION_INVALID.
    """
    found = re.fullmatch(r"\s*(\d{1,4})\s*[x×X,]\s*(\d{1,4})\s*", text)
    if not found:
        raise InvalidInput(
            "BOARD_OPTION_INVALID",
            f"{option} {text} is not a size, expected COLUMNSxROWS",
            f"Write it as {option} 14x16: {SIZE_COUNTS}.",
        )
    return int(found[1]), int(found[2])


def indexes_of(text: str | None) -> tuple[int, ...]:
    """Parse comma-separated indexes; an empty text gives none.

    Raises:
        InvalidInput: BOARD_OPTION_INVALID.
    """
    if text is None or not text.strip():
        return ()
    parts = [part.strip() for part in text.split(",")]
    if not all(part.isascii() and part.isdigit() for part in parts):
        raise InvalidInput(
            "BOARD_OPTION_INVALID",
            f"--fiducials {text} is not a list of indexes",
            "Number the dots row by row from 0 at the top left, and list the larger ones as 69,74,149,154.",
        )
    return tuple(int(part) for part in parts)


def _board_of(given: BoardOptions) -> Board:
    columns, rows = size_of("--size", given.size)
    match given.pattern:
        case Pattern.DOTS:
            _reject_unused(given, used=("pitch_mm", "fiducials", "layout"))
            return DotBoard(
                columns=columns,
                rows=rows,
                pitch_mm=_needed(given, "pitch_mm"),
                layout=DotLayout(_layout(given, Layout.SYMMETRIC, Layout.ASYMMETRIC) or Layout.SYMMETRIC),
                fiducials=indexes_of(given.fiducials),
            )
        case Pattern.CHECKERBOARD:
            _reject_unused(given, used=("square_mm",))
            return CheckerBoard(columns=columns, rows=rows, square_mm=_needed(given, "square_mm"))
        case Pattern.CHARUCO:
            _reject_unused(given, used=("square_mm", "marker_mm", "dictionary", "layout"))
            if given.dictionary is None:
                raise _missing(given, "dictionary")
            layout = _layout(given, Layout.NEWER, Layout.OLDER)
            return CharucoBoard(
                columns=columns,
                rows=rows,
                square_mm=_needed(given, "square_mm"),
                marker_mm=_needed(given, "marker_mm"),
                dictionary=given.dictionary,
                layout=None if layout is None else CharucoLayout(layout),
            )
        case Pattern.APRILGRID:
            _reject_unused(given, used=("tag_mm", "gap_mm"))
            return AprilGridBoard(
                columns=columns,
                rows=rows,
                tag_mm=_needed(given, "tag_mm"),
                gap_mm=_needed(given, "gap_mm"),
            )


def _layout(given: BoardOptions, *allowed: Layout) -> str | None:
    if given.layout is not None and given.layout not in allowed:
        raise InvalidInput(
            "BOARD_OPTION_INVALID",
            f"--layout {given.layout.value} is not a layout of {given.pattern.value}, allowed: "
            + ", ".join(one.value for one in allowed),
            "Omit it, or give the layout of the board.",
        )
    return None if given.layout is None else given.layout.value


def _needed(given: BoardOptions, name: str) -> float:
    value: float | None = getattr(given, name)
    if value is None:
        raise _missing(given, name)
    return value


def _missing(given: BoardOptions, name: str) -> InvalidInput:
    option = "--" + name.replace("_", "-")
    return InvalidInput(
        "BOARD_OPTION_MISSING",
        f"a {given.pattern.value} board needs {option}",
        f"Measure the print and give {option}.",
        {"option": option},
    )


def _reject_unused(given: BoardOptions, *, used: tuple[str, ...]) -> None:
    """Reject each given option that this pattern does not use; those of an inset apply to all patterns."""
    for field in fields(given):
        if field.name in ("pattern", "size", "inset", "inset_square_mm", *used):
            continue
        if getattr(given, field.name) is not None:
            raise _unused(given, field.name)


def _unused(given: BoardOptions, name: str) -> InvalidInput:
    option = "--" + name.replace("_", "-")
    return InvalidInput(
        "BOARD_OPTION_UNUSED",
        f"{option} does not apply to a {given.pattern.value} board",
        f"Omit {option}, or give another --pattern.",
        {"option": option},
    )
