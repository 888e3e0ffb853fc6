"""OpenCV finds a printed board in the rendered page, each point at its true place in millimetres."""

import re
from xml.etree import ElementTree

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from cv2.typing import MatLike

from server.printing import Label, Line, board_sheet, pdf_from_sheet, svg_from_sheet
from server.printing.board_marks import bounding_box, marks_of_board
from tracker.camera.boards import (
    AprilGridBoard,
    Board,
    CharucoBoard,
    CharucoLayout,
    CheckerBoard,
    DotBoard,
    DotLayout,
)
from tracker.camera.detection import BoardView, find_board
from tracker.errors import InvalidInput

PX_PER_MM = 6.0
SUBPIXEL_BITS = 8
Points = npt.NDArray[np.float64]
Grey = npt.NDArray[np.uint8]


def fixed(values: Points) -> npt.NDArray[np.int32]:
    # OpenCV's pixel (0, 0) is the centre of the first pixel, the page's (0, 0) its corner.
    return np.asarray(np.rint((values * PX_PER_MM - 0.5) * 2**SUBPIXEL_BITS), dtype=np.int32)


def drawn(svg: str) -> Grey:
    """The SVG's polygons and circles as a picture, without lines and text."""
    root = ElementTree.fromstring(svg.encode())  # noqa: S314  our own file
    width, height = (float(root.attrib[key].removesuffix("mm")) for key in ("width", "height"))
    assert root.attrib["viewBox"] == f"0 0 {width:g} {height:g}"
    picture = np.full((round(height * PX_PER_MM), round(width * PX_PER_MM)), 128, np.uint8)
    for one in root.iter():
        ink = 255 if one.attrib.get("fill") == "white" else 0
        if one.tag.endswith("polygon"):
            corners = np.array([point.split(",") for point in one.attrib["points"].split()], float)
            cv2.fillPoly(picture, [fixed(corners)], ink, cv2.LINE_AA, SUBPIXEL_BITS)
        elif one.tag.endswith("circle"):
            x, y = fixed(np.array([float(one.attrib["cx"]), float(one.attrib["cy"])]))
            radius = round(float(one.attrib["r"]) * PX_PER_MM * 2**SUBPIXEL_BITS)
            cv2.circle(picture, (int(x), int(y)), radius, ink, -1, cv2.LINE_AA, SUBPIXEL_BITS)
    return picture


def page_of(board: Board, **how: str) -> Grey:
    return drawn(svg_from_sheet(board_sheet(board, **how)))  # pyrefly: ignore[bad-argument-type]  # its words alone


def in_mm(px: MatLike) -> Points:
    return (np.asarray(px, np.float64).reshape(-1, 2) + 0.5) / PX_PER_MM


def assert_at_true_size(found_px: MatLike, board: Board, ids: list[int] | None = None) -> None:
    """Distances between all points equal the board's; the board is neither rotated nor mirrored."""
    wanted = board.object_points_mm[:, :2] if ids is None else board.object_points_mm[ids, :2]
    found = in_mm(found_px)
    assert found - found[0] == pytest.approx(wanted - wanted[0], abs=0.05)


@pytest.mark.parametrize(
    ("board", "flag"),
    [
        pytest.param(DotBoard(columns=16, rows=14, pitch_mm=4.0), cv2.CALIB_CB_SYMMETRIC_GRID, id="dots"),
        pytest.param(
            DotBoard(columns=4, rows=11, pitch_mm=10.0, layout=DotLayout.ASYMMETRIC),
            cv2.CALIB_CB_ASYMMETRIC_GRID,
            id="asymmetric",
        ),
        pytest.param(
            DotBoard(columns=10, rows=7, pitch_mm=15.5, fiducials=(12, 17, 52)),
            cv2.CALIB_CB_SYMMETRIC_GRID,
            id="with-larger-dots-and-across-the-page",
        ),
    ],
)
def test_dots_are_found_at_their_places(board: DotBoard, flag: int) -> None:
    parameters = cv2.SimpleBlobDetector.Params()
    parameters.minArea, parameters.maxArea = 20.0, 10_000.0
    found, centres = cv2.findCirclesGrid(
        page_of(board),
        (board.columns, board.rows),
        flags=flag,
        blobDetector=cv2.SimpleBlobDetector.create(parameters),
    )
    assert found
    assert_at_true_size(in_page_order(centres, board), board)


def in_page_order(centres: MatLike, board: DotBoard) -> MatLike:
    """Row by row: OpenCV may begin at another corner of a symmetric grid."""
    points = centres.reshape(-1, 2)
    row = np.rint((points[:, 1] - points[:, 1].min()) / (board.pitch_mm * PX_PER_MM))
    return np.asarray(points[np.lexsort((points[:, 0], row))])


def test_larger_dots_are_those_that_were_named() -> None:
    board = DotBoard(columns=16, rows=14, pitch_mm=4.0, fiducials=(69, 74, 149, 154))
    root = ElementTree.fromstring(svg_from_sheet(board_sheet(board)).encode())  # noqa: S314  our own file
    radii = [float(one.attrib["r"]) for one in root.iter() if one.tag.endswith("circle")]
    assert len(radii) == 224
    assert [index for index, radius in enumerate(radii) if radius > 1.2] == [69, 74, 149, 154]
    assert radii[0] == pytest.approx(1.0)
    assert radii[69] == pytest.approx(1.5)


def test_a_checkerboard_is_found_at_its_places() -> None:
    board = CheckerBoard(columns=9, rows=6, square_mm=25.0)
    found, corners = cv2.findChessboardCornersSB(page_of(board), (9, 6))
    assert found
    # OpenCV begins at a white outer square, which is the last one here.
    assert_at_true_size(corners[::-1], board)


@pytest.mark.parametrize("rows", [5, 6])
@pytest.mark.parametrize("layout", list(CharucoLayout))
def test_a_charuco_board_is_found_in_its_own_layout(layout: CharucoLayout, rows: int) -> None:
    board = CharucoBoard(
        columns=8, rows=rows, square_mm=22.0, marker_mm=16.0, dictionary="DICT_6X6_250", layout=layout
    )
    detector = cv2.aruco.CharucoDetector(board.opencv_board())
    corners, ids, _, markers = detector.detectBoard(page_of(board))
    assert ids is not None
    assert np.ravel(ids).tolist() == list(range(7 * (rows - 1)))
    assert len(np.ravel(markers)) == 4 * rows
    assert_at_true_size(corners, board)


@pytest.mark.parametrize("layout", list(CharucoLayout))
def test_a_charuco_board_is_opencv_s_own_picture_of_it(layout: CharucoLayout) -> None:
    board = CharucoBoard(
        columns=5, rows=4, square_mm=24.0, marker_mm=16.0, dictionary="DICT_4X4_50", layout=layout
    )
    (left, top), _ = bounding_box(marks_of_board(board))
    assert (left, top) == (0.0, 0.0) or layout is CharucoLayout.OLDER
    page = page_of(board)
    rows, columns = np.nonzero(page == 0)
    first_row, first_column = int(rows.min()), int(columns.min())
    height, width = int(rows.max()) - first_row + 1, int(columns.max()) - first_column + 1
    own = board.opencv_board().generateImage(
        (round(5 * 24 * PX_PER_MM), round(4 * 24 * PX_PER_MM)), marginSize=0
    )
    assert (width, height) == pytest.approx((own.shape[1], own.shape[0]), abs=2)
    mine = cv2.resize(
        page[first_row : first_row + height, first_column : first_column + width], own.shape[::-1]
    )
    # Except for a margin of a pixel along edges.
    assert np.mean(cv2.erode(cv2.absdiff(mine, own), np.ones((3, 3), np.uint8)) > 100) < 1e-4


def test_each_tag_of_an_april_grid_is_found_at_its_place() -> None:
    board = AprilGridBoard(columns=6, rows=8, tag_mm=20.0, gap_mm=6.0)
    view = find_board(page_of(board), board)
    assert isinstance(view, BoardView), view
    assert view.ids.size == 4 * 48
    assert_at_true_size(view.image_points_px, board, view.ids.tolist())


def test_the_pdf_draws_the_same_dots_round_and_in_place() -> None:
    board = DotBoard(columns=3, rows=2, pitch_mm=20.0)
    sheet = board_sheet(board)
    content = pdf_from_sheet(sheet).decode("cp1252")
    circles = [line for line in content.splitlines() if line.endswith("h f") and " c " in line]
    assert len(circles) == 6
    points = np.array(re.findall(r"(-?[\d.]+) (-?[\d.]+)", circles[0].split(" m ")[0])
                      + re.findall(r"(-?[\d.]+) (-?[\d.]+)", circles[0].split(" m ")[1]), float)  # fmt: skip
    centre = points[:-1][::3].mean(axis=0)
    t = np.linspace(0.0, 1.0, 20)[:, None]
    for a, b, c, d in (points[i : i + 4] for i in range(0, 12, 3)):
        curve = (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d
        assert np.linalg.norm(curve - centre, axis=1) == pytest.approx(5.0, abs=0.002)
    first = next(one for one in svg_from_sheet(sheet).splitlines() if "<circle" in one)
    assert re.findall(r'c[xy]="([\d.]+)"', first) == [f"{value:.4f}" for value in centre]


@pytest.mark.parametrize("paper", ["A4", "A3", "letter"])
def test_rulers_both_ways_are_100_mm_long_on_every_paper(paper: str) -> None:
    svg = svg_from_sheet(board_sheet(CheckerBoard(columns=4, rows=3, square_mm=30.0), paper=paper))
    root = ElementTree.fromstring(svg.encode())  # noqa: S314  our own file
    longest = {"x": 0.0, "y": 0.0}
    for line in root.iter("{http://www.w3.org/2000/svg}line"):
        for axis, maximum in longest.items():
            length = abs(float(line.attrib[f"{axis}2"]) - float(line.attrib[f"{axis}1"]))
            longest[axis] = max(maximum, length)
    assert longest == pytest.approx({"x": 100.0, "y": 100.0})


@pytest.mark.parametrize(
    ("board", "paper", "page"),
    [
        pytest.param(CheckerBoard(columns=5, rows=7, square_mm=25.0), "A4", (210.0, 297.0), id="upright"),
        pytest.param(CheckerBoard(columns=7, rows=5, square_mm=25.0), "A4", (297.0, 210.0), id="across"),
        pytest.param(CheckerBoard(columns=9, rows=6, square_mm=35.0), "A3", (420.0, 297.0), id="large"),
    ],
)
def test_the_page_lies_as_the_board_needs_it_with_white_around(
    board: CheckerBoard, paper: str, page: tuple[float, float]
) -> None:
    sheet = board_sheet(board, paper=paper)
    assert sheet.size_mm == page
    (left, top), (right, bottom) = bounding_box(tuple(mark for mark in sheet.marks[1:]))
    text = [mark for mark in sheet.marks if isinstance(mark, Label)]
    lines = [mark for mark in sheet.marks if isinstance(mark, Line)]
    assert top >= 4.0 + max(mark.at_mm[1] for mark in text if mark.at_mm[1] < page[1] / 2.0)
    assert bottom <= min(min(mark.start_mm[1], mark.end_mm[1]) for mark in lines[:102]) - 4.0
    assert left >= 4.0 + max(mark.end_mm[0] for mark in lines[102:])
    assert right <= page[0] - 12.0


def test_a_board_that_does_not_fit_is_rejected_with_both_sizes() -> None:
    with pytest.raises(InvalidInput, match=r"308\.0 x 218\.0 mm.*186\.0 x 271\.0") as reported:
        board_sheet(CheckerBoard(columns=9, rows=6, square_mm=30.0))
    assert reported.value.code == "BOARD_TOO_LARGE"


@pytest.mark.parametrize(
    ("dot_mm", "fiducials"), [(3.5, ()), (2.5, (3,)), (0.0, ()), (-1.0, ()), (float("nan"), ())]
)
def test_dots_that_touch_or_have_no_width_are_rejected(dot_mm: float, fiducials: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInput) as reported:
        board_sheet(DotBoard(columns=4, rows=3, pitch_mm=4.0, fiducials=fiducials), dot_mm=dot_mm)
    assert reported.value.code == "BOARD_DOTS_UNPRINTABLE"


def test_an_unknown_paper_size_is_rejected() -> None:
    with pytest.raises(InvalidInput, match="A4, A3, letter"):
        board_sheet(CheckerBoard(columns=4, rows=3, square_mm=10.0), paper="A0")
