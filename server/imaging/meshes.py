"""Reading and writing of surfaces as STL, OBJ and PLY.

trimesh parses bytes only and without a resolver, so that references to materials, textures or other files are
not followed. It is imported on demand, because it takes half a second of the start.
"""

import io
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from server.imaging.mesh_headers import checked_content
from tracker.errors import InvalidInput, NavigationError
from tracker.plan import Surface
from tracker.plan.mesh import MeshSurface, surface_from_mesh
from tracker.plan.mesh.intake import Space

if TYPE_CHECKING:
    import trimesh

FORMATS = ("stl", "obj", "ply")
# The parser of text files needs up to twenty times the file size of memory.
MAX_BYTES = 100 * 2**20
MAX_FACES = 2_000_000
EXPORT_TRIANGLES = "Export the bone surface again as triangles in STL, OBJ or PLY."
# Written by 3D Slicer into the first lines of exported files.
SPACE = re.compile(rb"SPACE\s*=\s*(LPS|RAS)", re.IGNORECASE)
WHERE_SPACE_IS = 4096


def read_mesh(path: Path, *, unit: str | None = None, space: Space | None = None) -> MeshSurface:
    """Read the surface in a file; its suffix states the format.

    Raises:
        InvalidInput: MESH_UNREADABLE, and as `mesh_from_bytes`.
        PlanError: as `mesh_from_bytes`.
    """
    try:
        _reject_large(path.stat().st_size)
        content = path.read_bytes()
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise InvalidInput(
            "MESH_UNREADABLE",
            f"the mesh cannot be read: {reason}",
            EXPORT_TRIANGLES,
            {"system_error": reason},
        ) from error
    return mesh_from_bytes(content, file_format=path.suffix[1:], unit=unit, space=space)


def mesh_from_bytes(
    content: bytes, *, file_format: str, unit: str | None = None, space: Space | None = None
) -> MeshSurface:
    """Parse the surface in the bytes of a file.

    Args:
        content: Content of an STL (text or binary), OBJ or PLY file.
        file_format: "stl", "obj" or "ply".
        unit: "mm", "cm", "m", "inch" or "um"; None accepts only a mesh whose size is plausible in mm.
        space: LPS or RAS; None for that stated in the file, or LPS if it states none.

    Raises:
        InvalidInput: MESH_FORMAT_UNKNOWN, MESH_TOO_LARGE, MESH_UNREADABLE.
        PlanError: as `tracker.plan.mesh.surface_from_mesh`.
    """
    _reject_large(len(content))
    file_format = file_format.lower()
    if file_format not in FORMATS:
        formats = ", ".join(FORMATS)
        raise InvalidInput(
            "MESH_FORMAT_UNKNOWN",
            f"the mesh format '{file_format}' is not supported, supported are {formats}",
            EXPORT_TRIANGLES,
            {"allowed": list(FORMATS), "format": file_format, "formats": formats},
        )
    space_match = SPACE.search(content[:WHERE_SPACE_IS])
    stated = None if space_match is None else Space(space_match[1].decode().upper())
    mesh = _parsed(checked_content(content, file_format), file_format)
    faces = np.asarray(mesh.faces)
    if faces.shape[0] > MAX_FACES:
        raise InvalidInput(
            "MESH_TOO_LARGE",
            f"the mesh has {faces.shape[0]} triangles, the maximum is {MAX_FACES}",
            "Export it with fewer triangles; 60000 are enough for a vertebra.",
            {"faces": int(faces.shape[0]), "max_faces": MAX_FACES},
        )
    return surface_from_mesh(mesh.vertices, faces, unit=unit, space=space or stated or Space.LPS)


def ply_from_surface(surface: Surface) -> bytes:
    """Return the surface as a binary PLY file, in LPS mm with double precision."""
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment Coaxial SPACE=LPS UNIT=mm\n"
        f"element vertex {surface.vertices_mm.shape[0]}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {surface.faces.shape[0]}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.empty(surface.faces.shape[0], dtype=[("count", "u1"), ("corners", "<i4", (3,))])
    rows["count"], rows["corners"] = 3, surface.faces
    return header.encode() + surface.vertices_mm.astype("<f8").tobytes() + rows.tobytes()


def stl_from_surface(surface: Surface) -> bytes:
    """Return the surface as a binary STL file, in LPS mm with the single precision of STL."""
    import trimesh  # noqa: PLC0415  see above

    mesh = trimesh.Trimesh(surface.vertices_mm, surface.faces, process=False)
    content = bytes(trimesh.exchange.stl.export_stl(mesh))
    return b"Coaxial SPACE=LPS UNIT=mm".ljust(80, b"\0") + content[80:]


def _reject_large(size: int) -> None:
    if size > MAX_BYTES:
        raise InvalidInput(
            "MESH_TOO_LARGE",
            f"the mesh has {size / 2**20:.0f} MB, the maximum is {MAX_BYTES / 2**20:.0f} MB",
            "Export it with fewer triangles, or as binary STL or PLY.",
            {"bytes": size, "size_mb": size / 2**20, "max_mb": MAX_BYTES / 2**20},
        )


def _parsed(content: bytes, file_format: str) -> "trimesh.Trimesh":
    """Parse the bytes with trimesh; any of its exceptions becomes MESH_UNREADABLE."""
    import trimesh  # noqa: PLC0415  see above

    try:
        # NaN coordinates are rejected below, so that the warnings of trimesh are suppressed.
        with np.errstate(all="ignore"):
            mesh = trimesh.load_mesh(
                io.BytesIO(content), file_type=file_format, process=False, resolver=None, skip_materials=True
            )
        if not isinstance(mesh, trimesh.Trimesh) or np.ndim(mesh.faces) != 2:
            mesh = trimesh.Trimesh()
    except NavigationError:
        raise
    except Exception as error:
        name, kind = file_format.upper(), type(error).__name__
        raise InvalidInput(
            "MESH_UNREADABLE",
            f"the mesh is not a readable {name} file: {kind}",
            EXPORT_TRIANGLES,
            {"format_name": name, "library_error": kind, "reason": str(error)[:200]},
        ) from error
    return mesh
