"""Printable plate of an accuracy test: numbered crosses at true size, with rulers in both directions."""

from collections.abc import Iterator, Mapping

from server.printing.paper import PAPER_MM
from server.printing.rulers import millimetre_ruler, vertical_ruler
from server.printing.sheet import Fill, Label, Line, Point, Sheet, rectangle
from tracker.errors import InvalidInput

LEFT_MM, RIGHT_MM, TOP_MM, FOOT_MM = 20.0, 12.0, 18.0, 20.0
RULER_MM = 100
# Arms of a cross; the gap in the middle shows the point, so that ink does not hide the tip's place.
ARM_MM, GAP_MM = 7.0, 0.4
MAX_DIVOTS = 100


def grid_of_divots(columns: int, rows: int, pitch_mm: float) -> dict[str, tuple[float, float, float]]:
    """Return the positions of numbered divots, row by row; x right, y down, z into the page.

    Raises:
        InvalidInput: PLATE_INVALID, more divots than anybody captures.
    """
    if not (0 < columns * rows <= MAX_DIVOTS and min(columns, rows) > 1 and 5.0 <= pitch_mm <= 300.0):
        raise InvalidInput(
            "PLATE_INVALID",
            f"a plate of {columns}x{rows} divots with a pitch of {pitch_mm:g} mm cannot be used",
            f"Give at least 2x2 and at most {MAX_DIVOTS} divots, and a pitch of 5 to 300 mm.",
            {"columns": columns, "rows": rows, "pitch_mm": pitch_mm, "max_divots": MAX_DIVOTS},
        )
    return {
        str(row * columns + column + 1): (column * pitch_mm, row * pitch_mm, 0.0)
        for row in range(rows)
        for column in range(columns)
    }


def plate_sheet(divots: Mapping[str, tuple[float, float, float]], *, name: str, paper: str = "A4") -> Sheet:
    """Return a page with a cross at each divot, centred between the margins, in the better orientation.

    Args:
        divots: Positions in mm by name, x right and y down on the page.
        name: Name of the plate.
        paper: "A4", "A3" or "letter".

    Raises:
        InvalidInput: PLATE_TOO_LARGE.
    """
    xs, ys = ([point[axis] for point in divots.values()] for axis in (0, 1))
    needed = (max(xs) - min(xs) + 2.0 * ARM_MM, max(ys) - min(ys) + 2.0 * ARM_MM)
    page = _page(needed, paper)
    left = LEFT_MM + (page[0] - LEFT_MM - RIGHT_MM - needed[0]) / 2.0 + ARM_MM - min(xs)
    top = TOP_MM + (page[1] - TOP_MM - FOOT_MM - needed[1]) / 2.0 + ARM_MM - min(ys)
    crosses = [mark for divot, (x, y, _) in divots.items() for mark in _cross(divot, (left + x, top + y))]
    return Sheet(
        title=f"Accuracy plate {name}",
        size_mm=page,
        marks=(
            # White, so that a viewer with a dark background does not show a dark margin.
            Fill(corners_mm=rectangle(0.0, 0.0, *page), white=True),
            Label(text=f"Coaxial accuracy plate: {name}", at_mm=(LEFT_MM, 8.0), size_mm=4.0),
            Label(
                text="Print at 100 %, glue it flat on a rigid board, and measure both rulers.",
                at_mm=(LEFT_MM, 13.0),
                size_mm=2.8,
            ),
            *crosses,
            *millimetre_ruler((LEFT_MM, page[1] - 5.0), length_mm=RULER_MM),
            *vertical_ruler((8.0, (page[1] - RULER_MM) / 2.0), length_mm=RULER_MM),
        ),
    )


def _cross(divot: str, at_mm: Point) -> Iterator[Line | Label]:
    x, y = at_mm
    for along in (-1.0, 1.0):
        yield Line(start_mm=(x + along * GAP_MM, y), end_mm=(x + along * ARM_MM, y), width_mm=0.15)
        yield Line(start_mm=(x, y + along * GAP_MM), end_mm=(x, y + along * ARM_MM), width_mm=0.15)
    yield Label(text=divot, at_mm=(x + 1.5, y - 1.5), size_mm=4.0)


def _page(needed_mm: Point, paper: str) -> Point:
    """Return the size of the page in portrait or landscape orientation; portrait if both fit."""
    width, height = PAPER_MM[paper]
    for page in ((width, height), (height, width)):
        free = page[0] - LEFT_MM - RIGHT_MM, page[1] - TOP_MM - FOOT_MM
        if needed_mm[0] <= free[0] and needed_mm[1] <= free[1]:
            return page
    free = width - LEFT_MM - RIGHT_MM, height - TOP_MM - FOOT_MM
    raise InvalidInput(
        "PLATE_TOO_LARGE",
        f"the plate needs {needed_mm[0]:.1f} x {needed_mm[1]:.1f} mm, but {paper} has {free[0]:.1f} x "
        f"{free[1]:.1f} mm in portrait orientation",
        "Use fewer divots, a smaller pitch, or a larger paper with --paper A3.",
        {"needed_mm": list(needed_mm), "free_mm": list(free), "paper": paper},
    )
