"""Scale space of a marker on white paper: the model at several Gaussian blurs on the sampling grid."""

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS, PAD, SQUARE_CELLS

# Texels per cell of the source image.
TEXELS = 4
# In cells. The sharpest is that of a wide marker, by the sampling of a cell.
SHARPEST_CELLS, STEP, BLURS = 0.3, 1.25, 12
CACHED_MODELS = 32


@dataclass(frozen=True, slots=True, kw_only=True)
class ScaleSpace:
    """One marker at several blurs, dark 0 and bright 1.

    Attributes:
        layers: (blurs, 4, 6, GRID_CELLS + 2 PAD, GRID_CELLS + 2 PAD): at the cell centres, half a cell to the
            right, below, and both; of each the value, its slopes to the right and down, and its curvatures
            along both and mixed, per cell.
        blurs_cells: (blurs,), sd of the Gaussian, ascending.
        rotated_correlation: largest correlation of the square with its quarter and half turns, -1..1.
    """

    layers: npt.NDArray[np.float32]
    blurs_cells: Array
    rotated_correlation: float


class _IdentityKey:
    """Cache key of an array by identity."""

    def __init__(self, square: GreyImage) -> None:
        self.square = square

    def __hash__(self) -> int:
        return id(self.square)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _IdentityKey) and other.square is self.square


def scale_space_of(square: GreyImage) -> ScaleSpace:
    """Return the scale space of a grey square (n, n) that fills its marker edge to edge; cached."""
    return _scale_space(_IdentityKey(square))


@lru_cache(maxsize=CACHED_MODELS)
def _scale_space(same: _IdentityKey) -> ScaleSpace:
    low, high = float(same.square.min()), float(same.square.max())
    size = SQUARE_CELLS * TEXELS
    small = cv2.resize(same.square, (size, size), interpolation=cv2.INTER_AREA).astype(np.float64)
    ink = (high - small) / (high - low)
    blurs = SHARPEST_CELLS * STEP ** np.arange(BLURS)
    # Half cells from the square's centre; a cell centre is half a cell off it.
    wide = GRID_CELLS + 2 * PAD
    at = np.arange(2 * wide) * 0.5 - (wide - 1) / 2.0
    texel = (np.arange(size) + 0.5) / TEXELS - SQUARE_CELLS / 2.0
    layers = np.empty((BLURS, 4, 6, wide, wide), np.float32)
    for number, blur in enumerate(blurs):
        flat, slope, bend = _gaussians(at[:, None] - texel, blur)
        below = [flat @ ink, slope @ ink, bend @ ink]
        # By row, then by column: the picture, right, down, right twice, down twice, both.
        pairs = ((0, flat), (0, slope), (1, flat), (0, bend), (2, flat), (1, slope))
        for which, (row, column) in enumerate(pairs):
            half = -(below[row] @ column.T)
            if which == 0:
                half += 1.0
            for phase in range(4):
                layers[number, phase, which] = half[phase // 2 :: 2, phase % 2 :: 2]
    return ScaleSpace(
        layers=layers,
        blurs_cells=np.asarray(blurs, np.float64),
        rotated_correlation=max(
            float(np.corrcoef(ink.ravel(), np.rot90(ink, turns).ravel())[0, 1]) for turns in (1, 2, 3)
        ),
    )


def _gaussians(offset: Array, blur: float) -> tuple[Array, Array, Array]:
    """Return Gaussian, first and second derivative at these distances (n, m) in cells, per texel."""
    flat = np.exp(-0.5 * (offset / blur) ** 2) / (blur * np.sqrt(2.0 * np.pi) * TEXELS)
    slope = -offset / blur**2 * flat
    return flat, slope, (offset**2 / blur**2 - 1.0) / blur**2 * flat
