"""Detection of a part inside the square that is dark where the model is bright, or the reverse.

Two markers may differ in one small field only. Nine tenths of their edges are then equal, and no threshold on
a score separates them, but the residuals of that field do. Smooth illumination does not produce such a
component, and an occluder extends over the border, where the outline is missing too. Therefore only a
component completely inside an intact outline counts.

A marker with dirt inside its square is rejected (`SHAPE_DIFFERS`). A component that extends over the border
is an occlusion, and does not reject it.
"""

from dataclasses import dataclass

import numpy as np

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.photometric_fit.estimator import SQUARE, Estimator, inside_square
from tracker.marker.photometric_fit.fit_kernels import correlation
from tracker.marker.photometric_fit.grid_kernels import SQUARE_CELLS
from tracker.marker.photometric_fit.illumination import smooth_light
from tracker.marker.photometric_fit.occlusion import MIN_AREA_RATIO
from tracker.marker.photometric_fit.occlusion_kernels import residual_components
from tracker.marker.photometric_fit.scale_space import scale_space_of

# An inverted part differs by one whole contrast; blur removes up to half of it.
MISMATCH_CONTRAST = 0.45
# Other squares reach 0.87 at 19 px and 0.77 at 36 px, in 400 images full of them; the marker has 0.9 and more
# in plain light. Small squares have few pixels and need a higher correlation.
CORRELATION_SIDES_PX, MIN_CORRELATION = (20.0, 32.0, 40.0, 48.0), (0.88, 0.80, 0.80, 0.70)
LIGHT_ROUNDS = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class ShapeMismatch:
    """Difference between image and model beyond what illumination can cause.

    Attributes:
        inside_ratio: ratio of the area of the largest contradicting component inside the square to the
            square's area, 0..1.
        occluded_ratio: ratio of the area of the components that reach its border, 0..1.
        correlation: normalised cross-correlation of the visible cells with the model, illumination removed;
            -1 where the model has no contrast.
        min_correlation: required at this size.
    """

    inside_ratio: float
    occluded_ratio: float
    correlation: float
    min_correlation: float

    @property
    def is_other_shape(self) -> bool:
        """Return whether this is another shape than the model's."""
        return self.inside_ratio >= MIN_AREA_RATIO or self.correlation < self.min_correlation


def shape_mismatch_of(
    image: GreyImage, square: GreyImage, corners_px: Array, *, side_px: float
) -> ShapeMismatch:
    """Compare a grey image (h, w) in focus with a model (n, n) at these corners (4, 2).

    `corners_px` are pixels of `image`: top-left, top-right, bottom-right, bottom-left of the printed face.
    """
    min_correlation = float(np.interp(side_px, CORRELATION_SIDES_PX, MIN_CORRELATION))
    fit = Estimator(image, scale_space_of(square), corners_px, side_px)
    fit.gain_basis = smooth_light(0)
    fit.visible = inside_square().copy()
    fit.sample()
    largest, occluded_ratio, ncc = 0, 1.0, -1.0
    if fit.solve(LIGHT_ROUNDS, free=0):
        labels = np.empty((SQUARE_CELLS, SQUARE_CELLS), np.int64)
        areas = residual_components(
            fit.residual[SQUARE].copy(), fit.gain[SQUARE].copy(), 0, MISMATCH_CONTRAST, 1, labels
        )
        largest = int(areas.max(initial=0))
        fit.visible[SQUARE] = labels != -1
        occluded_ratio = float(np.count_nonzero(labels == -1)) / SQUARE_CELLS**2
        # Visible cells have equal weights, so this is a correlation.
        if fit.solve(1, free=0):
            ncc = correlation(fit.observed, fit.residual, fit.visible, fit.offset_basis, 0.0)
    return ShapeMismatch(
        inside_ratio=largest / SQUARE_CELLS**2,
        occluded_ratio=occluded_ratio,
        correlation=ncc,
        min_correlation=min_correlation,
    )
