"""A finger that occludes a share of the marker."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import root_scalar

from tests.benchmarks.scenes.area import coverage_image
from tests.benchmarks.scenes.clutter import Floats
from tracker.geometry import Array

FINE = 4
TIP_CORNERS = 32
# Between these distances from the middle, in sides, a finger covers all of a square and nothing of it.
REACH_SIDES = (-2.5, 2.5)
TOLERANCE_SIDES = 1e-8


@dataclass(frozen=True, slots=True, kw_only=True)
class Finger:
    """A long rounded shape in front of the marker.

    Attributes:
        tip_px: middle (2,) of its round end.
        towards: direction (2,) from the tip to the hand.
        half_px: half its width.
        reflectance: of its ridge; it is darker to its sides.
    """

    tip_px: Array
    towards: Array
    half_px: float
    reflectance: float

    def outline_px(self, reach_px: float) -> Array:
        """Return the outline (n, 2) down to this distance from its tip."""
        across = np.array([-self.towards[1], self.towards[0]])
        turn = np.linspace(0.5 * np.pi, 1.5 * np.pi, TIP_CORNERS)
        end = np.outer(np.cos(turn), self.towards) + np.outer(np.sin(turn), across)
        far = self.towards * reach_px + np.outer([-1.0, 1.0], across) * self.half_px
        return np.concatenate([self.tip_px + self.half_px * end, self.tip_px + far])

    def share(self, left_px: float, top_px: float, size_wh: tuple[int, int], finer: int = 1) -> Array:
        """Return the covered share of each cell (h, w) of a grid whose first pixel is (left, top)."""
        outline = (self.outline_px(6000.0) - [left_px, top_px]) * finer + (finer - 1) / 2
        return coverage_image([outline], [1.0], size_wh)

    def shade(self, left_px: float, top_px: float, size_wh: tuple[int, int], finer: int = 1) -> Floats:
        """Return the reflectance at each cell (h, w), shaded as a cylinder."""
        u = left_px + (np.arange(size_wh[0]) - (finer - 1) / 2) / finer - self.tip_px[0]
        v = top_px + (np.arange(size_wh[1]) - (finer - 1) / 2) / finer - self.tip_px[1]
        off = (v[:, None] * self.towards[0] - u[None, :] * self.towards[1]) / self.half_px
        return np.asarray(self.reflectance * np.sqrt(np.clip(1.0 - 0.7 * off * off, 0.1, 1.0)), np.float32)


def finger_over(square_px: Array, occlusion_ratio: float, random: np.random.Generator) -> Finger:
    """Return a finger from a random side that occludes this share of the square (4, 2)."""
    angle, aside = random.uniform(0.0, 2.0 * np.pi), random.uniform(-0.35, 0.35)
    half, reflectance = random.uniform(0.45, 0.8), random.uniform(0.15, 0.75)
    towards = np.array([np.cos(angle), np.sin(angle)])
    side = float(np.linalg.norm(square_px - np.roll(square_px, 1, axis=0), axis=1).max())
    across = np.array([-towards[1], towards[0]])
    left, top = np.floor(square_px.min(axis=0)) - 2.0
    columns, rows = ((np.ceil(square_px.max(axis=0)) - [left, top] + 2.0) * FINE).astype(int).tolist()
    inside = coverage_image([(square_px - [left, top]) * FINE + (FINE - 1) / 2], [1.0], (columns, rows))

    def at(far: float) -> Finger:
        tip = square_px.mean(axis=0) + towards * far * side + across * aside * side
        return Finger(tip_px=tip, towards=towards, half_px=half * side, reflectance=reflectance)

    def excess(far: float) -> float:
        share = at(far).share(left, top, (columns, rows), FINE)
        return float(np.sum(share * inside)) / float(inside.sum()) - occlusion_ratio

    return at(root_scalar(excess, bracket=REACH_SIDES, method="brentq", xtol=TOLERANCE_SIDES).root)
