"""Refinement of a quad that is off by some pixels, by alignment with the templates."""

import numpy as np

from tracker.edges import GreyImage
from tracker.marker.template_matching.template_kernels import align_to_templates
from tracker.marker.template_matching.templates import (
    CELLS,
    MIN_SD_GREY,
    MIN_SD_RATIO,
    NEIGHBOURHOOD_CELLS,
    OCCLUSION_MASKS,
    RING,
    Float32,
    Template,
)
from tracker.quads import Quads

STEPS = 6
# Against steps that noise makes: sum of squares of a picture's cells, 1, times their share of noise.
DAMPING = np.float32(1.0)
# Against what perspective hardly does: a parallelogram becomes another shape.
STIFFNESS = np.float32(10.0)


def refine_quads(
    image: GreyImage, quads: Quads, template: Template, *, steps: int = STEPS
) -> tuple[Quads, Float32]:
    """Align quads (q, 4, 2) with the model; return them and their correlation (q,).

    A quad that is off by a tenth of its side is brought to a few hundredths, also under defocus, motion blur
    or partial occlusion.

    Args:
        image: pyramid level at which a cell of the quads is one to three pixels.
        quads: in px of that level, the model's first corner first.
        template: of the model.
        steps: maximum number of Gauss-Newton steps.
    """
    masked = template.upright
    found, correlation = align_to_templates(
        image,
        quads,
        template.basis,
        masked.columns,
        masked.mean,
        masked.spread,
        OCCLUSION_MASKS,
        steps,
        DAMPING,
        STIFFNESS,
        CELLS,
        RING,
        NEIGHBOURHOOD_CELLS,
        MIN_SD_GREY,
        MIN_SD_RATIO,
    )
    return np.asarray(found, np.float32), np.asarray(correlation, np.float32)
