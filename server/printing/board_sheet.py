"""Printable page of a calibration board at true size, with rulers in both directions."""

from collections.abc import Iterator

from server.printing.board_marks import bounding_box, marks_of_board, translated
from server.printing.paper import PAPER_MM
from server.printing.rulers import millimetre_ruler, vertical_ruler
from server.printing.sheet import Fill, Label, Point, Sheet, rectangle
from tracker.camera.boards import AprilGridBoard, Board, CharucoLayout, CheckerBoard, DotBoard, DotLayout
from tracker.errors import InvalidInput

# Margins around the board: text above, rulers on the left and below, and the unprintable area.
LEFT_MM, RIGHT_MM, TOP_MM, FOOT_MM = 16.0, 8.0, 12.0, 14.0
RULER_MM = 100
# White margin, limited so that the common board of 9 x 6 corners with 25 mm squares fits A4.
QUIET_MM = 4.0


def board_sheet(board: Board, *, paper: str = "A4", dot_mm: float | None = None) -> Sheet:
    """Return a page with the board in the centre, in portrait or landscape orientation.

    Args:
        board: The board.
        paper: "A4", "A3" or "letter".
        dot_mm: Diameter of dots, see `marks_of_board`.

    Raises:
        InvalidInput: PAPER_UNKNOWN, BOARD_TOO_LARGE, BOARD_DOTS_UNPRINTABLE.
    """
    if paper not in PAPER_MM:
        papers = ", ".join(PAPER_MM)
        raise InvalidInput(
            "PAPER_UNKNOWN",
            f"the paper size '{paper}' is unknown",
            f"Give --paper with one of {papers}.",
            {"paper": paper, "allowed": list(PAPER_MM), "papers": papers},
        )
    ink = marks_of_board(board, dot_mm=dot_mm)
    (low_x, low_y), (high_x, high_y) = bounding_box(ink)
    needed = (high_x - low_x + 2.0 * QUIET_MM, high_y - low_y + 2.0 * QUIET_MM)
    page = _page(needed, paper)
    free = _free(page)
    by = (
        LEFT_MM + (free[0] - needed[0]) / 2.0 + QUIET_MM - low_x,
        TOP_MM + (free[1] - needed[1]) / 2.0 + QUIET_MM - low_y,
    )
    return Sheet(
        title=f"Calibration board, {description_of(board)}",
        size_mm=page,
        marks=(
            # White, so that a viewer with a dark background does not show a dark margin.
            Fill(corners_mm=rectangle(0.0, 0.0, *page), white=True),
            *_labels(board),
            *(translated(mark, by) for mark in ink),
            *millimetre_ruler((LEFT_MM, page[1] - 5.0), length_mm=RULER_MM),
            *vertical_ruler((8.0, (page[1] - RULER_MM) / 2.0), length_mm=RULER_MM),
        ),
    )


def description_of(board: Board) -> str:
    """Return a one-line description of the board, in the terms of `coaxial calibrate`."""
    size = f"{board.columns}x{board.rows}"
    if isinstance(board, DotBoard):
        asymmetric = " asymmetric" if board.layout is DotLayout.ASYMMETRIC else ""
        larger = f", larger dots {','.join(map(str, board.fiducials))}" if board.fiducials else ""
        return f"dots {size}{asymmetric}, pitch {board.pitch_mm:g} mm{larger}"
    if isinstance(board, CheckerBoard):
        return f"checkerboard {size} inner corners, square {board.square_mm:g} mm"
    if isinstance(board, AprilGridBoard):
        return f"aprilgrid {size} tags, tag {board.tag_mm:g} mm, gap {board.gap_mm:g} mm"
    layout = board.layout or CharucoLayout.NEWER
    return (
        f"charuco {size} squares, square {board.square_mm:g} mm, marker {board.marker_mm:g} mm, "
        f"{board.dictionary}, {layout.value} layout"
    )


def _page(needed_mm: Point, paper: str) -> Point:
    """Return the size of the page in portrait or landscape orientation; portrait if both fit."""
    width, height = PAPER_MM[paper]
    for page in ((width, height), (height, width)):
        free = _free(page)
        if needed_mm[0] <= free[0] and needed_mm[1] <= free[1]:
            return page
    free = _free((width, height))
    raise InvalidInput(
        "BOARD_TOO_LARGE",
        f"the board needs {needed_mm[0]:.1f} x {needed_mm[1]:.1f} mm with its white margin, "
        f"but {paper} has {free[0]:.1f} x {free[1]:.1f} mm in portrait orientation",
        "Use fewer or smaller dots or squares, or a larger paper with --paper A3.",
        {"needed_mm": list(needed_mm), "free_mm": list(free), "paper": paper},
    )


def _free(page_mm: Point) -> Point:
    return page_mm[0] - LEFT_MM - RIGHT_MM, page_mm[1] - TOP_MM - FOOT_MM


def _labels(board: Board) -> Iterator[Label]:
    lines = (
        (6.5, 3.5, f"Coaxial: {description_of(board)}"),
        (
            10.5,
            2.6,
            "Print at 100 % and glue it flat. If 100 mm on both rulers are not 100 mm, measure the board.",
        ),
    )
    for base_mm, size_mm, text in lines:
        yield Label(text=text, at_mm=(LEFT_MM, base_mm), size_mm=size_mm)
