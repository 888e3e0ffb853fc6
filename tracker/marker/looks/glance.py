"""A glance at what is inside an outline: enough to let most outlines go before any edge is matched."""

import numpy as np

from tracker.edges import GreyImage
from tracker.marker.looks.kernels import peek, products
from tracker.marker.looks.templates import (
    AROUND_CELLS,
    CELLS,
    MIN_SD_GREY,
    MIN_SD_RATIO,
    PEEK_CELLS,
    RING,
    ROWS,
    Float32,
    Templates,
)
from tracker.marker.sampling.kernels import even_light, sample_quads
from tracker.outlines import Quads

# Quarters of a turn.
TURNS = 4
DARK, LIGHT = np.float32(64.0), np.float32(192.0)


def glance(image: GreyImage, quads: Quads, templates: Templates) -> Float32:
    """Likeness (q, m, 4) of what is inside each outline to each model at each turn, -1..1."""
    seen = np.asarray(sample_quads(image, quads, CELLS, RING), dtype=np.float32)
    even_light(seen, ROWS, AROUND_CELLS, MIN_SD_GREY, MIN_SD_RATIO)
    out = np.empty((len(quads), len(templates), 4), np.float32)
    for m, template in enumerate(templates.each):
        blurs, turns, cells = template.turned.shape
        alike = products(seen, np.ascontiguousarray(template.turned.reshape(-1, cells).T))
        out[:, m] = alike.reshape(len(quads), blurs, turns).max(axis=1)
    return out


def likely(
    even: GreyImage, quads: Quads, templates: Templates, *, most: int, smeared: bool = False
) -> tuple[Quads, Float32]:
    """Of many outlines (q, 4, 2) those that look most like a model at a peek of 8x8 pixels, and how much.

    Likeness (q, m, 4) to each model at each turn, -1..1.

    Args:
        even: the image in even light (h, w), 128 where it is as bright as around, soft enough for a peek.
        quads: the outlines, parallelograms.
        templates: of the models.
        most: how many to keep for each model.
        smeared: whether motion smears them, along their first side.
    """
    pictures = np.concatenate([one.smeared if smeared else one.peeked for one in templates.each])
    each = peek(even, quads, PEEK_CELLS, pictures, DARK, LIGHT)
    alike = each.reshape(len(templates), TURNS, len(quads)).transpose(2, 0, 1)
    kept = np.ones(len(quads), np.bool_)
    if len(quads) > most:
        kept[:] = False
        for m in range(len(templates)):
            kept[np.argpartition(-alike[:, m].max(axis=1), most)[:most]] = True
    return quads[kept], np.asarray(alike[kept], np.float32)
