"""Bones and sweeps over them, with a known truth."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from tests.tracker.registration.constellations import any_pose
from tracker.geometry import Anchor, Array, Rigid, Vertebra, rotation_from_vector
from tracker.plan import Surface
from tracker.registration.surface import ClosestPointQuery
from tracker.rehearsal.anatomy import vertebra_surface


@cache
def vertebra() -> Surface:
    return vertebra_surface()


@cache
def closest_points_on_vertebra() -> ClosestPointQuery:
    return ClosestPointQuery(vertebra())


@cache
def corners_from_behind() -> Array:
    """Triangles (n, 3, 3) of the vertebra that a surgeon sees: behind, and facing backwards."""
    corners = vertebra().vertices_mm[vertebra().faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    middles = corners.mean(axis=1)
    return np.asarray(corners[(normals[:, 1] > 0.15) & (middles[:, 1] > 11.0)])


def plate(size_mm: float = 60.0, step_mm: float = 3.0, bumps_mm: float = 0.0) -> Surface:
    """A flat bone, facing backwards (+y), with bumps from voxel to voxel."""
    count = int(size_mm / step_mm) + 1
    along = np.linspace(-size_mm / 2, size_mm / 2, count)
    x, z = (axis.ravel() for axis in np.meshgrid(along, along))
    y = np.random.default_rng(0).normal(size=x.size) * bumps_mm
    cells = [(row * count + column) for row in range(count - 1) for column in range(count - 1)]
    faces = [face for a in cells for face in ((a, a + count, a + 1), (a + 1, a + count, a + count + 1))]
    return Surface(vertices_mm=np.column_stack([x, y, z]), faces=np.array(faces))


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepTruth:
    """Swept points (n, 3) as touched and on the bone, the truth, and a start near it."""

    moving_mm: Array
    on_bone_mm: Array
    fixed_from_moving: Rigid[Vertebra, Anchor]
    start: Rigid[Vertebra, Anchor]


def sweep_over(
    corners: Array,
    rng: np.random.Generator,
    *,
    count: int = 40,
    sd_mm: float = 0.35,
    off_mm: float = 2.0,
    off_deg: float = 2.5,
    lifted_mm: float = 0.0,
) -> SweepTruth:
    """A sweep over triangles (m, 3, 3): `lifted_mm` above them, with noise; the start is off by so much."""
    chosen = corners[rng.choice(len(corners), count, replace=count > len(corners))]
    on_bone = np.einsum("nk,nkj->nj", rng.dirichlet([1.0, 1.0, 1.0], count), chosen)
    normals = np.cross(chosen[:, 1] - chosen[:, 0], chosen[:, 2] - chosen[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    pose = any_pose(rng)
    touched = on_bone + lifted_mm * normals + sd_mm * rng.normal(size=on_bone.shape)
    way, axis = (one / np.linalg.norm(one) for one in rng.normal(size=(2, 3)))
    turn, middle = rotation_from_vector(np.radians(off_deg) * axis), on_bone.mean(axis=0)
    return SweepTruth(
        moving_mm=pose.inverse.move_points(touched),
        on_bone_mm=on_bone,
        fixed_from_moving=pose,
        start=Rigid(
            rotation=turn @ pose.rotation,
            translation_mm=turn @ (pose.translation_mm - middle) + middle + off_mm * way,
        ),
    )
