"""Calibration boards and their geometry in millimetres.

A board lies in its own plane z = 0: x to the right and y down on the printed face, the first point at the
origin. Points count row by row from the top left.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput
from tracker.geometry import Array

MIN_POINTS, MAX_POINTS = 4, 10_000
# Of Kalibr: its tags, and the width of their black border in modules.
APRIL_GRID_DICTIONARY, APRIL_GRID_BORDER = "DICT_APRILTAG_36h11", 2


class DotLayout(StrEnum):
    """Arrangement of the dots."""

    SYMMETRIC = "symmetric"
    """On a square grid."""
    ASYMMETRIC = "asymmetric"
    """Each second row is shifted by half of the distance between two dots of a row."""


class CharucoLayout(StrEnum):
    """Which corner square of a ChArUco board is black; they differ where the number of rows is even."""

    NEWER = "newer"
    """OpenCV 4.6 and later: the top left square is black."""
    OLDER = "older"
    """Before OpenCV 4.6: the bottom left square is black."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DotBoard:
    """A grid of dots; some may be larger, to make the orientation unique.

    Attributes:
        columns: dots in a row.
        rows: rows of dots.
        pitch_mm: distance between adjacent dots; for an asymmetric board half the distance between two dots
            of a row, which is also the distance between two rows (OpenCV's asymmetric grid).
        layout: symmetric or asymmetric.
        fiducials: indexes of the larger dots, row by row from 0; empty if all dots are equal.

    Raises:
        InvalidInput: BOARD_INVALID, with the number that cannot be.
    """

    columns: int
    rows: int
    pitch_mm: float
    layout: DotLayout = DotLayout.SYMMETRIC
    fiducials: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        _reject_counts(self.columns, self.rows, self.columns * self.rows)
        _reject_length("pitch_mm", self.pitch_mm)
        object.__setattr__(self, "layout", DotLayout(self.layout))
        object.__setattr__(self, "fiducials", tuple(sorted({int(i) for i in self.fiducials})))
        count = self.columns * self.rows
        beyond = [index for index in self.fiducials if not 0 <= index < count]
        if beyond or len(self.fiducials) == count:
            raise _invalid(
                f"larger dots {list(self.fiducials)} of {count} dots, allowed indexes 0 to {count - 1}"
            )

    @property
    def object_points_mm(self) -> Array:
        """Return the centres of the dots (n, 3) in mm, row by row."""
        column, row = _indexes(self.columns, self.rows)
        if self.layout is DotLayout.ASYMMETRIC:
            column = 2.0 * column + row % 2
        return _points(column * self.pitch_mm, row * self.pitch_mm)

    @property
    def transposed(self) -> "DotBoard":
        """Return the board with columns and rows exchanged; indexes count along the new rows."""
        return DotBoard(
            columns=self.rows,
            rows=self.columns,
            pitch_mm=self.pitch_mm,
            layout=self.layout,
            fiducials=self.fiducials,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckerBoard:
    """A checkerboard, counted by its inner corners.

    Attributes:
        columns: inner corners in a row (one less than squares).
        rows: rows of inner corners.
        square_mm: side of a square.

    Raises:
        InvalidInput: BOARD_INVALID, with the number that cannot be.
    """

    columns: int
    rows: int
    square_mm: float

    def __post_init__(self) -> None:
        _reject_counts(self.columns, self.rows, self.columns * self.rows)
        _reject_length("square_mm", self.square_mm)

    @property
    def object_points_mm(self) -> Array:
        """Return the inner corners (n, 3) in mm, row by row."""
        column, row = _indexes(self.columns, self.rows)
        return _points(column * self.square_mm, row * self.square_mm)

    @property
    def has_unique_orientation(self) -> bool:
        """Return whether its colours change under a rotation by 180 degrees: odd by even corners."""
        return (self.columns + self.rows) % 2 == 1


@dataclass(frozen=True, slots=True, kw_only=True)
class CharucoBoard:
    """A checkerboard with an ArUco marker in each white square, which identify every corner.

    Attributes:
        columns: squares in a row.
        rows: rows of squares.
        square_mm: side of a square.
        marker_mm: side of a marker, black rim included.
        dictionary: OpenCV's name of the markers' dictionary, as DICT_6X6_250.
        layout: newer or older, see `CharucoLayout`; None is determined by the detection.

    Raises:
        InvalidInput: BOARD_INVALID, with what cannot be.
    """

    columns: int
    rows: int
    square_mm: float
    marker_mm: float
    dictionary: str
    layout: CharucoLayout | None = None

    def __post_init__(self) -> None:
        _reject_counts(self.columns, self.rows, (self.columns - 1) * (self.rows - 1))
        _reject_length("square_mm", self.square_mm)
        _reject_length("marker_mm", self.marker_mm)
        if self.marker_mm >= self.square_mm:
            raise _invalid(f"a marker of {self.marker_mm:g} mm in a square of {self.square_mm:g} mm")
        if self.dictionary not in dictionaries():
            raise _invalid(f"the dictionary '{self.dictionary}', allowed {', '.join(dictionaries())}")
        if self.layout is not None:
            object.__setattr__(self, "layout", CharucoLayout(self.layout))
        available = int(self.opencv_dictionary.bytesList.shape[0])
        needed = self.columns * self.rows // 2
        if needed > available:
            raise _invalid(f"{needed} markers, and {self.dictionary} has {available}")

    @property
    def object_points_mm(self) -> Array:
        """Return the inner corners (n, 3) in mm, row by row; the board's top left corner is the origin."""
        column, row = _indexes(self.columns - 1, self.rows - 1)
        return _points((column + 1.0) * self.square_mm, (row + 1.0) * self.square_mm)

    @property
    def opencv_dictionary(self) -> cv2.aruco.Dictionary:
        """Return the OpenCV dictionary."""
        return cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, self.dictionary))

    def opencv_board(self, layout: CharucoLayout | None = None) -> cv2.aruco.CharucoBoard:
        """Return the OpenCV board in this layout, or in its own (newer if it has none)."""
        board = cv2.aruco.CharucoBoard(
            (self.columns, self.rows), self.square_mm, self.marker_mm, self.opencv_dictionary
        )
        board.setLegacyPattern((layout or self.layout) is CharucoLayout.OLDER)
        return board


@dataclass(frozen=True, slots=True, kw_only=True)
class AprilGridBoard:
    """An AprilGrid as Kalibr prints it: AprilTags 36h11, with black squares in the gaps at their corners.

    Tags count from 0 at the bottom left, row by row upwards, and have a black border of two modules. Points
    are the corners of the tags; each lies where a tag and a square meet, as on a checkerboard.

    Attributes:
        columns: tags in a row.
        rows: rows of tags.
        tag_mm: side of a tag, black border included (Kalibr's tagSize).
        gap_mm: gap between two tags (Kalibr's tagSpacing times tagSize).

    Raises:
        InvalidInput: BOARD_INVALID, with the number that cannot be.
    """

    columns: int
    rows: int
    tag_mm: float
    gap_mm: float

    def __post_init__(self) -> None:
        _reject_counts(self.columns, self.rows, 4 * self.columns * self.rows)
        _reject_length("tag_mm", self.tag_mm)
        _reject_length("gap_mm", self.gap_mm)
        if self.gap_mm > self.tag_mm:
            raise _invalid(f"a gap of {self.gap_mm:g} mm between tags of {self.tag_mm:g} mm")
        available = int(self.opencv_dictionary.bytesList.shape[0])
        if self.columns * self.rows > available:
            raise _invalid(f"{self.columns * self.rows} tags, and {APRIL_GRID_DICTIONARY} has {available}")

    @property
    def object_points_mm(self) -> Array:
        """Return the corners of the tags (n, 3) in mm, row by row; the first tag's top left is the origin."""
        column, row = _indexes(2 * self.columns, 2 * self.rows)
        pitch_mm = self.tag_mm + self.gap_mm
        x, y = ((index // 2) * pitch_mm + (index % 2) * self.tag_mm for index in (column, row))
        return _points(x, y)

    @property
    def opencv_dictionary(self) -> cv2.aruco.Dictionary:
        """Return the OpenCV dictionary."""
        return cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, APRIL_GRID_DICTIONARY))

    def tag_at(self, column: int, row: int) -> int:
        """Return the number of a tag; rows count from the top."""
        return (self.rows - 1 - row) * self.columns + column

    def corner_ids(self, tag: int) -> tuple[int, int, int, int]:
        """Return the indexes of a tag's corners, in the order in which OpenCV returns them."""
        from_bottom, column = divmod(tag, self.columns)
        row = self.rows - 1 - from_bottom
        top_left = 2 * row * 2 * self.columns + 2 * column
        below = top_left + 2 * self.columns
        # OpenCV has the tags upside down: its first corner is the bottom right one.
        return below + 1, below, top_left, top_left + 1

    def white_modules(self, tag: int) -> npt.NDArray[np.bool_]:
        """Return the modules of a tag (10, 10), row 0 on top."""
        side = self.opencv_dictionary.markerSize + 2 * APRIL_GRID_BORDER
        picture = self.opencv_dictionary.generateImageMarker(tag, side, borderBits=APRIL_GRID_BORDER)
        return np.rot90(np.asarray(picture) > 127, 2)


Board: TypeAlias = DotBoard | CheckerBoard | CharucoBoard | AprilGridBoard


def dictionaries() -> tuple[str, ...]:
    """Return the names of OpenCV's marker dictionaries."""
    return tuple(sorted(name for name in dir(cv2.aruco) if name.startswith("DICT_")))


def _indexes(columns: int, rows: int) -> tuple[Array, Array]:
    row, column = np.divmod(np.arange(columns * rows), columns)
    return column.astype(np.float64), row.astype(np.float64)


def _points(x: Array, y: Array) -> Array:
    points = np.stack([x, y, np.zeros_like(x)], axis=1)
    points.setflags(write=False)
    return points


def _reject_counts(columns: int, rows: int, points: int) -> None:
    if min(columns, rows) < 2 or not MIN_POINTS <= points <= MAX_POINTS:
        raise _invalid(f"{columns} x {rows}, which is {points} points, allowed {MIN_POINTS} to {MAX_POINTS}")


def _reject_length(name: str, length_mm: float) -> None:
    if not (np.isfinite(length_mm) and 0.0 < length_mm <= 10_000.0):
        raise _invalid(f"{name} {length_mm:g}, allowed above 0 to 10000")


def _invalid(what: str) -> InvalidInput:
    return InvalidInput(
        "BOARD_INVALID",
        f"there is no such calibration board: {what}",
        "Count the board again: dots, or inner corners of a checkerboard, or squares of a ChArUco board, "
        "or tags of an AprilGrid.",
        {"board_fault": what},
    )
