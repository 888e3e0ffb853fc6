"""Prerendered textures of a marker at increasing Gaussian blur (a scale space)."""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

# Blur of the sharpest level, in sides: a marker 110 px wide in a camera in focus. Larger ones are averaged
# first.
SHARPEST_RATIO = 0.0062
# Ratio of the blurs of adjacent levels, small enough to interpolate between them to first order.
STEP = 1.15
COARSEST_RATIO = 0.16
# The level is halved in size as soon as its blur exceeds this many texels.
FINEST_BLURS = 7.0
WORKING_SIDE = 480
# Half width of the texture in sides: the square and the white paper around it.
REACH_RATIO = 0.8
# Width of a texel in sd of the blur, small enough for bilinear interpolation.
TEXEL_BLURS = 0.45
# Quantisation of the steepness: it fits a byte, and thresholds are multiples of it.
STEEPNESS = 200.0
# A model has 16 MB of textures, and a theatre has two models.
CACHED_MODELS = 4

Texels = npt.NDArray[np.float32]


@dataclass(frozen=True)
class Textures:
    """Textures of one marker on white paper, dark 0 and bright 1, one per blur level.

    Attributes:
        texels: all levels concatenated; each texel has value and slopes to the right and upwards, per side.
        starts: (k,), start of each level in `texels`, in floats.
        sizes: (k,), texels a side.
        blurs_ratio: (k,), sd of the blur in sides, ascending.
        texels_ratio: (k,), width of a texel in sides.
        steepness: one byte per texel: slope in units of 1/`STEEPNESS` of the level's maximum, rounded up.
    """

    texels: Texels
    starts: npt.NDArray[np.int64]
    sizes: npt.NDArray[np.int64]
    blurs_ratio: Array
    texels_ratio: Array
    steepness: npt.NDArray[np.uint8]

    @cached_property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """Return the arrays in the order that the compiled functions expect."""
        return self.texels, self.starts, self.sizes, self.blurs_ratio, self.texels_ratio, self.steepness


def textures_of(square: npt.NDArray[np.uint8]) -> Textures:
    """Return the textures of a grey square (n, n) that fills its marker edge to edge; cached.

    They take a tenth of a second, which tracking would pause at each change of the set-up.
    """
    return _textures(square.tobytes(), square.shape[0])


@lru_cache(maxsize=CACHED_MODELS)
def _textures(pixels: bytes, side: int) -> Textures:
    square = np.frombuffer(pixels, np.uint8).reshape(side, side)
    count = int(np.ceil(np.log(COARSEST_RATIO / SHARPEST_RATIO) / np.log(STEP))) + 1
    blurs = np.asarray(SHARPEST_RATIO * STEP ** np.arange(count), np.float64)
    picture, texel, has = _on_paper(square)
    parts, sizes = [], []
    for blur in blurs:
        while blur > FINEST_BLURS * texel:
            half = (picture.shape[1] // 2, picture.shape[0] // 2)
            picture = np.asarray(cv2.resize(picture, half, interpolation=cv2.INTER_AREA), np.float32)
            # Averaging pairs of texels is a box filter: the variance increases by the difference of two
            # boxes.
            has, texel = float(np.sqrt(has**2 + 3.0 * texel**2 / 12.0)), 2.0 * texel
        more = float(np.sqrt(blur**2 - has**2)) / texel
        picture = np.asarray(
            cv2.GaussianBlur(picture, (0, 0), more, borderType=cv2.BORDER_REPLICATE), np.float32
        )
        has = float(blur)
        parts.append(_with_slopes(picture, texel, TEXEL_BLURS * has))
        sizes.append(parts[-1].shape[0])
    lengths = [part.size for part in parts]
    return Textures(
        texels=np.concatenate([part.ravel() for part in parts]),
        starts=np.concatenate([[0], np.cumsum(lengths)[:-1]]).astype(np.int64),
        sizes=np.array(sizes, np.int64),
        blurs_ratio=blurs,
        texels_ratio=np.asarray(TEXEL_BLURS * blurs, np.float64),
        steepness=np.concatenate([_steepness_of(part) for part in parts]),
    )


def _steepness_of(part: Texels) -> npt.NDArray[np.uint8]:
    """Return the quantised slope (n * n,) of texels (n, n, 3), as in `Textures`."""
    slope = np.hypot(part[..., 1], part[..., 2]).ravel()
    return np.asarray(np.ceil(slope * (STEEPNESS / slope.max())), dtype=np.uint8)


def _on_paper(square: npt.NDArray[np.uint8]) -> tuple[Texels, float, float]:
    """Return the square on white paper at high resolution, its texel width and its blur, in sides."""
    low, high = (float(v) for v in np.percentile(square, (2, 98)))
    mode = cv2.INTER_AREA if square.shape[0] > WORKING_SIDE else cv2.INTER_LINEAR
    seen = cv2.resize(square, (WORKING_SIDE, WORKING_SIDE), interpolation=mode).astype(np.float32)
    seen = np.clip((seen - low) / (high - low), 0.0, 1.0)
    margin = int((REACH_RATIO + 0.05 - 0.5) * WORKING_SIDE) // 16 * 16
    paper = cv2.copyMakeBorder(seen, margin, margin, margin, margin, cv2.BORDER_CONSTANT, value=(1.0,))
    # Each texel is the mean over its area: a box filter, whose variance is 1/12 of its squared width.
    return np.asarray(paper, np.float32), 1.0 / WORKING_SIDE, 1.0 / (WORKING_SIDE * np.sqrt(12.0))


def _with_slopes(picture: Texels, texel: float, wanted: float) -> Texels:
    """Resample to another texel width (n, n, 3): value, slopes to the right and upwards per side."""
    half = int(np.ceil(REACH_RATIO / wanted))
    at = (np.arange(-half, half + 1) * (wanted / texel) + (picture.shape[0] - 1) / 2.0).astype(np.float32)
    x, y = np.meshgrid(at, at)
    right = np.gradient(picture, texel, axis=1)
    upwards = -np.gradient(picture, texel, axis=0)
    layers = [
        cv2.remap(layer, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        for layer in (picture, right, upwards)
    ]
    return np.stack(layers, axis=2).astype(np.float32)
