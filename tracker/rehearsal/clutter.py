"""Background clutter: instruments, gauze, labels and marker-like squares."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.rehearsal.field import OperatingField
from tracker.rehearsal.solids import Solid, tube

Image32 = npt.NDArray[np.float32]

# Positions of objects as ratios of the image's width and height: around the wound, never under the drill.
PLACES = ((0.11, 0.80), (0.90, 0.80), (0.12, 0.42), (0.91, 0.40), (0.30, 0.13), (0.80, 0.13), (0.24, 0.95))
STEEL = (0.66, 0.65, 0.64)
LOOKALIKES_ABOVE = 2.0
# A retractor's prong in the plane across the spine, from inside the wound's wall over its edge: x and height.
PRONG_MM = np.array([[44.0, 9.5], [46.5, 16.0], [52.0, 24.0], [58.5, 29.5], [66.0, 31.0], [80.0, 31.5]])
PRONGS_Z_MM = (-11.0, 2.0, 15.0)
RETRACTORS_FROM = 0.5
BAR_RINGS = 30


@dataclass(frozen=True, slots=True, kw_only=True)
class Sheet:
    """A flat object on the drapes.

    Attributes:
        picture: (h, w, 4) float32, BGR and coverage 0..1.
        size_mm: width and height.
        place: its centre, as ratios of the image's width and height.
        turn_rad: its rotation.
    """

    picture: Image32
    size_mm: tuple[float, float]
    place: tuple[float, float]
    turn_rad: float


def sheets(clutter: float, random: np.random.Generator) -> list[Sheet]:
    """Return gauze and labels; above a clutter of 2 also marker-like squares."""
    out = []
    places = [PLACES[i] for i in random.permutation(len(PLACES))]
    for i in range(round(1.4 * clutter)):
        picture, size = _gauze(random) if i % 2 == 0 else _label(random)
        out.append(_laid(picture, size, places[i % len(places)], 0.05 + 0.02 * i, random))
    out.extend(
        _laid(_lookalike(random), (36.0, 36.0), places[(i + 3) % len(places)], 0.10, random)
        for i in range(round(max(0.0, clutter - LOOKALIKES_ABOVE) * 1.5))
    )
    return out


def instruments(
    clutter: float, field: OperatingField, spots_mm: list[tuple[float, float]], random: np.random.Generator
) -> list[Solid]:
    """Return steel bars: retractors in the wound, and instruments at these positions (x, z)."""
    out = _retractors() if clutter >= RETRACTORS_FROM else []
    for i in range(min(round(1.6 * clutter), 12)):
        x, z = spots_mm[i % len(spots_mm)]
        x, z = x + random.normal(0.0, 12.0), z + random.normal(0.0, 12.0)
        angle = random.uniform(0.0, np.pi)
        pair = i % 2 == 0
        length_mm = random.uniform(105.0, 150.0)
        out.extend(_bar(field, (x, z), angle, side, length_mm) for side in ((-1.0, 1.0) if pair else (0.0,)))
    return out


def _retractors() -> list[Solid]:
    """Return two rake retractors, left and right."""
    out = []
    at = np.linspace(0.0, 1.0, BAR_RINGS)
    given = np.linspace(0.0, 1.0, len(PRONG_MM))
    x, height = (np.interp(at, given, PRONG_MM[:, i]) for i in range(2))
    for side in (-1.0, 1.0):
        for z in PRONGS_Z_MM:
            prong = np.stack([side * x, height, np.full(BAR_RINGS, z)], axis=1)
            out.append(tube(prong, 1.1 + 0.5 * at, colour=STEEL, gloss=0.9))
        ends = np.array(
            [[side * 80.0, 31.5, PRONGS_Z_MM[0] - 4.0], [side * 80.0, 31.5, PRONGS_Z_MM[-1] + 34.0]]
        )
        bar = ends[0] + at[:, None] * (ends[1] - ends[0])
        out.append(tube(bar, np.full(BAR_RINGS, 2.4), colour=STEEL, gloss=0.9))
    return out


def _bar(
    field: OperatingField, middle: tuple[float, float], angle: float, side: float, length_mm: float
) -> Solid:
    """Return one leg of a forceps (side -1 or 1), or a probe with a handle (side 0)."""
    t = np.linspace(0.0, 1.0, BAR_RINGS)
    along = (t - 0.5) * length_mm
    across = side * (0.8 + 5.0 * np.sin(np.pi * np.clip(t * 1.15, 0, 1)) ** 1.5)
    x = middle[0] + np.cos(angle) * along - np.sin(angle) * across
    z = middle[1] + np.sin(angle) * along + np.cos(angle) * across
    radius = 1.3 + 0.9 * t if side else np.where(t < 0.45, 1.3, 3.6)
    ground = field.height_at(x[None].astype(np.float32), z[None].astype(np.float32))[0]
    # Steel instruments lie on the highest folds of the cloth.
    height = np.polyval(np.polyfit(t, ground, 1), t)
    height += float(np.max(ground - height)) * 0.6 + radius
    return tube(np.stack([x, height, z], axis=1), radius, colour=STEEL, gloss=0.9)


def _laid(
    picture: Image32,
    size_mm: tuple[float, float],
    place: tuple[float, float],
    spread_ratio: float,
    random: np.random.Generator,
) -> Sheet:
    u, v = np.asarray(place) + random.uniform(-1, 1, 2) * spread_ratio
    return Sheet(
        picture=picture,
        size_mm=size_mm,
        place=(float(np.clip(u, 0.02, 0.98)), float(np.clip(v, 0.04, 0.96))),
        turn_rad=float(random.uniform(-np.pi, np.pi)),
    )


def _gauze(random: np.random.Generator) -> tuple[Image32, tuple[float, float]]:
    height, width = 200, 280
    rows, columns = np.mgrid[0:height, 0:width]
    weave = 0.86 + 0.05 * np.sin(rows * 1.6) * np.sin(columns * 1.6)
    picture = np.dstack([weave * 0.97, weave * 0.99, weave, np.ones_like(weave)])
    for _ in range(3):
        centre = random.uniform(0.2, 0.8, 2) * (height, width)
        stain = np.exp(-(((rows - centre[0]) ** 2 + (columns - centre[1]) ** 2) / random.uniform(200, 1500)))
        picture[..., :2] *= (1.0 - 0.62 * stain)[..., None]
        picture[..., 2] *= 1.0 - 0.22 * stain
    fold = columns > width * 0.52
    picture[..., :3] *= np.where(fold & (columns < width * 0.54), 0.84, 1.0)[..., None]
    edge = np.minimum(np.minimum(rows, height - 1 - rows), np.minimum(columns, width - 1 - columns))
    picture[..., 3] = np.clip(edge / 4.0, 0.0, 1.0)
    return picture.astype(np.float32), (58.0, 42.0)


def _label(random: np.random.Generator) -> tuple[Image32, tuple[float, float]]:
    picture = np.full((120, 260, 4), (237, 237, 234, 255), dtype=np.uint8)
    cv2.rectangle(picture, (0, 0), (259, 24), (153, 97, 41, 255), -1)
    ink, white, font = (51, 46, 46, 255), (242, 242, 242, 255), cv2.FONT_HERSHEY_SIMPLEX
    number = int(random.integers(10000, 99999))
    cv2.putText(picture, "SPINE TRAY", (8, 19), font, 0.6, white, 2)
    cv2.putText(picture, f"LOT {number}", (8, 56), font, 0.7, ink, 2)
    x = 8
    while x < 240:
        bar = int(random.integers(2, 6))
        cv2.rectangle(picture, (x, 72), (x + bar - 1, 108), ink, -1)
        x += bar + int(random.integers(2, 6))
    return picture.astype(np.float32) / 255.0, (46.0, 21.0)


def _lookalike(random: np.random.Generator) -> Image32:
    """Return a black square with a random white shape on white paper, as a foreign marker."""
    side, paper, ink = 144, (230, 230, 230, 255), (20, 20, 20, 255)
    picture = np.full((side, side, 4), paper, dtype=np.uint8)
    cv2.rectangle(picture, (22, 22), (121, 121), ink, -1)
    corners = random.uniform(38.0, 106.0, (int(random.integers(3, 7)), 2)).astype(np.int32)
    hull = cv2.convexHull(corners.reshape(-1, 1, 2))
    cv2.fillConvexPoly(picture, hull, paper, cv2.LINE_AA)
    return picture.astype(np.float32) / 255.0
