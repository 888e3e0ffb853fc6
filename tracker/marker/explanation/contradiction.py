"""Is there a part inside the square that is dark where the model is bright, or the other way round?

Two markers may differ in one small field only. Nine tenths of their edges are then the same, and no
threshold on a score tells them apart; but the field itself contradicts. Light that varies over the marker
does not, and something that covers the marker comes over its border, where the outline is missing too: only
what lies wholly inside, within an outline that is there, contradicts.

A marker with dirt inside its square is therefore rejected (`SHAPE_DIFFERS`); what reaches over its border
is a cover and does not reject it.
"""

from dataclasses import dataclass

import numpy as np

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.explanation.cover import MIN_AREA_RATIO
from tracker.marker.explanation.cover.kernels import contradicting
from tracker.marker.explanation.fields.kernels import FIELDS
from tracker.marker.explanation.fit import FIRST_BLUR_PX, field_px_of, inside_square
from tracker.marker.explanation.light import smooth_light
from tracker.marker.explanation.pictures import pictures_of

# A flipped part differs by one whole contrast; blur and its bleeding take up to half of it.
CONTRADICTION = 0.45
# Squares with something else inside reach 0.87 at 19 px and 0.77 at 36 px, in 400 pictures full of them; the
# marker itself has 0.9 and more in plain light. Few pixels say little: what is small must say it clearly.
CORRELATION_SIDES_PX, MIN_CORRELATION = (20.0, 32.0, 40.0, 48.0), (0.88, 0.80, 0.80, 0.70)
LIGHT_ROUNDS = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Contradiction:
    """Where image and model disagree beyond what light can do.

    Attributes:
        inside_ratio: area of the largest contradicting part that lies wholly inside the square, by its
            area, 0..1.
        covered_ratio: area of those that reach its border, by its area, 0..1.
        likeness: correlation of the uncovered fields with the model's, the light taken out, 0..1; -1 where
            there is nothing of the model.
        min_correlation: what is asked of a marker of this size.
    """

    inside_ratio: float
    covered_ratio: float
    correlation: float
    min_correlation: float

    @property
    def is_other_shape(self) -> bool:
        """Whether this is another shape than the model's."""
        return self.inside_ratio >= MIN_AREA_RATIO or self.correlation < self.min_correlation


def contradiction_of(
    image: GreyImage, square: GreyImage, corners_px: Array, *, side_px: float
) -> Contradiction:
    """What a grey image (h, w) in focus says against a model (n, n) at these corners (4, 2).

    `corners_px` are pixels of `image`: top-left, top-right, bottom-right, bottom-left of the printed face.
    """
    pictures = pictures_of(square)
    largest, covered, alike = contradicting(
        image,
        np.ascontiguousarray(corners_px, dtype=np.float64),
        pictures.layers,
        pictures.blurs_fields,
        FIRST_BLUR_PX,
        field_px_of(side_px),
        smooth_light(2),
        inside_square(),
        LIGHT_ROUNDS,
        CONTRADICTION,
    )
    return Contradiction(
        inside_ratio=largest / FIELDS**2,
        covered_ratio=covered,
        correlation=alike,
        min_correlation=float(np.interp(side_px, CORRELATION_SIDES_PX, MIN_CORRELATION)),
    )
