"""Observability of the six motion modes of a bone from swept points."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array

SHIFTS = ("to the left or right", "to the front or back", "along the spine (to head or feet)")
TURNS = (
    "tilting to head or feet (about the left-right axis)",
    "tilting to the side (about the front-back axis)",
    "turning about the spine's own axis",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionMode:
    """An independent rigid motion of a bone, and its uncertainty.

    Attributes:
        direction: (6,) unit vector: a shift in mm and a rotation in mm at the lever, on the CT axes.
        sd_mm: standard deviation; infinite if unobservable.
        description: for a surgeon.
    """

    direction: Array
    sd_mm: float
    description: str


def motion_modes(normal: Array, lever_mm: float) -> list[MotionMode]:
    """Return the six motion modes, least observable first, of a normal matrix (6, 6) in mm and rad.

    Rotations are scaled by the lever, as displacement at the target.
    """
    scale = np.diag([1.0] * 3 + [1.0 / lever_mm] * 3)
    values, directions = np.linalg.eigh(scale @ normal @ scale)
    floor = 1e-9 * max(float(values[-1]), 1e-12)
    found = []
    for value, direction in zip(values, directions.T, strict=True):
        sd = float(1.0 / np.sqrt(value)) if value > floor else np.inf
        found.append(MotionMode(direction=direction, sd_mm=sd, description=description(direction)))
    return found


def description(direction: Array) -> str:
    """Describe the dominant axis of a motion (6,)."""
    shift, turn = float(np.linalg.norm(direction[:3])), float(np.linalg.norm(direction[3:]))
    if shift >= turn:
        return SHIFTS[int(np.argmax(np.abs(direction[:3])))]
    return TURNS[int(np.argmax(np.abs(direction[3:])))]


def principal_extents_mm(points_mm: Array) -> tuple[float, float, float]:
    """Return the extents of points (n, 3) along their principal axes, the longest first; zeros for one point.

    A sweep that is short or narrow leaves motion modes unobservable.
    """
    if len(points_mm) < 2:
        return 0.0, 0.0, 0.0
    off = points_mm - points_mm.mean(axis=0)
    _, _, axes = np.linalg.svd(off, full_matrices=False)
    longest, middle, shortest = (*(float(np.ptp(off @ axis)) for axis in axes), 0.0, 0.0)[:3]
    return longest, middle, shortest
