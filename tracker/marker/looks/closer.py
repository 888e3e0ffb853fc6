"""A closer look: an outline that is off by some pixels is moved until its inside fits the picture."""

import numpy as np

from tracker.edges import GreyImage
from tracker.marker.looks.kernels import look_closer
from tracker.marker.looks.templates import (
    AROUND_CELLS,
    CELLS,
    COVERS,
    MIN_SD_GREY,
    MIN_SD_RATIO,
    RING,
    Float32,
    Template,
)
from tracker.outlines import Quads

STEPS = 6
# Against steps that noise makes: sum of squares of a picture's cells, 1, times their share of noise.
DAMPING = np.float32(1.0)
# Against what perspective hardly does: a parallelogram becomes another shape.
STIFFNESS = np.float32(10.0)


def looked_closer(
    image: GreyImage, quads: Quads, template: Template, *, steps: int = STEPS
) -> tuple[Quads, Float32]:
    """Outlines (q, 4, 2) moved to where their inside is most like the model, and how much it is (q,).

    An outline that is off by a tenth of its side is brought to a few hundredths, out of focus, in motion or
    partly covered alike.

    Args:
        image: the level at which a cell of the outlines is a pixel to three.
        quads: in px of that level, the model's own first corner first.
        template: the model's.
        steps: how often each is moved at most.
    """
    masked = template.upright
    found, correlation = look_closer(
        image,
        quads,
        template.basis,
        masked.columns,
        masked.mean,
        masked.spread,
        COVERS,
        steps,
        DAMPING,
        STIFFNESS,
        CELLS,
        RING,
        AROUND_CELLS,
        MIN_SD_GREY,
        MIN_SD_RATIO,
    )
    return np.asarray(found, np.float32), np.asarray(correlation, np.float32)
