"""Lighting model of the lamp: diffuse shading, highlights and rod shadows."""

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Image32 = npt.NDArray[np.float32]

# In the vertebra's frame: from the patient's left, above, and a little from the camera's side.
TO_LAMP = np.array([0.50, 0.84, -0.22]) / np.linalg.norm([0.50, 0.84, -0.22])
AMBIENT, DIFFUSE = 0.46, 0.74
# A theatre lamp is wide: shadows are soft, and fade with the distance of the occluder.
PENUMBRA_MM, PENUMBRA_PER_MM = 0.7, 0.06
SHADOW_DEPTH, SHADOW_FADES_MM = 0.62, 170.0


def lit(normals: Image32 | Array) -> Image32:
    """Return the brightness (n,) of a matt white surface with unit normals (n, 3) in the vertebra's frame."""
    facing = normals @ TO_LAMP.astype(np.float32)
    # Half Lambert: light comes from many sides in a theatre, nothing is pitch dark.
    wrapped = np.clip(0.5 + 0.5 * facing, 0.0, 1.0)
    return np.asarray(AMBIENT * 0.6 + (DIFFUSE + AMBIENT * 0.4) * wrapped**1.6, dtype=np.float32)


def shine(normals: Image32, to_camera: Image32, hardness: float) -> Image32:
    """Return the highlight (n,) 0..1 for normals (n, 3) seen along unit directions (n, 3)."""
    half = to_camera + TO_LAMP.astype(np.float32)
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    across = np.clip(np.einsum("...i,...i->...", normals, half), 0.0, 1.0)
    return np.asarray(across**hardness, dtype=np.float32)


def rod_shadow(
    points: Image32, tip: Array, along: Array, profile_mm: Array, profile_radius_mm: Array
) -> Image32:
    """Return the shadow of a rod, 0..1, at points (n, 3).

    The rod starts at `tip` and runs along the unit direction `along`; its radius is given over the
    distance from the tip. All in the vertebra's frame, mm. Distances between the rod and the ray to the
    lamp are linear in the point, which makes this cheap.
    """
    slant = float(along @ TO_LAMP)
    lean = max(1.0 - slant**2, 1e-6)
    normal = np.cross(along, TO_LAMP) / np.sqrt(lean)
    # Nearest points: at t along the rod and s along the ray to the lamp.
    t_of = (along - slant * TO_LAMP) / lean
    s_of = (slant * along - TO_LAMP) / lean
    functions = np.stack([normal, t_of, s_of], axis=1)
    values = points @ functions.astype(np.float32) - (tip @ functions).astype(np.float32)
    first, last = float(profile_mm[0]), float(profile_mm[-1])
    out = np.zeros(len(points), dtype=np.float32)
    thickest_mm = float(profile_radius_mm.max())
    near = np.flatnonzero(
        np.abs(values[:, 0]) < thickest_mm + PENUMBRA_MM + PENUMBRA_PER_MM * np.maximum(values[:, 2], 0.0)
    )
    distance, t, s = np.abs(values[near, 0]), values[near, 1], values[near, 2]
    soft = PENUMBRA_MM + PENUMBRA_PER_MM * np.maximum(s, 0.0)
    radius = np.interp(t, profile_mm, profile_radius_mm).astype(np.float32)
    covered = np.clip((radius + soft - distance) / (2.0 * soft), 0.0, 1.0)
    # A rod thinner than its penumbra never occludes the whole lamp.
    strength = np.minimum(1.0, radius / soft * 1.6) * np.exp(-np.maximum(s, 0.0) / SHADOW_FADES_MM)
    ends = np.clip((t - first + soft) / soft, 0, 1) * np.clip((last - t + soft) / soft, 0, 1)
    out[near] = SHADOW_DEPTH * covered * strength * ends * (s > 0.0)
    return out
