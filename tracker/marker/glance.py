"""A glance at what is inside an outline: enough to let most outlines go before any edge is matched."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.marker.kernels import even_light, peek, products, sample_quads
from tracker.marker.model import MarkerModel
from tracker.outlines import Quads

Float32 = npt.NDArray[np.float32]

# A square is seen as 12x12 cells and one more of its white paper all round.
CELLS, RING = 12, 1
ROWS = CELLS + 2 * RING
# The models' pictures as they are, and as a lens out of focus or a hand in motion leaves them.
BLURS_CELLS = (0.0, 1.2)
# Of thousands of outlines only a first peek is taken.
PEEK_CELLS = 6
DARK, LIGHT = np.float32(64.0), np.float32(192.0)
# How far a cover's edge is from the middle: 1 is the far side.
COVER_DEPTHS = (0.55, 0.2)
# A cell is judged beside those around it: as many as see the border and the paper at once.
AROUND_CELLS = 3
# What differs less than this is even: noise, and folds in the paper.
LEAST_SD_GREY, LEAST_SD_RATIO = 1.0, 0.1


def templates_of(models: tuple[MarkerModel, ...]) -> Float32:
    """The models as pictures (m, blurs, 4, cells), turned by 0..3 quarters, mean 0 and length 1.

    Turn k is the picture of an occurrence whose first corner is corner k of the model.
    """
    out = np.empty((len(models), len(BLURS_CELLS), 4, ROWS * ROWS), np.float32)
    for m, model in enumerate(models):
        for b, blur in enumerate(BLURS_CELLS):
            small = _small(model, blur)
            for turn in range(4):
                # np.rot90 turns the picture to the left, so that its right-hand corner comes to the top left.
                out[m, b, turn] = np.rot90(small, turn).ravel()
    even_light(out.reshape(-1, ROWS * ROWS), ROWS, AROUND_CELLS, LEAST_SD_GREY, LEAST_SD_RATIO)
    return out


def _small(model: MarkerModel, blur_cells: float) -> npt.NDArray[np.float64]:
    """The model on its white paper, a pixel a cell."""
    cells = cv2.resize(model.square, (CELLS, CELLS), interpolation=cv2.INTER_AREA).astype(np.float64)
    paper = float(np.percentile(model.square, 98))
    wide = np.pad(cells, CELLS, constant_values=paper)
    if blur_cells > 0.0:
        wide = np.asarray(cv2.GaussianBlur(wide, (0, 0), blur_cells), dtype=np.float64)
    return wide[CELLS - RING : 2 * CELLS + RING, CELLS - RING : 2 * CELLS + RING]


def glance(image: GreyImage, quads: Quads, templates: Float32) -> Float32:
    """Likeness (q, m, 4) of what is inside each outline to each model at each turn, -1..1."""
    models, blurs, turns, cells = templates.shape
    alike = products(_seen(image, quads), np.ascontiguousarray(templates.reshape(-1, cells).T))
    return np.asarray(alike.reshape(len(quads), models, blurs, turns).max(axis=2), dtype=np.float32)


def glance_past_cover(image: GreyImage, quads: Quads, templates: Float32) -> Float32:
    """The same (q, m, 4) where something may have come over the square from any side.

    What is left of it must look the more like the model the less it is: n cells with a correlation r are as
    likely as n log(1 - r^2).
    """
    models, blurs, turns, cells = templates.shape
    flat = templates.reshape(-1, cells)
    size = COVERS.sum(axis=1)[:, None]
    mean = products(COVERS, np.ascontiguousarray(flat.T)) / size
    spread = products(COVERS, np.ascontiguousarray((flat * flat).T)) - size * mean**2
    masked = (COVERS[:, None] * flat[None]).reshape(-1, cells)
    seen = _seen(image, quads)
    # Of each mask: our sum and sum of squares, and our product with each template in it.
    own_mean = products(seen, np.ascontiguousarray(COVERS.T))[..., None]
    own_spread = products(seen * seen, np.ascontiguousarray(COVERS.T))[..., None] - own_mean**2 / size
    shared = products(seen, np.ascontiguousarray(masked.T)).reshape(len(quads), *mean.shape) - own_mean * mean
    alike = np.maximum(shared, 0.0) ** 2 / np.maximum(own_spread * spread, np.float32(1e-9))
    # Of 1 - r^2 to the power of the share of cells that is seen.
    fit = np.log(np.maximum(1.0 - alike, np.float32(1e-4))) * (size / np.float32(cells))
    best = np.sqrt(1.0 - np.exp(fit.min(axis=1)))
    return np.asarray(best.reshape(len(quads), models, blurs, turns).max(axis=2), dtype=np.float32)


def _seen(image: GreyImage, quads: Quads) -> Float32:
    seen = sample_quads(image, quads, CELLS, RING)
    even_light(seen, ROWS, AROUND_CELLS, LEAST_SD_GREY, LEAST_SD_RATIO)
    return np.asarray(seen, dtype=np.float32)


def _covers() -> Float32:
    """The cells (k, 196) that are left, 1, when a straight edge has come in from one of 8 directions."""
    at = np.arange(ROWS) - (ROWS - 1) / 2.0
    x, y = np.meshgrid(at / CELLS, at / CELLS)
    left = [np.ones(ROWS * ROWS, np.bool_)]
    for angle in np.radians(np.arange(0, 360, 45)):
        toward = (np.cos(angle) * x + np.sin(angle) * y).ravel()
        reach = 0.5 * (abs(np.cos(angle)) + abs(np.sin(angle)))
        left += [toward < reach * depth for depth in COVER_DEPTHS]
    return np.array(left, np.float32)


COVERS = _covers()


def likely(even: GreyImage, quads: Quads, templates: Float32, *, most: int) -> Quads:
    """Of many outlines (q, 4, 2) those that look most like a model at a first peek of 8x8 pixels.

    Args:
        even: the image in even light (h, w), 128 where it is as bright as around.
        quads: the outlines, parallelograms.
        templates: of the models.
        most: how many to keep for each model.
    """
    if len(quads) <= most:
        return quads
    soft = np.asarray(cv2.blur(even, (3, 3)), dtype=np.uint8)
    small = _peek_templates(templates)
    each = peek(soft, quads, PEEK_CELLS, small.reshape(-1, small.shape[-1]), DARK, LIGHT)
    alike = each.reshape(len(templates), -1, len(quads)).max(axis=1)
    kept = np.zeros(len(quads), np.bool_)
    for m in range(len(templates)):
        kept[np.argpartition(-alike[m], most)[:most]] = True
    return quads[kept]


def _peek_templates(templates: Float32) -> Float32:
    """The sharp templates (m, 4, n * n) at the size of a peek."""
    rows, half = PEEK_CELLS + 2, CELLS // PEEK_CELLS
    out = np.empty((len(templates), 4, rows * rows), np.float32)
    for m in range(len(templates)):
        for turn in range(4):
            # The ring stays a ring: its cells are doubled outwards.
            wide = np.pad(templates[m, 0, turn].reshape(ROWS, ROWS), half - RING, mode="edge")
            small = wide.reshape(rows, half, rows, half).mean(axis=(1, 3)).ravel()
            small = small - small.mean()
            out[m, turn] = small / np.linalg.norm(small)
    return out


def nudged(quads: Quads, share: float) -> Quads:
    """Each outline (q, 4, 2) and it with each of its sides moved by +-share: (9 q, 4, 2)."""
    out = [quads]
    for k in range(4):
        a, b = k, (k + 1) % 4
        before, after = (k + 3) % 4, (k + 2) % 4
        for sign in (share, -share):
            moved = quads.copy()
            moved[:, a] += np.float32(sign) * (quads[:, a] - quads[:, before])
            moved[:, b] += np.float32(sign) * (quads[:, b] - quads[:, after])
            out.append(moved)
    return np.concatenate(out)
