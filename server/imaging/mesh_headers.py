"""Validation of the header of a mesh file against its length, before memory is allocated."""

import re

from tracker.errors import InvalidInput

STL_HEADER_BYTES, STL_FACE_BYTES = 84, 50
MAX_HEADER_BYTES = 64 * 1024
SIZES = {
    **dict.fromkeys(("char", "uchar", "int8", "uint8"), 1),
    **dict.fromkeys(("short", "ushort", "int16", "uint16"), 2),
    **dict.fromkeys(("int", "uint", "int32", "uint32", "float", "float32"), 4),
    **dict.fromkeys(("double", "float64"), 8),
}
OBJ_FACE = re.compile(rb"^[ \t]*f[ \t]", re.MULTILINE)
OBJ_VERTEX = re.compile(rb"^[ \t]*v[ \t]", re.MULTILINE)
OBJ_REFERENCE = re.compile(rb"^[ \t]*(mtllib|usemtl|maplib|usemap)\b[^\r\n]*", re.MULTILINE | re.IGNORECASE)


def checked_content(content: bytes, file_format: str) -> bytes:
    """Return the content without references to other files, if header and length agree.

    Raises:
        InvalidInput: MESH_UNREADABLE.
    """
    if not content:
        raise _unreadable(file_format, "it is empty")
    if file_format == "stl":
        return _checked_stl(content)
    if file_format == "ply":
        return _checked_ply(content)
    if b"\0" in content or not OBJ_VERTEX.search(content) or not OBJ_FACE.search(content):
        raise _unreadable("obj", "it has no lines of vertices (v) and faces (f)")
    return OBJ_REFERENCE.sub(b"#", content)


def _checked_stl(content: bytes) -> bytes:
    head = content[:MAX_HEADER_BYTES].lower()
    declared = int.from_bytes(content[80:STL_HEADER_BYTES], "little")
    needed = STL_HEADER_BYTES + STL_FACE_BYTES * declared
    # Some programs begin binary files with "solid" too; the length decides.
    if len(content) >= STL_HEADER_BYTES and len(content) == needed:
        return content
    if head.lstrip().startswith(b"solid") and b"facet" in head and b"vertex" in head:
        return content
    if len(content) < STL_HEADER_BYTES or b"\0" not in content[:MAX_HEADER_BYTES]:
        raise _unreadable("stl", "it is neither text that begins with 'solid' nor binary")
    raise _unreadable(
        "stl", f"it declares {declared} triangles, which need {needed} bytes, but has {len(content)}"
    )


def _checked_ply(content: bytes) -> bytes:
    end = re.search(rb"end_header[ \t]*\r?\n", content[:MAX_HEADER_BYTES])
    if not content.startswith(b"ply") or end is None:
        raise _unreadable("ply", "it has no header")
    lines = [line.strip() for line in content[: end.end()].splitlines()]
    # Comments may refer to a texture file, which must not be loaded.
    lines = [line for line in lines if not line.startswith((b"comment", b"obj_info"))]
    body = content[end.end() :]
    words = [line.decode("ascii", errors="replace").split() for line in lines]
    binary = any(line[:1] == ["format"] and line[1:2] != ["ascii"] for line in words)
    try:
        needed = _min_bytes(words, binary=binary)
    except (ValueError, KeyError, IndexError) as error:
        raise _unreadable("ply", "its header is invalid") from error
    if needed > len(body):
        raise _unreadable("ply", f"its header declares at least {needed} bytes, but it has {len(body)}")
    return b"\n".join(lines) + b"\n" + body


def _min_bytes(words: list[list[str]], *, binary: bool) -> int:
    """Return the minimum length of the data after a PLY header, as if all lists were empty."""
    needed, count = 0, 0
    for line in words:
        if line[:1] == ["element"]:
            count = int(line[2])
            if count < 0:
                raise ValueError(line[2])
        elif line[:1] == ["property"]:
            size = SIZES[line[2] if line[1] == "list" else line[1]]
            # In a text file a number needs a digit and a separator.
            needed += count * (size if binary else 2)
    # The last number of a text file needs no separator.
    return max(needed - (0 if binary else 1), 0)


def _unreadable(file_format: str, problem: str) -> InvalidInput:
    name = file_format.upper()
    return InvalidInput(
        "MESH_UNREADABLE",
        f"the mesh is not a readable {name} file: {problem}",
        "Export the bone surface again as triangles in STL, OBJ or PLY.",
        {"format": file_format, "format_name": name, "mesh_problem": problem},
    )
