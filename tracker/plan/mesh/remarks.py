"""Warnings about an imported mesh."""

from collections.abc import Iterator
from dataclasses import dataclass

from tracker.errors import Remark
from tracker.geometry import Array
from tracker.plan.mesh.units import Kind
from tracker.plan.triangles import Connectivity

SEGMENT_AGAIN = "Fill its holes in the segmentation, or use it for display only."


@dataclass(frozen=True, slots=True, kw_only=True)
class Findings:
    """Findings about a mesh; see `MeshSurface`."""

    kind: Kind
    size_mm: Array
    parts: int
    connectivity: Connectivity
    flipped: int
    faces: int
    dropped: int
    mirrored: bool


def remarks_of(found: Findings) -> tuple[Remark, ...]:
    """Return the warnings about a mesh, the most serious first."""
    return tuple(_remarks(found))


def _remarks(found: Findings) -> Iterator[Remark]:
    connectivity = found.connectivity
    if found.kind is Kind.SPINE:
        size = " x ".join(f"{side:.0f}" for side in found.size_mm)
        yield Remark(
            code="MESH_SEVERAL_VERTEBRAE",
            message=f"the mesh is {size} mm, the size of several vertebrae or a whole spine",
            remedy="Register with the surface of one vertebra, as vertebrae are not rigidly connected.",
            context={"size_mm": found.size_mm.tolist(), "size": size},
        )
    if connectivity.border_edges:
        yield Remark(
            code="MESH_OPEN",
            message=f"the mesh is open: {connectivity.border_edges} edges belong to one triangle only",
            remedy=SEGMENT_AGAIN,
            context={"border_edges": connectivity.border_edges},
        )
    if connectivity.non_manifold_edges:
        yield Remark(
            code="MESH_NOT_MANIFOLD",
            message=f"the mesh has {connectivity.non_manifold_edges} edges on which more than two "
            "triangles meet",
            remedy=SEGMENT_AGAIN,
            context={"non_manifold_edges": connectivity.non_manifold_edges},
        )
    if found.flipped:
        yield Remark(
            code="MESH_FLIPPED",
            message=f"{found.flipped} of {found.faces} triangles were inside out and were flipped",
            remedy="Check the surface before planning on it.",
            context={"flipped_faces": found.flipped, "faces": found.faces},
        )
    if found.parts > 1:
        yield Remark(
            code="MESH_IN_PARTS",
            message=f"the mesh has {found.parts} parts that do not touch",
            remedy="To use one bone only, export it alone.",
            context={"parts": found.parts},
        )
    if found.dropped:
        yield Remark(
            code="MESH_CLEANED",
            message=f"{found.dropped} degenerate or duplicate triangles of the mesh were removed",
            context={"dropped_faces": found.dropped},
        )
    if found.mirrored:
        yield Remark(
            code="MESH_FROM_RAS",
            message="the mesh is in RAS; its first two axes were flipped to LPS",
            remedy="Compare the surface with the slices before planning on it.",
        )
