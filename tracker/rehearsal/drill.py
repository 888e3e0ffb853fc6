"""Appearance of the drill: a body of revolution, and the board with the marker on its front."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.rehearsal.layer_kernels import Portrait

Image8 = npt.NDArray[np.uint8]
Image32 = npt.NDArray[np.float32]

# Radius over the distance from the tip: burr, shaft, sleeve, nose, handpiece, tail, cable.
PROFILE_MM = np.array(
    [
        0.0,
        0.4,
        1.0,
        2.0,
        3.0,
        3.8,
        4.4,
        40,
        40.2,
        56,
        56.2,
        58,
        74,
        78,
        88,
        96,
        168,
        172,
        180,
        182,
        190,
        192,
        330,
    ]
)
RADIUS_MM = np.array(
    [
        *(0.0, 1.15, 1.75, 2.0, 1.75, 1.2, 1.15),
        *(1.15, 2.4, 2.4, 3.6, 3.9, 5.6, 7.6, 8.2, 8.5, 8.5, 8.2, 7.4, 4.2, 3.2, 2.3, 2.3),
    ]
)
PORTRAIT_PER_MM = 4.0
PORTRAIT_HALF_MM = 10.0
PORTRAIT_START_MM, PORTRAIT_END_MM = -3.0, 330.0

# Length of the drill from the tip that can be near the bone.
NEAR_BONE_MM = 78.0

BOARD_HALF_MM = 17.5
BOARD_PER_MM = 16.0
BOARD_WHITE, BOARD_BLACK = 0.97, 0.09
BOARD_THICK_MM = 1.6
BOARD_EDGE_GREY = 0.50


def drill_portrait() -> Portrait:
    """Return the side view of the drill's body."""
    t, d = _stations()
    radius = np.interp(t, PROFILE_MM, RADIUS_MM, left=0.0)[None, :]
    across = np.clip(d[:, None] / np.maximum(radius, 1e-6), -1.0, 1.0)
    coverage = np.clip((radius - np.abs(d[:, None])) * PORTRAIT_PER_MM + 0.5, 0.0, 1.0) * (radius > 0)
    colour = _colour(t[None, :] + 0 * across, across)
    picture = _premultiplied(colour, coverage)
    shown = np.flatnonzero(picture[..., 3].any(axis=1))
    bulge = np.sqrt(np.maximum(radius**2 - d[:, None] ** 2, 0.0))
    return Portrait(
        picture=picture,
        bulge_mm=bulge.astype(np.float32),
        first_row=int(shown[0]) - 1,
        last_row=int(shown[-1]) + 1,
        near_columns=round((NEAR_BONE_MM - PORTRAIT_START_MM) * PORTRAIT_PER_MM),
        start_mm=PORTRAIT_START_MM,
        half_mm=PORTRAIT_HALF_MM,
        per_mm=PORTRAIT_PER_MM,
    )


def board_face(marker_image: Image8, half_mm: float = BOARD_HALF_MM) -> Image8:
    """Return the white board with the marker at its centre, grey, `BOARD_PER_MM` pixels per mm."""
    side = round(2 * half_mm * BOARD_PER_MM)
    face = np.full((side, side), BOARD_WHITE, dtype=np.float32)
    start = (side - marker_image.shape[0]) // 2
    printed = BOARD_BLACK + (BOARD_WHITE - BOARD_BLACK) * marker_image.astype(np.float32) / 255.0
    face[start : start + marker_image.shape[0], start : start + marker_image.shape[1]] = printed
    return np.asarray(np.rint(face * 255.0), dtype=np.uint8)


def _stations() -> tuple[Array, Array]:
    """Return the distance from the tip of each column, and from the axis of each row."""
    columns, rows = (PORTRAIT_END_MM - PORTRAIT_START_MM, 2.0 * PORTRAIT_HALF_MM)
    along = (np.arange(int(columns * PORTRAIT_PER_MM)) + 0.5) / PORTRAIT_PER_MM + PORTRAIT_START_MM
    across = (np.arange(int(rows * PORTRAIT_PER_MM)) + 0.5) / PORTRAIT_PER_MM - PORTRAIT_HALF_MM
    return np.asarray(along, dtype=np.float64), np.asarray(across, dtype=np.float64)


def _colour(t: npt.NDArray[np.float64], s: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return BGR 0..1 at distances t from the tip and s across (-1..1)."""
    turn = np.arcsin(s)
    round_light = 0.34 + 0.66 * np.clip(np.cos(turn - 0.55), 0.0, 1.0) ** 1.3
    band = np.exp(-(((s - 0.42) / 0.16) ** 2)) + 0.35 * np.exp(-(((s + 0.62) / 0.12) ** 2))
    steel = np.array([0.70, 0.68, 0.66]) * (0.62 * round_light + 0.55 * band)[..., None]
    satin = np.array([0.80, 0.79, 0.77]) * (0.80 * round_light + 0.22 * band)[..., None]
    dark = np.array([0.24, 0.22, 0.21]) * (round_light + 0.5 * band)[..., None]
    blue = np.array([0.62, 0.36, 0.12]) * (round_light + 0.3 * band)[..., None]
    out = satin
    out = np.where((t < 56.1)[..., None], steel, out)
    flutes = 0.72 + 0.28 * np.sign(np.sin(7.0 * turn + 2.2 * t))
    out = np.where((t < 4.4)[..., None], steel * flutes[..., None], out)
    # The sleeve's end, the grip's grooves, a coloured ring, the tail and the cable.
    out = np.where(((t > 40) & (t < 41.2))[..., None], steel * 0.55, out)
    grooves = (t > 60) & (t < 74) & (np.mod(t, 2.8) < 1.0)
    out = np.where(grooves[..., None], out * 0.62, out)
    out = np.where(((t > 90) & (t < 93.5))[..., None], blue, out)
    out = np.where(((t > 142) & (t < 143) | (t > 164) & (t < 165))[..., None], satin * 0.5, out)
    out = np.where((t > 172)[..., None], dark, out)
    return np.clip(out, 0.0, 1.0)


def _premultiplied(colour: npt.NDArray[np.float64], coverage: npt.NDArray[np.float64]) -> Image8:
    layer = np.dstack([colour * coverage[..., None], coverage])
    # Half a pixel of softness keeps the outline smooth when it is sampled obliquely.
    soft = cv2.GaussianBlur(layer.astype(np.float32), (0, 0), 0.7)
    return np.asarray(np.rint(soft * 255.0), dtype=np.uint8)
