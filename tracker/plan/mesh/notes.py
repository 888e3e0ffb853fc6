"""What the user should know of a mesh that is used."""

from collections.abc import Iterator
from dataclasses import dataclass

from tracker.geometry import Array
from tracker.plan.mesh.units import Kind
from tracker.plan.remark import Remark
from tracker.plan.triangles import Links

SEGMENT_AGAIN = "Fill its holes where it was segmented, or use it to look at only."


@dataclass(frozen=True, slots=True, kw_only=True)
class Findings:
    """What was found in a mesh; see `MeshSurface`."""

    kind: Kind
    size_mm: Array
    parts: int
    links: Links
    turned: int
    faces: int
    dropped: int
    mirrored: bool


def remarks_of(found: Findings) -> tuple[Remark, ...]:
    """The remarks on a mesh, the most serious first."""
    return tuple(_remarks(found))


def _remarks(found: Findings) -> Iterator[Remark]:
    links = found.links
    if found.kind is Kind.SPINE:
        size = " x ".join(f"{side:.0f}" for side in found.size_mm)
        yield Remark(
            code="MESH_SEVERAL_VERTEBRAE",
            message=f"the mesh is {size} mm, the size of several vertebrae or a whole spine",
            remedy="Register on one vertebra: take its surface alone, as vertebrae move against each other.",
            context={"size_mm": found.size_mm.tolist()},
        )
    if links.border_edges:
        yield Remark(
            code="MESH_OPEN",
            message=f"the mesh is open: {links.border_edges} edges belong to one triangle only",
            remedy=SEGMENT_AGAIN,
            context={"border_edges": links.border_edges},
        )
    if links.crowded_edges:
        yield Remark(
            code="MESH_NOT_MANIFOLD",
            message=f"the mesh has {links.crowded_edges} edges on which more than two triangles meet",
            remedy=SEGMENT_AGAIN,
            context={"crowded_edges": links.crowded_edges},
        )
    if found.turned:
        yield Remark(
            code="MESH_TURNED",
            message=f"{found.turned} of {found.faces} triangles of the mesh were inside out, and were turned",
            remedy="Look at the surface before planning on it.",
            context={"turned_faces": found.turned, "faces": found.faces},
        )
    if found.parts > 1:
        yield Remark(
            code="MESH_IN_PARTS",
            message=f"the mesh has {found.parts} parts that do not touch",
            remedy="If one bone is wanted, export it alone.",
            context={"parts": found.parts},
        )
    if found.dropped:
        yield Remark(
            code="MESH_CLEANED",
            message=f"{found.dropped} triangles of the mesh without area, or there twice, were left out",
            remedy="Nothing needs to be done.",
            context={"dropped_faces": found.dropped},
        )
    if found.mirrored:
        yield Remark(
            code="MESH_FROM_RAS",
            message="the mesh is in RAS; its first two axes were turned to LPS",
            remedy="Compare the surface with the slices before planning on it.",
        )
