"""Valid surfaces, and those that are rejected."""

import numpy as np
import pytest

from tracker.errors import PlanError
from tracker.plan import Surface

TETRAHEDRON = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 10.0, 0.0], [0.0, 0.0, 10.0]])
OUTWARDS = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def test_volume_is_positive_when_wound_outwards_and_negative_inside_out() -> None:
    assert Surface(vertices_mm=TETRAHEDRON, faces=OUTWARDS).volume_ml == pytest.approx(1.0 / 6.0)
    assert Surface(vertices_mm=TETRAHEDRON, faces=OUTWARDS[:, ::-1]).volume_ml == pytest.approx(-1.0 / 6.0)


def test_arrays_cannot_be_written() -> None:
    surface = Surface(vertices_mm=TETRAHEDRON, faces=OUTWARDS)
    assert not surface.vertices_mm.flags.writeable
    assert not surface.faces.flags.writeable


@pytest.mark.parametrize(
    ("vertices", "faces", "word"),
    [
        pytest.param(TETRAHEDRON[:, :2], OUTWARDS, "(n, 3)", id="flat-vertices"),
        pytest.param(TETRAHEDRON, OUTWARDS[:, :2], "(m, 3)", id="faces-of-two"),
        pytest.param(TETRAHEDRON * np.nan, OUTWARDS, "finite", id="not-a-number"),
        pytest.param(TETRAHEDRON, OUTWARDS + 1, "vertex 4", id="vertex-that-is-not-there"),
        pytest.param(TETRAHEDRON, OUTWARDS[:0], "(m, 3)", id="no-faces"),
    ],
)
def test_a_broken_mesh_is_rejected_with_the_reason(
    vertices: np.ndarray, faces: np.ndarray, word: str
) -> None:
    with pytest.raises(PlanError) as caught:
        Surface(vertices_mm=vertices, faces=faces)
    assert caught.value.code == "SURFACE_INVALID"
    assert word in caught.value.message
