"""Square candidates of a background: every quadrilateral outline in it, and squares sampled at random."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.design.outlines import outlines_of
from tracker.edges import GreyImage
from tracker.geometry import Array

# Grid cells per side for the correlation: finer than a marker's parts (an eighth of the side).
GRID_CELLS = 20
SUPERSAMPLING = 2
# Number of random squares of an image, of any position, size and rotation, beside its outlines.
RANDOM_SQUARES = 300
MIN_SIDE_PX, MAX_SIDE_RATIO = 20.0, 0.6
# Below this contrast (sd, grey levels) a square is flat, and its correlation is noise.
MIN_CONTRAST_GREY = 4.0

Cells32 = npt.NDArray[np.float32]


@dataclass(frozen=True, slots=True, kw_only=True)
class Places:
    """Squares of a background, sampled on a common grid for correlation.

    Attributes:
        image_index: (n,), index of the image of each square.
        corners_px: (n, 4, 2), clockwise on the screen.
        cells: (n, GRID_CELLS * GRID_CELLS), grey values, mean 0 and norm 1.
    """

    image_index: npt.NDArray[np.int64]
    corners_px: Array
    cells: Cells32

    def __len__(self) -> int:
        """Return the number of squares."""
        return len(self.image_index)


def places_in(image: GreyImage, *, image_index: int) -> Places:
    """Return the square candidates of a grey image (h, w): its outlines and random squares."""
    corners = np.concatenate([outlines_of(image), _random_squares(image, image_index)])
    squares, cells = [], []
    for one in corners:
        inside = rectified(image, one, side_px=GRID_CELLS * SUPERSAMPLING)
        row = normalised_row(cv2.resize(inside, (GRID_CELLS, GRID_CELLS), interpolation=cv2.INTER_AREA))
        if row is not None:
            squares.append(one)
            cells.append(row)
    return Places(
        image_index=np.full(len(squares), image_index, np.int64),
        corners_px=np.array(squares, dtype=np.float64).reshape(-1, 4, 2),
        cells=np.array(cells, dtype=np.float32).reshape(-1, GRID_CELLS * GRID_CELLS),
    )


def concatenated(parts: Sequence[Places]) -> Places:
    """Return the squares of several images as one record."""
    return Places(
        image_index=np.concatenate([np.empty(0, np.int64), *(part.image_index for part in parts)]),
        corners_px=np.concatenate([np.empty((0, 4, 2)), *(part.corners_px for part in parts)]),
        cells=np.concatenate(
            [np.empty((0, GRID_CELLS * GRID_CELLS), np.float32), *(part.cells for part in parts)]
        ),
    )


def rectified(image: GreyImage, corners_px: Array, *, side_px: int, margin_px: int = 0) -> GreyImage:
    """Return the rectified (frontal) image inside four corners (4, 2), with a margin."""
    low, high = margin_px - 0.5, margin_px + side_px - 0.5
    square = np.array([[low, low], [high, low], [high, high], [low, high]], dtype=np.float32)
    there = cv2.getPerspectiveTransform(square, corners_px.astype(np.float32))
    whole = side_px + 2 * margin_px
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    flat = cv2.warpPerspective(image, there, (whole, whole), flags=flags, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(flat, dtype=np.uint8)


def normalised_row(square: npt.NDArray[np.generic]) -> Cells32 | None:
    """Return a picture (n, n) as a row (n * n,) with mean 0 and norm 1; None if it is flat."""
    row = square.astype(np.float32).ravel()
    row = row - row.mean()
    length = float(np.linalg.norm(row))
    return None if length < MIN_CONTRAST_GREY * np.sqrt(row.size) else np.asarray(row / length)


def _random_squares(image: GreyImage, image_index: int) -> Array:
    """Return random squares (n, 4, 2) of an image; the seed is the image index."""
    random = np.random.default_rng([image_index, 97])
    height, width = image.shape
    largest = max(MAX_SIDE_RATIO * min(height, width), MIN_SIDE_PX + 1.0)
    side = np.exp(random.uniform(np.log(MIN_SIDE_PX), np.log(largest), RANDOM_SQUARES))
    turn = random.uniform(0.0, 2.0 * np.pi, RANDOM_SQUARES)
    centre = random.uniform(0.0, 1.0, (RANDOM_SQUARES, 2)) * [width, height]
    angles = turn[:, None] + np.radians([225.0, 315.0, 45.0, 135.0])
    reach = (side / np.sqrt(2.0))[:, None, None]
    corners = centre[:, None, :] + reach * np.stack([np.cos(angles), np.sin(angles)], axis=2)
    inside = ((corners >= 0.0) & (corners <= [width - 1.0, height - 1.0])).all(axis=(1, 2))
    return np.asarray(corners[inside])
