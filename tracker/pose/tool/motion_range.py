"""Range of tilt and spin of a tool over its poses, and whether it determines the tip."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, rotation_between
from tracker.pose.tool.poses import Poses

# Ratio of the range of a uniform distribution to its standard deviation.
RANGE_BY_SD = float(np.sqrt(12.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolMotionRange:
    """Rotation ranges of a tool, in degrees from end to end.

    Attributes:
        tilt_range_deg: range of the direction from marker to tip, along its main direction of motion.
        tilt_range_across_deg: the same, perpendicular to that direction.
        spin_range_deg: range about the direction from marker to tip.
        min_rotation_deg: range of a uniform sweep with the variance of the marker direction that moves least.
            It determines the observability of the tip: with tilts in one plane, the direction perpendicular
            to that plane does not move, and the tip is not observable along it.
    """

    tilt_range_deg: float
    tilt_range_across_deg: float
    spin_range_deg: float
    min_rotation_deg: float


def min_rotation_deg(poses: Poses) -> float:
    """Return `ToolMotionRange.min_rotation_deg`."""
    off = poses.rotations - poses.rotations.mean(axis=0)
    moved = np.einsum("nij,nik->jk", off, off) / len(poses)
    minimum = max(float(np.linalg.eigvalsh(moved)[0]), 0.0)
    # Chord and angle are nearly equal near the limit.
    return RANGE_BY_SD * float(np.degrees(np.sqrt(minimum)))


def motion_range_of(poses: Poses, tip_in_marker_mm: Array) -> ToolMotionRange:
    """Return the motion range of a tool with this tip (3,) over the poses."""
    length = float(np.linalg.norm(tip_in_marker_mm))
    # A tip at the marker's centre has no direction, so the marker's normal is used.
    along = tip_in_marker_mm / length if length > 1.0 else np.array([0.0, 0.0, 1.0])
    wide, narrow = tilt_ranges_deg(poses, along)
    return ToolMotionRange(
        tilt_range_deg=wide,
        tilt_range_across_deg=narrow,
        spin_range_deg=spin_range_deg(poses, along),
        min_rotation_deg=min_rotation_deg(poses),
    )


def tilt_ranges_deg(poses: Poses, along: Array) -> tuple[float, float]:
    """Return the tilt ranges of a unit direction (3,) of the marker: along its main motion, and across."""
    directions = poses.rotations @ along
    mean = _middle(directions)
    across = np.linalg.svd(mean[None, :])[2][1:]
    sideways = directions @ across.T
    # Azimuthal equidistant projection about the mean direction.
    sine = np.linalg.norm(sideways, axis=1, keepdims=True)
    angle = np.arctan2(sine, (directions @ mean)[:, None])
    flat = sideways * np.divide(angle, sine, out=np.ones_like(sine), where=sine > 1e-12)
    _, ways = np.linalg.eigh(flat.T @ flat)
    ranges = np.degrees(np.ptp(flat @ ways, axis=0))
    return float(ranges.max()), float(ranges.min())


def spin_range_deg(poses: Poses, along: Array) -> float:
    """Return the smallest arc that contains all spin angles about a unit direction (3,) of the marker."""
    angles = np.sort(spin_angles_deg(poses, along))
    gaps = np.diff(angles, append=angles[0] + 360.0)
    return float(360.0 - gaps.max())


def spin_angles_deg(poses: Poses, along: Array) -> Array:
    """Return the spin angles (n,), -180..180, about a unit direction (3,) of the marker, without tilts."""
    directions = poses.rotations @ along
    mean = _middle(directions)
    aside = np.linalg.svd(along[None, :])[2][1]
    seen = [
        rotation_between(direction, mean) @ rotation @ aside
        for direction, rotation in zip(directions, poses.rotations, strict=True)
    ]
    first, second = np.linalg.svd(mean[None, :])[2][1:]
    return np.asarray(np.degrees(np.arctan2(np.array(seen) @ second, np.array(seen) @ first)))


def _middle(directions: Array) -> Array:
    mean = directions.mean(axis=0)
    length = float(np.linalg.norm(mean))
    return np.asarray(mean / length if length > 1e-9 else directions[0])
