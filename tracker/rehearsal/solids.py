"""Meshes of round objects: needles, heads, bent steel."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array, Rigid, Vertebra
from tracker.rehearsal.placement import Room

SIDES = 14
Colour = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """A coloured mesh in the vertebra's frame.

    Attributes:
        vertices_mm: (n, 3).
        normals: (n, 3), unit, outwards.
        faces: (m, 3), counter-clockwise seen from outside.
        colours: (n, 3), BGR 0..1.
        gloss: (n,), strength of the highlight 0..1.
    """

    vertices_mm: Array
    normals: Array
    faces: npt.NDArray[np.int64]
    colours: Array
    gloss: Array


def tube(points_mm: Array, radii_mm: Array, *, colour: Colour, gloss: float) -> Solid:
    """Return a round bar along points (n, 3) with a radius at each; open ends."""
    points, radii = np.asarray(points_mm, dtype=np.float64), np.asarray(radii_mm, dtype=np.float64)
    along = np.gradient(points, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    # One direction that is across for the whole bar keeps the rings from twisting.
    spread = points - points.mean(axis=0)
    apart = np.linalg.svd(spread)[2][2]
    across = np.cross(along, apart)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    third = np.cross(along, across)
    angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
    normals = np.cos(angle)[None, :, None] * across[:, None] + np.sin(angle)[None, :, None] * third[:, None]
    vertices = points[:, None] + radii[:, None, None] * normals
    return _solid(vertices, normals, colour, gloss)


def ball(centre_mm: Array, radius_mm: float, *, colour: Colour, gloss: float) -> Solid:
    """Return a sphere."""
    polar = np.linspace(1e-3, np.pi - 1e-3, 11)
    centre = np.asarray(centre_mm, dtype=np.float64)
    points = centre + np.stack([np.zeros(11), np.zeros(11), -np.cos(polar) * radius_mm], axis=1)
    solid = tube(
        points + np.outer(np.zeros(11), [1, 0, 0]), np.sin(polar) * radius_mm, colour=colour, gloss=gloss
    )
    normals = (solid.vertices_mm - centre) / radius_mm
    return Solid(
        vertices_mm=solid.vertices_mm,
        normals=normals,
        faces=solid.faces,
        colours=solid.colours,
        gloss=solid.gloss,
    )


def joined(solids: Sequence[Solid]) -> Solid:
    """Return all solids as one mesh."""
    starts = np.cumsum([0, *(len(solid.vertices_mm) for solid in solids[:-1])])
    return Solid(
        vertices_mm=np.concatenate([solid.vertices_mm for solid in solids]),
        normals=np.concatenate([solid.normals for solid in solids]),
        faces=np.concatenate([solid.faces + start for solid, start in zip(solids, starts, strict=True)]),
        colours=np.concatenate([solid.colours for solid in solids]),
        gloss=np.concatenate([solid.gloss for solid in solids]),
    )


def moved(solid: Solid, room_from_vertebra: Rigid[Room, Vertebra]) -> Solid:
    """Return the solid in the room's frame."""
    return Solid(
        vertices_mm=room_from_vertebra.move_points(solid.vertices_mm),
        normals=room_from_vertebra.rotate_directions(solid.normals),
        faces=solid.faces,
        colours=solid.colours,
        gloss=solid.gloss,
    )


def _solid(vertices: Array, normals: Array, colour: Colour, gloss: float) -> Solid:
    rings = vertices.shape[0]
    ring, side = np.meshgrid(np.arange(rings - 1), np.arange(SIDES), indexing="ij")
    here, beside = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
    quads = np.stack([here, beside, beside + SIDES, here + SIDES], axis=-1).reshape(-1, 4)
    count = rings * SIDES
    return Solid(
        vertices_mm=vertices.reshape(-1, 3),
        normals=normals.reshape(-1, 3),
        faces=np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int64),
        colours=np.tile(np.asarray(colour, dtype=np.float64), (count, 1)),
        gloss=np.full(count, gloss),
    )
