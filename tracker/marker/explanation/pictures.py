"""The pictures of a marker on white paper, at every blur, on a grid of fields."""

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.explanation.fields.kernels import FIELDS, PAD, WIDE

# Texels a field of what the pictures are made from.
TEXELS = 4
# In fields. The sharpest is that of a wide marker, by the spread of the samples of a field.
SHARPEST_FIELDS, STEP, BLURS = 0.3, 1.25, 12
KEPT_MODELS = 32


@dataclass(frozen=True, slots=True, kw_only=True)
class Pictures:
    """One marker at several blurs, dark 0 and bright 1.

    Attributes:
        layers: (blurs, 4, 6, WIDE + 2 PAD, WIDE + 2 PAD): at the fields' centres, half a field to the right
            of them, below, and both; of each the picture, its slopes to the right and down and its curvatures
            along both and between, by the field.
        blurs_fields: (blurs,), sd of the Gaussian, ascending.
        turned_correlation: correlation of the square with the likest of its quarter and half turns, -1..1.
    """

    layers: npt.NDArray[np.float32]
    blurs_fields: Array
    turned_correlation: float


class _Same:
    """A picture as a key: equal to itself alone."""

    def __init__(self, square: GreyImage) -> None:
        self.square = square

    def __hash__(self) -> int:
        return id(self.square)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and other.square is self.square


def pictures_of(square: GreyImage) -> Pictures:
    """The pictures of a grey square (n, n) that fills its marker edge to edge; made once for each."""
    return _made(_Same(square))


@lru_cache(maxsize=KEPT_MODELS)
def _made(same: _Same) -> Pictures:
    low, high = float(same.square.min()), float(same.square.max())
    size = FIELDS * TEXELS
    small = cv2.resize(same.square, (size, size), interpolation=cv2.INTER_AREA).astype(np.float64)
    ink = (high - small) / (high - low)
    blurs = SHARPEST_FIELDS * STEP ** np.arange(BLURS)
    # Half fields from the square's centre; a field's centre is half a field off it.
    wide = WIDE + 2 * PAD
    at = np.arange(2 * wide) * 0.5 - (wide - 1) / 2.0
    texel = (np.arange(size) + 0.5) / TEXELS - FIELDS / 2.0
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
    return Pictures(
        layers=layers,
        blurs_fields=np.asarray(blurs, np.float64),
        turned_correlation=max(
            float(np.corrcoef(ink.ravel(), np.rot90(ink, turns).ravel())[0, 1]) for turns in (1, 2, 3)
        ),
    )


def _gaussians(apart: Array, blur: float) -> tuple[Array, Array, Array]:
    """What a texel adds to the picture, slope and curvature at this distance (n, m) in fields."""
    flat = np.exp(-0.5 * (apart / blur) ** 2) / (blur * np.sqrt(2.0 * np.pi) * TEXELS)
    slope = -apart / blur**2 * flat
    return flat, slope, (apart**2 / blur**2 - 1.0) / blur**2 * flat
