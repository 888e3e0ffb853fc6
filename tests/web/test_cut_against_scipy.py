"""The page's cut through a volume equals SciPy's, computed from the bytes that the server sends."""

import json
import subprocess
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from scipy import ndimage

from server.api.navigation_ct import navigation_ct_router
from server.procedure.navigation_ct import NavigationCt, NavigationCtProvider
from tracker.geometry import rotation_from_vector
from tracker.plan import Volume

CHECKOUT = Path(__file__).resolve().parents[2]
# The machine's Node, or the one in the packages.
NODE = ["sh", ".make/with-node", "web", "node"]
BONE = {"window_hu": 1800.0, "level_hu": 400.0}
# Node runs the modules with their types stripped. The plane is given, or the page's.
MODULES = ["cuts/cut", "cuts/planes", "operator/plan/slices/vectors"]
PROGRAM = """
const fs = require("node:fs");
const path = require("node:path");
const web = process.argv[1];
const ts = require(web + "/node_modules/typescript");
const { affine, size, plane, cut, grey, folder, modules } = JSON.parse(fs.readFileSync(0, "utf8"));
for (const name of modules) {
    const source = fs.readFileSync(`${web}/src/${name}.ts`, "utf8");
    const compilerOptions = { target: "es2023", module: "commonjs" };
    const { outputText } = ts.transpileModule(source, { compilerOptions });
    const file = `${folder}/js/${name}.js`;
    fs.mkdirSync(path.dirname(file), { recursive: true });
    fs.writeFileSync(file, outputText);
}
const { drawCut, inverseAffine } = require(`${folder}/js/cuts/cut.js`);
const { cutGrid } = require(`${folder}/js/cuts/planes.js`);
const grid = plane ?? cutGrid(cut.name, cut.pose, cut.field, 0);
const bytes = fs.readFileSync(folder + "/voxels");
const hu = new Int16Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
const pixels = new Uint8ClampedArray(grid.width_px * grid.height_px * 4);
drawCut({ hu, size, indexFromLps: inverseAffine(affine) }, grid, grey, pixels);
fs.writeFileSync(folder + "/pixels", pixels);
"""
WIDTH_PX, HEIGHT_PX, PIXEL_MM = 220, 170, 0.25
LEFT, BACK, FEET = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, -1.0])


def oblique_volume() -> Volume:
    """Noise in voxels that are neither cubic nor axis-aligned, so that any error of position shows."""
    affine = np.eye(4)
    affine[:3, :3] = rotation_from_vector([0.2, -0.3, 0.1]) @ np.diag([0.6, -0.7, 1.3])
    affine[:3, 3] = [-20.0, 33.0, -12.0]
    hu = np.random.default_rng(4).integers(-1000, 2000, (24, 60, 55)).astype(np.int16)
    return Volume(hu=hu, lps_from_ijk=affine)


class Fixed(NavigationCtProvider):
    """Provides one volume."""

    def __init__(self, found: NavigationCt) -> None:
        self._found = found

    def current(self) -> NavigationCt:
        return self._found


def drawn(folder: Path, sent: NavigationCt, wanted: dict[str, object]) -> npt.NDArray[np.uint8]:
    """The page's cut as RGBA, from the bytes that the server sends."""
    app = FastAPI()
    app.include_router(navigation_ct_router(Fixed(sent)))
    answer = TestClient(app).get("/api/navigation/ct")
    place = json.loads(answer.headers["volume-place"])
    (folder / "voxels").write_bytes(answer.content)
    arguments = {
        "affine": place["lps_from_ijk"],
        "size": place["size_ijk"],
        "grey": BONE,
        "folder": str(folder),
        "modules": MODULES,
        **wanted,
    }
    command = [*NODE, "-e", PROGRAM, str(CHECKOUT / "web")]
    subprocess.run(command, cwd=CHECKOUT, input=json.dumps(arguments), text=True, check=True)
    return np.fromfile(folder / "pixels", np.uint8).reshape(HEIGHT_PX, WIDTH_PX, 4)


def hold_against_scipy(
    pixels: npt.NDArray[np.uint8], volume: Volume, lps_from_px: npt.NDArray[np.float64]
) -> None:
    """Each pixel equals SciPy's to half a grey level; pixels outside of the CT are transparent."""
    u, v = np.meshgrid(np.arange(WIDTH_PX), np.arange(HEIGHT_PX))
    index = volume.index_from_lps(np.stack([u, v, np.ones_like(u)], axis=-1) @ lps_from_px.T)
    hu = ndimage.map_coordinates(
        volume.hu.astype(np.float64), index[..., ::-1].reshape(-1, 3).T, order=1, mode="nearest"
    ).reshape(HEIGHT_PX, WIDTH_PX)
    grey = np.clip((hu - BONE["level_hu"]) / BONE["window_hu"] + 0.5, 0.0, 1.0) * 255.0
    beyond = np.maximum(-index, index - (np.array(volume.shape_ijk) - 1.0)).max(axis=-1)
    inside, outside = beyond < -1e-3, beyond > 1e-3
    assert inside.mean() > 0.2
    assert outside.mean() > 0.05
    assert np.abs(pixels[inside, 0] - grey[inside]).max() <= 0.5 + 1e-6
    assert (pixels[inside, 3] == 255).all()
    assert (pixels[outside, 3] == 0).all()


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (0.3, 0.7, -0.4)], ids=["axial", "oblique"])
def test_the_cut_is_that_of_scipy_to_half_a_grey_level(tmp_path: Path, turn: tuple[float, ...]) -> None:
    sent = NavigationCt("ct", oblique_volume())
    centre = sent.volume.lps_from_index((np.array(sent.volume.shape_ijk) - 1.0) / 2.0)
    axes = rotation_from_vector(turn)
    corner = centre - axes @ [WIDTH_PX / 8.0, HEIGHT_PX / 8.0, 0.0]
    lps_from_px = np.column_stack([axes[:, 0] * PIXEL_MM, axes[:, 1] * PIXEL_MM, corner])
    plane = {"lps_from_px": lps_from_px.tolist(), "width_px": WIDTH_PX, "height_px": HEIGHT_PX}
    hold_against_scipy(drawn(tmp_path, sent, {"plane": plane}), sent.volume, lps_from_px)


@pytest.mark.parametrize(
    ("name", "right", "down"),
    [
        ("anatomical-axial", LEFT, BACK),
        ("anatomical-sagittal", BACK, FEET),
        ("anatomical-coronal", LEFT, FEET),
    ],
)
def test_an_anatomical_cut_is_that_of_scipy_through_the_tip(
    tmp_path: Path, name: str, right: npt.NDArray[np.float64], down: npt.NDArray[np.float64]
) -> None:
    sent = NavigationCt("ct", oblique_volume())
    # Off the middle of the volume, between voxels.
    middle = (np.array(sent.volume.shape_ijk) - 1.0) / 2.0
    tip = sent.volume.lps_from_index(middle + np.array([1.3, -0.7, 0.4]))
    cut = {
        "name": name,
        "pose": {"tip": tip.tolist(), "axis": [-0.6, -0.8, 0.0]},
        "field": {"widthMm": WIDTH_PX * PIXEL_MM, "heightMm": HEIGHT_PX * PIXEL_MM},
    }
    # The tip is in the middle of the picture.
    corner = tip - PIXEL_MM * ((WIDTH_PX - 1) / 2.0 * right + (HEIGHT_PX - 1) / 2.0 * down)
    lps_from_px = np.column_stack([right * PIXEL_MM, down * PIXEL_MM, corner])
    hold_against_scipy(drawn(tmp_path, sent, {"cut": cut}), sent.volume, lps_from_px)
