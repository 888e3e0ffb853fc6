"""Labelled CTs for tests: the vertebra of the rehearsal, once or as a spine of equal vertebrae."""

import functools
from collections.abc import Sequence

import numpy as np

from tracker.geometry import Array
from tracker.plan import Volume
from tracker.plan.labels import CLASS_OF_LEVEL, LabelVolume
from tracker.rehearsal.anatomy import bone_field
from tracker.rehearsal.ct.rehearsal_ct import CORTEX_HU, CORTEX_MM, MARROW_HU, TISSUE_HU

# Distance between the vertebrae of the spine: the height of an L3 with its disc.
STEP_MM = 38.0


def bone_at(points_lps_mm: Array, levels: int) -> tuple[Array, Array]:
    """Field of the nearest of equal vertebrae below each other, the first at the origin, and which it is."""
    fields = [bone_field(points_lps_mm + np.array([0.0, 0.0, n * STEP_MM])) for n in range(levels)]
    return np.min(fields, axis=0), np.argmin(fields, axis=0)


def labelled_spine(
    levels: Sequence[str] = ("L3",),
    *,
    spacing_mm: tuple[float, float, float] = (1.0, 1.0, 1.0),
    rotation: Array | None = None,
    noise_hu: float = 15.0,
) -> tuple[Volume, LabelVolume]:
    """CT and true labels of vertebrae from the head down; `rotation` turns the patient about the origin."""
    low = np.array([-52.0, -50.0, -40.0 - (len(levels) - 1) * STEP_MM])
    high = np.array([52.0, 60.0, 36.0])
    turn = np.eye(3) if rotation is None else rotation
    if rotation is not None:
        corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1)
        low, high = (turn @ corners).min(axis=1), (turn @ corners).max(axis=1)
    shape = np.ceil((high - low) / spacing_mm).astype(int)
    affine = np.diag([*spacing_mm, 1.0])
    affine[:3, 3] = low
    labels = np.zeros(shape[::-1], dtype=np.uint8)
    hu = np.empty(shape[::-1], dtype=np.int16)
    random = np.random.default_rng(1)
    numbers = np.array([CLASS_OF_LEVEL[level] for level in levels], dtype=np.uint8)
    j, i = np.meshgrid(np.arange(shape[1]), np.arange(shape[0]), indexing="ij")
    for k in range(shape[2]):
        index = np.stack([i, j, np.full(i.shape, k)], axis=-1).reshape(-1, 3)
        field, nearest = bone_at((index * spacing_mm + low) @ turn, len(levels))
        values = np.where(field < 0.0, np.where(field < -CORTEX_MM, MARROW_HU, CORTEX_HU), TISSUE_HU)
        hu[k] = np.rint(values + random.normal(0.0, noise_hu, len(values))).reshape(i.shape)
        labels[k] = np.where(field < 0.0, numbers[nearest], 0).reshape(i.shape)
    volume = Volume(hu=hu, lps_from_ijk=affine)
    return volume, LabelVolume(labels=labels, lps_from_ijk=affine, voxel_mm=max(spacing_mm))


@functools.cache
def three_levels() -> tuple[Volume, LabelVolume]:
    """L3 at the origin of the rehearsal's frame, L4 and L5 below."""
    return labelled_spine(("L3", "L4", "L5"))
