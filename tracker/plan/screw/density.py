"""Bone density along a screw."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.plan.channel import Channel
from tracker.plan.volume import Volume

STEP_MM = 0.5
RINGS = (0.0, 0.5, 1.0)
ROUND = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class BoneAlong:
    """HU along a screw: means over its section, starting at the entry.

    Attributes:
        along_mm: (n,), from the entry.
        hu: (n,).
        mean_hu: over the whole screw.
        min_hu: the lowest of `hu`.
        inside_ratio: share of the screw that lies within the CT.
    """

    along_mm: Array
    hu: Array
    mean_hu: float
    min_hu: float
    inside_ratio: float


def bone_along(volume: Volume, channel: Channel, *, diameter_mm: float, length_mm: float) -> BoneAlong:
    """Return the HU of the bone that a screw on the channel's axis replaces."""
    along = np.arange(0.0, max(length_mm, STEP_MM) + 1e-9, STEP_MM)
    axis = channel.axis_in_vertebra
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(axis, helper)
    first /= np.linalg.norm(first)
    second = np.cross(axis, first)
    angle = 2.0 * np.pi * np.arange(ROUND) / ROUND
    ring = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * second
    offsets = np.concatenate([share * 0.5 * diameter_mm * ring for share in RINGS])
    points = channel.entry_in_vertebra_mm + along[:, None, None] * axis + offsets
    # Rings are weighted by area, so that the mean is that of the section.
    weight = np.repeat([0.25, 1.0, 0.75], ROUND)
    hu = volume.sample_hu(points) @ weight / weight.sum()
    hu.setflags(write=False)
    along.setflags(write=False)
    return BoneAlong(
        along_mm=along,
        hu=hu,
        mean_hu=float(hu.mean()),
        min_hu=float(hu.min()),
        inside_ratio=float(volume.contains(points).mean()),
    )
