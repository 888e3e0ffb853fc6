"""Small locally normalised templates of the models, as defocus, motion blur and occlusion change them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.model import MarkerModel
from tracker.marker.photometric_fit import ScaleSpace, scale_space_of
from tracker.marker.sampling_kernels import normalise_locally

Float32 = npt.NDArray[np.float32]

# Cells per side of the square, and the width of the white paper around it in cells.
CELLS, RING = 12, 1
ROWS = CELLS + 2 * RING
# Radius of the local normalisation: the neighbourhood contains border and paper.
NEIGHBOURHOOD_CELLS = 3
# Minimum local sd, above noise and folds of the paper.
MIN_SD_GREY, MIN_SD_RATIO = 1.0, 0.1
# In sides: sd of the blur in and out of focus, and length of motion blur.
BLURS_SIDES, MOTION_SIDES = (0.008, 0.045, 0.1), 0.3
# Defocus levels used by the template match.
MATCHED_BLURS = (0, 2)
MOTIONS_DEG = (0.0, 45.0, 90.0, 135.0)
# Cells per side of the coarse match of thousands of quads.
COARSE_CELLS = 6
# Samples per cell in each direction; step of the numerical derivatives by the corners, in sides.
FINE, SHIFT_SIDES = 4, 0.02
# Damping of the refinement steps: the sum of squares of a template's cells, 1, times their noise ratio.
DAMPING = np.float32(1.0)
CACHED_MODELS = 32
# Damping of deviations from a parallelogram, which perspective hardly causes.
STIFFNESS = np.float32(10.0)
# Depth of an occluding edge from the centre: 1 is the far side.
OCCLUSION_DEPTHS = (0.55, 0.2)


@dataclass(frozen=True, slots=True, kw_only=True)
class OccludedTemplates:
    """Templates (p, n) under each occlusion mask (c).

    Attributes:
        columns: (n, p * c), each template under each mask, 0 where occluded.
        mean: (p, c), mean of the visible cells.
        spread: (p, c), sum of squares about that mean.
    """

    columns: Float32
    mean: Float32
    spread: Float32


@dataclass(frozen=True, slots=True, kw_only=True)
class Template:
    """Templates of one model, locally normalised to mean 0 and length 1.

    Attributes:
        rotated: (b, 4, n), in focus and out of focus, at four quarter rotations: rotation k is the appearance
            of a quad whose first corner is corner k of the model.
        coarse: (4, 64), rotated, at the size of the coarse match.
        motion_blurred: (4, 64), the same, blurred by motion along the first side of the quad.
        upright: (p, n) under the occlusion masks: three defocus levels and motion in four directions.
        basis: (p, n, 10), template, constant, and derivatives by the corners to the right and downwards, per
            side.
        factors: (p, c, 10, 10), Cholesky factors of the normal matrices of the basis under each occlusion
            mask.
        pictures: scale space of the model.
    """

    rotated: Float32
    coarse: Float32
    motion_blurred: Float32
    upright: OccludedTemplates
    basis: Float32
    factors: Float32
    pictures: ScaleSpace


@dataclass(frozen=True, slots=True, kw_only=True)
class Templates:
    """Templates of several models."""

    each: tuple[Template, ...]

    def __len__(self) -> int:
        return len(self.each)

    def __getitem__(self, which: Sequence[int]) -> "Templates":
        return Templates(each=tuple(self.each[k] for k in which))


def templates_of(models: Sequence[MarkerModel]) -> Templates:
    """Return the templates of models; cached."""
    squares = (model.square for model in models)
    return Templates(each=tuple(_template_of(square.tobytes(), square.shape[0]) for square in squares))


@lru_cache(maxsize=CACHED_MODELS)
def _template_of(pixels: bytes, side: int) -> Template:
    square = np.frombuffer(pixels, np.uint8).reshape(side, side)
    blurred = _blurred(square)
    upright = np.array([_sampled_cells(wide, np.zeros((4, 2))) for wide in blurred])
    grid = upright[list(MATCHED_BLURS)].reshape(-1, ROWS, ROWS)
    # np.rot90 rotates anticlockwise, so the top-right corner becomes the top-left one.
    rotated = np.array([[np.rot90(one, rotation).ravel() for rotation in range(4)] for one in grid])
    basis = np.array([_basis(wide, seen) for wide, seen in zip(blurred, upright, strict=True)], np.float32)
    return Template(
        rotated=np.ascontiguousarray(rotated, np.float32),
        coarse=np.array([_coarse_picture(one) for one in rotated[0]], np.float32),
        motion_blurred=np.array(
            [_coarse_picture(_motion_blurred_picture(upright, rotation)) for rotation in range(4)], np.float32
        ),
        upright=_occluded(upright),
        basis=basis,
        factors=_cholesky_factors(basis),
        pictures=scale_space_of(square),
    )


def _blurred(square: npt.NDArray[np.uint8]) -> list[Array]:
    """Return the model on white paper, half a side all round, with defocus and motion blur."""
    fine = CELLS * FINE
    small = np.asarray(cv2.resize(square, (fine, fine), interpolation=cv2.INTER_AREA), dtype=np.float64)
    wide = np.pad(small, fine // 2, constant_values=float(np.percentile(square, 98)))
    lens = [np.asarray(cv2.GaussianBlur(wide, (0, 0), sd * fine), dtype=np.float64) for sd in BLURS_SIDES]
    streaks = [_motion_kernel(MOTION_SIDES * fine, direction) for direction in np.radians(MOTIONS_DEG)]
    return [*lens, *(np.asarray(cv2.filter2D(lens[1], -1, one), dtype=np.float64) for one in streaks)]


def _motion_kernel(length: float, direction: float) -> Array:
    """Return the kernel of linear motion of this length, sum 1."""
    reach = int(np.ceil(length / 2)) + 1
    x, y = np.meshgrid(np.arange(-reach, reach + 1), np.arange(-reach, reach + 1))
    out = np.zeros(x.shape)
    for t in np.linspace(-length / 2, length / 2, 8 * reach):
        u, v = t * np.cos(direction), t * np.sin(direction)
        out += np.maximum(0.0, 1.0 - np.abs(x - u)) * np.maximum(0.0, 1.0 - np.abs(y - v))
    return np.asarray(out / out.sum())


def _sampled_cells(wide: Array, off: Array) -> Float32:
    """Return the cells (n,) of an image in a quad whose corners (4, 2) are displaced by `off` sides."""
    fine = CELLS * FINE
    at = (np.arange(ROWS * FINE) + 0.5) / fine - RING / CELLS
    a, b = np.meshgrid(at, at)
    corner = np.array([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b])
    shift = np.tensordot(off.T, corner, axes=1)
    x, y = (np.array([a, b]) + shift + 0.5) * fine - 0.5
    points = cv2.remap(wide.astype(np.float32), x.astype(np.float32), y.astype(np.float32), cv2.INTER_LINEAR)
    cells = np.asarray(points).reshape(ROWS, FINE, ROWS, FINE).mean(axis=(1, 3))
    seen = np.ascontiguousarray(cells.reshape(1, -1), np.float32)
    normalise_locally(seen, ROWS, NEIGHBOURHOOD_CELLS, MIN_SD_GREY, MIN_SD_RATIO)
    return np.asarray(seen[0])


def _basis(wide: Array, seen: Float32) -> Float32:
    columns = [seen, np.ones_like(seen)]
    for k in range(8):
        off = np.zeros((4, 2))
        off[k // 2, k % 2] = SHIFT_SIDES
        columns.append(
            (_sampled_cells(wide, off) - _sampled_cells(wide, -off)) / np.float32(2.0 * SHIFT_SIDES)
        )
    return np.stack(columns, axis=1)


def _occluded(pictures: Float32) -> OccludedTemplates:
    """Return the templates (p, n) under each mask (c)."""
    columns = pictures[:, None] * OCCLUSION_MASKS
    total, squares = columns.sum(axis=2), (columns**2).sum(axis=2)
    return OccludedTemplates(
        columns=np.ascontiguousarray(columns.reshape(-1, pictures.shape[1]).T, np.float32),
        mean=np.asarray(total / VISIBLE_COUNT, np.float32),
        spread=np.asarray(np.maximum(squares - total**2 / VISIBLE_COUNT, 1e-9), np.float32),
    )


def _cholesky_factors(basis: Float32) -> Float32:
    """Return the factors (p, c, 10, 10) of the damped normal matrices of each basis under each mask.

    Deviations from a parallelogram are damped more, because perspective causes only small ones: their signs
    alternate from corner to corner, as one diagonal extends while the other contracts.
    """
    matrices = np.einsum("pij,ci,pik->pcjk", basis, OCCLUSION_MASKS, basis, dtype=np.float64, optimize=True)
    alternating = np.tile([1.0, 1.0, -1.0, -1.0], 2)
    same_axis = np.equal.outer(np.arange(8) % 2, np.arange(8) % 2)
    # Regularises a template without any visible shape.
    matrices += 1e-9 * np.eye(10)
    matrices[..., 2:, 2:] += DAMPING * np.eye(8) + STIFFNESS * same_axis * np.outer(alternating, alternating)
    return np.asarray(np.linalg.cholesky(matrices), np.float32)


def _motion_blurred_picture(upright: Float32, rotation: int) -> Float32:
    """Return the template (n,) blurred along the side that is first after `rotation` quarter rotations."""
    along = 0.0 if rotation % 2 == 0 else 90.0
    picture = upright[len(BLURS_SIDES) + MOTIONS_DEG.index(along)]
    return np.asarray(np.rot90(picture.reshape(ROWS, ROWS), rotation).ravel())


def _coarse_picture(rotated: Float32) -> Array:
    rows, half = COARSE_CELLS + 2, CELLS // COARSE_CELLS
    # Extend the ring outwards by repeating its cells.
    wide = np.pad(rotated.reshape(ROWS, ROWS), half - RING, mode="edge")
    small = wide.reshape(rows, half, rows, half).mean(axis=(1, 3)).ravel()
    small = small - small.mean()
    return np.asarray(small / np.linalg.norm(small), dtype=np.float64)


def _occlusion_masks() -> Float32:
    """Return the visible cells (c, n), 1, for a straight occluding edge from each of 8 directions."""
    at = np.arange(ROWS) - (ROWS - 1) / 2.0
    x, y = np.meshgrid(at / CELLS, at / CELLS)
    left = [np.ones(ROWS * ROWS, np.bool_)]
    for angle in np.radians(np.arange(0, 360, 45)):
        toward = (np.cos(angle) * x + np.sin(angle) * y).ravel()
        reach = 0.5 * (abs(np.cos(angle)) + abs(np.sin(angle)))
        left += [toward < reach * depth for depth in OCCLUSION_DEPTHS]
    return np.array(left, np.float32)


OCCLUSION_MASKS = _occlusion_masks()
# The same by cell (n, c), and the number of visible cells under each mask (c,).
VISIBLE_CELLS = np.ascontiguousarray(OCCLUSION_MASKS.T)
VISIBLE_COUNT = OCCLUSION_MASKS.sum(axis=1)
