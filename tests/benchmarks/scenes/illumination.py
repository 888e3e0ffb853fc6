"""Illumination of a scene: gradient, shadow edge and glare."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tests.benchmarks.scenes.clutter import Floats
from tests.benchmarks.scenes.conditions import Condition
from tests.benchmarks.scenes.rigs import Rig
from tracker.geometry import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Illumination:
    """Illumination over the image.

    Attributes:
        gradient: (2,), relative change of the light for a pixel to the right and down.
        shadow_at_px, shadow_across, shadow_width_px: a point of its edge, direction (2,) into the shadow, and
            how soft it is.
        shadow_ratio: how much of the light is gone in it.
        glare_at_px, glare_axes: middle, and (2, 2) that takes an offset in px to standard deviations.
        glare_ratio: its height, 1 is full scale.
        middle_px: where the gradient is 0.
    """

    gradient: Array
    middle_px: Array
    shadow_at_px: Array
    shadow_across: Array
    shadow_width_px: float
    shadow_ratio: float
    glare_at_px: Array
    glare_axes: Array
    glare_ratio: float

    def on(self, reflectance: Floats, left_px: int, top_px: int) -> Floats:
        """Return the radiance of this part of the scene; 1 saturates at an illumination of 1."""
        height, width = reflectance.shape
        u = (np.arange(width, dtype=np.float32) + left_px)[None, :]
        v = (np.arange(height, dtype=np.float32) + top_px)[:, None]
        lit = reflectance * (1.0 + _along(u, v, self.middle_px, self.gradient))
        if self.shadow_ratio > 0.0:
            depth = _along(u, v, self.shadow_at_px, self.shadow_across / self.shadow_width_px)
            # tanh, because the exponential of a whole image's width overflows.
            lit = lit * (1.0 - self.shadow_ratio * 0.5 * (1.0 + np.tanh(0.5 * depth)))
        if self.glare_ratio > 0.0:
            a, b = (_along(u, v, self.glare_at_px, axis) for axis in self.glare_axes)
            lit = lit + self.glare_ratio * np.exp(-0.5 * (a * a + b * b))
        return np.asarray(lit, dtype=np.float32)


def _along(u: Floats, v: Floats, origin_px: Array, direction: Array) -> Floats:
    x, y = np.float32(direction[0]), np.float32(direction[1])
    return np.asarray((u - np.float32(origin_px[0])) * x + (v - np.float32(origin_px[1])) * y, np.float32)


def random_illumination(
    rig: Rig, condition: Condition, random: np.random.Generator, at_px: npt.ArrayLike, side_px: float
) -> Illumination:
    """Return an illumination of this condition with shadow and glare on the marker."""
    angles = random.uniform(0.0, 2.0 * np.pi, 3)
    offset, softness = random.uniform(-0.3, 0.3), random.uniform(0.05, 0.2)
    glare_at, glare_narrow = random.uniform(-0.5, 0.5, 2), random.uniform(0.5, 1.0)
    to_light, into, along = (np.array([np.cos(angle), np.sin(angle)]) for angle in angles)
    across = np.array([-along[1], along[0]])
    glare_px = 0.3 * side_px
    width, height = rig.size_wh_px
    at = np.asarray(at_px, dtype=np.float64)
    return Illumination(
        gradient=to_light * condition.gradient_ratio / (0.5 * np.hypot(width, height)),
        middle_px=np.array([(width - 1) / 2, (height - 1) / 2]),
        shadow_at_px=at + offset * side_px * into,
        shadow_across=into,
        shadow_width_px=softness * side_px,
        shadow_ratio=condition.shadow_ratio,
        glare_at_px=at + glare_at * side_px,
        glare_axes=np.stack([along / glare_px, across / (glare_px * glare_narrow)]),
        glare_ratio=condition.glare_ratio,
    )
