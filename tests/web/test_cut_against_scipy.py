"""The page's cut through a volume against SciPy's, from the bytes that the server sends."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from scipy import ndimage

from server.api.navigation_ct import navigation_ct_router
from server.procedure.navigation_ct import NavigationCt, NavigationCtProvider
from tracker.geometry import rotation_from_vector
from tracker.plan import Volume

CHECKOUT = Path(__file__).resolve().parents[2]
# The machine's Node, or the one that came with the packages.
NODE = ["sh", ".make/with-node", "web", "node"]
BONE = {"window_hu": 1800.0, "level_hu": 400.0}
# Node runs what TypeScript leaves of the module when its types are taken away; it has no imports.
PROGRAM = """
const fs = require("node:fs");
const ts = require(process.argv[1] + "/node_modules/typescript");
const source = fs.readFileSync(process.argv[1] + "/src/cuts/cut.ts", "utf8");
const { outputText } = ts.transpileModule(source, { compilerOptions: { target: "es2023", module: "esnext" } });
const { affine, size, plane, grey, folder } = JSON.parse(fs.readFileSync(0, "utf8"));
import("data:text/javascript," + encodeURIComponent(outputText)).then(({ drawCut, inverseAffine }) => {
    const bytes = fs.readFileSync(folder + "/voxels");
    const hu = new Int16Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
    const pixels = new Uint8ClampedArray(plane.width_px * plane.height_px * 4);
    drawCut({ hu, size, indexFromLps: inverseAffine(affine) }, plane, grey, pixels);
    fs.writeFileSync(folder + "/pixels", pixels);
});
"""


def oblique_volume() -> Volume:
    """Noise in voxels that are neither cubes nor upright: every error of place shows."""
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


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (0.3, 0.7, -0.4)], ids=["axial", "oblique"])
def test_the_cut_is_that_of_scipy_to_half_a_grey_level(tmp_path: Path, turn: tuple[float, ...]) -> None:
    sent = NavigationCt("ct", oblique_volume())
    app = FastAPI()
    app.include_router(navigation_ct_router(Fixed(sent)))
    answer = TestClient(app).get("/api/navigation/ct")
    place = json.loads(answer.headers["volume-place"])
    (tmp_path / "voxels").write_bytes(answer.content)
    centre = sent.volume.lps_from_index((np.array(sent.volume.shape_ijk) - 1.0) / 2.0)
    axes = rotation_from_vector(turn)
    width, height = 220, 170
    lps_from_px = np.column_stack(
        [axes[:, 0] * 0.25, axes[:, 1] * 0.25, centre - axes @ [width / 8.0, height / 8.0, 0.0]]
    )
    asked = {
        "affine": place["lps_from_ijk"],
        "size": place["size_ijk"],
        "plane": {"lps_from_px": lps_from_px.tolist(), "width_px": width, "height_px": height},
        "grey": BONE,
        "folder": str(tmp_path),
    }
    command = [*NODE, "-e", PROGRAM, str(CHECKOUT / "web")]
    subprocess.run(command, cwd=CHECKOUT, input=json.dumps(asked), text=True, check=True)
    pixels = np.fromfile(tmp_path / "pixels", np.uint8).reshape(height, width, 4)

    u, v = np.meshgrid(np.arange(width), np.arange(height))
    index = sent.volume.index_from_lps(np.stack([u, v, np.ones_like(u)], axis=-1) @ lps_from_px.T)
    hu = ndimage.map_coordinates(
        sent.volume.hu.astype(np.float64), index[..., ::-1].reshape(-1, 3).T, order=1, mode="nearest"
    ).reshape(height, width)
    grey = np.clip((hu - BONE["level_hu"]) / BONE["window_hu"] + 0.5, 0.0, 1.0) * 255.0
    beyond = np.maximum(-index, index - (np.array(sent.volume.shape_ijk) - 1.0)).max(axis=-1)
    inside, outside = beyond < -1e-3, beyond > 1e-3
    assert inside.mean() > 0.2
    assert outside.mean() > 0.05
    assert np.abs(pixels[inside, 0] - grey[inside]).max() <= 0.5 + 1e-6
    assert (pixels[inside, 3] == 255).all()
    assert (pixels[outside, 3] == 0).all()
