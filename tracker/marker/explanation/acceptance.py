"""What explains the pixels of a square, and whether it leaves nothing that would need another shape.

How much must be explained depends on how much could pass for the marker there: on a small, blurred, covered
or unevenly lit square, other shapes come nearer to it.

A tracked marker at its expected place may be covered more than one that is found anew (`explains_known`): a
finger over three tenths with its shadow lost 3 in 100 images, which the search could not recover. A
look-alike put under the finger in the same instant would be accepted.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.marker.explanation.cover import MIN_AREA_RATIO, Mask
from tracker.marker.explanation.fields.kernels import FIELDS, RING, WIDE
from tracker.marker.explanation.flips import MAX_FLIPPED_RATIO

# In empty scenes other squares from 16 px reach 0.91 with a fitted blur, in shadow too, and 0.84 under fitted
# highlights, which take away from both; the marker itself has 0.96 and more, at 20 px under glare 0.93.
# What is small has little to say, and what is covered less.
CORRELATION_SIDES_PX, MIN_CORRELATION = (18.0, 24.0, 34.0), (0.975, 0.95, 0.94)
HIGHLIGHTS_LESS = 0.02
COVERED_MORE = 0.01
COVERED_RATIO, MAX_HIDDEN_RATIO = 0.03, 0.45
# The outline is what all squares share: enough of what is within must be seen.
MAX_INNER_HIDDEN_RATIO = 0.55
# Of what was there a moment ago, so much more may be hidden, and so much lie on it apart from the border.
MIN_KNOWN_CORRELATION, MAX_KNOWN_HIDDEN_RATIO, MAX_KNOWN_AREA_RATIO = 0.9, 0.55, 0.015
# In uneven light, the noise that the outline shows taken out, other squares reach 0.92 where they have 0.7
# with it, and wide ones 0.95 with 0.89 (9,000 looked at), once 0.943; of a wide square the noise hides less.
# Where the square is small, nothing is said.
MIN_UNEVEN_PX = 18.0
IN_NOISE_SIDES_PX, MIN_IN_NOISE, MIN_BESIDE_NOISE = (30.0, 45.0), (0.8, 0.9), 0.955
# The more noise is taken out, the less else may be left. In shadow, highlights, smear and noise, framed
# squares with a bent spot have reached 0.93 with noise and 0.96 without it, small ones 0.93 and 0.99 (3,300
# looked at); nearly all had to be taken for blurred over more of their side than the next limit allows.
BOTH_SIDES_PX, MIN_BOTH = (20.0, 26.0), (1.93, 1.875)
# Blurred over less of its side (geometric mean of both directions) one that is not small has more to say than
# another can imitate: of the squares that the limit above alone refuses, one of 20 px was so sharp, and 19 of
# 28 markers were.
SHARP_MEAN_BLUR_SIDE_RATIOS, SHARP_SIDES_PX, MIN_BOTH_SHARP = (0.055, 0.06), (20.0, 24.0), (1.93, 1.84)
# Blurred over more of its side, or more of it hidden or too bright to tell, a part of the shape passes for
# light.
MAX_UNEVEN_BLUR_SIDE_RATIO, MAX_UNEVEN_SMEAR_SIDE_RATIO, MAX_UNEVEN_HIDDEN_RATIO = 0.062, 0.105, 0.4
MAX_UNEVEN_MEAN_BLUR_SIDE_RATIO = 0.072
MAX_UNEVEN_MOVED_PX, MAX_UNEVEN_MOVED_SIDE_RATIO = 2.0, 0.06
MAX_MOVED_PX, MAX_MOVED_SIDE_RATIO = 2.0, 0.04
# A cover's own edge pulls a fit to it: where there is one, the edges must have been right already.
MAX_MOVED_COVERED_PX, MAX_MOVED_COVERED_SIDE_RATIO = 0.8, 0.02
# Edges of what is smeared are found at either end of its way, an sd and three quarters of it off the middle;
# a blur that is the same to all sides moves none.
MAX_MOVED_BLURS = 1.75
# Two sides that face each other tell less of where it is along them; wherever a smeared one is found there in
# full sight, nothing else comes near to it.
MAX_MOVED_SMEARS = 2.6
# Blurred over so much of its side, one square is like another: like this one under highlights, and in every
# other light unless nearly all is explained. In blurred scenes other squares of 16 px in full sight reach
# 0.973, of 24 px 0.943, covered ones 0.98; smear leaves one direction sharp, and others 0.88 (1,500 scenes,
# five markers known; markers that are changed in a part reach 0.97 in either).
BLURRED_SIDE_RATIO, SHARP_SIDE_RATIO, MAX_BLUR_SIDE_RATIO, MAX_SMEAR_SIDE_RATIO = 0.1, 0.05, 0.16, 0.2
MIN_CORRELATION_BLURRED, MIN_CORRELATION_SMEARED, MIN_CORRELATION_BLURRED_COVERED = 0.975, 0.935, 0.98
# Of what is small, so much more than where it is sharp.
BLURRED_MORE = 0.01
# Half as blurred, and sharp in no direction, squares with two spots in them have reached 0.95 where covered,
# and 0.97 under highlights: there, none is believed.
MIN_CORRELATION_SOFT_COVERED = 0.965


@dataclass(frozen=True, slots=True, kw_only=True)
class BesideNoise:
    """How like the model a square is where noise does not hide it.

    Attributes:
        likeness, inner_correlation: as in `Explanation`, without the noise that the outline shows.
        flipped_ratio: how far the most doubtful part of the shape is from the model, towards dark for bright.
    """

    correlation: float
    inner_correlation: float
    flipped_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """How far blur, light and cover explain the pixels of a square.

    Attributes:
        side_px: of the square in the image.
        likeness: correlation of what is visible with the model, blur and light fitted, -1..1.
        inner_correlation: the same where the model has its shape, the outline left out.
        hidden_ratio: part of the square that is covered, 0..1.
        inner_hidden_ratio: the same of where the model has its shape.
        inner_untold_ratio: the same, and what is too bright, or too near to a cover, to tell.
        inside_ratio: area of the largest piece that contradicts and is not covered, by the square's.
        corners_px: (4, 2), where they explain it best.
        moved_px: how far the corners (4, 2) had to be moved to explain it best, the farthest.
        blur_px: (2,), sd along the sharpest and the most blurred direction.
        under_highlights: whether highlights had to be fitted.
        is_turned: whether the model, turned by a quarter or more, explains as much, or mirrored more.
        beside_noise: in uneven light, what is left of both likenesses when the noise is taken out.
        hidden: which fields of the square and its paper (n, n), from the top left, something covers.
    """

    side_px: float
    correlation: float
    inner_correlation: float
    hidden_ratio: float
    inner_hidden_ratio: float
    inner_untold_ratio: float
    inside_ratio: float
    corners_px: Array
    moved_px: float
    blur_px: tuple[float, float]
    hidden: Mask
    under_highlights: bool = False
    is_turned: bool = False
    beside_noise: BesideNoise | None = None

    @property
    def is_covered(self) -> bool:
        """Whether something covers more of the square than a fit leaves over by itself."""
        return self.hidden_ratio > COVERED_RATIO

    def covers(self, at_ratio: Array) -> Mask:
        """Whether something covers these points (n, 2) of the marker's plane.

        They are in sides from its centre, to the right and upwards of the printed face.
        """
        if not self.is_covered:
            return np.zeros(len(at_ratio), np.bool_)
        fields = np.floor((at_ratio * (1.0, -1.0) + 0.5) * FIELDS).astype(np.int64) + RING
        inside = ((fields >= 0) & (fields < WIDE)).all(axis=1)
        columns, rows = np.clip(fields, 0, WIDE - 1).T
        return np.asarray(inside & self.hidden[rows, columns])

    @property
    def explains(self) -> bool:
        """Whether nothing is left that would need another shape to explain it."""
        return (
            not self.is_turned
            and (self._is_alike if self.beside_noise is None else self._is_alike_beside_noise)
            and not (self.under_highlights and self._is_blurred)
            and self.inside_ratio < MIN_AREA_RATIO
            and self.hidden_ratio <= MAX_HIDDEN_RATIO
            and self.inner_hidden_ratio <= MAX_INNER_HIDDEN_RATIO
            and self.moved_px <= self._max_moved_px
            and self.blur_px[0] <= BLURRED_SIDE_RATIO * self.side_px
            and self.blur_px[1] <= self._max_blur_ratio * self.side_px
        )

    @property
    def explains_known(self) -> bool:
        """Whether it is what was there a moment ago: more of it may be hidden than of what is found anew."""
        return (
            not self.is_turned
            and not self.under_highlights
            and not self._is_blurred
            and min(self.correlation, self.inner_correlation) >= MIN_KNOWN_CORRELATION
            and self.inside_ratio < MAX_KNOWN_AREA_RATIO
            and max(self.hidden_ratio, self.inner_hidden_ratio) <= MAX_KNOWN_HIDDEN_RATIO
            and self.moved_px <= self._max_moved_px
        )

    @property
    def _max_moved_px(self) -> float:
        px, ratio = (
            (MAX_MOVED_COVERED_PX, MAX_MOVED_COVERED_SIDE_RATIO)
            if self.is_covered
            else (MAX_MOVED_PX, MAX_MOVED_SIDE_RATIO)
        )
        smeared_px = float(np.sqrt(max(self.blur_px[1] ** 2 - self.blur_px[0] ** 2, 0.0)))
        in_sight = self._is_smeared and not self.is_covered
        smears = MAX_MOVED_SMEARS if in_sight else MAX_MOVED_BLURS
        return max(px, ratio * self.side_px, smears * smeared_px)

    @property
    def _max_blur_ratio(self) -> float:
        return MAX_SMEAR_SIDE_RATIO if self._is_smeared and not self.is_covered else MAX_BLUR_SIDE_RATIO

    @property
    def _is_smeared(self) -> bool:
        """Whether it is blurred in one direction, and sharp in the other."""
        return self._is_blurred and self.blur_px[0] <= SHARP_SIDE_RATIO * self.side_px

    @property
    def _is_blurred(self) -> bool:
        return self.blur_px[1] > BLURRED_SIDE_RATIO * self.side_px

    @property
    def _is_alike(self) -> bool:
        """Whether in usual light it is more like the model than other shapes come."""
        is_sharp = self.blur_px[0] <= SHARP_SIDE_RATIO * self.side_px
        if self.under_highlights and not is_sharp:
            return False
        least = float(np.interp(self.side_px, CORRELATION_SIDES_PX, MIN_CORRELATION))
        if self._is_blurred and self.is_covered:
            least = MIN_CORRELATION_BLURRED_COVERED
        elif self._is_smeared:
            least = MIN_CORRELATION_SMEARED
        elif self._is_blurred:
            least = max(least + BLURRED_MORE, MIN_CORRELATION_BLURRED)
        elif self.is_covered and not is_sharp:
            least = max(least, MIN_CORRELATION_SOFT_COVERED)
        least += COVERED_MORE * self.is_covered - HIGHLIGHTS_LESS * self.under_highlights
        return min(self.correlation, self.inner_correlation) >= least

    @property
    def _is_alike_beside_noise(self) -> bool:
        """Whether in uneven light the shape stands out of the noise, and little but noise is left of it."""
        without = self.beside_noise
        if without is None:
            return False
        alike, beside = (min(one.correlation, one.inner_correlation) for one in (self, without))
        moved_px = max(MAX_UNEVEN_MOVED_PX, MAX_UNEVEN_MOVED_SIDE_RATIO * self.side_px)
        least = float(np.interp(self.side_px, IN_NOISE_SIDES_PX, MIN_IN_NOISE))
        return (
            self.side_px >= MIN_UNEVEN_PX
            and max(self.hidden_ratio, self.inner_untold_ratio) <= MAX_UNEVEN_HIDDEN_RATIO
            and self.moved_px <= moved_px
            and self.blur_px[0] <= MAX_UNEVEN_BLUR_SIDE_RATIO * self.side_px
            and self.blur_px[1] <= MAX_UNEVEN_SMEAR_SIDE_RATIO * self.side_px
            and self._mean_blur_ratio <= MAX_UNEVEN_MEAN_BLUR_SIDE_RATIO
            and alike >= least
            and beside >= MIN_BESIDE_NOISE
            and alike + beside >= self._min_both
            and without.flipped_ratio <= MAX_FLIPPED_RATIO
        )

    @property
    def _min_both(self) -> float:
        """How like the model it must be with noise and without it, together."""
        soft = float(np.interp(self.side_px, BOTH_SIDES_PX, MIN_BOTH))
        sharp = min(float(np.interp(self.side_px, SHARP_SIDES_PX, MIN_BOTH_SHARP)), soft)
        return float(np.interp(self._mean_blur_ratio, SHARP_MEAN_BLUR_SIDE_RATIOS, (sharp, soft)))

    @property
    def _mean_blur_ratio(self) -> float:
        """Geometric mean of the blur's sd along both directions, by the side."""
        return float(np.sqrt(self.blur_px[0] * self.blur_px[1])) / self.side_px
