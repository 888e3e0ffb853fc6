"""Colours of soft surfaces: muscle, fat, skin under film, cloth."""

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.rehearsal.field import DRAPE_EDGE, OperatingField, wound_ratio
from tracker.rehearsal.grain import Grain
from tracker.rehearsal.lamp import lit, shine

Image32 = npt.NDArray[np.float32]

# BGR of the materials from the middle of the wound outwards, and where each gives way to the next.
MUSCLE, DEEP, FAT, SKIN, CLOTH = (
    np.array(colour, dtype=np.float32)
    for colour in (
        (0.17, 0.18, 0.52),
        (0.10, 0.09, 0.30),
        (0.38, 0.62, 0.80),
        (0.36, 0.56, 0.76),
        (0.50, 0.47, 0.15),
    )
)


def soft_colours(
    field: OperatingField, grain: Grain, points: Image32, shade: Image32, camera_mm: Array
) -> tuple[Image32, Image32]:
    """Return BGR 0..1 (h, w, 3) of the field at points (h, w, 3), and the light (h, w) there.

    `shade` (h, w) is the unshadowed fraction of the lamp's light.
    """
    x, z = np.ascontiguousarray(points[..., 0]), np.ascontiguousarray(points[..., 2])
    rho = wound_ratio(x, z)
    cloudy, fine = grain.clouds(x, z, 70.0), grain.clouds(x, z, 23.0)
    ragged = grain.clouds(x, z, 160.0)
    muscle, fat, skin, cloth = _shares(rho, 0.02 * ragged)
    normals = field.normals_at(x, z)
    # Fibres of muscle run along the spine; the cloth has a weave.
    fibres = grain.clouds(x * 2.6, z * 0.5, 60.0)
    bump = 0.20 * muscle * fibres + 0.10 * fat * fine
    normals = normals + np.dstack([bump, 0 * bump, 0.5 * bump * cloudy])
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    weave = grain.specks(x, z, 0.55)
    tone = (
        muscle * (1.0 + 0.16 * cloudy + 0.10 * fibres)
        + fat * (1.0 + 0.10 * fine)
        + skin * (1.0 + 0.04 * cloudy)
        + cloth * (1.0 + 0.022 * weave + 0.02 * cloudy)
    )
    deep = np.clip(0.45 + 0.4 * cloudy, 0.0, 1.0)[..., None]
    colour = muscle[..., None] * (MUSCLE * (1.0 - 0.6 * deep) + DEEP * 0.6 * deep)
    colour = colour + fat[..., None] * FAT + skin[..., None] * SKIN + cloth[..., None] * CLOTH
    to_camera = camera_mm.astype(np.float32) - points
    to_camera /= np.linalg.norm(to_camera, axis=2, keepdims=True)
    wet = (muscle * 0.34 + fat * 0.20 + skin * 0.10) * np.clip(0.7 + 0.5 * fine, 0.0, 1.6) * shade
    # The lamp's circle of light falls off over the drapes.
    circle = 0.62 + 0.38 * np.exp(-((x / 260.0) ** 2) - ((z - 20.0) / 300.0) ** 2)
    # The drape casts a thin line of shade on the skin at its edge.
    seam = 1.0 - 0.35 * np.exp(-(((rho - DRAPE_EDGE + 0.012) / 0.018) ** 2))
    light = lit(normals) * shade * circle
    out = colour * (tone * light * seam)[..., None]
    out += (wet * (0.8 * shine(normals, to_camera, 30.0) + 0.10 * shine(normals, to_camera, 5.0)))[..., None]
    return np.asarray(np.clip(out, 0.0, 1.0), dtype=np.float32), np.asarray(light, dtype=np.float32)


def _shares(rho: Image32, ragged: Image32) -> tuple[Image32, Image32, Image32, Image32]:
    """Return the share of each material; the sum is 1."""

    def after(edge: float, width: float, rough: Image32 | float = 0.0) -> Image32:
        return np.asarray(np.clip((rho + rough - edge) / width + 0.5, 0.0, 1.0), dtype=np.float32)

    # The film's and the cloth's edges are cut; only flesh is ragged.
    fat, skin, cloth = after(0.93, 0.07, ragged), after(1.045, 0.015), after(DRAPE_EDGE, 0.008)
    return 1.0 - fat, fat - skin, skin - cloth, cloth
