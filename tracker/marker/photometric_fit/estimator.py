"""Iterative estimator of position, blur and illumination of a model on a square."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.photometric_fit.fit_kernels import BLUR, PLACE, SATURATED_GREY, clear_of_beyond, solve
from tracker.marker.photometric_fit.grid_kernels import (
    GRID_CELLS,
    RING,
    SQUARE_CELLS,
    cells_per_px,
    lens_blur,
    render_model,
    sample_cells,
)
from tracker.marker.photometric_fit.illumination import contrasts, grid, smooth_light
from tracker.marker.photometric_fit.occlusion import Mask, Residuals
from tracker.marker.photometric_fit.scale_space import ScaleSpace
from tracker.marker.sampling_kernels import normalise_locally, square_to_quad

# Initial blur: a camera in focus, its pixel, and the interpolation between pixels.
FIRST_BLUR_PX, WIDE_BLUR_SIDES = 0.8, 0.05
MIN_SIDE_PX = 8.0
# Number of illumination terms without highlights: a quadratic and a step.
MAX_SMOOTH_TERMS = 7
# Neighbourhood of the local normalisation: a sixth of a side reaches both the border and the paper.
NEIGHBOURHOOD_CELLS, PICTURE_GREY = 4, 100.0
SQUARE = np.s_[RING:-RING, RING:-RING]
MIN_SD_GREY, MIN_SD_RATIO = 6.0, 0.1
UNIT = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
# Half width, in half sides, of the area inside the border where another marker may have its shape.
OTHERS_HALF = 0.8


@dataclass(frozen=True, slots=True, kw_only=True)
class FitState:
    """State of an estimator that can be restored.

    Attributes:
        corners: (4, 2) in the unit square.
        blur: (3,), variances along u, v and covariance, in cells^2.
        reference_gain: (GRID_CELLS, GRID_CELLS), contrast that scales the model's derivatives.
        observed: (GRID_CELLS, GRID_CELLS) grey levels.
        rendered: (6, GRID_CELLS, GRID_CELLS), the model with its slopes and curvatures.
    """

    corners: Array
    blur: Array
    reference_gain: Array
    observed: Array
    rendered: npt.NDArray[np.float32]


class Estimator:
    """Fits one model to one square by robust Gauss-Newton iterations. Mutable."""

    def __init__(self, image: GreyImage, pictures: ScaleSpace, corners_px: Array, side_px: float) -> None:
        self.image, self.pictures = image, pictures
        self.side_px = side_px
        self.cell_px = max(side_px, MIN_SIDE_PX) / SQUARE_CELLS
        self.to_px = np.empty(8)
        square_to_quad(np.ascontiguousarray(corners_px, dtype=np.float64), self.to_px)
        self.corners: Array = UNIT.copy()
        self.blur: Array = np.zeros(3)
        self.reference_gain: Array = np.ones((GRID_CELLS, GRID_CELLS))
        self.visible: Mask = np.ones((GRID_CELLS, GRID_CELLS), np.bool_)
        self.offset_basis: Array = smooth_light(2)
        self.gain_basis: Array = contrasts()
        self.rendered: npt.NDArray[np.float32] = np.empty((6, GRID_CELLS, GRID_CELLS), np.float32)
        self.observed: Array = np.empty((GRID_CELLS, GRID_CELLS))
        self.residual: Array = np.empty((GRID_CELLS, GRID_CELLS))
        self.gain: Array = np.empty((GRID_CELLS, GRID_CELLS))

    def solve(self, rounds: int, weight: Array | None = None, *, free: int = PLACE + BLUR) -> bool:
        """Fit position, blur and illumination; return False where the model has no contrast."""
        self.weight = np.ones((GRID_CELLS, GRID_CELLS)) if weight is None else weight
        contrast = solve(
            self.image,
            self.to_px,
            self.pictures.layers,
            self.pictures.blurs_cells,
            self.corners,
            self.blur,
            self.reference_gain,
            self.visible,
            self.weight,
            self.offset_basis,
            self.gain_basis,
            self.cell_px,
            rounds,
            free,
            self.observed,
            self.rendered,
            self.residual,
            self.gain,
        )
        return bool(contrast > 0.0)

    def sample(self, blur_px: float = FIRST_BLUR_PX) -> None:
        """Sample the image and render the model with an isotropic blur, before any fit."""
        self.blur, ahead = np.empty(3), self.ahead
        lens_blur(ahead, blur_px, self.blur)
        self.observed = np.empty((GRID_CELLS, GRID_CELLS))
        sample_cells(self.image, self.to_px, self.corners, self.observed)
        render_model(self.pictures.layers, self.pictures.blurs_cells, self.blur, ahead, self.rendered)

    @property
    def has_highlight_terms(self) -> bool:
        """Return whether the illumination basis contains highlights."""
        return bool(self.offset_basis.shape[1] > MAX_SMOOTH_TERMS)

    @property
    def ahead(self) -> Array:
        """Return the Jacobian (2, 2) of grid cells by image pixels."""
        ahead = np.empty((2, 2))
        cells_per_px(self.to_px, self.corners, ahead)
        return ahead

    @property
    def state(self) -> FitState:
        """Return the current state; setting it also marks all cells as visible."""
        return FitState(
            corners=self.corners.copy(),
            blur=self.blur.copy(),
            reference_gain=self.reference_gain.copy(),
            observed=self.observed.copy(),
            rendered=self.rendered.copy(),
        )

    @state.setter
    def state(self, state: FitState) -> None:
        """Restore a state, and mark all cells as visible."""
        self.corners, self.blur, self.reference_gain = (
            state.corners.copy(),
            state.blur.copy(),
            state.reference_gain.copy(),
        )
        self.observed, self.rendered = state.observed.copy(), state.rendered.copy()
        self.visible = np.ones((GRID_CELLS, GRID_CELLS), np.bool_)

    @property
    def picture(self) -> npt.NDArray[np.float32]:
        """Return the rendered model, dark 0 to bright 1."""
        return np.asarray(self.rendered[0])

    def local_ncc(self) -> float:
        """Return the local normalised cross-correlation (LNCC) of image and model, -1..1.

        Each cell is normalised by its neighbourhood, so a shadow, highlight or occluder over one part leaves
        the rest unchanged. The larger value of two blurs is returned.
        """
        best, of_best = -1.0, np.zeros(3)
        for blur_px in (FIRST_BLUR_PX, WIDE_BLUR_SIDES * self.side_px):
            self.sample(blur_px)
            both = np.stack([self.observed[SQUARE], PICTURE_GREY * self.picture[SQUARE]])
            flat = both.reshape(2, -1).astype(np.float32)
            normalise_locally(flat, SQUARE_CELLS, NEIGHBOURHOOD_CELLS, MIN_SD_GREY, MIN_SD_RATIO)
            ncc = float(flat[0] @ flat[1])
            if ncc > best:
                best, of_best = ncc, self.blur
        self.blur = of_best
        return best

    def informative(self, visible: Mask) -> Mask:
        """Return the visible cells that are neither saturated nor mixed with the background by blur."""
        clear = np.empty((GRID_CELLS, GRID_CELLS), np.bool_)
        clear_of_beyond(self.blur, clear)
        return np.asarray(visible & (self.observed < SATURATED_GREY) & clear)

    @property
    def blur_sd_cells(self) -> float:
        """Return the RMS of the blur's sd over all directions, in cells."""
        return float(np.sqrt(0.5 * (self.blur[0] + self.blur[1])))

    @property
    def residuals(self) -> Residuals:
        """Return the residuals of the fit."""
        return Residuals(observed=self.observed, picture=self.picture, residual=self.residual, gain=self.gain)


def local_ncc_at(image: GreyImage, pictures: ScaleSpace, corners_px: Array, *, side_px: float) -> float:
    """Return the local normalised cross-correlation of a marker with the image, -1..1.

    `corners_px` (4, 2): where it is compared. Under shadow, highlight and noise it discriminates better than
    a template match, under motion blur worse.
    """
    return Estimator(image, pictures, corners_px, side_px).local_ncc()


@cache
def inside_square() -> Mask:
    """Return the mask of cells inside the outline."""
    u, v = grid()
    return np.asarray(np.maximum(np.abs(u), np.abs(v)) < 1.0)


def shape_mask(picture: npt.NDArray[np.float32]) -> Mask:
    """Return the bounding mask of the bright shape within the outline."""
    u, v = grid()
    bright = (picture > 0.5) & (np.maximum(np.abs(u), np.abs(v)) < 0.85)
    rows, columns = np.nonzero(bright)
    if len(rows) == 0:
        return inside_square()
    out = np.zeros_like(bright)
    out[max(rows.min() - 1, 0) : rows.max() + 2, max(columns.min() - 1, 0) : columns.max() + 2] = True
    return np.asarray(out & inside_square())


def any_shape_mask(picture: npt.NDArray[np.float32]) -> Mask:
    """Return the mask of this model's shape and of the area where another marker may have its shape."""
    u, v = grid()
    return np.asarray(shape_mask(picture) | (np.maximum(np.abs(u), np.abs(v)) < OTHERS_HALF))
