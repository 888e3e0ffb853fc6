"""Printed marker faces as outlines: shapes with edges of both polarities, rings, and codes."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import cv2
import numpy as np
import numpy.typing as npt

from tests.benchmarks.scenes.area import coverage_image
from tracker import MarkerModel
from tracker.geometry import Array

SIDE_MM = 25.0
QUIET_RATIO = 0.2
MODEL_PX = 400
CIRCLE_CORNERS = 96
SQUARE = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Face:
    """A black square with shapes in it, on white paper.

    Attributes:
        name: of the marker.
        white, black: outlines (n, 2) in sides of the square, x right, y down from its top left corner; the
            black ones lie in white ones, the white ones in black.
        side_mm: of the black square.
        quiet_ratio: width of the paper around it, in sides.
    """

    name: str
    white: tuple[Array, ...] = ()
    black: tuple[Array, ...] = ()
    side_mm: float = SIDE_MM
    quiet_ratio: float = QUIET_RATIO
    outlines_mm: tuple[Array, ...] = field(init=False)

    def __post_init__(self) -> None:
        quiet = self.quiet_ratio
        paper = (np.array(SQUARE) - 0.5) * (1.0 + 2.0 * quiet) + 0.5
        shapes = [paper, np.array(SQUARE), *self.white, *self.black]
        object.__setattr__(self, "outlines_mm", tuple(map(self._on_face, shapes)))

    def _on_face(self, outline: Array) -> Array:
        x, y = np.asarray(outline, dtype=np.float64).T
        return np.stack([x - 0.5, 0.5 - y, np.zeros(len(x))], axis=1) * self.side_mm

    def weights(self, black: float, white: float) -> list[float]:
        """Return the weight that each outline adds, so that ink is `black` and paper `white`."""
        step = white - black
        return [white, -step, *([step] * len(self.white)), *([-step] * len(self.black))]

    @property
    def corners_mm(self) -> Array:
        """Corners (4, 3) of the black square: top-left, top-right, bottom-right, bottom-left."""
        return self.outlines_mm[1]

    @property
    def image(self) -> npt.NDArray[np.uint8]:
        """The printed face (400, 400), black 0, white 255; the black square fills it edge to edge."""
        shapes = [(outline * MODEL_PX) - 0.5 for outline in (*self.white, *self.black)]
        weights = [255.0] * len(self.white) + [-255.0] * len(self.black)
        grey = (
            coverage_image(shapes, weights, (MODEL_PX, MODEL_PX))
            if shapes
            else np.zeros((MODEL_PX, MODEL_PX))
        )
        return np.asarray(np.clip(np.rint(grey), 0, 255), dtype=np.uint8)

    @property
    def model(self) -> MarkerModel:
        """Return the tracker's model of the face."""
        return MarkerModel.from_image(self.image, side_mm=self.side_mm, name=self.name)


def circle(x: float, y: float, radius: float) -> Array:
    """A circle as a polygon of the same area."""
    angle = np.arange(CIRCLE_CORNERS) * (2.0 * np.pi / CIRCLE_CORNERS)
    turn = 2.0 * np.pi / CIRCLE_CORNERS
    wide = radius * np.sqrt(turn / np.sin(turn))
    return np.stack([x + wide * np.cos(angle), y + wide * np.sin(angle)], axis=1)


def polygon(*corners: tuple[float, float]) -> Array:
    """A polygon of these corners."""
    return np.array(corners, dtype=np.float64)


def code_face(name: str, fields: Sequence[Sequence[int]], *, rim: int = 1) -> Face:
    """Return a code: white for fields of 1, with a border of `rim` black fields."""
    rows = len(fields)
    size = rows + 2 * rim
    cells = [
        (np.array(SQUARE) + np.array([column + rim, row + rim])) / size
        for row, line in enumerate(fields)
        for column, bit in enumerate(line)
        if bit
    ]
    return Face(name=name, white=tuple(cells))


def dictionary_face(name: str, dictionary: int, number: int, fields: int) -> Face:
    """Return a marker of an OpenCV dictionary with this many fields per side inside its border."""
    printed = cv2.aruco.generateImageMarker(cv2.aruco.getPredefinedDictionary(dictionary), number, fields + 2)
    return code_face(name, (np.asarray(printed)[1:-1, 1:-1] > 0).astype(int).tolist())


SAIL = Face(
    name="sail",
    white=(
        polygon((0.17, 0.83), (0.17, 0.33), (0.44, 0.17), (0.60, 0.45), (0.83, 0.52), (0.83, 0.83)),
        polygon((0.68, 0.17), (0.83, 0.17), (0.83, 0.38), (0.68, 0.38)),
    ),
    black=(polygon((0.29, 0.71), (0.29, 0.42), (0.50, 0.54), (0.62, 0.71)),),
)
ORBIT = Face(
    name="orbit",
    white=(circle(0.50, 0.50, 0.37), circle(0.64, 0.50, 0.10)),
    black=(circle(0.57, 0.44, 0.24),),
)
CODE = code_face("code", ((1, 0, 1, 1), (0, 1, 1, 0), (1, 1, 0, 0), (0, 1, 0, 0)))
FACES = (SAIL, ORBIT, CODE)
PLAIN = Face(name="plain")
# More shapes for tests of several markers at once.
ANVIL = Face(
    name="anvil",
    white=(
        polygon((0.15, 0.20), (0.85, 0.20), (0.70, 0.50), (0.70, 0.85), (0.30, 0.85), (0.40, 0.50)),
        polygon((0.15, 0.62), (0.25, 0.62), (0.25, 0.85), (0.15, 0.85)),
    ),
    black=(circle(0.58, 0.34, 0.08),),
)
