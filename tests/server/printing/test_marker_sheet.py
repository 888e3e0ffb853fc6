"""The printed page is true to size: the files are parsed, and their numbers are millimetres and points."""

import re
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt
import pytest

from server.printing import Fill, Label, Line, Sheet, marker_sheet, pdf_from_sheet, svg_from_sheet
from tracker.design import Patch, Shape
from tracker.errors import InvalidInput

SVG = "{http://www.w3.org/2000/svg}"
CORNERS = np.array([[0.2, 0.3], [0.6, 0.2], [0.8, 0.7]])
SHAPE = Shape(patches=(Patch(corners=CORNERS, white=True),))
Points = npt.NDArray[np.float64]


def parsed(text: str) -> ElementTree.Element:
    return ElementTree.fromstring(text.encode())  # noqa: S314  our own file


def polygons_of_svg(text: str) -> list[tuple[str, Points]]:
    found = parsed(text).iter(f"{SVG}polygon")
    return [
        (one.attrib["fill"], np.array([point.split(",") for point in one.attrib["points"].split()], float))
        for one in found
    ]


def content_of(file: bytes) -> str:
    match = re.search(rb"<< /Length (\d+) >>\nstream\n(.*)\nendstream", file, re.DOTALL)
    assert match is not None
    assert len(match[2]) == int(match[1])
    return match[2].decode("cp1252")


def fills_of_pdf(file: bytes) -> list[tuple[str, Points]]:
    """Grey and corners in points of the page, y up, of each filled path."""
    content = content_of(file)
    a, b, c, d, e, f = (float(v) for v in content.splitlines()[0].split()[:6])
    assert b == c == 0.0
    fills = []
    for line in content.splitlines()[1:]:
        if line.endswith(" f"):
            corners = np.array(re.findall(r"(-?[\d.]+) (-?[\d.]+) [ml]", line), float)
            fills.append((line.split()[0], corners * [a, d] + [e, f]))
    return fills


def side_of(corners: Points) -> tuple[float, float]:
    width, height = np.ptp(corners, axis=0)
    return float(width), float(height)


@pytest.mark.parametrize("side_mm", [25.0, 25.4, 40.0])
def test_the_svg_has_the_square_at_its_true_size(side_mm: float) -> None:
    text = svg_from_sheet(marker_sheet(SHAPE, side_mm=side_mm, name="drill"))
    root = parsed(text)
    assert (root.attrib["width"], root.attrib["height"]) == ("210mm", "297mm")
    # One unit is one millimetre.
    assert root.attrib["viewBox"] == "0 0 210 297"
    _, (ink, square), (inner_ink, inner) = polygons_of_svg(text)
    assert (ink, inner_ink) == ("black", "white")
    assert side_of(square) == pytest.approx((side_mm, side_mm), abs=1e-3)
    assert (inner - square.min(axis=0)) / side_mm == pytest.approx(CORNERS, abs=1e-4)


@pytest.mark.parametrize("side_mm", [25.0, 25.4])
def test_the_pdf_has_the_square_at_its_true_size_and_its_top_up(side_mm: float) -> None:
    file = pdf_from_sheet(marker_sheet(SHAPE, side_mm=side_mm, name="drill"))
    box = re.search(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", file)
    assert box is not None
    assert [float(size) for size in box.groups()] == pytest.approx([595.2756, 841.8898], abs=1e-3)
    _, (ink, square), (inner_ink, inner) = fills_of_pdf(file)
    assert (ink, inner_ink) == ("0", "1")
    points = side_mm / 25.4 * 72.0
    assert side_of(square) == pytest.approx((points, points), abs=1e-3)
    from_top_left = (inner - [square[:, 0].min(), square[:, 1].max()]) / points * [1, -1]
    assert from_top_left == pytest.approx(CORNERS, abs=1e-4)
    assert b"/PrintScaling /None" in file


def test_the_table_of_the_pdf_points_at_its_objects() -> None:
    file = pdf_from_sheet(marker_sheet(SHAPE, side_mm=25.0, name="drill"))
    start = int(file.rsplit(b"startxref\n", 1)[1].split()[0])
    assert file[start:].startswith(b"xref\n0 7\n")
    offsets = [int(line[:10]) for line in file[start:].splitlines()[3:9]]
    assert [file[at : at + 7] for at in offsets] == [b"%d 0 obj" % n for n in range(1, 7)]
    # Each entry of the table is 20 bytes long, as readers assume.
    assert re.search(rb"xref\n0 7\n(.{18} \n|.{18}\r\n){7}trailer", file)


def test_both_rulers_are_as_long_as_they_say() -> None:
    root = parsed(svg_from_sheet(marker_sheet(SHAPE, side_mm=25.0, name="drill")))
    lengths = [
        float(line.attrib["x2"]) - float(line.attrib["x1"])
        for line in root.iter(f"{SVG}line")
        if line.attrib["y1"] == line.attrib["y2"]
    ]
    assert max(lengths) == pytest.approx(50.8)
    assert 50.0 in [round(length, 6) for length in lengths]


def test_nothing_is_printed_in_the_white_margin() -> None:
    sheet = marker_sheet(SHAPE, side_mm=100.0, name="drill")
    square = np.array(next(m for m in sheet.marks if isinstance(m, Fill) and not m.white).corners_mm)
    low, high = square.min(axis=0) - 20.0, square.max(axis=0) + 20.0
    points = []
    for mark in sheet.marks:
        if isinstance(mark, Label):
            points.append(mark.at_mm)
        elif isinstance(mark, Line):
            points += [mark.start_mm, mark.end_mm]
    inside = [point for point in points if (low < point).all() and (point < high).all()]
    assert inside == []
    assert (high < sheet.size_mm).all()


def test_words_cannot_break_out_of_their_file() -> None:
    sheet = Sheet(title="a<b", size_mm=(10, 10), marks=(Label(text="f(x) <b> \\ 25 °", at_mm=(1, 1)),))
    assert r"(f\(x\) <b> \\ 25 °)" in content_of(pdf_from_sheet(sheet))
    texts = [one.text for one in parsed(svg_from_sheet(sheet)).iter(f"{SVG}text")]
    assert texts == ["f(x) <b> \\ 25 °"]


@pytest.mark.parametrize("side_mm", [0.0, 4.9, 101.0, float("nan")])
def test_a_side_that_the_page_cannot_hold_is_rejected(side_mm: float) -> None:
    with pytest.raises(InvalidInput) as reported:
        marker_sheet(SHAPE, side_mm=side_mm, name="drill")
    assert reported.value.code == "MARKER_SIDE_UNPRINTABLE"
