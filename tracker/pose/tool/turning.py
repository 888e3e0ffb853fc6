"""How far the tool was tilted and spun, and whether that was enough to know its tip."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, rotation_between
from tracker.pose.tool.poses import Poses

# The range of an even sweep, by its standard deviation.
RANGE_BY_SD = float(np.sqrt(12.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Turning:
    """How a tool was moved, in degrees from one end to the other.

    Attributes:
        tilt_range_deg: of the direction from marker to tip, the way in which it moved most.
        tilt_range_across_deg: the same, at right angles to that way.
        spin_range_deg: about the direction from marker to tip.
        min_turn_deg: what decides whether the tip can be known: the range of an even sweep that would move
            the marker's least moved direction as much. Tilted in one plane alone, the direction across that
            plane does not move, and where the tip lies along it is anybody's guess.
    """

    tilt_range_deg: float
    tilt_range_across_deg: float
    spin_range_deg: float
    min_turn_deg: float


def min_turn_deg(poses: Poses) -> float:
    """See `Turning.min_turn_deg`."""
    off = poses.rotations - poses.rotations.mean(axis=0)
    moved = np.einsum("nij,nik->jk", off, off) / len(poses)
    least = max(float(np.linalg.eigvalsh(moved)[0]), 0.0)
    # A chord's length and its angle are one at the sizes at which this decides.
    return RANGE_BY_SD * float(np.degrees(np.sqrt(least)))


def turning_of(poses: Poses, tip_in_marker_mm: Array) -> Turning:
    """How the tool with this tip (3,) was moved in these poses."""
    length = float(np.linalg.norm(tip_in_marker_mm))
    # A tip at the marker's centre has no direction: then the marker's normal is watched.
    along = tip_in_marker_mm / length if length > 1.0 else np.array([0.0, 0.0, 1.0])
    wide, narrow = tilt_ranges_deg(poses, along)
    return Turning(
        tilt_range_deg=wide,
        tilt_range_across_deg=narrow,
        spin_range_deg=spin_range_deg(poses, along),
        min_turn_deg=min_turn_deg(poses),
    )


def tilt_ranges_deg(poses: Poses, along: Array) -> tuple[float, float]:
    """Ranges of a unit direction (3,) of the marker: the way in which it moved most, and across it."""
    directions = poses.rotations @ along
    mean = _middle(directions)
    across = np.linalg.svd(mean[None, :])[2][1:]
    sideways = directions @ across.T
    # Angle from the middle, kept in its direction: a map on which distances from the middle are true.
    sine = np.linalg.norm(sideways, axis=1, keepdims=True)
    angle = np.arctan2(sine, (directions @ mean)[:, None])
    flat = sideways * np.divide(angle, sine, out=np.ones_like(sine), where=sine > 1e-12)
    _, ways = np.linalg.eigh(flat.T @ flat)
    ranges = np.degrees(np.ptp(flat @ ways, axis=0))
    return float(ranges.max()), float(ranges.min())


def spin_range_deg(poses: Poses, along: Array) -> float:
    """The arc that holds all angles about a unit direction (3,) of the marker; tilts are taken out first."""
    angles = np.sort(spin_angles_deg(poses, along))
    gaps = np.diff(angles, append=angles[0] + 360.0)
    return float(360.0 - gaps.max())


def spin_angles_deg(poses: Poses, along: Array) -> Array:
    """Angles (n,) -180..180 about a unit direction (3,) of the marker; tilts are taken out first."""
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
