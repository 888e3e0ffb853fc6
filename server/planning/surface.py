"""Job functions that create the bone surface from a CT or a mesh file, and measure distances to it."""

import dataclasses
from dataclasses import dataclass
from pathlib import Path

from server.imaging.meshes import mesh_from_bytes, ply_from_surface
from server.jobs import Report
from server.planning.volume import load_volume
from tracker.errors import InvalidInput
from tracker.navigation.clearance import WallSelection, select_wall
from tracker.plan import Channel, PedicleMeasure
from tracker.plan.bone import BoneSettings, BoneSurface, bone_surface
from tracker.plan.document import plain
from tracker.plan.mesh import MeshSurface
from tracker.plan.mesh.intake import Space

MESH, PLY = "mesh", "surface.ply"
STL_HEADER_BYTES, STL_FACE_BYTES = 84, 50
# Bytes in the header of a binary STL: printable text, padded with zeros.
PLAIN, HEAD_BYTES = frozenset((0, *range(32, 127))), 4096


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshRequest:
    """Options for reading a mesh file.

    Attributes:
        file_format: "stl", "obj" or "ply"; None detects it from the content.
        unit: unit of the coordinates; None accepts only a mesh whose size is plausible in mm.
        space: LPS or RAS; None for that stated in the file.
    """

    file_format: str | None = None
    unit: str | None = None
    space: Space | None = None


def surface_of_ct(
    report: Report, *, path: str, lps_from_ijk: list[list[float]], settings: BoneSettings, folder: str
) -> dict[str, object]:
    """Extract the surface from a CT, write it to a file, and return its properties."""
    report(0.1, "extracting the bone")
    found = bone_surface(load_volume(path, lps_from_ijk), settings)
    (Path(folder) / PLY).write_bytes(ply_from_surface(found.surface))
    return {"source": "ct", **_summary(found)}


def surface_of_file(report: Report, *, order: MeshRequest, folder: str) -> dict[str, object]:
    """Import the surface from a mesh file, write it to a file, and return its properties."""
    report(0.1, "reading the triangles")
    content = (Path(folder) / MESH).read_bytes()
    found = mesh_from_bytes(
        content, file_format=order.file_format or format_of(content), unit=order.unit, space=order.space
    )
    (Path(folder) / PLY).write_bytes(ply_from_surface(found.surface))
    return {"source": "file", **_summary(found)}


def measure_wall(
    report: Report, *, path: str, channel: Channel, measure: PedicleMeasure | None, radius_mm: float
) -> WallSelection:
    """Job: choose the wall around a channel from a stored bone surface (PLY, mm, LPS)."""
    report(0.1, "measuring the distances to the bone")
    found = mesh_from_bytes(Path(path).read_bytes(), file_format="ply", unit="mm", space=Space.LPS)
    return select_wall(channel, found.surface, measure, radius_mm=radius_mm)


def format_of(content: bytes) -> str:
    """Detect the format of a mesh file from its content.

    Raises:
        InvalidInput: MESH_FORMAT_UNKNOWN.
    """
    start = content.lstrip()[:2000]
    if start.startswith(b"ply"):
        return "ply"
    faces = int.from_bytes(content[80:STL_HEADER_BYTES], "little")
    is_binary = len(content) == STL_HEADER_BYTES + STL_FACE_BYTES * faces
    # A truncated binary STL is recognised by its header, so that the reader can report the truncation.
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
        f"the start of the file ({len(content)} bytes) is not that of STL, OBJ or PLY",
        "Export the bone surface again as triangles, or state the format.",
        {"bytes": len(content)},
    )


def _summary(found: BoneSurface | MeshSurface) -> dict[str, object]:
    """Return the properties of a surface without its triangles."""
    surface = found.surface
    values = {
        field.name: plain(getattr(found, field.name))
        for field in dataclasses.fields(found)
        if field.name != "surface"
    }
    return {
        "vertices": int(surface.vertices_mm.shape[0]),
        "faces": int(surface.faces.shape[0]),
        "low_lps_mm": surface.vertices_mm.min(axis=0).tolist(),
        "high_lps_mm": surface.vertices_mm.max(axis=0).tolist(),
        **values,
    }
