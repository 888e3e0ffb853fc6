"""Find regular grids among points, and the cell of each point."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from tracker.camera.detection.plane import off_plane_px
from tracker.geometry import Array

Cells = npt.NDArray[np.int64]
Cell = tuple[int, int]

# Maximum difference of successive steps, as a ratio of their length.
STEP_TOLERANCE_RATIO = 0.3
MIN_MEMBERS = 6
NEIGHBOURS = 9
SEEDS = 40
MIN_ANGLE_SINE = 0.35
# Maximum distance of a point from the smooth model of the grid, in steps.
OFF_GRID_RATIO = 0.2
DIRECTIONS: tuple[Cell, ...] = ((1, 0), (-1, 0), (0, 1), (0, -1))
# Other bases of the same lattice, because in an oblique view a diagonal may be shorter than a side.
BASES = tuple(
    np.array(basis)
    for basis in (((1, 0), (0, 1)), ((1, 1), (0, 1)), ((1, -1), (0, 1)), ((1, 0), (1, 1)), ((1, 0), (-1, 1)))
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Lattice:
    """Points of one regular grid.

    Attributes:
        members: (n,), indexes of the given points.
        cells: (n, 2), steps along two sides; from x to y is clockwise in the image.
    """

    members: npt.NDArray[np.int64]
    cells: Cells


def lattices(points_px: Array, *, max_count: int) -> Iterator[Lattice]:
    """Yield regular grids among points (n, 2), each among the points without the previous ones."""
    left = np.arange(len(points_px))
    for _ in range(max_count):
        found = largest_lattice(points_px[left])
        if len(found.members) < MIN_MEMBERS:
            return
        yield Lattice(members=left[found.members], cells=found.cells)
        left = np.delete(left, found.members)


def largest_lattice(points_px: Array) -> Lattice:
    """Return the largest regular grid among points (n, 2); a grid without points if there is none."""
    best: dict[Cell, int] = {}
    if len(points_px) >= 5:
        tree = scipy.spatial.KDTree(points_px)
        tried: set[int] = set()
        for seed in _seeds(points_px):
            if seed in tried:
                continue
            basis = _basis_at(points_px, tree, seed)
            if basis is None:
                continue
            grown = _grown(points_px, tree, seed, basis)
            tried.update(grown.values())
            if len(grown) > len(best):
                best = grown
            if len(best) > len(points_px) // 2:
                break
    members = np.array(list(best.values()), dtype=np.int64)
    cells = np.array(list(best), dtype=np.int64).reshape(-1, 2)
    lattice = _smooth_part(points_px, Lattice(members=members, cells=cells))
    return _upright(points_px, lattice)


def step_lengths_px(points_px: Array, cells: Cells) -> tuple[Array, Array]:
    """Return the shortest step to a neighbour of each point [px], and the area of its cell [px2]."""
    place = {(int(x), int(y)): index for index, (x, y) in enumerate(cells)}
    lengths, areas = np.zeros(len(cells)), np.zeros(len(cells))
    for index, (x, y) in enumerate(cells):
        steps = {}
        for dx, dy in DIRECTIONS:
            other = place.get((int(x) + dx, int(y) + dy))
            if other is not None:
                steps[dx, dy] = points_px[other] - points_px[index]
        along = [step * (dx + dy) for (dx, dy), step in steps.items() if dy == 0]
        across = [step * (dx + dy) for (dx, dy), step in steps.items() if dx == 0]
        if steps:
            lengths[index] = min(float(np.linalg.norm(step)) for step in steps.values())
        if along and across:
            a, b = np.mean(along, axis=0), np.mean(across, axis=0)
            areas[index] = abs(a[0] * b[1] - a[1] * b[0])
    known = areas > 0
    areas[~known] = np.median(areas[known]) if known.any() else 1.0
    stepped = lengths > 0
    lengths[~stepped] = np.median(lengths[stepped]) if stepped.any() else 1.0
    return lengths, areas


def _seeds(points_px: Array) -> list[int]:
    """Return seed points near the centre and spread over all points."""
    from_middle = np.argsort(np.linalg.norm(points_px - np.median(points_px, axis=0), axis=1))
    spread = np.linspace(0, len(points_px) - 1, min(SEEDS, len(points_px))).astype(int)
    return [int(i) for i in from_middle[: SEEDS // 4]] + [int(i) for i in from_middle[spread]]


def _basis_at(points_px: Array, tree: "scipy.spatial.KDTree", seed: int) -> tuple[Array, Array] | None:
    """Return two basis steps from a point to neighbours that also exist in the opposite direction."""
    here = points_px[seed]
    _, near = tree.query(here, k=min(NEIGHBOURS, len(points_px)))
    steps = points_px[near[1:]] - here
    lengths_px = np.linalg.norm(steps, axis=1)
    # One query of all, because a query costs more than its points.
    back_px, _ = tree.query(here - steps)
    is_regular = (lengths_px >= 2.0) & (back_px <= STEP_TOLERANCE_RATIO * lengths_px)
    steps, lengths_px = steps[is_regular], lengths_px[is_regular]
    if not len(steps):
        return None
    sines = np.abs(steps[0, 0] * steps[:, 1] - steps[0, 1] * steps[:, 0]) / (lengths_px[0] * lengths_px)
    crossing = np.flatnonzero(sines > MIN_ANGLE_SINE)
    return (steps[0], steps[crossing[0]]) if crossing.size else None


def _grown(
    points_px: Array, tree: "scipy.spatial.KDTree", seed: int, basis: tuple[Array, Array]
) -> dict[Cell, int]:
    """Return the cells of points reached from the seed by region growing with similar steps."""
    a, b = basis
    if a[0] * b[1] - a[1] * b[0] < 0:
        b = -b
    place: dict[Cell, int] = {(0, 0): seed}
    owner = {seed: (0, 0)}
    steps: dict[Cell, tuple[Array, Array]] = {(0, 0): (a, b)}
    queue = deque([(0, 0)])
    while queue:
        cell = queue.popleft()
        here = points_px[place[cell]]
        ways = [way for way in DIRECTIONS if (cell[0] + way[0], cell[1] + way[1]) not in place]
        if not ways:
            continue
        expected = np.array(ways) @ np.array(steps[cell])
        distances_px, nearest = tree.query(here + expected)
        is_near = distances_px <= STEP_TOLERANCE_RATIO * np.linalg.norm(expected, axis=1)
        for direction, found, near in zip(ways, nearest.tolist(), is_near, strict=True):
            target = (cell[0] + direction[0], cell[1] + direction[1])
            if not near or found in owner:
                continue
            place[target], owner[found] = found, target
            step = points_px[found] - here
            a_new, b_new = steps[cell]
            if direction[0]:
                a_new = direction[0] * step
            else:
                b_new = direction[1] * step
            steps[target] = (a_new, b_new)
            queue.append(target)
    return place


def _smooth_part(points_px: Array, lattice: Lattice) -> Lattice:
    """Return the lattice without outliers of a smooth model (homography and cubic distortion)."""
    for _ in range(3):
        count = len(lattice.members)
        if count < 12:
            return lattice
        px = points_px[lattice.members]
        off = _off_smooth(px, lattice.cells)
        lengths, _ = step_lengths_px(px, lattice.cells)
        retained = off < np.maximum(OFF_GRID_RATIO * lengths, 4.0 * np.median(off))
        if retained.all():
            return lattice
        lattice = Lattice(members=lattice.members[retained], cells=lattice.cells[retained])
    return lattice


def _off_smooth(px: Array, cells: Cells) -> Array:
    """Return the distance of each point from a robust fit of a homography with a cubic correction."""
    grid = cells.astype(np.float64)
    residual = off_plane_px(grid, px, is_robust=True)
    if residual is None:
        return np.zeros(len(px))
    flat = px - residual
    middle, size = flat.mean(axis=0), flat.std() + 1e-9
    x, y = ((flat - middle) / size).T
    order = 3 if len(px) >= 30 else 1
    terms = np.stack([x**i * y**j for i in range(order + 1) for j in range(order + 1 - i)], axis=1)
    weight = np.ones(len(px))
    off = np.linalg.norm(residual, axis=1)
    for _ in range(8):
        root = np.sqrt(weight)[:, None]
        bend, *_ = np.linalg.lstsq(terms * root, residual * root, rcond=None)
        off = np.linalg.norm(residual - terms @ bend, axis=1)
        weight = 1.0 / (1.0 + (off / (3.0 * np.median(off) + 1e-6)) ** 2)
    return np.asarray(off, dtype=np.float64)


def _upright(points_px: Array, lattice: Lattice) -> Lattice:
    """Return the grid with axes along its rows and columns, counted from 0."""
    if len(lattice.members) < 4:
        return lattice
    best, best_fill = lattice.cells, 0.0
    for basis in BASES:
        cells = np.rint(lattice.cells @ np.linalg.inv(basis)).astype(np.int64)
        extent = cells.max(axis=0) - cells.min(axis=0) + 1
        fill = len(cells) / float(extent[0] * extent[1])
        if fill > best_fill + 1e-9:
            best, best_fill = cells, fill
    cells = best - best.min(axis=0)
    px = points_px[lattice.members]
    design = np.column_stack([cells, np.ones(len(cells))])
    affine, *_ = np.linalg.lstsq(design, px, rcond=None)
    if affine[0, 0] * affine[1, 1] - affine[0, 1] * affine[1, 0] < 0:
        cells = np.column_stack([cells[:, 0], cells[:, 1].max() - cells[:, 1]])
    return Lattice(members=lattice.members, cells=cells)
