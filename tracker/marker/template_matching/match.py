"""Template match and coarse match of quads, which discard most of them, and alignment of the others."""

import numpy as np

from tracker.edges import GreyImage
from tracker.marker.sampling_kernels import normalise_locally, sample_quads
from tracker.marker.template_matching.template_kernels import (
    align_to_templates,
    coarse_correlations,
    products,
)
from tracker.marker.template_matching.templates import (
    CELLS,
    COARSE_CELLS,
    MIN_SD_GREY,
    MIN_SD_RATIO,
    NEIGHBOURHOOD_CELLS,
    OCCLUSION_MASKS,
    RING,
    ROWS,
    STIFFNESS,
    VISIBLE_CELLS,
    VISIBLE_COUNT,
    Float32,
    Template,
    Templates,
)
from tracker.quads import Quads

# Quarter rotations.
QUARTER_TURNS = 4
DARK, LIGHT = np.float32(64.0), np.float32(192.0)
STEPS = 6


def template_match(image: GreyImage, quads: Quads, templates: Templates) -> Float32:
    """Return the local normalised cross-correlation of quads, models and quarter rotations (q, m, 4)."""
    seen = np.asarray(sample_quads(image, quads, CELLS, RING), dtype=np.float32)
    normalise_locally(seen, ROWS, NEIGHBOURHOOD_CELLS, MIN_SD_GREY, MIN_SD_RATIO)
    out = np.empty((len(quads), len(templates), 4), np.float32)
    for m, template in enumerate(templates.each):
        blurs, rotations, cells = template.rotated.shape
        ncc = products(seen, np.ascontiguousarray(template.rotated.reshape(-1, cells).T))
        out[:, m] = ncc.reshape(len(quads), blurs, rotations).max(axis=1)
    return out


def coarse_match(
    even: GreyImage, quads: Quads, templates: Templates, *, maximum: int, motion_blurred: bool = False
) -> tuple[Quads, Float32]:
    """Return the quads (q, 4, 2) that match a model best in 8 x 8 pixels, and their correlation (q, m, 4).

    Args:
        even: the illumination-normalised image (h, w), 128 where it equals the local mean, slightly smoothed.
        quads: parallelograms.
        templates: of the models.
        maximum: number of quads to retain for each model.
        motion_blurred: whether motion blurs them along their first side.
    """
    pictures = np.concatenate(
        [one.motion_blurred if motion_blurred else one.coarse for one in templates.each]
    )
    each = coarse_correlations(even, quads, COARSE_CELLS, pictures, DARK, LIGHT)
    ncc = each.reshape(len(templates), QUARTER_TURNS, len(quads)).transpose(2, 0, 1)
    selected = np.ones(len(quads), np.bool_)
    if len(quads) > maximum:
        selected[:] = False
        for m in range(len(templates)):
            selected[np.argpartition(-ncc[:, m].max(axis=1), maximum)[:maximum]] = True
    return quads[selected], np.asarray(ncc[selected], np.float32)


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
