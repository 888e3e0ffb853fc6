"""Which bars of the image are which needles of the plan: all ways of naming them, the likeliest first."""

import itertools
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.geometry import Array, rotation_from_vector
from tracker.registration.needles.equations import Task
from tracker.registration.needles.finding import FoundNeedle
from tracker.registration.needles.places import NeedlePlace
from tracker.registration.needles.seen import HIDDEN_MM, HIDDEN_SD_MM
from tracker.registration.needles.solutions import nearest_solution
from tracker.registration.needles.view import MeasuredView, TouchedPoint, frame_of_sight, view_from_ruler

MAX_CANDIDATES, MAX_NAMINGS, MAX_FITTED = 24, 40_000, 40
DRAWN = 1200
# How far needles stand out of the bone: they are of one make, each driven in as deep as it goes, and what
# crosses one before the other may hide a part.
OUT_MM, OUT_SD_MM, EACH_SD_MM, SHORTEST_OUT_MM = 45.0, 12.0, 10.0, 15.0
# All needles are of one wire: their widths in the image differ by depth and noise alone.
WIDTH_SD_RATIO = 0.15


def likely_namings(
    candidates: Sequence[FoundNeedle],
    places: Sequence[NeedlePlace],
    camera: CameraModel,
    measured: MeasuredView,
    *,
    touched: tuple[TouchedPoint, ...] = (),
) -> list[tuple[float, tuple[int, ...]]]:
    """The likely choices and orders of candidates as (cost, indices in the plan's order), likeliest first.

    All are compared with what such a view shows: where needles come out of the bone beside one another, how
    they lie in the image and how long they look. The best of them are compared by the pose that fits them.

    Args:
        candidates: as found, the likeliest first.
        places: of the needles.
        camera: calibrated.
        measured: V, H and azimuth.
        touched: points that the tool's tip was held on.
    """
    choices = _choices(len(candidates), len(places))
    shown, beside = _shown_costs(candidates, places, camera, measured, choices)
    beside = beside + looks_costs(candidates, choices)
    fine = []
    for n in np.argsort(shown + beside, kind="stable")[:MAX_FITTED]:
        choice = tuple(int(i) for i in choices[n])
        seen = [candidates[i].seen for i in choice]
        at_px = np.mean([one.entry_px for one in seen], axis=0)
        view = view_from_ruler(measured, camera, at_px, touched=touched)
        cost = nearest_solution(Task.of(places, seen, camera, view)).cost
        fine.append((cost + float(beside[n]), choice))
    return sorted(fine)


def _choices(candidates: int, places: int) -> npt.NDArray[np.intp]:
    """All ways (m, n) of choosing, of as many of the likeliest candidates as there is time for."""
    count = min(candidates, MAX_CANDIDATES)
    while count > places and math.perm(count, places) > MAX_NAMINGS:
        count -= 1
    return np.array(list(itertools.permutations(range(count), places)), dtype=np.intp)


def _shown_costs(
    candidates: Sequence[FoundNeedle],
    places: Sequence[NeedlePlace],
    camera: CameraModel,
    measured: MeasuredView,
    choices: npt.NDArray[np.intp],
) -> tuple[Array, Array]:
    """How far each choice (m) is from what is expected: by its lines, and what its lengths add to that."""
    ends = np.stack([[one.seen.entry_px, one.seen.head_px] for one in candidates])
    rays = np.column_stack([camera.normalised_from_px(ends.reshape(-1, 2)), np.ones(2 * len(ends))])
    seen = _features(_seen_beside(rays.reshape(-1, 2, 3), choices))
    drawn = _features(_drawn(places, camera, measured))
    off = seen - drawn.mean(axis=0)
    lines = 3 * len(places)
    turns = slice(2 * len(places), lines)
    off[:, turns] = (off[:, turns] + np.pi) % (2.0 * np.pi) - np.pi
    spread = np.cov(drawn.T)
    by_lines = _far(off[:, :lines], spread[:lines, :lines])
    return by_lines, _far(off, spread) - by_lines


def _far(off: Array, spread: Array) -> Array:
    """Squared distances (m) of rows (m, k) in standard deviations."""
    # The entries are told from their middle, so that two of these numbers follow from the others.
    known = np.linalg.pinv(spread, rcond=1e-9, hermitian=True)
    return np.asarray(np.einsum("ni,ij,nj->n", off, known, off))


def looks_costs(candidates: Sequence[FoundNeedle], choices: npt.NDArray[np.intp]) -> Array:
    """What speaks against each choice (m, n) being needles of one kind: (m)."""
    widths = np.array([one.seen.width_px for one in candidates])[choices]
    mean = np.maximum(widths.mean(axis=1, keepdims=True), 1e-9)
    uneven = (widths / mean - 1.0) / WIDTH_SD_RATIO
    doubt = -2.0 * np.log([max(one.score_ratio, 1e-3) for one in candidates])
    return np.asarray((uneven**2).sum(axis=1) + doubt[choices].sum(axis=1))


def _features(ends: Array) -> Array:
    """(m, 4n) of ends (m, n, 2, 2): entries about their middle, directions in radians, log of the lengths."""
    entries = ends[:, :, 0] - ends[:, :, 0].mean(axis=1, keepdims=True)
    lines = ends[:, :, 1] - ends[:, :, 0]
    turns = np.arctan2(lines[..., 0], lines[..., 1])
    lengths = np.log(np.maximum(np.linalg.norm(lines, axis=2), 1e-9))
    return np.concatenate([entries.reshape(len(ends), -1), turns, lengths], axis=1)


def _seen_beside(rays: Array, choices: npt.NDArray[np.intp]) -> Array:
    """Ends (m, n, 2, 2) of each choice as a camera would see them that looks at the middle of the entries."""
    chosen = rays[choices]
    sights = chosen[:, :, 0].mean(axis=1)
    sights /= np.linalg.norm(sights, axis=1, keepdims=True)
    frames = np.stack([frame_of_sight(sight) for sight in sights])
    turned = np.einsum("mnei,mij->mnej", chosen, frames)
    return np.asarray(turned[..., :2] / np.maximum(turned[..., 2:], 1e-3))


def _drawn(places: Sequence[NeedlePlace], camera: CameraModel, measured: MeasuredView) -> Array:
    """Ends (DRAWN, n, 2, 2) as they might be seen: view, places, leans and lengths drawn as they spread."""
    view = view_from_ruler(measured, camera, camera.matrix[:2, 2])
    frame = frame_of_sight(np.array([0.0, 0.0, 1.0]))
    random = np.random.default_rng(0)
    turns = random.multivariate_normal(np.zeros(3), view.rotation_covariance, DRAWN)
    rotations = np.stack([frame.T @ rotation_from_vector(turn) @ view.rotation for turn in turns])
    away = np.maximum(random.normal(view.distance_mm, view.distance_sd_mm, DRAWN), 0.3 * view.distance_mm)
    out_mm = random.normal(OUT_MM, OUT_SD_MM, DRAWN)
    middle = np.mean([one.point_lps_mm for one in places], axis=0)
    ends = np.empty((DRAWN, len(places), 2, 2))
    ratio = HIDDEN_SD_MM**2 / HIDDEN_MM
    for n, place in enumerate(places):
        points = random.multivariate_normal(place.point_lps_mm, place.covariance_mm2, DRAWN) - middle
        beside = np.linalg.svd(place.direction_lps[None])[2][1:]
        lean = random.normal(0.0, np.radians(place.direction_sd_deg), (DRAWN, 2)) @ beside
        ways = place.direction_lps + lean
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        heads = np.maximum(out_mm + random.normal(0.0, EACH_SD_MM, DRAWN), SHORTEST_OUT_MM)
        hidden = np.minimum(random.gamma(HIDDEN_MM / ratio, ratio, DRAWN), 0.6 * heads)
        for end, at_mm in enumerate((hidden, heads)):
            shown = np.einsum("mij,mj->mi", rotations, points + at_mm[:, None] * ways)
            depth = np.maximum(shown[:, 2] + away, 20.0)
            ends[:, n, end] = shown[:, :2] / depth[:, None]
    return ends
