"""Meshes of all common formats are read completely; anything else is rejected with one sentence."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from server.imaging.meshes import mesh_from_bytes, ply_from_surface, read_mesh, stl_from_surface
from tests.real_data import real_data_file
from tracker.errors import InvalidInput, NavigationError, PlanError
from tracker.plan import Surface

# A block of 60 x 50 x 30 mm with binary corner numbers: x 1, y 2, z 4.
CORNERS = np.array([[x, y, z] for z in (0.0, 30.0) for y in (-50.0, 0.0) for x in (100.0, 160.0)])
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
FACES = np.array([f for a, b, c, d in QUADS for f in ((a, b, c), (a, c, d))])
BLOCK_ML = 90.0
PLY_HEADER = (
    "ply\nformat {form} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n"
    "property float z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
)


def obj(corners: npt.NDArray[np.float64] = CORNERS, *, first: str = "", quads: bool = True) -> bytes:
    lines = [first] + [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in corners]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in (QUADS if quads else FACES)]
    return "\n".join(lines).encode()


def ascii_stl() -> bytes:
    facets = [
        "facet normal 0 0 0\n outer loop\n"
        + "".join("  vertex {:.6e} {:.6e} {:.6e}\n".format(*CORNERS[i]) for i in face)
        + " endloop\nendfacet\n"
        for face in FACES
    ]
    return ("solid bone\n" + "".join(facets) + "endsolid bone\n").encode()


def binary_stl(*, header: bytes = b"", count: int | None = None) -> bytes:
    rows = np.zeros(len(FACES), dtype=[("n", "<f4", (3,)), ("v", "<f4", (3, 3)), ("a", "<u2")])
    rows["v"] = CORNERS[FACES]
    number = len(FACES) if count is None else count
    return header.ljust(80, b" ") + np.uint32(number).tobytes() + rows.tobytes()


def text_ply(*, vertices: int = 8, faces: int = 6, comment: str = "") -> bytes:
    head = PLY_HEADER.format(form="ascii", vertices=vertices, faces=faces).replace("ply\n", f"ply\n{comment}")
    lines = [" ".join(map(str, corner)) for corner in CORNERS]
    lines += ["4 " + " ".join(map(str, face)) for face in QUADS]
    return (head + "\n".join(lines) + "\n").encode()


def binary_ply(*, order: str = "little", vertices: int = 8, faces: int = 12) -> bytes:
    head = PLY_HEADER.format(form=f"binary_{order}_endian", vertices=vertices, faces=faces)
    sign = "<" if order == "little" else ">"
    rows = np.zeros(len(FACES), dtype=[("n", "u1"), ("v", f"{sign}i4", (3,))])
    rows["n"], rows["v"] = 3, FACES
    return head.encode() + CORNERS.astype(f"{sign}f4").tobytes() + rows.tobytes()


@pytest.mark.parametrize(
    ("content", "file_format"),
    [
        pytest.param(ascii_stl(), "stl", id="stl-as-text"),
        pytest.param(ascii_stl().replace(b"\n", b"\r\n"), "STL", id="stl-as-text-with-returns"),
        pytest.param(binary_stl(), "stl", id="stl-binary"),
        pytest.param(binary_stl(header=b"solid facet vertex"), "stl", id="stl-binary-that-begins-as-text"),
        pytest.param(obj(), "obj", id="obj-with-quads"),
        pytest.param(obj(quads=False), "obj", id="obj-with-triangles"),
        pytest.param(
            obj(first="mtllib http://example.org/x.mtl\nusemtl a\no bone"), "obj", id="obj-materials"
        ),
        pytest.param(text_ply(), "ply", id="ply-as-text-with-quads"),
        pytest.param(text_ply(comment="comment TextureFile /etc/hosts\n"), "ply", id="ply-with-a-texture"),
        pytest.param(binary_ply(), "ply", id="ply-binary"),
        pytest.param(binary_ply(order="big"), "ply", id="ply-binary-the-other-way-round"),
    ],
)
def test_every_form_of_a_file_gives_the_same_block(content: bytes, file_format: str) -> None:
    taken = mesh_from_bytes(content, file_format=file_format)
    assert taken.surface.vertices_mm.shape == (8, 3)
    assert taken.surface.faces.shape == (12, 3)
    assert taken.surface.volume_ml == pytest.approx(BLOCK_ML)
    assert taken.size_mm == pytest.approx([60.0, 50.0, 30.0])
    assert taken.closed
    assert (taken.unit, taken.unit_given, taken.kind) == ("mm", False, "vertebra")
    assert taken.remarks == ()


def test_several_objects_in_one_file_come_as_parts() -> None:
    second = "\no other\n" + "\n".join(f"v {x + 61} {y} {z}" for x, y, z in CORNERS)
    second += "\n" + "\n".join("f " + " ".join(str(i - 8) for i in face) for face in QUADS)
    taken = mesh_from_bytes(obj(first="o one") + second.encode(), file_format="obj")
    assert taken.parts == 2
    assert taken.surface.volume_ml == pytest.approx(2.0 * BLOCK_ML)
    assert [remark.code for remark in taken.remarks] == ["MESH_IN_PARTS"]


@pytest.mark.parametrize(
    ("content", "file_format", "said"),
    [
        pytest.param(b"", "stl", "empty", id="empty"),
        pytest.param(b"Dear colleague, the bone is fine.", "stl", "neither text", id="a-letter-named-stl"),
        pytest.param(
            b"solid ground under our feet " * 10, "stl", "neither text", id="text-that-begins-as-stl"
        ),
        pytest.param(
            b"solid x\nfacet\nvertex a b c\n", "stl", "no STL|0 triangles", id="stl-without-numbers"
        ),
        pytest.param(binary_stl(count=4_000_000_000), "stl", "4000000000 triangles", id="stl-that-boasts"),
        pytest.param(binary_stl(count=3), "stl", "declares 3 triangles", id="stl-that-is-too-long"),
        pytest.param(binary_stl()[:-7], "stl", "declares 12 triangles", id="stl-cut-off"),
        pytest.param(b"\x89PNG" + bytes(200), "obj", "no lines", id="a-picture-named-obj"),
        pytest.param(
            obj() + b"\nf 1 2 900000000",
            "obj",
            "not a readable OBJ",
            id="obj-with-a-corner-that-is-not-there",
        ),
        pytest.param(b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "obj", "no lines", id="obj-of-points"),
        pytest.param(text_ply(vertices=2_000_000_000), "ply", "declares at least", id="ply-that-boasts"),
        pytest.param(binary_ply(vertices=2_000_000_000), "ply", "declares at least", id="ply-boasts-binary"),
        pytest.param(binary_ply(vertices=-8), "ply", "header", id="ply-with-fewer-than-none"),
        pytest.param(binary_ply()[:-5], "ply", "not a readable PLY", id="ply-cut-off"),
        pytest.param(b"ply\nformat ascii 1.0\n", "ply", "no header", id="ply-without-an-end-of-its-header"),
        pytest.param(obj(), "ply", "no header", id="obj-named-ply"),
        pytest.param(obj(), "3mf", "is not supported", id="another-format"),
        pytest.param(obj(), "", "is not supported", id="no-format"),
    ],
)
def test_what_is_no_mesh_is_rejected_in_a_sentence(content: bytes, file_format: str, said: str) -> None:
    with pytest.raises(NavigationError, match=said) as reported:
        mesh_from_bytes(content, file_format=file_format)
    assert reported.value.code in {"MESH_UNREADABLE", "MESH_FORMAT_UNKNOWN", "MESH_EMPTY"}


@pytest.mark.parametrize(
    ("content", "said"),
    [
        pytest.param(obj().replace(b"v 160.000000", b"v nan", 1), "finite", id="not-a-number"),
        pytest.param(obj().replace(b"v 160.000000", b"v 1e400", 1), "finite", id="beyond-all-numbers"),
        pytest.param(obj().replace(b"v 160.000000", b"v 1e30", 1), "above 1e9", id="beyond-the-moon"),
    ],
)
def test_coordinates_that_cannot_be_are_rejected(content: bytes, said: str) -> None:
    with pytest.raises(PlanError, match=said) as reported:
        mesh_from_bytes(content, file_format="obj")
    assert reported.value.code == "MESH_INVALID"


def problem_of(content: bytes, file_format: str) -> tuple[str, str] | None:
    try:
        mesh_from_bytes(content, file_format=file_format)
    except NavigationError as error:
        return error.message, error.remedy
    return None


@pytest.mark.parametrize(
    ("content", "file_format"),
    [(binary_stl(), "stl"), (ascii_stl(), "stl"), (obj(), "obj"), (text_ply(), "ply"), (binary_ply(), "ply")],
)
def test_damaged_files_end_in_a_surface_or_in_a_sentence(content: bytes, file_format: str) -> None:
    rng = np.random.default_rng(8)
    rejected = 0
    for _ in range(60):
        damaged = bytearray(content[: rng.integers(len(content) // 2, 2 * len(content))])
        for at in rng.integers(0, len(damaged), 4):
            damaged[at] = rng.integers(0, 256)
        reported = problem_of(bytes(damaged), file_format)
        assert reported is None or all(reported)
        rejected += reported is not None
    assert rejected > 10


def test_a_file_too_large_is_rejected_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("server.imaging.meshes.MAX_BYTES", 100)
    path = tmp_path / "bone.obj"
    path.write_bytes(obj())
    with pytest.raises(InvalidInput) as reported:
        read_mesh(path)
    assert reported.value.code == "MESH_TOO_LARGE"


def test_no_message_names_the_file_which_may_name_the_patient(tmp_path: Path) -> None:
    path = tmp_path / "Doe^Jane.stl"
    path.write_bytes(b"nothing")
    for read in (path, tmp_path / "Doe^John.stl"):
        with pytest.raises(InvalidInput) as reported:
            read_mesh(read)
        assert "Doe" not in f"{reported.value} {reported.value.context}"


def test_the_coordinate_space_stated_by_a_file_is_applied() -> None:
    ras = mesh_from_bytes(binary_stl(header=b"3D Slicer output. SPACE=RAS"), file_format="stl")
    lps = mesh_from_bytes(binary_stl(header=b"3D Slicer output. SPACE=LPS"), file_format="stl")
    assert lps.surface.vertices_mm.min(axis=0) == pytest.approx([100.0, -50.0, 0.0])
    assert ras.surface.vertices_mm.min(axis=0) == pytest.approx([-160.0, 0.0, 0.0])
    assert ras.surface.volume_ml == pytest.approx(BLOCK_ML)
    assert [remark.code for remark in ras.remarks] == ["MESH_FROM_RAS"]
    assert lps.remarks == ()


@pytest.mark.parametrize(("write", "file_format"), [(ply_from_surface, "ply"), (stl_from_surface, "stl")])
def test_what_is_written_is_read_again_as_it_was(write: object, file_format: str) -> None:
    assert callable(write)
    surface = Surface(vertices_mm=CORNERS + np.array([1.0 / 3.0, -900.1, 1300.7]), faces=FACES)
    content = write(surface)
    assert b"SPACE=LPS" in content[:100]
    again = mesh_from_bytes(content, file_format=file_format)
    assert again.surface.volume_ml == pytest.approx(BLOCK_ML, rel=1e-4)
    exact = 0.0 if file_format == "ply" else 1e-4
    order = np.lexsort(surface.vertices_mm.T[::-1])
    assert np.abs(again.surface.vertices_mm - surface.vertices_mm[order]).max() <= exact


@pytest.mark.parametrize(("level", "volume_ml"), [("L3", 80.6), ("L1", None)])
def test_real_vertebrae_in_metres_are_recognised_and_not_scaled_unasked(
    level: str, volume_ml: float | None
) -> None:
    path = real_data_file("mesh", "lumbar", f"{level}_Schrumpfverpacken.obj")
    with pytest.raises(PlanError, match="in m it is") as reported:
        read_mesh(path)
    assert reported.value.code == "MESH_UNIT_NEEDED"
    assert reported.value.context["proposed_unit"] == "m"
    taken = read_mesh(path, unit="m")
    assert taken.closed
    assert taken.remarks == ()
    if volume_ml is not None:
        assert taken.surface.volume_ml == pytest.approx(volume_ml, abs=0.1)
        assert taken.size_mm == pytest.approx([92.3, 94.6, 54.6], abs=0.1)
