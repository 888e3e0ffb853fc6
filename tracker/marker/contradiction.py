"""Is there a part inside the square that is dark where the model is bright, or the other way round?

Two markers may differ in one small field only. Nine tenths of their edges are then the same, and no
threshold on a score tells them apart; but the field itself contradicts. Light that varies over the marker
does not, and something that covers the marker comes over its border, where the outline is missing too: only
what lies wholly inside, within an outline that is there, contradicts.
"""

from dataclasses import dataclass
from functools import cache, lru_cache
from math import sqrt

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.geometry.kernels import solve_positive
from tracker.marker.active_edges import BLUR_PX
from tracker.marker.kernels import sample_square

# Fields a side. A field of a 3x3 code with a border of a quarter is 4x4 of them.
FIELDS = 24
SAMPLES = 2  # a side, in each field
# A flipped part differs by one whole contrast; blur and its bleeding take up to half of it.
CONTRADICTION = 0.45
# Under this part of the square, a contradiction is a speck (dirt, a highlight) and not another shape.
LEAST_AREA_RATIO = 3 / FIELDS**2 - 1e-9
# Squares with something else inside reach 0.87 at 19 px and 0.77 at 36 px, in 400 pictures full of them; the
# marker itself has 0.9 and more in plain light. Few pixels say little: what is small must say it clearly.
LIKENESS_SIDES_PX, LEAST_LIKENESS = (20.0, 32.0, 40.0, 48.0), (0.88, 0.80, 0.80, 0.70)
FIT_ROUNDS = 4
KEPT_MODELS = 32
# Residuals over this part of the contrast lose their say in the fit of the light.
OUTLIER_CONTRAST = 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class Contradiction:
    """Where image and model disagree beyond what light can do.

    Attributes:
        inside_ratio: area of the contradicting parts that lie wholly inside the square, by its area, 0..1.
        covered_ratio: area of those that reach its border, by its area, 0..1.
        likeness: correlation of the uncovered fields with the model's, the light taken out, -1..1.
        least_likeness: what is asked of a marker of this size.
    """

    inside_ratio: float
    covered_ratio: float
    likeness: float
    least_likeness: float

    @property
    def is_other_shape(self) -> bool:
        """Whether this is another shape than the model's."""
        return self.inside_ratio >= LEAST_AREA_RATIO or self.likeness < self.least_likeness


def contradiction_of(
    image: GreyImage, square: GreyImage, corners_px: Array, *, side_px: float
) -> Contradiction:
    """What a grey image (h, w) says against a model (n, n) at these corners (4, 2).

    `corners_px` are pixels of `image`: top-left, top-right, bottom-right, bottom-left of the printed face.
    """
    seen = np.asarray(sample_square(image, corners_px, FIELDS, SAMPLES), dtype=np.float64)
    expected = _expected(square, side_px)
    rest = _without_light(seen, expected)
    smooth = cv2.blur(rest, (3, 3), borderType=cv2.BORDER_REPLICATE)
    inside = 0
    open_to_sight = np.ones((FIELDS, FIELDS), np.bool_)
    for sign in (1.0, -1.0):
        count, labels, stats, _ = cv2.connectedComponentsWithStats(
            (sign * smooth > CONTRADICTION).astype(np.uint8), connectivity=4
        )
        for label in range(1, count):
            left, top, width, height, area = (int(v) for v in stats[label])
            if left == 0 or top == 0 or left + width == FIELDS or top + height == FIELDS:
                open_to_sight &= labels != label
            else:
                inside = max(inside, area)
    return Contradiction(
        inside_ratio=inside / FIELDS**2,
        covered_ratio=1.0 - float(open_to_sight.mean()),
        likeness=_likeness(seen, expected, open_to_sight),
        least_likeness=float(np.interp(side_px, LIKENESS_SIDES_PX, LEAST_LIKENESS)),
    )


def _likeness(seen: Array, expected: Array, open_to_sight: npt.NDArray[np.bool_]) -> float:
    """Correlation of two squares of fields where nothing lies over them, the light taken out of both."""
    chosen = open_to_sight.ravel()
    light = _light()[0][chosen] if not chosen.all() else None
    rests = [_less_light(one.ravel()[chosen], light) for one in (seen, expected)]
    sizes = [sqrt(float(rest @ rest)) for rest in rests]
    return float(rests[0] @ rests[1]) / (sizes[0] * sizes[1]) if min(sizes) > 0.0 else 0.0


def _less_light(values: Array, light: Array | None) -> Array:
    """What is left of fields (n,) without this light (n, 6); None: all fields are there."""
    if light is None:
        orthonormal = _light()[1]
        return np.asarray(values - orthonormal @ (values @ orthonormal))
    return np.asarray(values - light @ np.linalg.lstsq(light, values, rcond=None)[0])


@cache
def _light() -> tuple[Array, Array]:
    """Light over the square: a quadratic in both directions (fields, 6), and an orthonormal basis of it."""
    v, u = np.mgrid[0:FIELDS, 0:FIELDS] * (2.0 / (FIELDS - 1)) - 1.0
    light = np.stack([one.ravel() for one in (np.ones_like(u), u, v, u * u, u * v, v * v)], axis=1)
    return light, np.ascontiguousarray(np.linalg.qr(light)[0])


class _Same:
    """A picture as a key: equal to itself alone."""

    def __init__(self, square: GreyImage) -> None:
        self.square = square

    def __hash__(self) -> int:
        return id(self.square)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and other.square is self.square


@lru_cache(maxsize=KEPT_MODELS)
def _pattern(same: _Same) -> tuple[Array, float, float]:
    """A model (n, n) at four pixels a field, its darkest and its brightest grey."""
    small = cv2.resize(same.square, (4 * FIELDS, 4 * FIELDS), interpolation=cv2.INTER_AREA)
    return small.astype(np.float64), float(same.square.min()), float(same.square.max())


def _expected(square: GreyImage, side_px: float) -> Array:
    """The model's fields (24, 24), blurred as a camera does, 0 dark to 1 bright."""
    small, low, high = _pattern(_Same(square))
    blur = BLUR_PX * 4 * FIELDS / max(side_px, 8.0)
    blurred = cv2.GaussianBlur(small, (0, 0), blur, borderType=cv2.BORDER_REPLICATE)
    fields = cv2.resize(blurred, (FIELDS, FIELDS), interpolation=cv2.INTER_AREA)
    return np.asarray((fields - low) / (high - low), dtype=np.float64)


def _solution(matrix: Array, right: Array) -> Array:
    """What solves a symmetric system, or comes nearest where it has no one solution."""
    solution = np.empty(len(right))
    if solve_positive(matrix, right, solution):
        return solution
    return np.asarray(np.linalg.lstsq(matrix, right, rcond=1e-9)[0])


def _without_light(seen: Array, expected: Array) -> Array:
    """What is left of the fields when contrast and light (a quadratic over the square) are taken out.

    In units of the contrast: +1 is bright where the model is dark.
    """
    basis = np.column_stack([expected.ravel(), _light()[0]])
    values = seen.ravel()
    weight = np.ones_like(values)
    contrast, rest = 0.0, np.zeros_like(values)
    for _ in range(FIT_ROUNDS):
        weighted = basis * weight[:, None]
        solution = _solution(weighted.T @ basis, values @ weighted)
        contrast = float(solution[0])
        if contrast <= 1.0:
            # No contrast at all, or the negative of the model: everything contradicts.
            return np.ones_like(seen)
        rest = (values - basis @ solution) / contrast
        weight = 1.0 / (1.0 + (rest / OUTLIER_CONTRAST) ** 2) ** 2
    return rest.reshape(seen.shape)
