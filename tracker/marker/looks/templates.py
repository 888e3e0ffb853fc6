"""The models as small pictures, as lens, motion and covers leave them: what outlines are compared with."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.explanation import Pictures, pictures_of
from tracker.marker.looks.kernels import masked_pictures
from tracker.marker.model import MarkerModel
from tracker.marker.sampling.kernels import even_light

Float32 = npt.NDArray[np.float32]

# A square is seen as 12x12 cells and one more of its white paper all round.
CELLS, RING = 12, 1
ROWS = CELLS + 2 * RING
# A cell is judged beside those around it: as many as see the border and the paper at once.
AROUND_CELLS = 3
# What differs less than this is even: noise, and folds in the paper.
MIN_SD_GREY, MIN_SD_RATIO = 1.0, 0.1
# In sides: sd of the blur of a lens, in focus and out of it, and how far a hand moves it meanwhile.
BLURS_SIDES, MOTION_SIDES = (0.008, 0.045, 0.1), 0.3
# Of the lens's, those that a glance compares with.
GLANCED = (0, 2)
MOTIONS_DEG = (0.0, 45.0, 90.0, 135.0)
# Of thousands of outlines only a first peek is taken.
PEEK_CELLS = 6
# Points of a cell of the pictures, each way; how far a corner is moved to see what that changes, in sides.
FINE, SHIFT_SIDES = 4, 0.02
# How far a cover's edge is from the middle: 1 is the far side.
COVER_DEPTHS = (0.55, 0.2)


@dataclass(frozen=True, slots=True, kw_only=True)
class Masked:
    """Pictures (p, n) under each of the covers (c).

    Attributes:
        columns: (n, p * c), each picture where a cover leaves it, else 0.
        mean: (p, c), of what is left.
        spread: (p, c), sum of squares about that mean.
    """

    columns: Float32
    mean: Float32
    spread: Float32


@dataclass(frozen=True, slots=True, kw_only=True)
class Template:
    """One model's pictures, in even light, mean 0 and length 1.

    Attributes:
        turned: (b, 4, n), by a lens in focus and out of it, turned by 0..3 quarters: turn k is the picture
            of an occurrence whose first corner is corner k of the model.
        peeked: (4, 64), turned, at the size of a peek.
        smeared: (4, 64), the same smeared along the first side of the outline.
        upright: (p, n) under the covers: the lens's three and those of motion in four directions.
        basis: (p, n, 10), what such a picture is made of: itself, 1, and what changes when the outline's
            corners are off to the right and downwards, for each corner in turn, per side.
        pictures: the model more finely, at several blurs.
    """

    turned: Float32
    peeked: Float32
    smeared: Float32
    upright: Masked
    basis: Float32
    pictures: Pictures


@dataclass(frozen=True, slots=True, kw_only=True)
class Templates:
    """Those of some models."""

    each: tuple[Template, ...]

    def __len__(self) -> int:
        return len(self.each)

    def __getitem__(self, which: Sequence[int]) -> "Templates":
        return Templates(each=tuple(self.each[k] for k in which))


def templates_of(models: Sequence[MarkerModel]) -> Templates:
    """The pictures of models that outlines are compared with."""
    return Templates(each=tuple(_template_of(model.square) for model in models))


def _template_of(square: npt.NDArray[np.uint8]) -> Template:
    blurred = _blurred(square)
    upright = np.array([_seen(wide, np.zeros((4, 2))) for wide in blurred])
    grid = upright[list(GLANCED)].reshape(-1, ROWS, ROWS)
    # np.rot90 turns the picture to the left, so that its right-hand corner comes to the top left.
    turned = np.array([[np.rot90(one, turn).ravel() for turn in range(4)] for one in grid])
    basis = np.array([_basis(wide, seen) for wide, seen in zip(blurred, upright, strict=True)])
    return Template(
        turned=np.ascontiguousarray(turned, np.float32),
        peeked=np.array([_peek_picture(one) for one in turned[0]], np.float32),
        smeared=np.array([_peek_picture(_smeared(upright, turn)) for turn in range(4)], np.float32),
        upright=_masked(upright),
        basis=np.ascontiguousarray(basis, np.float32),
        pictures=pictures_of(square),
    )


def _blurred(square: npt.NDArray[np.uint8]) -> list[Array]:
    """The model on its white paper, half a side all round, as lens and motion blur it."""
    fine = CELLS * FINE
    small = np.asarray(cv2.resize(square, (fine, fine), interpolation=cv2.INTER_AREA), dtype=np.float64)
    wide = np.pad(small, fine // 2, constant_values=float(np.percentile(square, 98)))
    lens = [np.asarray(cv2.GaussianBlur(wide, (0, 0), sd * fine), dtype=np.float64) for sd in BLURS_SIDES]
    streaks = [_streak(MOTION_SIDES * fine, direction) for direction in np.radians(MOTIONS_DEG)]
    return [*lens, *(np.asarray(cv2.filter2D(lens[1], -1, one), dtype=np.float64) for one in streaks)]


def _streak(length: float, direction: float) -> Array:
    """What motion makes of a point: a line of this length, of sum 1."""
    reach = int(np.ceil(length / 2)) + 1
    x, y = np.meshgrid(np.arange(-reach, reach + 1), np.arange(-reach, reach + 1))
    out = np.zeros(x.shape)
    for t in np.linspace(-length / 2, length / 2, 8 * reach):
        u, v = t * np.cos(direction), t * np.sin(direction)
        out += np.maximum(0.0, 1.0 - np.abs(x - u)) * np.maximum(0.0, 1.0 - np.abs(y - v))
    return np.asarray(out / out.sum())


def _seen(wide: Array, off: Array) -> Float32:
    """The cells (n,) of a picture in an outline whose corners (4, 2) are off by so many sides."""
    fine = CELLS * FINE
    at = (np.arange(ROWS * FINE) + 0.5) / fine - RING / CELLS
    a, b = np.meshgrid(at, at)
    corner = np.array([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b])
    shift = np.tensordot(off.T, corner, axes=1)
    x, y = (np.array([a, b]) + shift + 0.5) * fine - 0.5
    points = cv2.remap(wide.astype(np.float32), x.astype(np.float32), y.astype(np.float32), cv2.INTER_LINEAR)
    cells = np.asarray(points).reshape(ROWS, FINE, ROWS, FINE).mean(axis=(1, 3))
    seen = np.ascontiguousarray(cells.reshape(1, -1), np.float32)
    even_light(seen, ROWS, AROUND_CELLS, MIN_SD_GREY, MIN_SD_RATIO)
    return np.asarray(seen[0])


def _basis(wide: Array, seen: Float32) -> Array:
    columns = [seen, np.ones_like(seen)]
    for k in range(8):
        off = np.zeros((4, 2))
        off[k // 2, k % 2] = SHIFT_SIDES
        columns.append((_seen(wide, off) - _seen(wide, -off)) / np.float32(2.0 * SHIFT_SIDES))
    return np.stack(columns, axis=1)


def _masked(pictures: Float32) -> Masked:
    columns, mean, spread = masked_pictures(np.ascontiguousarray(pictures, np.float32), COVERS)
    return Masked(columns=columns, mean=mean, spread=spread)


def _smeared(upright: Float32, turn: int) -> Float32:
    """The picture (n,) smeared along what is the first side after so many quarter turns."""
    along = 0.0 if turn % 2 == 0 else 90.0
    picture = upright[len(BLURS_SIDES) + MOTIONS_DEG.index(along)]
    return np.asarray(np.rot90(picture.reshape(ROWS, ROWS), turn).ravel())


def _peek_picture(turned: Float32) -> Array:
    rows, half = PEEK_CELLS + 2, CELLS // PEEK_CELLS
    # The ring stays a ring: its cells are doubled outwards.
    wide = np.pad(turned.reshape(ROWS, ROWS), half - RING, mode="edge")
    small = wide.reshape(rows, half, rows, half).mean(axis=(1, 3)).ravel()
    small = small - small.mean()
    return np.asarray(small / np.linalg.norm(small), dtype=np.float64)


def _covers() -> Float32:
    """The cells (c, n) that are left, 1, when a straight edge has come in from one of 8 directions."""
    at = np.arange(ROWS) - (ROWS - 1) / 2.0
    x, y = np.meshgrid(at / CELLS, at / CELLS)
    left = [np.ones(ROWS * ROWS, np.bool_)]
    for angle in np.radians(np.arange(0, 360, 45)):
        toward = (np.cos(angle) * x + np.sin(angle) * y).ravel()
        reach = 0.5 * (abs(np.cos(angle)) + abs(np.sin(angle)))
        left += [toward < reach * depth for depth in COVER_DEPTHS]
    return np.array(left, np.float32)


COVERS = _covers()
