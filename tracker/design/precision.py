"""Cramer-Rao bound of a marker's pose from its edges (Fisher information), compared with a plain square."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array, rotation_from_vector
from tracker.marker import ActiveEdges, MarkerModel

# A marker at arm's length: 27 px wide, 20 of its sides away, tilted by 30 degrees in any direction.
SIDE_PX, DISTANCE_SIDES, TILT_DEG, DIRECTIONS = 27.0, 20.0, 30.0, 12
# Sd of an edge's position per pixel of its length, for a noise of 4 grey levels, contrast of 160 and blur of
# 1 px: sd = noise / contrast * sqrt(2 * sqrt(pi) * blur).
EDGE_SD_PX = 4.0 / 160.0 * float(np.sqrt(2.0 * np.sqrt(np.pi)))
# The camera response and ink spread shift all edges towards bright or dark by the same amount (sd).
SHIFT_SD_PX = 0.25
STEP = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Precision:
    """Minimum standard deviations of any unbiased estimator, for a marker 27 px wide, tilted by 30 degrees.

    Attributes:
        tilt_sd_deg: of the direction of the marker's normal.
        distance_sd_ratio: of the distance, by the distance.
        plain_tilt_sd_deg: of the normal, if only the outline of the square were used.
        plain_distance_sd_ratio: of the distance, likewise.
    """

    tilt_sd_deg: float
    distance_sd_ratio: float
    plain_tilt_sd_deg: float
    plain_distance_sd_ratio: float

    @property
    def tilt_gain(self) -> float:
        """Return the ratio of the plain square's tilt sd to this marker's."""
        return self.plain_tilt_sd_deg / self.tilt_sd_deg

    @property
    def distance_gain(self) -> float:
        """Return the ratio of the plain square's distance sd to this marker's."""
        return self.plain_distance_sd_ratio / self.distance_sd_ratio


def precision_of(model: MarkerModel) -> Precision:
    """Return the pose precision from a model's active edges, averaged over the directions of the tilt."""
    active = model.level_for(SIDE_PX)
    tilt, distance = _min_sd(active, np.ones(len(active.points_mm), np.bool_), model.side_mm)
    plain_tilt, plain_distance = _min_sd(active, ~active.inner, model.side_mm)
    return Precision(
        tilt_sd_deg=tilt,
        distance_sd_ratio=distance,
        plain_tilt_sd_deg=plain_tilt,
        plain_distance_sd_ratio=plain_distance,
    )


def _min_sd(active: ActiveEdges, chosen: npt.NDArray[np.bool_], side_mm: float) -> tuple[float, float]:
    """Return the RMS over all directions of the sd of the normal (deg) and of the relative distance."""
    points = np.column_stack([active.points_mm[chosen], np.zeros(int(chosen.sum()))]) / side_mm
    normals = np.column_stack([active.normals[chosen], np.zeros(int(chosen.sum()))])
    length_px = active.length_mm[chosen] / side_mm * SIDE_PX
    weight = length_px * active.strength_ratio[chosen] ** 2 / EDGE_SD_PX**2
    tilts, distances = [], []
    for about in np.arange(DIRECTIONS) * 2.0 * np.pi / DIRECTIONS:
        axis = np.array([np.cos(about), np.sin(about), 0.0])
        rotation = rotation_from_vector(axis * np.radians(TILT_DEG)) @ np.diag([1.0, -1.0, -1.0])
        covariance = _covariance(points, normals, weight, rotation)
        # Rotation about the normal does not tilt the marker.
        across = np.eye(3) - np.outer(rotation[:, 2], rotation[:, 2])
        tilts.append(float(np.trace(across @ covariance[3:6, 3:6] @ across)))
        distances.append(float(covariance[2, 2]))
    return float(np.degrees(np.sqrt(np.mean(tilts)))), float(np.sqrt(np.mean(distances))) / DISTANCE_SIDES


def _covariance(points: Array, normals: Array, weight: Array, rotation: Array) -> Array:
    """Return the covariance (7, 7) of translation (sides), rotation (rad) and common edge shift (px)."""
    there = np.array([0.0, 0.0, DISTANCE_SIDES])
    focal = SIDE_PX * DISTANCE_SIDES

    def projected(at: Array) -> Array:
        seen = at @ rotation.T + there
        return np.asarray(focal * seen[:, :2] / seen[:, 2:])

    directions = projected(points + STEP * normals) - projected(points)
    # Perspective preserves the direction along the edge, not its normal in the plane: project the tangent.
    along = projected(points + STEP * normals[:, [1, 0, 2]] * [-1.0, 1.0, 0.0]) - projected(points)
    across = np.column_stack([-along[:, 1], along[:, 0]])
    across *= np.sign((across * directions).sum(axis=1, keepdims=True))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    rotated = points @ rotation.T
    seen = rotated + there
    depth = seen[:, 2:]
    columns = [
        np.column_stack([across * focal / depth, -(across * seen[:, :2]).sum(1) * focal / depth[:, 0] ** 2])
    ]
    columns.append(np.cross(rotated, columns[0]))
    jacobian = np.column_stack([*columns, np.ones(len(points))])
    information = jacobian.T @ (jacobian * weight[:, None])
    information[6, 6] += 1.0 / SHIFT_SD_PX**2
    return np.asarray(np.linalg.inv(information), dtype=float)
