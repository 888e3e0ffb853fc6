"""Prior of the pedicle axis from its surroundings: canal, vertebral body, and clearance to the walls.

A pedicle is hardly longer than it is wide, so its walls hardly constrain its direction. The axis is then
determined by anatomy: from posterior through the centre of the isthmus into the body, inside bone.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.plan.pedicle.outlines import planes_across
from tracker.plan.pedicle.solid import Solid

# The part of a screw path around the isthmus that bone must surround.
MAX_BEHIND_ENTRY_MM, AHEAD_MM, STEP_MM = 10.0, 28.0, 1.5
MAX_DEPTH_MM, MIN_DEPTH_MM = 6.0, -3.0
# Scale of the mean clearance in the score.
CLEARANCE_MM = 0.3
CANAL_MM = (8.0, 34.0)
WALL_FROM_MM, WALL_TO_MM = -14.0, 8.0
# Pedicles near the midline run straight, lateral ones converge: the trend from the thoracic spine to L5.
USUAL_DEG, USUAL_AT_MM, TURN_DEG_PER_MM = 6.0, 16.0, 2.2
USUAL_RANGE_DEG = (0.0, 28.0)
KNOWN_SD_DEG, UNKNOWN_SD_DEG = 6.0, 11.0
# Lower bound of the sd of the direction from the surroundings.
MIN_SD_DEG = 3.0
ASIDE_MM = np.arange(-5.0, 5.1, 1.0)
TRANSVERSE_DEG = np.arange(-24.0, 45.0, 3.0)
SAGITTAL_DEG = np.arange(-30.0, 31.0, 3.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Course:
    """Expected axis direction with standard deviations, angles as in `PedicleMeasure`.

    `usual_ratio` is the influence of the anatomical prior on the transverse angle: 1 is full.
    """

    transverse_deg: float
    sagittal_deg: float
    transverse_sd_deg: float
    sagittal_sd_deg: float
    usual_ratio: float

    def axis(self, side: str) -> Array:
        """Return the unit axis (3,) of these angles, pointing forwards."""
        outwards = 1.0 if side == "left" else -1.0
        ways = _directions(np.array([self.transverse_deg]), np.array([self.sagittal_deg]), outwards)
        return np.asarray(ways[0])

    def off_deg(self, axis: Array, side: str) -> Array:
        """Return the deviations (n, 2) of unit axes (n, 3), transverse and sagittal, in degrees."""
        medial = -axis[:, 0] if side == "left" else axis[:, 0]
        transverse = np.degrees(np.arctan2(medial, -axis[:, 1])) - self.transverse_deg
        sagittal = np.degrees(np.arctan2(axis[:, 2], -axis[:, 1])) - self.sagittal_deg
        return np.stack([transverse, sagittal], axis=1)


def course_through(solid: Solid, isthmus_mm: Array, side: str) -> Course:
    """Return the expected direction through a point: the usual one, weighted by the bone around the path."""
    outwards = 1.0 if side == "left" else -1.0
    middle = _middle_mm(solid, isthmus_mm, outwards)
    transverse, transverse_sd = 10.0, UNKNOWN_SD_DEG
    sagittal, sagittal_sd = 0.0, UNKNOWN_SD_DEG
    if middle is not None:
        aside = abs(isthmus_mm[0] - middle)
        transverse = USUAL_DEG + TURN_DEG_PER_MM * (aside - USUAL_AT_MM)
        transverse, transverse_sd = float(np.clip(transverse, *USUAL_RANGE_DEG)), KNOWN_SD_DEG
        tilt = _body_tilt_deg(solid, isthmus_mm, middle)
        if tilt is not None:
            sagittal, sagittal_sd = tilt, KNOWN_SD_DEG
    t, s = np.meshgrid(TRANSVERSE_DEG, sagittal + SAGITTAL_DEG, indexing="ij")
    score = _clearance_mm(solid, isthmus_mm, t.ravel(), s.ravel(), outwards).reshape(t.shape) / CLEARANCE_MM
    score -= 0.5 * ((t - transverse) / transverse_sd) ** 2 + 0.5 * ((s - sagittal) / sagittal_sd) ** 2
    weight = np.exp(score - score.max())
    weight /= weight.sum()
    mean_t, mean_s = float((weight * t).sum()), float((weight * s).sum())
    variance_t = float((weight * (t - mean_t) ** 2).sum())
    return Course(
        transverse_deg=mean_t,
        sagittal_deg=mean_s,
        transverse_sd_deg=max(float(np.sqrt(variance_t)), MIN_SD_DEG),
        sagittal_sd_deg=max(float(np.sqrt((weight * (s - mean_s) ** 2).sum())), MIN_SD_DEG),
        usual_ratio=min(variance_t / transverse_sd**2, 1.0),
    )


def middle_of_bone(solid: Solid, point_mm: Array, axis: Array) -> Array:
    """Return the deepest point (3,) within a few mm of a point, across an axis."""
    (across,), (up,) = planes_across(axis[None])
    x, y = (grid.ravel() for grid in np.meshgrid(ASIDE_MM, ASIDE_MM))
    near_by = point_mm + x[:, None] * across + y[:, None] * up
    # A small penalty on the distance keeps the point in place among equal depths.
    return np.asarray(near_by[np.argmax(solid.depth_at(near_by) - 0.3 * np.hypot(x, y))])


def _directions(transverse: Array, sagittal: Array, outwards: float) -> Array:
    """Return unit directions (n, 3) of angles (n,) in degrees."""
    medial = np.tan(np.radians(transverse))
    directions = np.stack([-outwards * medial, -np.ones_like(medial), np.tan(np.radians(sagittal))], axis=1)
    return np.asarray(directions / np.linalg.norm(directions, axis=1, keepdims=True))


def _clearance_mm(solid: Solid, at: Array, transverse: Array, sagittal: Array, outwards: float) -> Array:
    """Return the mean clearance (n,) of paths through a point, clipped at the relevant maximum."""
    directions = _directions(transverse, sagittal, outwards)
    along = np.arange(-MAX_BEHIND_ENTRY_MM, AHEAD_MM + 0.1, STEP_MM)
    depth = solid.depth_at(at + along[:, None, None] * directions)
    return np.asarray(np.clip(depth, MIN_DEPTH_MM, MAX_DEPTH_MM).mean(axis=0))


def _middle_mm(solid: Solid, at: Array, outwards: float) -> float | None:
    """Return the x coordinate of the canal's centre, or None if no canal is beside the point."""
    along = np.arange(0.0, 48.0, 0.5)
    found = []
    for back in (-3.0, 0.0, 3.0, 7.0, 11.0):
        for lift in (-4.0, -1.0, 2.0):
            line = at + np.array([0.0, back, lift]) - outwards * along[:, None] * np.array([1.0, 0.0, 0.0])
            outside = np.flatnonzero(solid.depth_at(line) < 0.0)
            if not len(outside) or along[outside[0]] > 16.0:
                continue
            bone = np.flatnonzero(solid.depth_at(line)[outside[0] :] > 0.0)
            if len(bone) and CANAL_MM[0] <= 0.5 * bone[0] <= CANAL_MM[1]:
                found.append(float(at[0] - outwards * (along[outside[0]] + 0.25 * bone[0])))
    return float(np.median(found)) if len(found) >= 3 else None


def _body_tilt_deg(solid: Solid, at: Array, middle_mm: float) -> float | None:
    """Return the sagittal tilt of the body, from its posterior wall."""
    along = np.arange(-8.0, 24.0, 0.5)
    level, wall = [], []
    for lift in np.arange(WALL_FROM_MM, WALL_TO_MM + 0.1, 2.0):
        line = np.array([middle_mm, at[1], at[2] + lift]) - along[:, None] * np.array([0.0, 1.0, 0.0])
        depth = solid.depth_at(line)
        entering = np.flatnonzero((depth[:-1] < 0.0) & (depth[1:] >= 0.0))
        if len(entering):
            level.append(lift)
            wall.append(-along[entering[0]])
    if len(level) < 6:
        return None
    z, y = np.array(level), np.array(wall)
    first, second = np.triu_indices(len(z), 1)
    far = z[second] - z[first] >= 6.0
    slope = float(np.median((y[second] - y[first])[far] / (z[second] - z[first])[far]))
    return float(np.clip(np.degrees(np.arctan(slope)), -35.0, 35.0))
