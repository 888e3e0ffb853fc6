"""Random generation of marker shapes that satisfy the design rules; reproducible by seed."""

from collections.abc import Iterator

import numpy as np

from tracker.design.rules import satisfies_rules
from tracker.design.shape import Patch, Shape, rasterised, vectorised
from tracker.geometry import Array

# In sides. The border is at least an eighth, so that outline and inside remain two separate edges.
BORDERS = (0.13, 0.17)
BODY_RADII, BODY_CORNERS = (0.22, 0.60), (3, 7)
HOLE_RADII, HOLE_CORNERS = (0.11, 0.28), (3, 6)
ISLAND_RADII = (0.10, 0.28)
ISLAND_SHARE = 0.6
# Corners lie on a grid of a hundredth of the side, a quarter of a millimetre.
GRID = 100


def proposed_shapes(seed: int) -> Iterator[Shape]:
    """Yield white polygons with black holes, some with a second white polygon, without end.

    The outer edges of white polygons have the opposite polarity to those of holes and of the square. A shift
    of bright against dark (camera response, ink spread) moves them in opposite directions, a change of scale
    in the same one, so both polarities together make distance and blooming separately observable.
    """
    random = np.random.default_rng([seed, 311])
    while True:
        shape = vectorised(rasterised(_shape(random), GRID))
        if satisfies_rules(shape):
            yield shape


def _shape(random: np.random.Generator) -> Shape:
    border = float(random.uniform(*BORDERS))
    body = _polygon(
        random, 0.5 + random.uniform(-0.18, 0.18, 2), BODY_RADII, int(random.integers(*BODY_CORNERS)), border
    )
    inside = body.mean(axis=0) + random.uniform(-0.2, 0.2, 2)
    hole = _polygon(random, inside, HOLE_RADII, int(random.integers(*HOLE_CORNERS)), border)
    patches = [Patch(corners=body, white=True), Patch(corners=hole, white=False)]
    if random.uniform() < ISLAND_SHARE:
        aside = random.uniform(border + 0.08, 1.0 - border - 0.08, 2)
        island = _polygon(random, aside, ISLAND_RADII, int(random.integers(*HOLE_CORNERS)), border)
        patches.append(Patch(corners=island, white=True))
    return Shape(patches=tuple(patches))


def _polygon(
    random: np.random.Generator, centre: Array, radii: tuple[float, float], corners: int, border: float
) -> Array:
    """Return corners (n, 2) around a centre, at roughly even angles, clipped to the border."""
    step = 2.0 * np.pi / corners
    angles = random.uniform(0.0, 2.0 * np.pi) + step * (
        np.arange(corners) + random.uniform(-0.35, 0.35, corners)
    )
    radius = random.uniform(*radii, corners)
    at = centre + radius[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return np.asarray(np.clip(at, border, 1.0 - border))
