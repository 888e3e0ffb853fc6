"""Marks on cuts of the CT as lines in the vertebra frame, one node for each colour."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import viser

from server.supervision.marks import CutPlane, Drawing, Pointer, Shape
from tracker.geometry import Array

Mark: TypeAlias = Drawing | Pointer

# Of pages that mark, as in `web/src/marks/colours.ts`.
COLOURS = ((86, 180, 233), (230, 159, 0), (204, 121, 167), (240, 228, 66), (0, 192, 139), (255, 138, 92))
LINE_PX = 4.0
# Half arm of the cross of a point or pointer.
CROSS_MM = 1.5
CIRCLE_CORNERS = 48
MAX_HEAD_MM = 3.0
HEAD_RAD = 2.6
NO_SEGMENT = np.zeros((1, 2, 3), np.float32)


class MarkNodes:
    """The nodes of all marks. Mutable."""

    def __init__(self, scene: viser.SceneApi, root: str) -> None:
        self._scene = scene
        self._root = root
        self._lines: dict[int, viser.LineSegmentsHandle] = {}
        self._shown: tuple[object, ...] = ()

    def show(self, marks: Sequence[Mark]) -> None:
        """Show these marks; nothing is done while they are the same."""
        key = tuple(map(_key, marks))
        if key == self._shown:
            return
        self._shown = key
        for index in {*self._lines, *map(_colour_index, marks)}:
            parts = [segments_in_vertebra_mm(one) for one in marks if _colour_index(one) == index]
            if index not in self._lines:
                self._lines[index] = self._scene.add_line_segments(
                    f"{self._root}/marks_{index}",
                    NO_SEGMENT,
                    COLOURS[index],
                    thickness=LINE_PX,
                    thickness_units="screen",
                )
            line = self._lines[index]
            line.visible = len(parts) > 0
            if parts:
                line.points = np.concatenate(parts).astype(np.float32)


def segments_in_vertebra_mm(mark: Mark) -> Array:
    """Return the segments (n, 2, 3) of a mark on a cut; a single point is a cross of three segments."""
    plane = mark.plane
    if plane is None:
        raise ValueError("a mark on the video has no place in the patient")
    if isinstance(mark, Pointer) or len(mark.points) == 1:
        at = _in_vertebra_mm(plane, [mark.at if isinstance(mark, Pointer) else mark.points[0]])
        arms = CROSS_MM * np.eye(3)
        return np.stack([at - arms, at + arms], axis=1)
    ends = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in _lines_mm(mark)])
    return _in_vertebra_mm(plane, ends)


def _lines_mm(drawing: Drawing) -> list[Array]:
    """Return the lines (n, 2) of a drawing on its plane."""
    points_mm = np.asarray(drawing.points, dtype=np.float64)
    if drawing.shape is Shape.PEN:
        return [points_mm]
    first, second = points_mm
    along = second - first
    length_mm = float(np.linalg.norm(along))
    if drawing.shape is Shape.CIRCLE:
        turn = np.linspace(0.0, 2.0 * np.pi, CIRCLE_CORNERS + 1)
        return [first + length_mm * np.column_stack([np.cos(turn), np.sin(turn)])]
    turn = np.arctan2(along[1], along[0]) + np.array([HEAD_RAD, -HEAD_RAD])
    sides = second + min(MAX_HEAD_MM, length_mm / 2) * np.column_stack([np.cos(turn), np.sin(turn)])
    return [points_mm, np.stack([sides[0], second, sides[1]])]


def _in_vertebra_mm(plane: CutPlane, points_mm: Sequence[tuple[float, float]] | Array) -> Array:
    """Return points of a plane (n, 2) in the vertebra frame (n, 3)."""
    directions = np.array([plane.right_in_vertebra, plane.down_in_vertebra])
    return np.asarray(points_mm) @ directions + np.array(plane.origin_in_vertebra_mm)


def _colour_index(mark: Mark) -> int:
    return mark.session % len(COLOURS)


def _key(mark: Mark) -> tuple[object, ...]:
    """Return a key that changes with the mark's appearance; points of a drawing are only ever appended."""
    if isinstance(mark, Pointer):
        return mark.session, mark.at, mark.plane
    return mark.key, len(mark.points)
