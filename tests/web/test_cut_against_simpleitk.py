"""The page's cut through a CT equals SimpleITK's, computed from the bytes that the server sends.

    PYTHONPATH=. python tests/web/test_cut_against_simpleitk.py

prints the differences in grey levels of the display.
"""

import json
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
import SimpleITK as sitk  # noqa: N813  its documentation names it so
from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.api.navigation_ct import navigation_ct_router
from server.procedure.navigation_ct import NavigationCt, NavigationCtProvider
from tests.web.page_modules import run_in_node
from tracker.geometry import rotation_from_vector
from tracker.plan import Volume

Vector = npt.NDArray[np.float64]

MODULES = ["cuts/cut", "cuts/planes", "operator/plan/slices/vectors"]
PROGRAM = """
const { drawCut, inverseAffine } = load("cuts/cut");
const { cutGrid } = load("cuts/planes");
const bytes = fs.readFileSync(folder + "/voxels");
const hu = new Int16Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
const volume = { hu, size: given.size, indexFromLps: inverseAffine(given.affine) };
for (const { id, name, pose, aheadMm } of given.cuts) {
    const grid = cutGrid(name, pose, given.field, aheadMm);
    const pixels = new Uint8ClampedArray(grid.width_px * grid.height_px * 4);
    drawCut(volume, grid, given.grey, pixels);
    fs.writeFileSync(`${folder}/${id}`, pixels);
}
"""
WIDTH_PX, HEIGHT_PX, PIXEL_MM = 220, 170, 0.25
FIELD = {"widthMm": WIDTH_PX * PIXEL_MM, "heightMm": HEIGHT_PX * PIXEL_MM}
# Window and level in HU.
BONE, SOFT_TISSUE = (1800.0, 400.0), (350.0, 40.0)
LEFT, BACK, HEAD = np.eye(3)
# In an in-line cut the tip is this share of the height below the middle.
TIP_BELOW = 0.12
# An 8-bit pixel is at most this far from its unrounded value.
ROUNDING = 0.5
# Of positions near the outermost voxels, which either program may count as outside.
BORDER_VOXELS = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class CutCase:
    """One cut of the page.

    Attributes:
        name: The page's name of the plane.
        axis: Drilling direction.
        right: Direction of the picture's rows, by the definition of the plane.
        down: Direction of its columns.
        ahead_mm: Distance of the probe's eye from the tip.
    """

    name: str
    axis: Vector
    right: Vector
    down: Vector
    ahead_mm: float = 0.0

    @property
    def id(self) -> str:
        """Return plane, direction and distance."""
        return f"{self.name} {np.round(self.axis, 2).tolist()} +{self.ahead_mm:.0f}"

    def corner(self, tip: Vector) -> Vector:
        """Return the centre of the top-left pixel."""
        middle = tip + self.ahead_mm * self.axis
        if self.name in ("axial", "sagittal"):
            middle = tip + TIP_BELOW * FIELD["heightMm"] * self.axis
        return middle - PIXEL_MM * ((WIDTH_PX - 1) / 2 * self.right + (HEIGHT_PX - 1) / 2 * self.down)


def unit(vector: Vector) -> Vector:
    return np.asarray(vector / np.linalg.norm(vector))


def perpendicular(wanted: Vector, axis: Vector) -> Vector:
    return unit(wanted - (wanted @ axis) * axis)


def cuts_along(axis: Vector) -> list[CutCase]:
    """All planes of a drill in this direction."""
    axial = perpendicular(LEFT, axis)
    caudal = perpendicular(-HEAD, axis)
    probes = [
        CutCase(name="probe", axis=axis, right=np.cross(caudal, axis), down=caudal, ahead_mm=ahead)
        for ahead in (0.0, 10.0)
    ]
    return [
        CutCase(name="axial", axis=axis, right=axial, down=-axis),
        CutCase(name="sagittal", axis=axis, right=np.cross(axis, axial), down=-axis),
        *probes,
        CutCase(name="anatomical-axial", axis=axis, right=LEFT, down=BACK),
        CutCase(name="anatomical-sagittal", axis=axis, right=BACK, down=-HEAD),
        CutCase(name="anatomical-coronal", axis=axis, right=LEFT, down=-HEAD),
    ]


CUTS = [
    cut
    for axis in ([0.0, -1.0, 0.0], [-0.3, -0.9, 0.2], [0.5, -0.7, -0.45])
    for cut in cuts_along(unit(np.array(axis)))
]


def noise(spacing_mm: tuple[float, float, float], size: tuple[int, int, int], tilt: float = 0.0) -> Volume:
    """Noise in voxels that are neither cubic nor axis-aligned, so that any error of position shows.

    Args:
        spacing_mm: along i, j and k; negative for a direction against the patient's.
        size: voxels along i, j and k.
        tilt: shear of the slices along j per mm, as by a tilted gantry.
    """
    affine = np.eye(4)
    shear = np.eye(3)
    shear[1, 2] = tilt
    affine[:3, :3] = rotation_from_vector([0.2, -0.3, 0.1]) @ shear @ np.diag(spacing_mm)
    affine[:3, 3] = [-20.0, 33.0, -12.0]
    hu = np.random.default_rng(4).integers(-1000, 2000, size[::-1]).astype(np.int16)
    return Volume(hu=hu, lps_from_ijk=affine)


VOLUMES: dict[str, Callable[[], Volume]] = {
    "anisotropic": lambda: noise((0.6, -0.7, 1.3), (55, 60, 24)),
    "thick-slices": lambda: noise((0.4, 0.4, 3.0), (100, 95, 14)),
    "tilted-gantry": lambda: noise((0.5, 0.6, 2.0), (70, 70, 18), tilt=0.25),
}


class Fixed(NavigationCtProvider):
    """Provides one volume."""

    def __init__(self, found: NavigationCt) -> None:
        self._found = found

    def current(self) -> NavigationCt:
        return self._found


def tip_in(volume: Volume) -> Vector:
    """A point off the middle of the volume, between voxels."""
    middle = (np.array(volume.shape_ijk) - 1.0) / 2.0
    return np.asarray(volume.lps_from_index(middle + np.array([1.3, -0.7, 0.4])))


def page_cuts(volume: Volume, window: tuple[float, float], folder: Path) -> list[npt.NDArray[np.uint8]]:
    """The page's cuts as RGBA, from the bytes that the server sends."""
    app = FastAPI()
    app.include_router(navigation_ct_router(Fixed(NavigationCt("ct", volume))))
    answer = TestClient(app).get("/api/navigation/ct")
    place = json.loads(answer.headers["volume-place"])
    (folder / "voxels").write_bytes(answer.content)
    tip = tip_in(volume).tolist()
    cuts = [
        {
            "id": f"{number}.rgba",
            "name": cut.name,
            "pose": {"tip": tip, "axis": cut.axis.tolist()},
            "aheadMm": cut.ahead_mm,
        }
        for number, cut in enumerate(CUTS)
    ]
    given = {
        "affine": place["lps_from_ijk"],
        "size": place["size_ijk"],
        "grey": {"window_hu": window[0], "level_hu": window[1]},
        "field": FIELD,
        "cuts": cuts,
    }
    run_in_node(PROGRAM, MODULES, given, folder)
    return [
        np.fromfile(folder / f"{number}.rgba", np.uint8).reshape(HEIGHT_PX, WIDTH_PX, 4)
        for number in range(len(CUTS))
    ]


def itk_image(volume: Volume) -> tuple[sitk.Image, sitk.AffineTransform]:
    """The volume in ITK's geometry, which has no shear, and the transform from LPS that removes it."""
    rotation, scaled = np.linalg.qr(volume.lps_from_ijk[:3, :3])
    signs = np.sign(np.diag(scaled))
    image = sitk.GetImageFromArray(volume.hu.astype(np.float64))
    image.SetSpacing(np.abs(np.diag(scaled)).tolist())
    image.SetDirection((rotation * signs).ravel().tolist())
    image.SetOrigin(volume.lps_from_ijk[:3, 3].tolist())
    plain_from_ijk = rotation @ np.diag(np.diag(scaled))
    unsheared = sitk.AffineTransform(3)
    unsheared.SetMatrix((plain_from_ijk @ np.linalg.inv(volume.lps_from_ijk[:3, :3])).ravel().tolist())
    unsheared.SetCenter(volume.lps_from_ijk[:3, 3].tolist())
    return image, unsheared


def itk_cut(volume: Volume, cut: CutCase) -> Vector:
    """Hounsfield units of the cut by SimpleITK; NaN outside of the voxels."""
    image, unsheared = itk_image(volume)
    grid = sitk.ResampleImageFilter()
    grid.SetSize((WIDTH_PX, HEIGHT_PX, 1))
    grid.SetOutputSpacing((PIXEL_MM, PIXEL_MM, 1.0))
    normal = np.cross(cut.right, cut.down)
    grid.SetOutputDirection(np.column_stack([cut.right, cut.down, normal]).ravel().tolist())
    grid.SetOutputOrigin(cut.corner(tip_in(volume)).tolist())
    grid.SetTransform(unsheared)
    grid.SetInterpolator(sitk.sitkLinear)
    grid.SetDefaultPixelValue(float("nan"))
    grid.SetOutputPixelType(sitk.sitkFloat64)
    return np.asarray(sitk.GetArrayFromImage(grid.Execute(image))[0])


def beyond_voxels(volume: Volume, cut: CutCase) -> Vector:
    """Distance of each pixel from the box of the voxels' centres, in voxels; negative inside."""
    image, unsheared = itk_image(volume)
    right, down = PIXEL_MM * cut.right, PIXEL_MM * cut.down
    places = [
        cut.corner(tip_in(volume)) + u * right + v * down
        for v in (0, HEIGHT_PX - 1)
        for u in (0, WIDTH_PX - 1)
    ]
    index = np.array(
        [
            image.TransformPhysicalPointToContinuousIndex(unsheared.TransformPoint(one.tolist()))
            for one in places
        ]
    )
    # Affine in u and v: from three corners to all pixels.
    u, v = np.meshgrid(np.linspace(0, 1, WIDTH_PX), np.linspace(0, 1, HEIGHT_PX))
    all_indices = index[0] + u[..., None] * (index[1] - index[0]) + v[..., None] * (index[2] - index[0])
    return np.asarray(np.maximum(-all_indices, all_indices - (np.array(volume.shape_ijk) - 1.0)).max(axis=-1))


def displayed(hu: Vector, window: tuple[float, float]) -> Vector:
    """Grey levels before they are rounded to 8 bits."""
    return np.asarray(np.clip((hu - window[1]) / window[0] + 0.5, 0.0, 1.0) * 255.0)


def differences(
    pixels: npt.NDArray[np.uint8], volume: Volume, cut: CutCase, window: tuple[float, float]
) -> Vector:
    """Grey levels between page and SimpleITK in each pixel inside of the volume; checks which are inside."""
    beyond = beyond_voxels(volume, cut)
    inside, outside = beyond < -BORDER_VOXELS, beyond > BORDER_VOXELS
    assert inside.mean() > 0.2, cut.id
    assert (pixels[inside, 3] == 255).all(), cut.id
    assert (pixels[outside, 3] == 0).all(), cut.id
    assert (pixels[..., :1] == pixels[..., :3]).all(), cut.id
    return np.abs(pixels[inside, 0] - displayed(itk_cut(volume, cut)[inside], window))


@pytest.mark.parametrize("window", [BONE, SOFT_TISSUE], ids=["bone", "soft-tissue"])
@pytest.mark.parametrize("name", VOLUMES)
def test_each_cut_is_that_of_simpleitk_to_half_a_grey_level(
    tmp_path: Path, name: str, window: tuple[float, float]
) -> None:
    volume = VOLUMES[name]()
    has_outside = False
    for pixels, cut in zip(page_cuts(volume, window, tmp_path), CUTS, strict=True):
        worst = differences(pixels, volume, cut, window).max()
        assert worst <= ROUNDING + 1e-6, (cut.id, worst)
        has_outside |= bool((beyond_voxels(volume, cut) > BORDER_VOXELS).mean() > 0.05)
    assert has_outside


if __name__ == "__main__":
    for volume_name, make in VOLUMES.items():
        for window_name, hu in (("bone", BONE), ("soft tissue", SOFT_TISSUE)):
            with tempfile.TemporaryDirectory() as made_in:
                here = make()
                drawn = page_cuts(here, hu, Path(made_in))
                found = np.concatenate(
                    [differences(one, here, cut, hu) for one, cut in zip(drawn, CUTS, strict=True)]
                )
            sys.stdout.write(
                f"{volume_name:14} {window_name:12} {len(CUTS)} cuts, {found.size} pixels: "
                f"median {np.median(found):.3f}, worst {found.max():.6f} grey levels\n"
            )
