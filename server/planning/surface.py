"""The surface of the bone, out of a CT or a file, in a process of its own."""

import dataclasses
from dataclasses import dataclass
from pathlib import Path

from server.imaging.meshes import mesh_from_bytes, ply_from_surface
from server.jobs import Report
from server.planning.volume import volume_of
from tracker.errors import InvalidInput
from tracker.plan.bone import BoneSettings, BoneSurface, bone_surface
from tracker.plan.document import plain
from tracker.plan.mesh import MeshSurface
from tracker.plan.mesh.intake import Space

MESH, PLY = "mesh", "surface.ply"
STL_HEADER_BYTES, STL_FACE_BYTES = 84, 50
# What programs write before a binary STL: words, filled up with nothing.
PLAIN, HEAD_BYTES = frozenset((0, *range(32, 127))), 4096


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshOrder:
    """How a file of triangles shall be read.

    Attributes:
        file_format: "stl", "obj" or "ply"; told by its first bytes if None.
        unit: of its numbers; None where they have to show by themselves that they are mm.
        space: LPS or RAS; None takes what the file says.
    """

    file_format: str | None = None
    unit: str | None = None
    space: Space | None = None


def surface_of_ct(
    report: Report, *, path: str, lps_from_ijk: list[list[float]], settings: BoneSettings, folder: str
) -> dict[str, object]:
    """The work itself, in a process of its own: the surface as a file, and what was done."""
    report(0.1, "looking for the bone")
    found = bone_surface(volume_of(path, lps_from_ijk), settings)
    (Path(folder) / PLY).write_bytes(ply_from_surface(found.surface))
    return {"source": "ct", **_told_of(found)}


def surface_of_file(report: Report, *, order: MeshOrder, folder: str) -> dict[str, object]:
    """The same for a file."""
    report(0.1, "reading the triangles")
    content = (Path(folder) / MESH).read_bytes()
    found = mesh_from_bytes(
        content, file_format=order.file_format or format_of(content), unit=order.unit, space=order.space
    )
    (Path(folder) / PLY).write_bytes(ply_from_surface(found.surface))
    return {"source": "file", **_told_of(found)}


def format_of(content: bytes) -> str:
    """The format of a file of triangles, told by its bytes.

    Raises:
        InvalidInput: MESH_FORMAT_UNKNOWN.
    """
    start = content.lstrip()[:2000]
    if start.startswith(b"ply"):
        return "ply"
    faces = int.from_bytes(content[80:STL_HEADER_BYTES], "little")
    is_binary = len(content) == STL_HEADER_BYTES + STL_FACE_BYTES * faces
    # One that was cut off is told as such, by what it announces and has.
    is_cut = (
        len(content) > STL_HEADER_BYTES and b"\0" in content[:HEAD_BYTES] and not set(content[:80]) - PLAIN
    )
    if (len(content) > STL_HEADER_BYTES and is_binary) or (start.startswith(b"solid") and b"facet" in start):
        return "stl"
    if is_cut and faces:
        return "stl"
    if any(line.split()[:1] in ([b"v"], [b"o"], [b"g"], [b"#"], [b"mtllib"]) for line in start.splitlines()):
        return "obj"
    raise InvalidInput(
        "MESH_FORMAT_UNKNOWN",
        f"the file of {len(content)} bytes is neither STL, OBJ nor PLY by what it begins with",
        "Export the bone's surface again as triangles, or name its format.",
        {"bytes": len(content)},
    )


def _told_of(found: BoneSurface | MeshSurface) -> dict[str, object]:
    """Everything but the triangles themselves, and how many there are."""
    surface = found.surface
    told_of = {
        field.name: plain(getattr(found, field.name))
        for field in dataclasses.fields(found)
        if field.name != "surface"
    }
    return {
        "vertices": int(surface.vertices_mm.shape[0]),
        "faces": int(surface.faces.shape[0]),
        "low_lps_mm": surface.vertices_mm.min(axis=0).tolist(),
        "high_lps_mm": surface.vertices_mm.max(axis=0).tolist(),
        **told_of,
    }
