"""ITK transforms compared with SimpleITK, the independent reader and writer of their direction."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import SimpleITK as sitk  # noqa: N813  its documentation names it so

from server.slicer_file import fixed_from_moving_in_itk, itk_text
from tracker.errors import InvalidInput
from tracker.geometry import Anchor, Rigid, Vertebra

POINTS_MM = np.array([[10.0, -20.0, 30.0], [0.0, 0.0, 0.0], [-400.0, 1.0, 950.0]])
AFFINE = """#Insight Transform File V1.0
#Transform 0
Transform: AffineTransform_double_3_3
Parameters: 0 -1 0 1 0 0 0 0 1 1 2 3
FixedParameters: 4 5 6
"""


def pose(seed: int) -> Rigid[Vertebra, Anchor]:
    rng = np.random.default_rng(seed)
    return Rigid.from_vector(rng.normal(size=3), rng.uniform(-500.0, 500.0, 3))


@pytest.mark.parametrize("seed", range(3))
def test_simpleitk_maps_points_of_the_ct_to_the_patient_by_what_is_written(seed: int, tmp_path: Path) -> None:
    fixed_from_moving = pose(seed)
    file = tmp_path / "registration.tfm"
    file.write_text(itk_text(fixed_from_moving), encoding="utf-8")
    moving_from_fixed = sitk.ReadTransform(str(file))
    for moving in POINTS_MM:
        fixed = fixed_from_moving.move_points(moving)
        assert moving_from_fixed.TransformPoint(fixed.tolist()) == pytest.approx(moving, abs=1e-9)
    again = fixed_from_moving_in_itk(file.read_bytes(), name="it")
    assert again.matrix == pytest.approx(fixed_from_moving.matrix, abs=1e-12)


def about_a_centre() -> sitk.Transform:
    transform = sitk.AffineTransform(3)
    transform.SetMatrix(pose(5).rotation.ravel().tolist())
    transform.SetTranslation([11.0, -12.0, 13.0])
    transform.SetCenter([40.0, 50.0, -60.0])
    return transform


def of_angles(*, is_zyx: bool) -> sitk.Transform:
    transform = sitk.Euler3DTransform([1.0, 2.0, 3.0], 0.3, -0.7, 1.9, [4.0, 5.0, 6.0])
    transform.SetComputeZYX(is_zyx)
    return transform


def of_a_versor() -> sitk.Transform:
    transform = sitk.VersorRigid3DTransform()
    transform.SetRotation([0.6, 0.0, 0.8], 2.8)
    transform.SetTranslation([7.0, 8.0, 9.0])
    transform.SetCenter([1.0, -1.0, 2.0])
    return transform


@pytest.mark.parametrize(
    "made",
    [
        pytest.param(about_a_centre, id="affine-about-a-centre"),
        pytest.param(lambda: of_angles(is_zyx=False), id="angles-in-the-order-zxy"),
        pytest.param(lambda: of_angles(is_zyx=True), id="angles-in-the-order-zyx"),
        pytest.param(of_a_versor, id="versor"),
        pytest.param(sitk.VersorRigid3DTransform, id="versor-without-rotation"),
    ],
)
def test_what_simpleitk_writes_is_read(made: Callable[[], sitk.Transform], tmp_path: Path) -> None:
    file = tmp_path / "start.tfm"
    moving_from_fixed = made()
    sitk.WriteTransform(moving_from_fixed, str(file))
    fixed_from_moving = fixed_from_moving_in_itk(file.read_bytes(), name="it")
    for fixed in POINTS_MM:
        moving = moving_from_fixed.TransformPoint(fixed.tolist())
        assert fixed_from_moving.move_points(moving) == pytest.approx(fixed, abs=1e-6)


def composite(tmp_path: Path) -> bytes:
    file = tmp_path / "c.tfm"
    sitk.WriteTransform(sitk.CompositeTransform([about_a_centre(), of_a_versor()]), str(file))
    return file.read_bytes()


def hdf5(tmp_path: Path) -> bytes:
    file = tmp_path / "c.h5"
    sitk.WriteTransform(of_a_versor(), str(file))
    return file.read_bytes()


@pytest.mark.parametrize(
    ("content", "code", "said"),
    [
        pytest.param(composite, "TRANSFORM_UNREADABLE", "3 transforms, expected 1", id="composite"),
        pytest.param(hdf5, "TRANSFORM_UNREADABLE", "HDF5 file (.h5)", id="hdf5"),
        pytest.param(b"", "TRANSFORM_UNREADABLE", "first line", id="empty"),
        pytest.param(
            AFFINE.replace("Affine", "BSpline"), "TRANSFORM_UNREADABLE", "BSplineTransform", id="spline"
        ),
        pytest.param(AFFINE.replace("_3_3", "_2_2"), "TRANSFORM_UNREADABLE", "_2_2", id="two-dimensions"),
        pytest.param(
            AFFINE.replace("FixedP", "Fixedp"),
            "TRANSFORM_UNREADABLE",
            "does not contain each of",
            id="without-a-centre",
        ),
        pytest.param(AFFINE.replace("0 -1 0 1", "0 -2 0 1"), "TRANSFORM_INVALID", "orthonormal", id="scaled"),
        pytest.param(AFFINE.replace("0 -1 0 1", "0 1 0 1"), "TRANSFORM_INVALID", "rigid", id="mirrored"),
        pytest.param(AFFINE.replace("1 2 3", "1 2"), "TRANSFORM_INVALID", "11 parameters", id="too-few"),
        pytest.param(AFFINE.replace("1 2 3", "1 2 nan"), "TRANSFORM_INVALID", "finite", id="not-a-number"),
        pytest.param(AFFINE.replace("1 2 3", "1 2 1e9"), "TRANSFORM_INVALID", "exceeds", id="too-far"),
    ],
)
def test_another_file_is_rejected_with_the_reason(
    content: bytes | str | Callable[[Path], bytes], code: str, said: str, tmp_path: Path
) -> None:
    given = content(tmp_path) if callable(content) else content
    with pytest.raises(InvalidInput) as rejected:
        fixed_from_moving_in_itk(given.encode() if isinstance(given, str) else given, name="start.tfm")
    assert rejected.value.code == code
    assert said in rejected.value.message


def test_a_file_cut_at_any_byte_is_rejected() -> None:
    content = AFFINE.encode()
    for length in range(len(content)):
        with pytest.raises(InvalidInput):
            fixed_from_moving_in_itk(content[:length], name="start.tfm")
