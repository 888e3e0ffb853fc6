"""Poses of a tool with known tip and axis: tilted about a divot, or spun about its axis."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array, rotation_from_vector
from tracker.pose.tool import Poses, pivot_calibration

TIP_MM = (4.0, -120.0, -6.0)
PIVOT_MM = (30.0, -20.0, 500.0)
FACING = rotation_from_vector([2.9, 0.4, 0.2])


@dataclass(frozen=True, slots=True, kw_only=True)
class Hand:
    """Motion of the tool and quality of its poses; angles are half ranges.

    Attributes:
        tilts_deg: along one axis, and perpendicular to it.
        spin_deg: about the direction to the tip.
        shift_sd_mm: noise of each coordinate.
        turn_sd_deg: noise about each axis of the marker.
        outlier_ratio: share of poses that are off by some 10 mm and 2 degrees.

    """

    count: int = 60
    tip_mm: tuple[float, float, float] = TIP_MM
    pivot_mm: tuple[float, float, float] = PIVOT_MM
    tilts_deg: tuple[float, float] = (30.0, 30.0)
    spin_deg: float = 20.0
    shift_sd_mm: float = 0.1
    depth_sd_mm: float = 0.0
    turn_sd_deg: tuple[float, float, float] = (0.1, 0.1, 0.1)
    outlier_ratio: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Pivoted:
    """Poses with their truth."""

    poses: Poses
    tip_mm: Array
    pivot_mm: Array
    is_outlier: npt.NDArray[np.bool_]


def turns(vectors_rad: Array) -> Array:
    return np.array([rotation_from_vector(vector) for vector in vectors_rad])


def pivoted(hand: Hand | None = None, *, seed: int = 0, states_covariance: bool = False) -> Pivoted:
    """Poses of a tool that is tilted evenly over an ellipse with its tip fixed."""
    hand = hand or Hand()
    random = np.random.default_rng(seed)
    tip, pivot = np.array(hand.tip_mm), np.array(hand.pivot_mm)
    lever = FACING @ tip / np.linalg.norm(tip)
    first = np.cross(lever, [1.0, 0.3, 0.2])
    first /= np.linalg.norm(first)
    way = random.uniform(0.0, 2.0 * np.pi, hand.count)
    far = np.sqrt(random.uniform(0.0, 1.0, hand.count))
    along, across = np.radians(hand.tilts_deg)
    tilt = np.outer(along * far * np.cos(way), first) + np.outer(
        across * far * np.sin(way), np.cross(lever, first)
    )
    spin = np.outer(np.radians(hand.spin_deg) * random.uniform(-1.0, 1.0, hand.count), lever)
    rotations = turns(tilt) @ turns(spin) @ FACING
    translations = pivot - rotations @ tip
    sight = translations / np.linalg.norm(translations, axis=1, keepdims=True)
    turn_sd = np.radians(hand.turn_sd_deg)
    noisy = rotations @ turns(random.normal(size=(hand.count, 3)) * turn_sd)
    moved = translations + random.normal(size=(hand.count, 3)) * hand.shift_sd_mm
    moved = moved + sight * random.normal(size=(hand.count, 1)) * hand.depth_sd_mm
    out = random.uniform(size=hand.count) < hand.outlier_ratio
    moved[out] += random.normal(size=(int(out.sum()), 3)) * 8.0
    if out.any():
        noisy[out] = turns(random.normal(size=(int(out.sum()), 3)) * np.radians(2.0)) @ noisy[out]
    covariances = None
    if states_covariance:
        covariances = np.zeros((hand.count, 6, 6))
        covariances[:, :3, :3] = hand.shift_sd_mm**2 * np.eye(3)
        covariances[:, :3, :3] += hand.depth_sd_mm**2 * sight[:, :, None] * sight[:, None, :]
        covariances[:, 3:, 3:] = rotations @ np.diag(turn_sd**2) @ rotations.transpose(0, 2, 1)
    poses = Poses(rotations=noisy, translations_mm=moved, covariances=covariances)
    return Pivoted(poses=poses, tip_mm=tip, pivot_mm=pivot, is_outlier=out)


AXIS = np.array([0.1, -1.0, 0.05]) / np.linalg.norm([0.1, -1.0, 0.05])


def spun(
    *,
    count: int = 60,
    arc_deg: float = 160.0,
    wobble_deg: float = 1.0,
    turn_sd_deg: float = 0.2,
    outliers: int = 0,
    seed: int = 0,
) -> Poses:
    """Poses of a tool spun about `AXIS`, which wavers itself."""
    random = np.random.default_rng(seed)
    angles = np.radians(arc_deg) * random.uniform(-0.5, 0.5, (count, 1))
    wobble = turns(np.radians(wobble_deg) * random.normal(size=(count, 3)))
    rotations = wobble @ FACING @ turns(angles * AXIS)
    rotations = rotations @ turns(np.radians(turn_sd_deg) * random.normal(size=(count, 3)))
    for index in range(outliers):
        rotations[index] = rotation_from_vector(random.normal(size=3) * 0.4) @ rotations[index]
    return Poses(rotations=rotations, translations_mm=np.array(PIVOT_MM) - rotations @ (TIP_MM[1] * -AXIS))


HANDS = {
    "noise like a ball": Hand(shift_sd_mm=0.2, turn_sd_deg=(0.0, 0.0, 0.0)),
    "noise of angles": Hand(shift_sd_mm=0.02, turn_sd_deg=(0.3, 0.3, 0.3)),
    "one camera": Hand(shift_sd_mm=0.03, depth_sd_mm=0.3, turn_sd_deg=(0.3, 0.3, 0.05)),
    "a fifth outliers": Hand(outlier_ratio=0.2),
    "long pointer tilted little": Hand(
        count=80, tip_mm=(-14.0, 390.0, -7.0), tilts_deg=(18.0, 18.0), pivot_mm=(-800, -80, 2100)
    ),
    "few poses": Hand(count=16),
    "tip at the marker's centre": Hand(tip_mm=(0.0, 0.0, 0.5)),
    "stated covariances": Hand(
        count=40, shift_sd_mm=0.03, depth_sd_mm=0.3, turn_sd_deg=(0.3, 0.3, 0.05), outlier_ratio=0.1
    ),
}
# Hands whose poses come with their covariance.
STATED = ("stated covariances",)


def squared_errors(hand: Hand, *, runs: int, states_covariance: bool = False) -> list[float]:
    """Squared errors of the calibrated tip in units of the stated covariance."""
    squared = []
    for seed in range(runs):
        made = pivoted(hand, seed=1000 + seed, states_covariance=states_covariance)
        found = pivot_calibration(made.poses)
        off = found.tip_in_marker_mm - made.tip_mm
        squared.append(float(off @ np.linalg.solve(found.tip_covariance_mm2, off)))
    return squared
