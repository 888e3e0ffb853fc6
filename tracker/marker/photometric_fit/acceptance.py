"""Result of photometric verification and its acceptance limits.

The minimum correlation exceeds the largest correlation of other shapes at that size, which is higher on
small, blurred, occluded or unevenly illuminated squares.

More occlusion is accepted for a tracked marker at its expected position than for a new detection
(`is_accepted_when_tracked`). Otherwise a finger with its shadow over three tenths of the marker would lose 3
in 100 images, which the search could not recover. A similar marker put under the finger at that moment would
be accepted.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS, RING, SQUARE_CELLS
from tracker.marker.photometric_fit.inverted_parts import MAX_INVERTED_RATIO
from tracker.marker.photometric_fit.occlusion import MIN_AREA_RATIO, Mask

# In scenes without the marker, other squares from 16 px reach a correlation of 0.91 with fitted blur, also in
# shadow, and 0.84 under fitted highlights, which lower both; the marker has 0.96 and more, at 20 px under
# glare 0.93. Small and occluded squares discriminate less.
CORRELATION_SIDES_PX, MIN_CORRELATION = (18.0, 24.0, 34.0), (0.975, 0.95, 0.94)
HIGHLIGHT_ALLOWANCE = 0.02
OCCLUDED_MARGIN = 0.01
OCCLUDED_RATIO, MAX_OCCLUDED_RATIO = 0.03, 0.45
# The outline is common to all squares, so enough of the inside must be visible.
MAX_INNER_OCCLUDED_RATIO = 0.55
# Looser limits for a tracked marker: occluded part, and area of components inside the border.
MIN_KNOWN_CORRELATION, MAX_KNOWN_OCCLUDED_RATIO, MAX_KNOWN_AREA_RATIO = 0.9, 0.55, 0.015
# Under nonuniform illumination, with the outline's noise removed, other squares reach 0.92 where they have
# 0.7 with it, and wide ones 0.95 with 0.89 (9,000 tested), once 0.943; noise hides less of a wide square.
# Small squares are not accepted.
MIN_NONUNIFORM_PX = 18.0
IN_NOISE_SIDES_PX, MIN_IN_NOISE, MIN_NOISE_CORRECTED = (30.0, 45.0), (0.8, 0.9), 0.955
# The more noise is removed, the less other residual is allowed. Under shadow, highlights, motion blur and
# noise, framed squares with a bent spot have reached 0.93 with noise and 0.96 without it, small ones 0.93 and
# 0.99 (3,300 tested); nearly all had a fitted blur over the next limit.
BOTH_SIDES_PX, MIN_BOTH = (20.0, 26.0), (1.93, 1.875)
# With less blur (geometric mean of both axes, by the side) a square that is not small discriminates better:
# of the squares that the limit above alone rejects, one of 20 px was so sharp, and 19 of 28 markers were.
SHARP_MEAN_BLUR_SIDE_RATIOS, SHARP_SIDES_PX, MIN_BOTH_SHARP = (0.055, 0.06), (20.0, 24.0), (1.93, 1.84)
# With more blur, occlusion or saturation, a part of the shape can be fitted by the illumination.
MAX_NONUNIFORM_BLUR_SIDE_RATIO, MAX_NONUNIFORM_MOTION_BLUR_SIDE_RATIO, MAX_NONUNIFORM_OCCLUDED_RATIO = (
    0.062,
    0.105,
    0.4,
)
MAX_NONUNIFORM_MEAN_BLUR_SIDE_RATIO = 0.072
MAX_NONUNIFORM_SHIFT_PX, MAX_NONUNIFORM_SHIFT_SIDE_RATIO = 2.0, 0.06
MAX_SHIFT_PX, MAX_SHIFT_SIDE_RATIO = 2.0, 0.04
# The edge of an occluder biases the fit, so with an occluder the corners may hardly move.
MAX_SHIFT_OCCLUDED_PX, MAX_SHIFT_OCCLUDED_SIDE_RATIO = 0.8, 0.02
# Edges of a motion-blurred marker are found at either end of the motion, 1.75 sd from the middle; isotropic
# blur moves none.
MAX_SHIFT_BLURS = 1.75
# Two opposite sides constrain the position along them less; an unoccluded motion-blurred marker may therefore
# shift farther, as nothing else comes close to it there.
MAX_SHIFT_MOTION_BLURS = 2.6
# Above this ratio of blur to the side, squares are similar: they are rejected under highlights, and otherwise
# unless nearly all cells fit. In blurred scenes other unoccluded squares of 16 px reach 0.973, of
# 24 px 0.943, occluded ones 0.98; motion blur leaves one direction sharp, and others reach 0.88 (1,500
# scenes, five known markers; markers changed in a part reach 0.97 in either).
BLURRED_SIDE_RATIO, SHARP_SIDE_RATIO, MAX_BLUR_SIDE_RATIO, MAX_MOTION_BLUR_SIDE_RATIO = 0.1, 0.05, 0.16, 0.2
MIN_CORRELATION_BLURRED, MIN_CORRELATION_MOTION_BLURRED, MIN_CORRELATION_BLURRED_OCCLUDED = 0.975, 0.935, 0.98
# Added to the minimum correlation of small squares when blurred.
BLURRED_MARGIN = 0.01
# With half that blur and no sharp direction, squares with two spots have reached 0.95 when occluded and 0.97
# under highlights: there, none is accepted.
MIN_CORRELATION_SOFT_OCCLUDED = 0.965


@dataclass(frozen=True, slots=True, kw_only=True)
class NoiseCorrectedFit:
    """Correlation with the model after the noise is subtracted.

    Attributes:
        correlation, inner_correlation: as in `PhotometricFit`, corrected for the noise measured on the
        outline.
        inverted_ratio: largest contrast inversion of a part of the shape: 0 is the model, 1 dark for bright.
    """

    correlation: float
    inner_correlation: float
    inverted_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PhotometricFit:
    """Fit of a model under blur, illumination and occlusion to the pixels of a square.

    Attributes:
        side_px: side of the square in the image.
        correlation: normalised cross-correlation of the visible cells with the fitted model, -1..1.
        inner_correlation: the same inside the shape, without the outline.
        occluded_ratio: occluded part of the square, 0..1.
        inner_occluded_ratio: the same inside the shape.
        inner_unobserved_ratio: the same plus saturated cells and cells next to an occluder.
        inside_ratio: area of the largest contradicting, not occluding component, by the area of the square.
        corners_px: (4, 2), fitted corners.
        moved_px: largest shift of a corner by the fit.
        blur_px: (2,), sd of the blur along its minor and major axis.
        occluded: (n, n), mask of occluded cells of the square and its paper, from the top left.
        has_highlights: whether highlight terms were fitted.
        is_rotation_ambiguous: whether the rotated model fits as well, or the mirrored model better.
        noise_corrected: correlations without noise, under nonuniform illumination; else None.
    """

    side_px: float
    correlation: float
    inner_correlation: float
    occluded_ratio: float
    inner_occluded_ratio: float
    inner_unobserved_ratio: float
    inside_ratio: float
    corners_px: Array
    moved_px: float
    blur_px: tuple[float, float]
    occluded: Mask
    has_highlights: bool = False
    is_rotation_ambiguous: bool = False
    noise_corrected: NoiseCorrectedFit | None = None

    @property
    def is_occluded(self) -> bool:
        """Return whether more of the square is occluded than noise explains."""
        return self.occluded_ratio > OCCLUDED_RATIO

    def occludes(self, at_ratio: Array) -> Mask:
        """Return which points (n, 2) of the marker's plane are occluded.

        Points are in sides from the centre, to the right and upwards of the printed face.
        """
        if not self.is_occluded:
            return np.zeros(len(at_ratio), np.bool_)
        fields = np.floor((at_ratio * (1.0, -1.0) + 0.5) * SQUARE_CELLS).astype(np.int64) + RING
        inside = ((fields >= 0) & (fields < GRID_CELLS)).all(axis=1)
        columns, rows = np.clip(fields, 0, GRID_CELLS - 1).T
        return np.asarray(inside & self.occluded[rows, columns])

    @property
    def is_accepted(self) -> bool:
        """Return whether the fit is good enough to exclude other shapes."""
        return (
            not self.is_rotation_ambiguous
            and (self._matches if self.noise_corrected is None else self._matches_beside_noise)
            and not (self.has_highlights and self._is_blurred)
            and self.inside_ratio < MIN_AREA_RATIO
            and self.occluded_ratio <= MAX_OCCLUDED_RATIO
            and self.inner_occluded_ratio <= MAX_INNER_OCCLUDED_RATIO
            and self.moved_px <= self._max_moved_px
            and self.blur_px[0] <= BLURRED_SIDE_RATIO * self.side_px
            and self.blur_px[1] <= self._max_blur_ratio * self.side_px
        )

    @property
    def is_accepted_when_tracked(self) -> bool:
        """Whether a tracked marker is accepted here: more of it may be occluded than of a detection."""
        return (
            not self.is_rotation_ambiguous
            and not self.has_highlights
            and not self._is_blurred
            and min(self.correlation, self.inner_correlation) >= MIN_KNOWN_CORRELATION
            and self.inside_ratio < MAX_KNOWN_AREA_RATIO
            and max(self.occluded_ratio, self.inner_occluded_ratio) <= MAX_KNOWN_OCCLUDED_RATIO
            and self.moved_px <= self._max_moved_px
        )

    @property
    def _max_moved_px(self) -> float:
        px, ratio = (
            (MAX_SHIFT_OCCLUDED_PX, MAX_SHIFT_OCCLUDED_SIDE_RATIO)
            if self.is_occluded
            else (MAX_SHIFT_PX, MAX_SHIFT_SIDE_RATIO)
        )
        motion_blur_sd_px = float(np.sqrt(max(self.blur_px[1] ** 2 - self.blur_px[0] ** 2, 0.0)))
        is_unoccluded = self._is_motion_blurred and not self.is_occluded
        max_blurs = MAX_SHIFT_MOTION_BLURS if is_unoccluded else MAX_SHIFT_BLURS
        return max(px, ratio * self.side_px, max_blurs * motion_blur_sd_px)

    @property
    def _max_blur_ratio(self) -> float:
        return (
            MAX_MOTION_BLUR_SIDE_RATIO
            if self._is_motion_blurred and not self.is_occluded
            else MAX_BLUR_SIDE_RATIO
        )

    @property
    def _is_motion_blurred(self) -> bool:
        """Return whether the square is blurred in one direction and sharp in the other."""
        return self._is_blurred and self.blur_px[0] <= SHARP_SIDE_RATIO * self.side_px

    @property
    def _is_blurred(self) -> bool:
        return self.blur_px[1] > BLURRED_SIDE_RATIO * self.side_px

    @property
    def _matches(self) -> bool:
        """Whether, without nonuniform illumination, the correlation exceeds what other shapes reach."""
        is_sharp = self.blur_px[0] <= SHARP_SIDE_RATIO * self.side_px
        if self.has_highlights and not is_sharp:
            return False
        minimum = float(np.interp(self.side_px, CORRELATION_SIDES_PX, MIN_CORRELATION))
        if self._is_blurred and self.is_occluded:
            minimum = MIN_CORRELATION_BLURRED_OCCLUDED
        elif self._is_motion_blurred:
            minimum = MIN_CORRELATION_MOTION_BLURRED
        elif self._is_blurred:
            minimum = max(minimum + BLURRED_MARGIN, MIN_CORRELATION_BLURRED)
        elif self.is_occluded and not is_sharp:
            minimum = max(minimum, MIN_CORRELATION_SOFT_OCCLUDED)
        minimum += OCCLUDED_MARGIN * self.is_occluded - HIGHLIGHT_ALLOWANCE * self.has_highlights
        return min(self.correlation, self.inner_correlation) >= minimum

    @property
    def _matches_beside_noise(self) -> bool:
        """Whether, under nonuniform illumination, the shape exceeds the noise and little else remains."""
        without = self.noise_corrected
        if without is None:
            return False
        ncc, beside = (min(one.correlation, one.inner_correlation) for one in (self, without))
        moved_px = max(MAX_NONUNIFORM_SHIFT_PX, MAX_NONUNIFORM_SHIFT_SIDE_RATIO * self.side_px)
        minimum = float(np.interp(self.side_px, IN_NOISE_SIDES_PX, MIN_IN_NOISE))
        return (
            self.side_px >= MIN_NONUNIFORM_PX
            and max(self.occluded_ratio, self.inner_unobserved_ratio) <= MAX_NONUNIFORM_OCCLUDED_RATIO
            and self.moved_px <= moved_px
            and self.blur_px[0] <= MAX_NONUNIFORM_BLUR_SIDE_RATIO * self.side_px
            and self.blur_px[1] <= MAX_NONUNIFORM_MOTION_BLUR_SIDE_RATIO * self.side_px
            and self._mean_blur_ratio <= MAX_NONUNIFORM_MEAN_BLUR_SIDE_RATIO
            and ncc >= minimum
            and beside >= MIN_NOISE_CORRECTED
            and ncc + beside >= self._min_both
            and without.inverted_ratio <= MAX_INVERTED_RATIO
        )

    @property
    def _min_both(self) -> float:
        """Return the required sum of the correlations with and without noise."""
        soft = float(np.interp(self.side_px, BOTH_SIDES_PX, MIN_BOTH))
        sharp = min(float(np.interp(self.side_px, SHARP_SIDES_PX, MIN_BOTH_SHARP)), soft)
        return float(np.interp(self._mean_blur_ratio, SHARP_MEAN_BLUR_SIDE_RATIOS, (sharp, soft)))

    @property
    def _mean_blur_ratio(self) -> float:
        """Return the geometric mean of the blur's sd along both axes, as a ratio of the side."""
        return float(np.sqrt(self.blur_px[0] * self.blur_px[1])) / self.side_px
