"""Sheets as PDF 1.4: pages of filled polygons, lines and texts, in points of 1/72 inch."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from server.printing.sheet import Disc, Fill, Line, Mark, Sheet

POINTS_PER_MM = 72.0 / 25.4
# Distance of the inner control points of the Bezier curve that best approximates a quarter circle.
ARC = 0.552284749831


@dataclass(frozen=True, slots=True, kw_only=True)
class Attachment:
    """A file inside of a PDF, which viewers show and save under its name."""

    name: str
    content: bytes


def pdf_from_sheet(sheet: Sheet) -> bytes:
    """Return the PDF. Its page has the size of the sheet, and requests printing without scaling."""
    return pdf_from_sheets([sheet])


def pdf_from_sheets(sheets: Sequence[Sheet], *, attachment: Attachment | None = None) -> bytes:
    """Return the PDF with a page for each sheet, the title of the first one, and an attached file."""
    first_page = 4 if attachment is None else 6
    kids = " ".join(f"{first_page + 2 * number} 0 R" for number in range(len(sheets)))
    names = "" if attachment is None else " /Names << /EmbeddedFiles << /Names [(1) 4 0 R] >> >>"
    objects = [
        f"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >>{names} >>".encode(),
        f"<< /Type /Pages /Kids [{kids}] /Count {len(sheets)} >>".encode(),
        b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
    ]
    if attachment is not None:
        name = _string(attachment.name)
        objects += [
            f"<< /Type /Filespec /F {name} /EF << /F 5 0 R >> >>".encode("cp1252", errors="replace"),
            _stream(attachment.content, b"/Type /EmbeddedFile "),
        ]
    for number, sheet in enumerate(sheets):
        objects += _page(sheet, contents=first_page + 2 * number + 1)
    return _file([*objects, b"<< /Title %s >>" % _string(sheets[0].title).encode("cp1252", errors="replace")])


def _page(sheet: Sheet, *, contents: int) -> list[bytes]:
    """Return the objects of a page: its description, and its contents under that number."""
    width, height = (POINTS_PER_MM * size for size in sheet.size_mm)
    # The matrix converts mm from the top to points from the bottom; all numbers below it are in mm.
    content = "\n".join(
        [f"{POINTS_PER_MM:.8f} 0 0 {-POINTS_PER_MM:.8f} 0 {height:.4f} cm", *map(_operators, sheet.marks)]
    ).encode("cp1252", errors="replace")
    return [
        f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width:.4f} {height:.4f}] /Contents {contents} 0 R "
        "/Resources << /Font << /F 3 0 R >> >> >>".encode(),
        _stream(content),
    ]


def _stream(content: bytes, entries: bytes = b"") -> bytes:
    return b"<< %s/Length %d >>\nstream\n%s\nendstream" % (entries, len(content), content)


def _file(objects: list[bytes]) -> bytes:
    """Return the file: numbered objects, and the cross-reference table with its offset."""
    # Four bytes above 127 mark the file as binary.
    file = b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n"
    starts = []
    for number, body in enumerate(objects, start=1):
        starts.append(len(file))
        file += b"%d 0 obj\n%s\nendobj\n" % (number, body)
    table = b"".join(b"%010d 00000 n \n" % start for start in starts)
    return (
        file
        + b"xref\n0 %d\n0000000000 65535 f \n%strailer\n<< /Size %d /Root 1 0 R /Info %d 0 R >>\n"
        % (
            len(objects) + 1,
            table,
            len(objects) + 1,
            len(objects),
        )
        + b"startxref\n%d\n%%%%EOF\n" % len(file)
    )


def _operators(mark: Mark) -> str:
    if isinstance(mark, Fill):
        first, *others = (f"{x:.4f} {y:.4f}" for x, y in mark.corners_mm)
        lines = " ".join(f"{point} l" for point in others)
        return f"{1 if mark.white else mark.grey_ratio:.4g} g {first} m {lines} h f"
    if isinstance(mark, Disc):
        return _circle(mark)
    if isinstance(mark, Line):
        (x1, y1), (x2, y2) = mark.start_mm, mark.end_mm
        return f"{mark.width_mm:g} w 0 G {x1:.4f} {y1:.4f} m {x2:.4f} {y2:.4f} l S"
    x, y = mark.at_mm
    # The y axis points down, so that letters have to be flipped.
    return f"BT 0 g /F {mark.size_mm:g} Tf 1 0 0 -1 {x:.4f} {y:.4f} Tm {_string(mark.text)} Tj ET"


def _circle(disc: Disc) -> str:
    """Return four Bezier curves, because PDF has no circles; the error is at most 0.03 % of the radius."""
    (x, y), r = disc.centre_mm, disc.radius_mm
    points = [(1.0, 0.0)]
    for one, next_one in pairwise(((1, 0), (0, 1), (-1, 0), (0, -1), (1, 0))):
        points.append((one[0] + ARC * next_one[0], one[1] + ARC * next_one[1]))
        points.append((next_one[0] + ARC * one[0], next_one[1] + ARC * one[1]))
        points.append(next_one)
    first, *others = (f"{x + r * a:.4f} {y + r * b:.4f}" for a, b in points)
    curves = " ".join(f"{' '.join(others[i : i + 3])} c" for i in range(0, 12, 3))
    return f"0 g {first} m {curves} h f"


def _string(text: str) -> str:
    escaped = text.replace("\\", r"\\").replace("(", r"\(").replace(")", r"\)")
    return f"({escaped})"
