"""Height field of the operating field: open wound, skin and drapes, over the patient's back."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Image32 = npt.NDArray[np.float32]

# x to the patient's left and z to the head, in mm of the vertebra's frame; heights are its y.
MAP_X_MM, MAP_Z_MM, MAP_STEP_MM = (-560.0, 480.0), (-260.0, 1100.0), 2.0
WOUND_HALF_MM, WOUND_POWER, WOUND_CENTRE_Z_MM = (60.0, 66.0), 2.4, 2.0
BED_MM, SKIN_MM = 7.0, 24.0
WALL, DRAPE_EDGE = (0.86, 1.06), 1.27
MAX_HEIGHT_MM, LEVELS = 44.0, 34


class OperatingField:
    """Height field of all soft surfaces, with ray intersection."""

    def __init__(self, random: np.random.Generator) -> None:
        xs = np.arange(MAP_X_MM[0], MAP_X_MM[1], MAP_STEP_MM, dtype=np.float32)
        zs = np.arange(MAP_Z_MM[0], MAP_Z_MM[1], MAP_STEP_MM, dtype=np.float32)
        x, z = np.meshgrid(xs, zs)
        rho = wound_ratio(x, z)
        height = (
            BED_MM + (SKIN_MM - BED_MM) * _step(rho, *WALL) + 2.2 * _step(rho, DRAPE_EDGE, DRAPE_EDGE + 0.035)
        )
        height += _folds(x, z, random) * _step(rho, DRAPE_EDGE, 2.6)
        # The muscle is not flat: it bulges between the processes and sinks beside them.
        height += (
            1.5 * np.sin(x / 7.0 + random.uniform(0, 6)) * np.sin(z / 9.0) * (1.0 - _step(rho, 0.8, 1.0))
        )
        self._height = height.astype(np.float32)

    def height_at(self, x_mm: Image32, z_mm: Image32) -> Image32:
        """Return the height (h, w) at points (h, w)."""
        u = (x_mm - MAP_X_MM[0]) / MAP_STEP_MM
        v = (z_mm - MAP_Z_MM[0]) / MAP_STEP_MM
        out = cv2.remap(self._height, u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        return np.asarray(out, dtype=np.float32)

    def normals_at(self, x_mm: Image32, z_mm: Image32, reach_mm: float = 2.0) -> Image32:
        """Return the unit normals (h, w, 3) at points (h, w)."""
        dx = self.height_at(x_mm + reach_mm, z_mm) - self.height_at(x_mm - reach_mm, z_mm)
        dz = self.height_at(x_mm, z_mm + reach_mm) - self.height_at(x_mm, z_mm - reach_mm)
        normal = np.dstack([-dx, np.full_like(dx, 2.0 * reach_mm), -dz])
        return np.asarray(normal / np.linalg.norm(normal, axis=2, keepdims=True), dtype=np.float32)

    def meet(self, origin_mm: Array, rays: Image32) -> Image32:
        """Return the ray parameter (h, w) at which each ray (h, w, 3) from the origin meets the field.

        The rays point down and are traced level by level from above, so that the near edge of the wound
        occludes what is behind it.
        """
        ox, oy, oz = (np.float32(v) for v in origin_mm)
        down = np.minimum(rays[..., 1], np.float32(-0.05))
        levels = np.linspace(MAX_HEIGHT_MM, -2.0, LEVELS, dtype=np.float32)
        scale = (levels[-1] - oy) / down
        before = np.full(rays.shape[:2], np.float32(MAX_HEIGHT_MM))
        found = np.zeros(rays.shape[:2], dtype=bool)
        for i, level in enumerate(levels):
            s = (level - oy) / down
            over = level - self.height_at(ox + s * rays[..., 0], oz + s * rays[..., 2])
            new = (over <= 0.0) & ~found
            ratio = np.clip(over[new] / np.minimum(over[new] - before[new], -1e-6), 0.0, 1.0)
            step = (levels[i - 1] - level) / down[new] if i else np.float32(0.0)
            scale[new] = s[new] + ratio * step
            found |= new
            before = over
        return np.asarray(scale, dtype=np.float32)


def wound_ratio(x_mm: Image32, z_mm: Image32) -> Image32:
    """Return the normalised distance from the wound's centre: 0 at the centre, 1 at the edge."""
    half_x, half_z = WOUND_HALF_MM
    power = WOUND_POWER
    bent = np.abs(x_mm / half_x) ** power + np.abs((z_mm - WOUND_CENTRE_Z_MM) / half_z) ** power
    return np.asarray(bent ** (1.0 / power), dtype=np.float32)


def _step(value: Image32, low: float, high: float) -> Image32:
    t = np.clip((value - low) / (high - low), 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t), dtype=np.float32)


def _folds(x: Image32, z: Image32, random: np.random.Generator) -> Image32:
    """Return cloth folds: a few long, curved waves."""
    out = np.zeros_like(x)
    for _ in range(4):
        angle, length = random.uniform(0, np.pi), random.uniform(60.0, 160.0)
        along, across = np.cos(angle) * x + np.sin(angle) * z, np.cos(angle) * z - np.sin(angle) * x
        bend = 18.0 * np.sin(across / random.uniform(70.0, 130.0) + random.uniform(0, 6))
        wave = 0.5 + 0.5 * np.sin((along + bend) * (2.0 * np.pi / length) + random.uniform(0, 6))
        out += (wave**3 * length * 0.035).astype(np.float32)
    return out
