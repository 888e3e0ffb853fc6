"""Outlines that the page draws in a cut, compared with the exact intersections of cylinders and plane.

    PYTHONPATH=. python tests/web/test_overlay_outlines.py

prints the largest distances in mm.
"""

import itertools
import json
import re
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2

from tests.web.page_modules import run_in_node

Vector = npt.NDArray[np.float64]

MODULES = [
    "cuts/overlay",
    "cuts/planes",
    "operator/plan/drawing/cylinder",
    "operator/plan/slices/place",
    "operator/plan/slices/vectors",
]
PROGRAM = """
const { overlayOf } = load("cuts/overlay");
const { cutGrid } = load("cuts/planes");
const drawn = given.cases.map(({ name, drill, channel, aheadMm }) => {
    const grid = cutGrid(name, drill.pose, { widthMm: 64, heightMm: 80 }, aheadMm);
    const { paths } = overlayOf(name, grid, { channel, drill, aheadMm, maxOffsetMm: 1.8 });
    return { paths, lps_from_px: grid.lps_from_px, pixel_mm: grid.pixel_mm };
});
process.stdout.write(JSON.stringify(drawn));
"""
MAX_DISTANCE_MM = 0.1
NAMES = ("axial", "sagittal", "probe", "anatomical-axial", "anatomical-sagittal", "anatomical-coronal")
# As far back as the page draws the drill.
SHAFT_MM = 200.0
PEDICLE_ENTRY = np.array([14.0, 12.0, 3.0])
# Distances at which a point is looked for on both sides of a boundary.
RADII_MM = (0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 5.0)
RAYS = 180


@dataclass(frozen=True, slots=True, kw_only=True)
class Cylinder:
    """A cylinder with flat ends, in mm of the vertebra."""

    start: Vector
    end: Vector
    radius: float

    def contains(self, points: Vector) -> npt.NDArray[np.bool_]:
        """Return for each point (..., 3) whether it is inside."""
        way = self.end - self.start
        length = np.linalg.norm(way)
        along = (points - self.start) @ (way / length)
        beside = np.linalg.norm(points - self.start - along[..., None] * (way / length), axis=-1)
        return np.asarray((along >= 0) & (along <= length) & (beside <= self.radius))


@dataclass(frozen=True, slots=True, kw_only=True)
class Plane:
    """A cut's plane: x right and y down, in mm from the middle of the top-left pixel."""

    origin: Vector
    right: Vector
    down: Vector

    def points(self, xy: Vector) -> Vector:
        """Return points of the vertebra (..., 3) from points of the plane (..., 2)."""
        return np.asarray(self.origin + xy[..., :1] * self.right + xy[..., 1:] * self.down)


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A drill, a plan and the name of a cut."""

    name: str
    tip: Vector
    axis: Vector
    entry: Vector
    target: Vector
    covariance: Vector
    ahead_mm: float

    def bodies(self) -> dict[str, Cylinder]:
        """Return what is drawn to scale, by the name of its path."""
        axis = (self.target - self.entry) / np.linalg.norm(self.target - self.entry)
        drill = Cylinder(start=self.tip - SHAFT_MM * self.axis, end=self.tip, radius=2.0)
        found = {
            "channel": Cylinder(start=self.entry, end=self.target, radius=4.0),
            "screw": Cylinder(start=self.entry, end=self.entry + 45.0 * axis, radius=3.25),
            "placed": Cylinder(
                start=self.entry + np.array([3.0, 0.0, 1.0]),
                end=self.target - np.array([2.0, 1.0, 0.0]),
                radius=3.0,
            ),
        }
        return found if self.name == "probe" else {**found, "shaft": drill}

    def message(self) -> dict[str, object]:
        """Return the arguments of the page's function."""
        placed = self.bodies()["placed"]
        variances, directions = np.linalg.eigh(self.covariance)
        half_axes = (directions * np.sqrt(chi2.ppf(0.95, 3) * variances)).T
        return {
            "name": self.name,
            "aheadMm": self.ahead_mm,
            "drill": {
                "pose": {"tip": self.tip.tolist(), "axis": self.axis.tolist()},
                "radiusMm": 2.0,
                "spread": {"ellipsoidMm": half_axes.tolist(), "coneDeg": 1.5},
                "nearest": None,
            },
            "channel": {
                "entry_in_vertebra_mm": self.entry.tolist(),
                "target_in_vertebra_mm": self.target.tolist(),
                "radius_mm": 4.0,
                "screw": {"diameter_mm": 6.5, "length_mm": 45.0},
                "ct_id": "ct",
                "placed_screws": [
                    {
                        "name": "L3 right",
                        "head_in_vertebra_mm": placed.start.tolist(),
                        "tip_in_vertebra_mm": placed.end.tolist(),
                        "diameter_mm": 6.0,
                    }
                ],
            },
        }


def cases() -> list[Case]:
    """Drills beside and aslant to a channel, from in line to 60 degrees, in each cut."""
    rng = np.random.default_rng(7)
    found = []
    for tilt, name in itertools.product([0.0, 0.0, 0.02, 0.3, 1.0], NAMES):
        planned = np.array([rng.uniform(-0.5, 0.5), -1.0, rng.uniform(-0.3, 0.3)])
        planned /= np.linalg.norm(planned)
        axis = planned + tilt * np.cross(planned, rng.normal(size=3))
        axis /= np.linalg.norm(axis)
        root = rng.normal(size=(3, 3)) * [1.2, 0.5, 0.2]
        found.append(
            Case(
                name=name,
                tip=PEDICLE_ENTRY + 18.0 * planned + (rng.uniform(-2.5, 2.5, 3) if tilt else 0.0),
                axis=axis,
                entry=PEDICLE_ENTRY,
                target=PEDICLE_ENTRY + 40.0 * planned,
                covariance=root @ root.T,
                ahead_mm=float(rng.choice([0.0, 10.0, 30.0])) if name == "probe" else 0.0,
            )
        )
    return found


def polygon(path: str) -> Vector:
    """Corners (N, 2) of a path of straight lines."""
    return np.array(re.findall(r"(-?[\d.]+) (-?[\d.]+)", path), dtype=np.float64).reshape(-1, 2)


def distances_to_polygon(points: Vector, corners: Vector) -> Vector:
    """Distance of each point (N, 2) from the closed polygon."""
    starts, ways = corners, np.roll(corners, -1, axis=0) - corners
    lengths2 = np.maximum((ways**2).sum(axis=1), 1e-18)
    away = points[:, None] - starts
    share = np.clip((away * ways).sum(axis=-1) / lengths2, 0.0, 1.0)
    return np.asarray(np.linalg.norm(away - share[..., None] * ways, axis=-1).min(axis=1))


def outline_error_mm(corners: Vector, plane: Plane, body: Cylinder) -> float:
    """Largest distance between a drawn outline and the boundary of the intersection, in both directions."""
    turns = np.linspace(0.0, 2 * np.pi, RAYS, endpoint=False)
    circle = np.column_stack([np.cos(turns), np.sin(turns)])
    # From the drawing to the truth: how far from each corner both inside and outside are found.
    near = body.contains(plane.points(corners[:, None] + np.zeros((1, 2))))[:, 0]
    to_truth = np.full(len(corners), np.inf)
    for radius in reversed(RADII_MM):
        inside = body.contains(plane.points(corners[:, None] + radius * circle[::10]))
        is_near = (inside != near[:, None]).any(axis=1)
        to_truth[is_near] = radius
    # From the truth to the drawing: boundary points by bisection from the middle.
    middle = corners.mean(axis=0)
    assert body.contains(plane.points(middle)), "the middle of the drawn outline is outside of the body"
    spokes = np.vstack([circle, corners - middle])
    spokes /= np.maximum(np.linalg.norm(spokes, axis=1, keepdims=True), 1e-12)
    low, high = np.zeros(len(spokes)), np.full(len(spokes), 300.0)
    for _ in range(50):
        half = (low + high) / 2
        inside = body.contains(plane.points(middle + half[:, None] * spokes))
        low, high = np.where(inside, half, low), np.where(inside, high, half)
    to_drawing = distances_to_polygon(middle + low[:, None] * spokes, corners)
    return float(max(to_truth.max(), to_drawing.max()))


def meets(plane: Plane, body: Cylinder) -> bool:
    """Whether plane and body meet, by a raster of 0.5 mm over more than the field."""
    steps = np.arange(-60.0, 140.0, 0.5)
    xy = np.stack(np.meshgrid(steps, steps), axis=-1)
    return bool(body.contains(plane.points(xy)).any())


def ellipse_error_mm(corners: Vector, centre: Vector, covariance: Vector) -> float:
    """Largest distance between a drawn ellipse and the 95 % contour of a covariance, in both directions."""
    turns = np.linspace(0.0, 2 * np.pi, 2000, endpoint=False)
    root = np.linalg.cholesky(covariance)
    contour = centre + np.sqrt(chi2.ppf(0.95, 2)) * np.column_stack([np.cos(turns), np.sin(turns)]) @ root.T
    forth = distances_to_polygon(contour, corners).max()
    back = distances_to_polygon(corners, contour).max()
    return float(max(forth, back))


def errors_mm(folder: Path) -> dict[str, list[float]]:
    """Errors of all outlines, by the name of their path."""
    found: dict[str, list[float]] = {}
    all_cases = cases()
    answer = run_in_node(PROGRAM, MODULES, {"cases": [case.message() for case in all_cases]}, folder)
    for case, drawn in zip(all_cases, json.loads(answer), strict=True):
        affine = np.array(drawn["lps_from_px"])
        right, down = (affine[:, axis] / np.linalg.norm(affine[:, axis]) for axis in (0, 1))
        plane = Plane(origin=affine[:, 2], right=right, down=down)
        for part, body in case.bodies().items():
            corners = polygon(drawn["paths"][part])
            if len(corners) == 0:
                assert not meets(plane, body), (case, part)
            else:
                found.setdefault(part, []).append(outline_error_mm(corners, plane, body))
        if case.ahead_mm == 0.0:
            to_plane = np.stack([right, down])
            centre = to_plane @ (case.tip - plane.origin)
            ellipse = polygon(drawn["paths"]["ellipse"])
            flat = to_plane @ case.covariance @ to_plane.T
            found.setdefault("ellipse", []).append(ellipse_error_mm(ellipse, centre, flat))
    return found


def test_outlines_and_the_tip_s_ellipse_are_exact_to_a_tenth_of_a_millimetre(tmp_path: Path) -> None:
    found = errors_mm(tmp_path)
    assert {part: len(errors) > len(NAMES) for part, errors in found.items()} == dict.fromkeys(
        ["channel", "screw", "placed", "shaft", "ellipse"], True
    )
    assert {part: max(errors) for part, errors in found.items() if max(errors) > MAX_DISTANCE_MM} == {}


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made_in:
        for name, errors in errors_mm(Path(made_in)).items():
            sys.stdout.write(
                f"{name:8} {len(errors)} outlines: median {np.median(errors):.3f}, "
                f"worst {max(errors):.3f} mm\n"
            )
