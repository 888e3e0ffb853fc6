"""A lumbar vertebra as one smooth implicit surface, with the spinal canal removed.

Synthetic: ellipsoids and capsules with the proportions of an L3 (width over the transverse processes about
90 mm, body 49 x 36 x 30 mm, pedicles about 9 mm wide), joined by a smooth minimum. Vertebra frame
(LPS, mm): x to the patient's left, y backwards, z to the head; the origin lies in the canal. The shape is
symmetric, so only the left half is given.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.plan import Channel, Surface
from tracker.rehearsal.meshing import surface_net

Field = npt.NDArray[np.float32]
Triple = tuple[float, float, float]

GRID_STEP_MM = 1.5
GRID_Y_MM = (-45.0, 57.0)
GRID_Z_MM = (-34.5, 31.5)
GRID_X_END_MM = 51.0
BLEND_MM = 4.0

BODY_CENTRE_Y_MM, BODY_HALF_MM = -25.4, (24.6, 18.0, 15.0)
CANAL_CENTRE_Y_MM, CANAL_HALF_MM = 1.0, (11.2, 8.5)

PEDICLE_POINT_MM = np.array([16.0, 0.0, 4.5])
CHANNEL_DIRECTION = np.array([-0.165, -0.985, -0.04])
CHANNEL_RADIUS_MM = 3.75
TARGET_Y_MM = -28.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Limb:
    """A tapered capsule, scaled along the axes."""

    start_mm: Triple
    end_mm: Triple
    start_radius_mm: float
    end_radius_mm: float
    squash: Triple = (1.0, 1.0, 1.0)


LIMBS = (
    # pedicle: an upright oval between body and arch
    Limb(
        start_mm=(12.8, -18.0, 4.0),
        end_mm=(18.0, 11.0, 4.8),
        start_radius_mm=7.6,
        end_radius_mm=7.4,
        squash=(0.64, 0.64, 1.0),
    ),
    # articular pillar, superior and inferior articular process, mammillary process
    Limb(start_mm=(17.6, 11.0, 8.0), end_mm=(15.5, 13.0, -12.0), start_radius_mm=6.6, end_radius_mm=5.8),
    Limb(
        start_mm=(19.0, 10.5, 10.0),
        end_mm=(20.2, 13.5, 21.5),
        start_radius_mm=6.6,
        end_radius_mm=5.4,
        squash=(0.8, 1.0, 1.0),
    ),
    Limb(
        start_mm=(14.6, 14.0, -10.0),
        end_mm=(13.2, 17.0, -24.5),
        start_radius_mm=6.4,
        end_radius_mm=5.6,
        squash=(1.0, 0.72, 1.0),
    ),
    Limb(start_mm=(21.0, 15.5, 12.0), end_mm=(21.5, 18.0, 13.5), start_radius_mm=3.4, end_radius_mm=2.6),
    # transverse process, flat from front to back
    Limb(
        start_mm=(19.0, 9.5, 3.0),
        end_mm=(41.6, 13.5, 6.0),
        start_radius_mm=7.2,
        end_radius_mm=4.4,
        squash=(1.0, 0.62, 1.0),
    ),
    # lamina: a plate from the pillar to the midline
    Limb(
        start_mm=(15.0, 12.5, -3.0),
        end_mm=(1.5, 21.5, -8.0),
        start_radius_mm=9.0,
        end_radius_mm=9.0,
        squash=(0.42, 0.42, 1.0),
    ),
    # spinous process: a hatchet blade with a thicker edge
    Limb(
        start_mm=(0.0, 21.0, -6.0),
        end_mm=(0.0, 42.0, -10.0),
        start_radius_mm=9.0,
        end_radius_mm=9.5,
        squash=(0.42, 1.0, 1.0),
    ),
    Limb(start_mm=(0.0, 47.5, -4.0), end_mm=(0.0, 46.0, -18.0), start_radius_mm=3.6, end_radius_mm=4.4),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Needle:
    """A landmark needle in the bone.

    Attributes:
        tip_in_vertebra_mm: (3,), inside the bone.
        head_in_vertebra_mm: (3,), the free end.
        radius_mm: of the wire.
    """

    tip_in_vertebra_mm: Array
    head_in_vertebra_mm: Array
    radius_mm: float


def bone_field(points_mm: npt.ArrayLike) -> Field:
    """Return the implicit bone function at points (..., 3): below 0 inside, roughly mm near the surface."""
    p = np.asarray(points_mm, dtype=np.float32)
    x, y, z = np.abs(p[..., 0]), p[..., 1], p[..., 2]
    field = _body(x, y, z)
    for limb in LIMBS:
        field = _smooth_min(field, _limb(x, y, z, limb), BLEND_MM)
    return -_smooth_min(-field, canal_field(p), 1.5)


def canal_field(points_mm: npt.ArrayLike) -> Field:
    """Return the implicit function of the spinal canal at points (..., 3): below 0 inside."""
    p = np.asarray(points_mm, dtype=np.float32)
    x, y = p[..., 0], p[..., 1]
    half_x, half_y = CANAL_HALF_MM
    oval = np.sqrt((x / half_x) ** 2 + ((y - CANAL_CENTRE_Y_MM) / half_y) ** 2)
    return np.asarray((oval - 1.0) * half_y, dtype=np.float32)


def bone_normals(points_mm: npt.ArrayLike, reach_mm: float = 0.4) -> Array:
    """Return outward unit normals (n, 3) at points (n, 3), by differences over `reach_mm`."""
    p = np.asarray(points_mm, dtype=np.float64)
    gradient = _gradient(p, reach_mm)
    length = np.linalg.norm(gradient, axis=1, keepdims=True)
    return np.asarray(gradient / np.maximum(length, 1e-9), dtype=np.float64)


@lru_cache(maxsize=1)
def vertebra_surface() -> Surface:
    """Return the closed bone surface, outward winding, about 15 thousand faces."""
    xs = np.arange(0.0, GRID_X_END_MM + 1e-6, GRID_STEP_MM, dtype=np.float32)
    ys = np.arange(GRID_Y_MM[0], GRID_Y_MM[1] + 1e-6, GRID_STEP_MM, dtype=np.float32)
    zs = np.arange(GRID_Z_MM[0], GRID_Z_MM[1] + 1e-6, GRID_STEP_MM, dtype=np.float32)
    half = bone_field(np.stack(np.meshgrid(xs, ys, zs, indexing="ij"), axis=-1))
    values = np.concatenate([half[:0:-1], half])
    origin = (-float(xs[-1]), float(ys[0]), float(zs[0]))
    vertices, faces = surface_net(values, origin_mm=origin, step_mm=GRID_STEP_MM)
    # The net's vertices sit in the middle of their cells' crossings; pull them onto the shape itself.
    for _ in range(2):
        gradient = _gradient(vertices, 0.3)
        step = bone_field(vertices)[:, None] * gradient / np.maximum((gradient**2).sum(1), 0.05)[:, None]
        vertices = vertices - np.clip(step, -0.5, 0.5)
    return Surface(vertices_mm=vertices, faces=faces)


@lru_cache(maxsize=1)
def pedicle_channels() -> tuple[Channel, ...]:
    """Return the left and right channel, each along the axis of its pedicle."""
    return (_channel("L3 left", 1.0), _channel("L3 right", -1.0))


@lru_cache(maxsize=1)
def landmark_needles() -> tuple[Needle, ...]:
    """Return the needles of the paper: one in a superior articular process, two on the spinous process."""
    ends: tuple[tuple[Triple, Triple], ...] = (
        ((-19.5, 12.5, 17.0), (-24.0, 56.0, 30.0)),
        ((0.0, 40.0, -3.0), (-3.0, 84.0, 14.0)),
        ((0.0, 41.0, -15.0), (-2.0, 88.0, -24.0)),
    )
    return tuple(
        Needle(tip_in_vertebra_mm=np.array(tip), head_in_vertebra_mm=np.array(head), radius_mm=0.8)
        for tip, head in ends
    )


def _channel(name: str, side: float) -> Channel:
    mirror = np.array([side, 1.0, 1.0])
    direction = CHANNEL_DIRECTION / np.linalg.norm(CHANNEL_DIRECTION) * mirror
    middle = PEDICLE_POINT_MM * mirror
    steps_mm = np.arange(0.0, 60.0, 0.02)
    outside = bone_field(middle - steps_mm[:, None] * direction) > 0.0
    entry = middle - steps_mm[int(np.argmax(outside))] * direction
    target = middle + direction * ((TARGET_Y_MM - middle[1]) / direction[1])
    return Channel(
        name=name, entry_in_vertebra_mm=entry, target_in_vertebra_mm=target, radius_mm=CHANNEL_RADIUS_MM
    )


def _body(x: Field, y: Field, z: Field) -> Field:
    """Implicit function of the vertebral body: an elliptic cylinder with a waist and concave endplates."""
    half_x, half_y, half_z = BODY_HALF_MM
    waist = 1.0 - 0.08 * np.clip(1.0 - (z / half_z) ** 2, 0.0, 1.0)
    oval = np.sqrt((x / half_x) ** 2 + ((y - BODY_CENTRE_Y_MM) / half_y) ** 2)
    wall = (oval - waist) * half_y
    hollow = 1.4 * np.clip(1.0 - oval**2, 0.0, 1.0)
    plate = np.asarray(np.abs(z) - half_z + hollow, dtype=np.float32)
    return np.asarray(-_smooth_min(-wall, -plate, 5.0), dtype=np.float32)


def _limb(x: Field, y: Field, z: Field, limb: Limb) -> Field:
    sx, sy, sz = limb.squash
    (ax, ay, az), (bx, by, bz) = limb.start_mm, limb.end_mm
    ux, uy, uz = (bx - ax) / sx, (by - ay) / sy, (bz - az) / sz
    px, py, pz = (x - ax) / sx, (y - ay) / sy, (z - az) / sz
    along = np.clip((px * ux + py * uy + pz * uz) / (ux * ux + uy * uy + uz * uz), 0.0, 1.0)
    distance = np.sqrt((px - along * ux) ** 2 + (py - along * uy) ** 2 + (pz - along * uz) ** 2)
    radius = limb.start_radius_mm + along * (limb.end_radius_mm - limb.start_radius_mm)
    return np.asarray((distance - radius) * min(limb.squash), dtype=np.float32)


def _smooth_min(a: Field, b: Field, width_mm: float) -> Field:
    """Smooth minimum of two fields, blended over `width_mm`."""
    overlap = np.maximum(width_mm - np.abs(a - b), 0.0)
    return np.asarray(np.minimum(a, b) - overlap * overlap * (0.25 / width_mm), dtype=np.float32)


def _gradient(points_mm: Array, reach_mm: float) -> Array:
    # Four corners of a tetrahedron give a gradient in four evaluations in place of six.
    corners = np.array([[1, -1, -1], [-1, -1, 1], [-1, 1, -1], [1, 1, 1]], dtype=np.float64)
    values = bone_field(points_mm[:, None, :] + reach_mm * corners)
    return np.asarray(values @ corners / (4.0 * reach_mm), dtype=np.float64)
