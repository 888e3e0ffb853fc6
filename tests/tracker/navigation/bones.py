"""Simple bones with known dimensions, and drills placed on their channels."""

import numpy as np
import numpy.typing as npt
import trimesh

from tracker.geometry import Array, Rigid, Tool, Vertebra, rotation_between
from tracker.navigation.directions import channel_directions
from tracker.plan import Channel, Surface

# A rod straight forwards, from y = 20 behind to y = -40 in front.
ROD_RADIUS_MM, ROD_BACK_MM, ROD_FRONT_MM = 5.0, 20.0, -40.0
ROD_CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=np.array([0.0, ROD_BACK_MM, 0.0]),
    target_in_vertebra_mm=np.array([0.0, ROD_FRONT_MM + 5.0, 0.0]),
    radius_mm=4.0,
)


def rod(
    radius_mm: float = ROD_RADIUS_MM, *, turned_inside_out: bool = False, shorter_mm: float = 0.0
) -> Surface:
    """The rod; a shorter one with inverted faces is its marrow."""
    middle = np.array([0.0, 0.5 * (ROD_BACK_MM + ROD_FRONT_MM), 0.0])
    length = ROD_BACK_MM - ROD_FRONT_MM - 2.0 * shorter_mm
    mesh = trimesh.creation.cylinder(radius=radius_mm, height=length, sections=96)
    faces = mesh.faces[:, ::-1] if turned_inside_out else mesh.faces
    # A rotation about the patient's left-right axis lays it down.
    return Surface(vertices_mm=mesh.vertices[:, [0, 2, 1]] * [1.0, -1.0, 1.0] + middle, faces=faces)


def together(*surfaces: Surface) -> Surface:
    """Several surfaces merged."""
    starts = np.cumsum([0, *[len(each.vertices_mm) for each in surfaces]])
    return Surface(
        vertices_mm=np.concatenate([each.vertices_mm for each in surfaces]),
        faces=np.concatenate([each.faces + start for each, start in zip(surfaces, starts, strict=False)]),
    )


def without_faces(surface: Surface, where: npt.NDArray[np.bool_]) -> Surface:
    """The surface without the triangles whose centre is flagged."""
    return Surface(vertices_mm=surface.vertices_mm, faces=surface.faces[~where])


def middles_mm(surface: Surface) -> Array:
    """The centre (m, 3) of each triangle."""
    return np.asarray(surface.vertices_mm[surface.faces].mean(axis=1))


def drill_at(
    channel: Channel,
    depth_mm: float,
    *,
    medial_mm: float = 0.0,
    cranial_mm: float = 0.0,
    medial_deg: float = 0.0,
    cranial_deg: float = 0.0,
) -> Rigid[Vertebra, Tool]:
    """A drill with an offset and angles at the entry, and its tip at a depth along the channel."""
    across = channel_directions(channel, "left" if "left" in channel.name else "right")
    slope = np.tan(np.radians([medial_deg, cranial_deg]))
    way = across.axis + slope[0] * across.medial + slope[1] * across.cranial
    entry = channel.entry_in_vertebra_mm + medial_mm * across.medial + cranial_mm * across.cranial
    return Rigid(rotation=rotation_between([0.0, 0.0, 1.0], way), translation_mm=entry + depth_mm * way)
