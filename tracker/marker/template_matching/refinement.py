"""Refinement of approximate quads by alignment with the templates."""

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
    STIFFNESS,
    VISIBLE_CELLS,
    VISIBLE_COUNT,
    Float32,
    Template,
)
from tracker.quads import Quads

STEPS = 6


def refine_quads(
    image: GreyImage, quads: Quads, template: Template, *, steps: int = STEPS
) -> tuple[Quads, Float32]:
    """Align quads (q, 4, 2) with the model; return them and their correlation (q,).

    This reduces an error of a tenth of the side to a few hundredths, also under defocus, motion blur
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
        template.factors,
        masked.columns,
        masked.mean,
        masked.spread,
        OCCLUSION_MASKS,
        VISIBLE_CELLS,
        VISIBLE_COUNT,
        steps,
        STIFFNESS,
        CELLS,
        RING,
        NEIGHBOURHOOD_CELLS,
        MIN_SD_GREY,
        MIN_SD_RATIO,
    )
    return np.asarray(found, np.float32), np.asarray(correlation, np.float32)
