"""Printable page of a marker at true size, with rulers to verify the scale."""

from collections.abc import Iterator

from server.printing.paper import A4_MM
from server.printing.rulers import MM_PER_INCH, inch_ruler, millimetre_ruler
from server.printing.sheet import Fill, Label, Line, Point, Sheet, rectangle
from tracker.design import Shape
from tracker.errors import InvalidInput

EDGE_MM = 20.0
# White margin around the square, in sides; crop marks are outside of it.
QUIET_RATIO = 0.25
CROP_MARK_MM, CROP_OFFSET_MM = 6.0, 1.0
MIN_SIDE_MM, MAX_SIDE_MM = 5.0, 100.0


def marker_sheet(shape: Shape, *, side_mm: float, name: str) -> Sheet:
    """Return an A4 page with the marker, crop marks, rulers of 50 mm and 2 inches, and instructions.

    Raises:
        InvalidInput: MARKER_SIDE_UNPRINTABLE, the square does not fit the page or is too small to cut.
    """
    if not MIN_SIDE_MM <= side_mm <= MAX_SIDE_MM:
        raise InvalidInput(
            "MARKER_SIDE_UNPRINTABLE",
            f"a marker of {side_mm:g} mm cannot be printed on A4 with its white margin, "
            f"allowed: {MIN_SIDE_MM:g} to {MAX_SIDE_MM:g} mm",
            "Give another side with --side-mm.",
            {"side_mm": side_mm, "min_side_mm": MIN_SIDE_MM, "max_side_mm": MAX_SIDE_MM},
        )
    quiet = QUIET_RATIO * side_mm
    left, top = (A4_MM[0] - side_mm) / 2.0, 95.0
    foot = top + side_mm + quiet + 24.0
    return Sheet(
        title=f"Marker {name}, {side_mm:g} mm",
        size_mm=A4_MM,
        marks=(
            # White, so that a viewer with a dark background does not show a dark margin.
            Fill(corners_mm=rectangle(0.0, 0.0, *A4_MM), white=True),
            *_labels(name, side_mm),
            Fill(corners_mm=rectangle(left, top, side_mm, side_mm)),
            *(
                Fill(
                    corners_mm=tuple((left + x * side_mm, top + y * side_mm) for x, y in patch.corners),
                    white=patch.white,
                )
                for patch in shape.patches
            ),
            *_crop_marks((left - quiet, top - quiet), side_mm + 2.0 * quiet),
            *millimetre_ruler((EDGE_MM + 10.0, foot)),
            *inch_ruler((EDGE_MM + 10.0, foot + 20.0)),
        ),
    )


def _labels(name: str, side_mm: float) -> Iterator[Label]:
    lines = (
        (f"Coaxial marker: {name}", 6.0),
        (f"Side of the black square: {side_mm:g} mm ({side_mm / MM_PER_INCH:.4g} in)", 4.0),
        ("Print at 100 % (actual size, no fitting to the page), on stiff matt paper.", 4.0),
        ("Then measure the rulers below and the square. Enter the measured side in Coaxial.", 4.0),
        ("Cut along the marks: the white margin is part of the marker. Keep it flat. This side up.", 4.0),
    )
    for row, (text, size) in enumerate(lines):
        yield Label(text=text, at_mm=(EDGE_MM, EDGE_MM + 8.0 + 8.0 * row), size_mm=size)


def _crop_marks(corner_mm: Point, side_mm: float) -> Iterator[Line]:
    """Yield two short lines outside each corner of the cut."""
    (left, top), gap, end = corner_mm, CROP_OFFSET_MM, CROP_OFFSET_MM + CROP_MARK_MM
    for x, outward_x in ((left, -1.0), (left + side_mm, 1.0)):
        for y, outward_y in ((top, -1.0), (top + side_mm, 1.0)):
            yield Line(start_mm=(x + outward_x * gap, y), end_mm=(x + outward_x * end, y))
            yield Line(start_mm=(x, y + outward_y * gap), end_mm=(x, y + outward_y * end))
