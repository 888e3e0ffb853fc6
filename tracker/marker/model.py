"""Marker model: a printed square with a unique shape, described by its edges."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from math import log

import cv2
import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.marker.active_edges import LEVELS_PX, ActiveEdges, active_edges_at

# Width of the white paper around the square, in sides, that a fit may assume.
PAPER_RATIO = 0.2
MIN_SIDE_PX = 8
SQUARE_TOLERANCE_RATIO = 0.02
MIN_CONTRAST_GREY = 40
# Minimum dark part of the border; a worn corner is allowed.
MIN_DARK_BORDER_RATIO = 0.9
# A shape with a quarter or half turn symmetry has no unique orientation, and one that is its own mirror image
# cannot be distinguished from its reflection.
MAX_SYMMETRY = 0.985
# More similar shapes are confused when small or blurred. Those of a printed sheet reach 0.88, a shape and its
# mirror image 0.98.
MAX_SIMILARITY = 0.95
WORKING_SIDE_PX = 360


# Without slots, which leave no place for what is extracted at its first use.
@dataclass(frozen=True, kw_only=True)
class MarkerModel:
    """A printed square with a unique geometric shape.

    Attributes:
        name: shown on the screen.
        side_mm: outer side of the black square.
        image: (h, w) grey, as given; the black square fills it edge to edge, row 0 on top.
        square: (n, n) grey, resampled to the size that the edges are extracted from.
    """

    name: str
    side_mm: float
    image: npt.NDArray[np.uint8]
    square: npt.NDArray[np.uint8]

    @classmethod
    def from_image(cls, image: npt.NDArray[np.uint8], *, side_mm: float, name: str) -> "MarkerModel":
        """Create a model from a grey image (h, w) that the black square fills edge to edge, row 0 on top.

        Raises:
            InvalidInput: MARKER_IMAGE_INVALID, MARKER_SIDE_INVALID or MARKER_SYMMETRIC.
        """
        grey = np.asarray(image)
        problem = _problem(grey)
        if problem:
            raise InvalidInput(
                "MARKER_IMAGE_INVALID",
                f"the image of marker '{name}' cannot be used: {problem}",
                "Give a square grey image that the black square fills edge to edge, with no white margin.",
                {"name": name, "shape": list(grey.shape), "marker_problem": problem},
            )
        if not (np.isfinite(side_mm) and side_mm > 0.0):
            raise InvalidInput(
                "MARKER_SIDE_INVALID",
                f"the side of marker '{name}' is {side_mm} mm, needed above 0 mm",
                "Measure the outer side of the printed black square in mm.",
                {"name": name, "side_mm": float(side_mm)},
            )
        square = _working_image(grey.astype(np.uint8))
        _reject_symmetry(square, name)
        return cls(name=name, side_mm=float(side_mm), image=grey.copy(), square=square)

    @cached_property
    def levels(self) -> tuple[ActiveEdges, ...]:
        """Active edges at each size in the image, smallest first.

        Extracted at the first use, because the web server needs none: they and the compiled loops that it
        would load for them take a sixth of its start.
        """
        return tuple(active_edges_at(self.square, side_mm=self.side_mm, level_px=px) for px in LEVELS_PX)

    @property
    def corners_mm(self) -> Array:
        """Return the corners (4, 3) in the marker's frame: top-left, top-right, bottom-right, bottom-left."""
        h = self.side_mm / 2.0
        return np.array([[-h, h, 0.0], [h, h, 0.0], [h, -h, 0.0], [-h, -h, 0.0]])

    @property
    def own_correlation(self) -> tuple[float, float]:
        """Return the largest correlation with its quarter rotations and with its mirror images, -1..1."""
        small = _small(self.square)
        mirrored = small[:, ::-1]
        return max(_rotation_correlations(small)), max(
            _correlation(small, np.rot90(mirrored, turns)) for turns in range(4)
        )

    def level_for(self, side_px: float) -> ActiveEdges:
        """Return the active edges for a marker of about this size in the image."""
        size = log(max(side_px, 1.0))
        return min(self.levels, key=lambda level: abs(log(level.level_px) - size))


def _problem(grey: npt.NDArray[np.generic]) -> str:
    """Return the reason why this image cannot be used, or an empty string."""
    if grey.ndim != 2 or grey.dtype != np.uint8:
        return f"it is {grey.dtype} with {grey.ndim} dimensions, needed uint8 grey (h, w)"
    h, w = grey.shape
    if min(h, w) < MIN_SIDE_PX:
        return f"it is {w}x{h} px, at least {MIN_SIDE_PX}x{MIN_SIDE_PX}"
    if abs(w - h) > max(1.0, SQUARE_TOLERANCE_RATIO * max(w, h)):
        return f"it is {w}x{h} px, and a square may differ by {SQUARE_TOLERANCE_RATIO:.0%}"
    low, high = (float(v) for v in np.percentile(grey.astype(np.float64), (1, 99)))
    if high - low < MIN_CONTRAST_GREY:
        return f"its contrast is {high - low:.0f} grey levels, at least {MIN_CONTRAST_GREY}"
    ring = np.concatenate([grey[0], grey[-1], grey[:, 0], grey[:, -1]]).astype(np.float64)
    dark = float(np.mean(ring < (low + high) / 2.0))
    if dark < MIN_DARK_BORDER_RATIO:
        return f"{dark:.0%} of its border is dark, at least {MIN_DARK_BORDER_RATIO:.0%}"
    return ""


def _working_image(grey: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Resample to a square large enough to locate its edges to a hundredth of its side."""
    n = max(grey.shape)
    if n >= WORKING_SIDE_PX:
        wanted = (n, n)
        if grey.shape == wanted:
            return grey.copy()
        return np.asarray(cv2.resize(grey, wanted, interpolation=cv2.INTER_AREA), dtype=np.uint8)
    # An image of a few cells (8x8) has sharp edges and must not be smoothed, unlike a photograph.
    hard = len(np.unique(grey)) <= 4
    mode = cv2.INTER_NEAREST if hard else cv2.INTER_CUBIC
    size = n * -(-WORKING_SIDE_PX // n)
    return np.asarray(cv2.resize(grey, (size, size), interpolation=mode), dtype=np.uint8)


def reject_similar(models: Sequence[MarkerModel]) -> None:
    """Reject models that are similar in any rotation by a multiple of 90 degrees.

    Raises:
        InvalidInput: MARKERS_TOO_SIMILAR, or MARKER_NAMES_NOT_UNIQUE.
    """
    names = [model.name for model in models]
    if len(set(names)) != len(names):
        raise InvalidInput(
            "MARKER_NAMES_NOT_UNIQUE",
            f"{len(names)} markers have {len(set(names))} names: {', '.join(sorted(names))}",
            "Give each marker a unique name.",
            {"markers": len(names), "different": len(set(names)), "names": ", ".join(sorted(names))},
        )
    small = [_small(model.square) for model in models]
    for (a, first), (b, second) in combinations(enumerate(small), 2):
        correlation = max(_correlation(first, np.rot90(second, turns)) for turns in range(4))
        if correlation > MAX_SIMILARITY:
            raise InvalidInput(
                "MARKERS_TOO_SIMILAR",
                f"markers '{names[a]}' and '{names[b]}' look the same, however they are turned: "
                f"correlation {correlation:.3f}, allowed {MAX_SIMILARITY}",
                "Use shapes that differ; 'coaxial marker design' with another seed makes another.",
                {
                    "names": [names[a], names[b]],
                    "correlation": correlation,
                    "max_correlation": MAX_SIMILARITY,
                },
            )


def reject_mirror_symmetric(models: Iterable[MarkerModel]) -> None:
    """Reject models that equal their own mirror image: a reflection of the print is detected as the marker.

    The pose of the print itself is unambiguous, so such a marker may be tracked in images without
    reflections.

    Raises:
        InvalidInput: MARKER_MIRROR_SYMMETRIC.
    """
    for model in models:
        _, correlation = model.own_correlation
        if correlation > MAX_SYMMETRY:
            raise InvalidInput(
                "MARKER_MIRROR_SYMMETRIC",
                f"marker '{model.name}' is its own mirror image: correlation {correlation:.3f}, allowed "
                f"{MAX_SYMMETRY}; its reflection in steel would be detected as the marker, at a wrong pose",
                "Use a shape that differs from its mirror image; 'coaxial marker design' makes one.",
                {
                    "name": model.name,
                    "correlation": correlation,
                    "max_correlation": MAX_SYMMETRY,
                },
            )


def _small(square: npt.NDArray[np.uint8]) -> Array:
    return cv2.resize(square, (96, 96), interpolation=cv2.INTER_AREA).astype(np.float64)


def _correlation(a: Array, b: Array) -> float:
    return float(np.corrcoef(a.ravel(), b.ravel())[0, 1])


def _rotation_correlations(small: Array) -> list[float]:
    """Return the correlation of an image with its one, two and three quarter rotations."""
    return [_correlation(small, np.rot90(small, turns)) for turns in (1, 2, 3)]


def _reject_symmetry(square: npt.NDArray[np.uint8], name: str) -> None:
    for turns, correlation in enumerate(_rotation_correlations(_small(square)), start=1):
        if correlation > MAX_SYMMETRY:
            raise InvalidInput(
                "MARKER_SYMMETRIC",
                f"marker '{name}' looks the same when rotated by {90 * turns} degrees: "
                f"correlation {correlation:.3f}, allowed {MAX_SYMMETRY}",
                "Use a shape without rotational symmetry.",
                {
                    "name": name,
                    "turned_deg": 90 * turns,
                    "correlation": correlation,
                    "max_correlation": MAX_SYMMETRY,
                },
            )
