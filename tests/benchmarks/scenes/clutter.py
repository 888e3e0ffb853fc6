"""Cluttered backgrounds with many marker-like objects and no marker."""

from collections.abc import Callable
from functools import lru_cache

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Floats = npt.NDArray[np.float32]
Canvas = npt.NDArray[np.uint8]
SUPERSAMPLING = 2
SHIFT_BITS = 4
LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ0123456789+-:/"
# Things in an image of 768 px width; a wider image has as many, larger.
CLOTHS, TOOLS, LINES, DISCS, WORDS, BOARDS, SQUARES = 12, 10, 36, 26, 9, 3, 56


@lru_cache(maxsize=40)
def clutter(size_wh_px: tuple[int, int], seed: int) -> Floats:
    """Return the reflectance (h, w) of a background, 0 to 1, deterministic by seed; read-only."""
    random = np.random.default_rng([seed, 4201])
    width, height = size_wh_px[0] * SUPERSAMPLING, size_wh_px[1] * SUPERSAMPLING
    canvas = _cloth(random, (width, height))
    unit = (0.8 if size_wh_px[0] > 1200 else 1.0) * width / 768.0
    draw: list[tuple[int, Callable[[Canvas, np.random.Generator, float], None]]] = [
        (CLOTHS, _patch),
        (TOOLS, _tool),
        (LINES, _line),
        (DISCS, _disc),
        (WORDS, _word),
        (BOARDS, _checkerboard),
        (SQUARES, _square),
    ]
    for count, one in draw:
        for _ in range(count):
            one(canvas, random, unit)
    small = cv2.resize(canvas, size_wh_px, interpolation=cv2.INTER_AREA).astype(np.float32) / 255.0
    grain = random.standard_normal(small.shape, dtype=np.float32)
    reflectance = np.clip(0.05 + 0.85 * small + 0.015 * grain, 0.02, 0.95).astype(np.float32)
    reflectance.setflags(write=False)
    return reflectance


def _cloth(random: np.random.Generator, size_wh: tuple[int, int]) -> Canvas:
    """Soft folds of several sizes."""
    width, height = size_wh
    grey = np.full((height, width), random.uniform(70.0, 150.0), np.float32)
    for waves, size in ((3, 34.0), (9, 22.0), (31, 12.0), (120, 6.0)):
        rough = random.standard_normal((max(2, waves * height // width), waves)).astype(np.float32)
        grey += size * cv2.resize(rough, (width, height), interpolation=cv2.INTER_CUBIC)
    return np.clip(grey, 8, 247).astype(np.uint8)


def _place(canvas: Canvas, random: np.random.Generator) -> Array:
    return random.uniform([0.0, 0.0], [canvas.shape[1], canvas.shape[0]])


def _fill(canvas: Canvas, corners: Array, grey: float) -> None:
    points = np.rint(corners * 2**SHIFT_BITS).astype(np.int32)
    cv2.fillPoly(canvas, [points], grey, cv2.LINE_AA, SHIFT_BITS)


def _blob(random: np.random.Generator, centre: Array, radius: float, corners: int) -> Array:
    angles = np.sort(random.uniform(0.0, 2.0 * np.pi, corners))
    far = radius * random.uniform(0.45, 1.0, corners)
    return centre + np.stack([far * np.cos(angles), far * np.sin(angles)], axis=1)


def _leaning_square(random: np.random.Generator, centre: Array, radius: float) -> Array:
    """Return an oblique square as a camera sees it: rotated, foreshortened, with perspective."""
    angles = np.pi / 4.0 + np.arange(4) * (np.pi / 2.0)
    flat = np.stack([np.cos(angles), np.sin(angles)], axis=1) * random.uniform(0.85, 1.15, (4, 1))
    flat = _turned(flat, random.uniform(0.0, np.pi)) * [1.0, random.uniform(0.5, 1.0)]
    return centre + radius * _turned(flat, random.uniform(0.0, 2.0 * np.pi))


def _turned(points: Array, angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points @ np.array([[c, s], [-s, c]]), dtype=np.float64)


def _patch(canvas: Canvas, random: np.random.Generator, unit: float) -> None:
    corners = int(random.integers(5, 10))
    outline = _blob(random, _place(canvas, random), unit * random.uniform(35.0, 130.0), corners)
    _fill(canvas, outline, random.uniform(15.0, 235.0))


def _tool(canvas: Canvas, random: np.random.Generator, unit: float) -> None:
    """A long metal bar with a bright line along it."""
    centre, angle = _place(canvas, random), random.uniform(0.0, np.pi)
    length, width, grey = (
        unit * random.uniform(60, 240),
        unit * random.uniform(3, 13),
        random.uniform(30, 175),
    )
    box = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    _fill(canvas, centre + _turned(box * [length, width], angle), grey)
    _fill(canvas, centre + _turned(box * [length, width * random.uniform(0.1, 0.4)], angle), grey + 75.0)


def _line(canvas: Canvas, random: np.random.Generator, unit: float) -> None:
    a, b = (_place(canvas, random).astype(int).tolist() for _ in range(2))
    thick = max(1, round(unit * random.uniform(0.5, 2.2)))
    cv2.line(canvas, a, b, random.uniform(0.0, 255.0), thick, cv2.LINE_AA)


def _disc(canvas: Canvas, random: np.random.Generator, unit: float) -> None:
    centre = _place(canvas, random).astype(int).tolist()
    axes = np.maximum(unit * random.uniform(2.0, 28.0, 2), 1.0).astype(int).tolist()
    thick = -1 if random.uniform() < 0.5 else max(1, round(unit * random.uniform(1.0, 3.0)))
    angle = random.uniform(0.0, 180.0)
    cv2.ellipse(canvas, centre, axes, angle, 0.0, 360.0, random.uniform(0, 255), thick, cv2.LINE_AA)


def _word(canvas: Canvas, random: np.random.Generator, unit: float) -> None:
    text = "".join(random.choice(list(LETTERS), int(random.integers(3, 11))))
    where = _place(canvas, random).astype(int).tolist()
    grey = float(random.choice([12.0, 35.0, 215.0, 245.0]))
    thick = max(1, round(unit * random.uniform(0.8, 1.8)))
    scale = unit * random.uniform(0.3, 1.1)
    cv2.putText(canvas, text, where, cv2.FONT_HERSHEY_SIMPLEX, scale, grey, thick, cv2.LINE_AA)


def _checkerboard(canvas: Canvas, random: np.random.Generator, unit: float) -> None:
    corners = _leaning_square(random, _place(canvas, random), unit * random.uniform(30.0, 80.0))
    dark, bright = random.uniform(10.0, 60.0), random.uniform(170.0, 245.0)
    _fill(canvas, corners, bright)
    _fields(canvas, corners, np.indices((6, 6)).sum(axis=0) % 2 == 0, dark)


def _fields(canvas: Canvas, corners: Array, dark: npt.NDArray[np.bool_], grey: float) -> None:
    rows, columns = dark.shape
    flat = np.array([[0, 0], [columns, 0], [columns, rows], [0, rows]], np.float32)
    seen = cv2.getPerspectiveTransform(flat, corners.astype(np.float32))
    for row, column in np.argwhere(dark):
        cell = np.array([[[0, 0], [1, 0], [1, 1], [0, 1]]], np.float32) + np.array([column, row])
        _fill(canvas, cv2.perspectiveTransform(cell.astype(np.float32), seen)[0].astype(np.float64), grey)


def _square(canvas: Canvas, random: np.random.Generator, unit: float) -> None:
    """Draw a marker-like square: mostly dark, on paper, often with something inside."""
    centre, radius = _place(canvas, random), unit * random.uniform(8.0, 36.0)
    corners = _leaning_square(random, centre, radius)
    ink, paper = random.uniform(5.0, 60.0), random.uniform(150.0, 240.0)
    if random.uniform() < 0.3:
        ink, paper = paper, ink
    if random.uniform() < 0.6:
        _fill(canvas, centre + (corners - centre) * random.uniform(1.2, 1.5), paper)
    _fill(canvas, corners, ink)
    if random.uniform() < 0.25:
        return
    share = random.uniform(0.5, 0.8)
    inner = centre + (corners - centre) * share
    within = int(random.integers(0, 6))
    if within == 5:
        _fields(canvas, inner, random.uniform(size=(4, 4)) < 0.5, paper)
        return
    _fill(canvas, inner, paper)
    room = radius * share * 0.6
    if within == 0:
        _fill(canvas, centre + (inner - centre) * 0.5, ink)
    elif within == 1:
        cv2.circle(canvas, centre.astype(int).tolist(), max(1, int(room * 0.7)), ink, -1, cv2.LINE_AA)
    elif within in {2, 3}:
        _fill(canvas, _blob(random, centre, room, 3 + 2 * (within - 2)), ink)
    else:
        _fields(canvas, inner, random.uniform(size=(3, 3)) < 0.4, ink)
