"""Assign detected bars to planned needles: all assignments, ranked by likelihood."""

import itertools
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.geometry import Array, rotation_from_vector
from tracker.registration.needles.detection import DetectedNeedle
from tracker.registration.needles.observation import OCCLUDED_MM, OCCLUDED_SD_MM
from tracker.registration.needles.planned import PlannedNeedle
from tracker.registration.needles.pose_solver import solve_from_view
from tracker.registration.needles.residuals import NeedleProblem
from tracker.registration.needles.view_prior import (
    RulerMeasurement,
    TouchedPoint,
    frame_of_sight,
    view_prior_from_ruler,
)

MAX_CANDIDATES, MAX_ASSIGNMENTS, MAX_FITTED = 24, 40_000, 40
MONTE_CARLO_SAMPLES = 1200
# Visible length of needles outside the bone: mean, common sd, sd of each and minimum. They are of one type
# and driven in fully, and a crossing needle may occlude a part.
OUT_MM, OUT_SD_MM, EACH_SD_MM, SHORTEST_OUT_MM = 45.0, 12.0, 10.0, 15.0
# All needles have the same diameter, so their widths in the image differ only by depth and noise.
WIDTH_SD_RATIO = 0.15


def rank_assignments(
    candidates: Sequence[DetectedNeedle],
    places: Sequence[PlannedNeedle],
    camera: CameraModel,
    measured: RulerMeasurement,
    *,
    touched: tuple[TouchedPoint, ...] = (),
) -> list[tuple[float, tuple[int, ...]]]:
    """Return assignments as (cost, indices in the plan's order), the most likely first.

    All are compared with Monte Carlo samples of the view: relative entries, directions and lengths in the
    image. The best ones are compared by the cost of their fitted pose.

    Args:
        candidates: detected needles, the most likely first.
        places: planned needles.
        camera: calibrated.
        measured: V, H and azimuth.
        touched: points captured with the tool's tip.
    """
    choices = _choices(len(candidates), len(places))
    shown, beside = _shown_costs(candidates, places, camera, measured, choices)
    beside = beside + observation_costs(candidates, choices)
    fine = []
    for n in np.argsort(shown + beside, kind="stable")[:MAX_FITTED]:
        choice = tuple(int(i) for i in choices[n])
        seen = [candidates[i].seen for i in choice]
        at_px = np.mean([one.entry_px for one in seen], axis=0)
        view = view_prior_from_ruler(measured, camera, at_px, touched=touched)
        cost = solve_from_view(NeedleProblem.of(places, seen, camera, view)).cost
        fine.append((cost + float(beside[n]), choice))
    return sorted(fine)


def _choices(candidates: int, places: int) -> npt.NDArray[np.intp]:
    """Return all assignments (m, n) of as many candidates as the budget permits."""
    count = min(candidates, MAX_CANDIDATES)
    while count > places and math.perm(count, places) > MAX_ASSIGNMENTS:
        count -= 1
    return np.array(list(itertools.permutations(range(count), places)), dtype=np.intp)


def _shown_costs(
    candidates: Sequence[DetectedNeedle],
    places: Sequence[PlannedNeedle],
    camera: CameraModel,
    measured: RulerMeasurement,
    choices: npt.NDArray[np.intp],
) -> tuple[Array, Array]:
    """Return squared Mahalanobis distances (m) of the lines, and the additional ones of the lengths."""
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
    """Return squared Mahalanobis distances (m) of rows (m, k)."""
    # The entries are relative to their mean, so the covariance has rank deficiency 2.
    known = np.linalg.pinv(spread, rcond=1e-9, hermitian=True)
    return np.asarray(np.einsum("ni,ij,nj->n", off, known, off))


def observation_costs(candidates: Sequence[DetectedNeedle], choices: npt.NDArray[np.intp]) -> Array:
    """Return the cost (m) of each assignment (m, n) by unequal widths and low scores."""
    widths = np.array([one.seen.width_px for one in candidates])[choices]
    mean = np.maximum(widths.mean(axis=1, keepdims=True), 1e-9)
    uneven = (widths / mean - 1.0) / WIDTH_SD_RATIO
    doubt = -2.0 * np.log([max(one.score_ratio, 1e-3) for one in candidates])
    return np.asarray((uneven**2).sum(axis=1) + doubt[choices].sum(axis=1))


def _features(ends: Array) -> Array:
    """Return features (m, 4n) of ends (m, n, 2, 2): centred entries, directions in radians, log lengths."""
    entries = ends[:, :, 0] - ends[:, :, 0].mean(axis=1, keepdims=True)
    lines = ends[:, :, 1] - ends[:, :, 0]
    turns = np.arctan2(lines[..., 0], lines[..., 1])
    lengths = np.log(np.maximum(np.linalg.norm(lines, axis=2), 1e-9))
    return np.concatenate([entries.reshape(len(ends), -1), turns, lengths], axis=1)


def _seen_beside(rays: Array, choices: npt.NDArray[np.intp]) -> Array:
    """Return ends (m, n, 2, 2) as seen by a camera that looks at the centroid of the entries."""
    chosen = rays[choices]
    sights = chosen[:, :, 0].mean(axis=1)
    sights /= np.linalg.norm(sights, axis=1, keepdims=True)
    frames = np.stack([frame_of_sight(sight) for sight in sights])
    turned = np.einsum("mnei,mij->mnej", chosen, frames)
    return np.asarray(turned[..., :2] / np.maximum(turned[..., 2:], 1e-3))


def _drawn(places: Sequence[PlannedNeedle], camera: CameraModel, measured: RulerMeasurement) -> Array:
    """Return Monte Carlo samples of ends (samples, n, 2, 2) over view, placement, lean and length."""
    view = view_prior_from_ruler(measured, camera, camera.matrix[:2, 2])
    frame = frame_of_sight(np.array([0.0, 0.0, 1.0]))
    random = np.random.default_rng(0)
    turns = random.multivariate_normal(np.zeros(3), view.rotation_covariance, MONTE_CARLO_SAMPLES)
    rotations = np.stack([frame.T @ rotation_from_vector(turn) @ view.rotation for turn in turns])
    away = np.maximum(
        random.normal(view.distance_mm, view.distance_sd_mm, MONTE_CARLO_SAMPLES), 0.3 * view.distance_mm
    )
    out_mm = random.normal(OUT_MM, OUT_SD_MM, MONTE_CARLO_SAMPLES)
    middle = np.mean([one.point_lps_mm for one in places], axis=0)
    ends = np.empty((MONTE_CARLO_SAMPLES, len(places), 2, 2))
    ratio = OCCLUDED_SD_MM**2 / OCCLUDED_MM
    for n, place in enumerate(places):
        points = (
            random.multivariate_normal(place.point_lps_mm, place.covariance_mm2, MONTE_CARLO_SAMPLES) - middle
        )
        beside = np.linalg.svd(place.direction_lps[None])[2][1:]
        lean = random.normal(0.0, np.radians(place.direction_sd_deg), (MONTE_CARLO_SAMPLES, 2)) @ beside
        ways = place.direction_lps + lean
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        heads = np.maximum(out_mm + random.normal(0.0, EACH_SD_MM, MONTE_CARLO_SAMPLES), SHORTEST_OUT_MM)
        hidden = np.minimum(random.gamma(OCCLUDED_MM / ratio, ratio, MONTE_CARLO_SAMPLES), 0.6 * heads)
        for end, at_mm in enumerate((hidden, heads)):
            shown = np.einsum("mij,mj->mi", rotations, points + at_mm[:, None] * ways)
            depth = np.maximum(shown[:, 2] + away, 20.0)
            ends[:, n, end] = shown[:, :2] / depth[:, None]
    return ends
