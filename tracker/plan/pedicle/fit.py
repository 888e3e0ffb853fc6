"""Least-squares fit of the bar model to the voxels, for sub-voxel wall positions even in thick slices.

A wall of 1 mm is blurred to half of its Hounsfield units, in thick slices to a third, so no threshold locates
it. A fit that models the voxel's box locates it to a tenth of a voxel. Rays provide only the initial outline.
It takes a quarter of a second per click.
"""

import functools
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array
from tracker.plan.edge_model import (
    BLUR_SD_LOG,
    CORTEX_SD_HU,
    LOCAL_BLUR_LOG,
    LOCAL_CORTEX_RATIO,
    USUAL_CORTEX_HU,
    Imaging,
)
from tracker.plan.pedicle import tube_model
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.outlines import planes_across
from tracker.plan.pedicle.search import Bar

MIN_HALF_MM, MAX_HALF_MM = 3.0, 6.0
# Iterations that only locate the section need fewer voxels than the final fit.
MAX_VOXELS = (900, 1200, 3500)
# Maximum number of steps per round. The first rounds are short, because bone that deviates from the bar model
# pulls the fit away over many steps. If the misfit of the first round is high, as for walls of high contrast,
# MORE_STEPS are tried, and used if the misfit is then low.
MAX_STEPS, MORE_STEPS = (8, 10, 20), 80
# A step that lowers the loss by less is the last one; the rest is far below the stated errors.
MIN_GAIN_RATIO = 1e-4
# If the narrowest section is farther than this from the window's centre, the window is moved again.
SETTLED, MORE_ROUNDS, MIN_WAIST = 0.15, 2, 0.02
# Only with a low misfit: otherwise a moving window converges on adjacent bone.
MAX_MISFIT_RATIO = 0.04
# Voxels outside of the wall are used within this band, and as many standard deviations of its blur.
OUTSIDE_BAND_MM, BAND_SDS = 1.2, 2.2
MIN_VOXELS = 60
MAX_PART_MM = 0.8
COARSE_SD_DEG = 4.0
# Scale of the robust loss: bone is not homogeneous.
MIN_SCALE_HU, SCALE_RATIO = 12.0, 0.06
# Sd of the change of the log thickness around the wall: a medial wall is two or three times as thick as the
# lateral one.
AROUND_SD_LOG = 0.3
# Expected HU of the cortex, from that of the densest voxels (0) to that of usual compact bone (1).
HIDDEN_RATIO = 0.25
# Residuals are correlated within cubes of this side: those of noise over some voxels, those of trabeculae and
# of bone that deviates from the model over a few millimetres.
CLUSTER_MM, MIN_FREE_RATIO = 3.0, 0.25
_FIXED_SLOPES: Array = np.array([0.0, 0.0, 0.02])


@dataclass(frozen=True, slots=True, kw_only=True)
class FittedBar:
    """A bar model fitted to voxels.

    Attributes:
        origin_mm: (3,), LPS; axis, left and up are unit (3,).
        half_mm: half the length of the window.
        parameters: (29,), see `tube_model`.
        covariance: (29, 29).
        residual_hu: robust standard deviation of the residuals.
        misfit_ratio: residual beyond noise as a ratio of the contrast of bone: deviation from the bar model.
        fitted: whether the fit converged; if not, these are the coarse values.
    """

    origin_mm: Array
    axis: Array
    left: Array
    up: Array
    half_mm: float
    parameters: Array
    covariance: Array
    residual_hu: float
    misfit_ratio: float
    fitted: bool


def fit_bar(near: Neighbourhood, bar: Bar, *, fixed_axis: bool = False) -> FittedBar:
    """Fit the bar around its narrowest section; iterate until window and axis are consistent.

    With a fixed axis, only position and shape of its section are fitted.
    """
    half = float(np.clip(0.8 * min(bar.behind_mm, bar.ahead_mm), MIN_HALF_MM, MAX_HALF_MM))
    origin, axis = bar.centre_mm, bar.axis
    parameters = _first_parameters(near, bar)
    fitted: FittedBar | None = None
    last = len(MAX_VOXELS) - 1
    for round_number in (*range(last + 1), *(last,) * MORE_ROUNDS):
        (left,), (up,) = planes_across(axis[None])
        frame = np.stack([axis, left, up])
        samples = _samples(near, bar, parameters, origin, frame, half, MAX_VOXELS[round_number])
        if len(samples.hu) < MIN_VOXELS:
            break
        slopes = _FIXED_SLOPES if fixed_axis else _coarse_slopes(bar, axis, left, up, half)
        solved = _solve(near, samples, half, parameters, slopes, MAX_STEPS[round_number])
        if fitted is None and not fixed_axis and _misfit_ratio(near, solved[2]) > MAX_MISFIT_RATIO:
            ended = _solve(near, samples, half, solved[0], slopes, MORE_STEPS)
            solved = ended if _misfit_ratio(near, ended[2]) <= MAX_MISFIT_RATIO else solved
        parameters, covariance, residual, done = solved
        fitted = FittedBar(
            origin_mm=origin,
            axis=axis,
            left=left,
            up=up,
            half_mm=half,
            parameters=parameters,
            covariance=covariance,
            residual_hu=residual,
            misfit_ratio=_misfit_ratio(near, residual),
            fitted=done,
        )
        settled = abs(narrowest(fitted)) <= SETTLED or fitted.misfit_ratio > MAX_MISFIT_RATIO
        if round_number == last and settled:
            break
        origin, turned, parameters = _moved(fitted)
        axis = axis if fixed_axis else turned
    return fitted if fitted is not None else _unfitted(near, bar, parameters, half)


def voxel_across_mm(near: Neighbourhood, fitted: FittedBar) -> tuple[float, float]:
    """Return the size of a voxel across the bar, from side to side and upwards."""
    to_left, upwards = np.linalg.norm(near.voxel_width_mm(np.stack([fitted.left, fitted.up])), axis=1)
    return float(to_left), float(upwards)


def imaging_of(near: Neighbourhood, fitted: FittedBar, axis: Array) -> Imaging:
    """Return HU of the cortex and blur along an axis, from the fit and what is usual, by their variances."""
    p, variance = fitted.parameters, np.diag(fitted.covariance)
    cortex_share = 1.0 / (1.0 + variance[tube_model.CORTEX] / CORTEX_SD_HU**2)
    cortex_hu = USUAL_CORTEX_HU + cortex_share * (p[tube_model.CORTEX] - USUAL_CORTEX_HU)
    local_hu = LOCAL_CORTEX_RATIO * (cortex_hu - near.tissue_hu)
    through = float((axis @ near.slice_normal) ** 2)
    blur_mm2 = np.exp(2.0 * p[tube_model.BLURS]) @ [1.0 - through, through]
    return Imaging(
        cortex_hu=float(cortex_hu),
        cortex_sd_hu=float(np.hypot(np.sqrt(1.0 - cortex_share) * CORTEX_SD_HU, local_hu)),
        blur_mm=float(np.sqrt(blur_mm2)),
        blur_sd_log=float(np.hypot(min(np.sqrt(variance[tube_model.BLUR]), BLUR_SD_LOG), LOCAL_BLUR_LOG)),
        tissue_hu=near.tissue_hu,
        noise_hu=near.noise_hu,
    )


def narrowest(fitted: FittedBar) -> float:
    """Return the position of the minimum section, -1..1 over the window; 0 if it does not narrow.

    The curvature of a weak waist is bounded below by `MIN_WAIST`, so that the place is a continuous function
    of the fit.
    """
    slope, bend = fitted.parameters[tube_model.GROWTH][:2]
    waist = np.hypot(max(float(bend), 0.0), MIN_WAIST)
    return float(np.clip(-slope / (2.0 * waist), -0.6, 0.6))


def _moved(fitted: FittedBar) -> tuple[Array, Array, Array]:
    """Return origin, axis and initial parameters of the next iteration, at the narrowest place."""
    at = narrowest(fitted)
    parameters = fitted.parameters.copy()
    c = parameters[tube_model.CENTRE]
    section = tube_model.section_at(parameters, np.array([at]))
    origin = (
        fitted.origin_mm
        + at * fitted.half_mm * fitted.axis
        + section.x_mm[0] * fitted.left
        + section.y_mm[0] * fitted.up
    )
    slope = np.array([c[1] + 2 * c[2] * at, c[4] + 2 * c[5] * at]) / fitted.half_mm
    axis = fitted.axis + slope[0] * fitted.left + slope[1] * fitted.up
    parameters[tube_model.AXES][:2] = np.log([section.half_width_mm[0], section.half_height_mm[0]])
    parameters[tube_model.CENTRE] = [0.0, 0.0, c[2], 0.0, 0.0, c[5]]
    growth = parameters[tube_model.GROWTH]
    parameters[tube_model.GROWTH] = [0.0, growth[1], 0.0, growth[3]]
    return origin, axis / np.linalg.norm(axis), parameters


def _first_parameters(near: Neighbourhood, bar: Bar) -> Array:
    row = int(np.argmin(np.abs(bar.along_mm)))
    smooth = bar.sections.smooth_mm[row]
    quarter = len(smooth) // 4
    angle = 2.0 * np.pi * np.arange(len(smooth)) / len(smooth)
    # The second moments of the star-shaped outline give the initial ellipse.
    fourth = smooth**4
    xx, yy = (fourth * np.cos(angle) ** 2).mean(), (fourth * np.sin(angle) ** 2).mean()
    xy = (fourth * np.cos(angle) * np.sin(angle)).mean()
    values, vectors = np.linalg.eigh(np.array([[xx, xy], [xy, yy]]) / (smooth**2).mean())
    half = np.sqrt(np.maximum(2.0 * values, 0.5))
    wide = int(np.argmax(np.abs(vectors[0])))
    direction = vectors[:, wide] * np.sign(vectors[0, wide])
    round_shape = abs(half[0] - half[1]) < 0.06 * half.sum()
    out = np.zeros(tube_model.COUNT)
    out[tube_model.AXES] = [
        np.log(half[wide]),
        np.log(half[1 - wide]),
        0.0 if round_shape else np.arctan2(direction[1], direction[0]),
    ]
    if not np.isfinite(out).all() or quarter == 0:
        out[tube_model.AXES] = [np.log(4.0), np.log(6.0), 0.0]
    centre = near.smooth_hu(bar.centre_mm[None])[0]
    out[tube_model.CORTEX] = max(near.cortex_hu, centre)
    out[tube_model.THICKNESS] = np.log(1.2)
    out[tube_model.MARROW] = centre
    out[tube_model.BLURS] = np.log(_usual_blur_mm(near))
    out[tube_model.OUTSIDE.start] = near.tissue_hu
    return out


def _coarse_slopes(bar: Bar, axis: Array, left: Array, up: Array, half: float) -> Array:
    """Return the slopes of the coarse line against this axis, and the allowed change of the fit, in mm."""
    forwards = bar.axis @ axis
    to_left, to_up = bar.axis @ left / forwards, bar.axis @ up / forwards
    return np.array([to_left * half, to_up * half, np.tan(np.radians(COARSE_SD_DEG)) * half])


def _usual_blur_mm(near: Neighbourhood) -> float:
    inside = float(np.linalg.norm(near.lps_from_index[:3, :2], axis=0).mean())
    return float(np.clip(0.35 * inside, 0.1, 0.5))


def _samples(
    near: Neighbourhood,
    bar: Bar,
    parameters: Array,
    origin: Array,
    frame: Array,
    half: float,
    max_samples: int,
) -> tube_model.Samples:
    """Return the voxels of the window in the bar, or in a thin band around it without other bone."""
    sides = near.lps_from_index[:3, :3]
    section = tube_model.section_at(parameters, np.linspace(-1.0, 1.0, 5))
    widest_mm = np.maximum(section.half_width_mm, section.half_height_mm) * (
        1.0 + np.abs(parameters[tube_model.SHAPE]).sum()
    )
    blur_mm = np.exp(parameters[tube_model.BLUR])
    max_band_mm = OUTSIDE_BAND_MM + BAND_SDS * np.hypot(np.linalg.norm(sides) / np.sqrt(12.0), blur_mm)
    reach_mm = float((np.hypot(section.x_mm, section.y_mm) + widest_mm).max() + max_band_mm)
    points, hu = _voxels(near, origin, frame, half, reach_mm)
    local = (points - origin) @ frame.T
    along = local[:, 0] / half
    distance, angle = tube_model.wall_distance_mm(parameters, along, local[:, 1:])
    a, b = np.exp(parameters[tube_model.AXES][:2])
    normal = np.stack([np.cos(angle) / a, np.sin(angle) / b], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    roll = parameters[tube_model.AXES][2]
    turn = np.array([[np.cos(roll), np.sin(roll)], [-np.sin(roll), np.cos(roll)]])
    normal = (normal @ turn) @ frame[1:]
    box_mm2 = (near.voxel_width_mm(normal) ** 2).sum(axis=1) / 12.0
    rows = np.flatnonzero(distance < OUTSIDE_BAND_MM + BAND_SDS * np.sqrt(box_mm2 + blur_mm**2))
    rows = rows[~_open(bar, points[rows])]
    if len(rows) > max_samples:
        rows = np.random.default_rng(1).choice(rows, max_samples, replace=False)
    normal = normal[rows]
    parts, offsets = _parts(near, frame, half)
    part_mm = near.voxel_width_mm(normal) / parts
    beside_mm = near.voxel_width_mm(np.cross(frame[0], normal)) / parts
    columns = [along[rows], local[rows, 1], local[rows, 2], part_mm.max(axis=1)]
    columns += [(part_mm**2).sum(axis=1) / 12.0 - columns[3] ** 2 / 12.0, (beside_mm**2).sum(axis=1) / 12.0]
    columns += [(normal @ near.slice_normal) ** 2]
    return tube_model.Samples(
        rows=np.ascontiguousarray(np.stack(columns, axis=1)), offsets=offsets, hu=hu[rows]
    )


def _parts(near: Neighbourhood, frame: Array, half: float) -> tuple[Array, Array]:
    """Return in how many parts the sides of a voxel are divided (3,), and the offsets of all parts (k, 3).

    Within a part, the wall is a plane edge with a small curvature.
    """
    sides = near.lps_from_index[:3, :3]
    parts = np.ceil(np.linalg.norm(sides, axis=0) / MAX_PART_MM).astype(int)
    steps = np.meshgrid(*((np.arange(n) + 0.5) / n - 0.5 for n in parts), indexing="ij")
    offsets = np.stack([step.ravel() for step in steps], axis=1) @ sides.T @ frame.T
    return parts, np.ascontiguousarray(offsets / [half, 1.0, 1.0])


def _voxels(
    near: Neighbourhood, origin: Array, frame: Array, half: float, reach_mm: float
) -> tuple[Array, Array]:
    """Return points (n, 3) and HU (n,) of the voxels in a cylinder along the first axis of the frame."""
    inverse = np.linalg.inv(near.lps_from_index[:3, :3])
    along, *across = np.abs(inverse @ frame.T).T
    reach = along * half + np.hypot(*across) * reach_mm
    middle = near.index_of(origin)
    last_index = np.array(near.block.shape[::-1]) - 1
    low = np.clip(np.floor(middle - reach), 0, last_index).astype(int)
    high = np.clip(np.ceil(middle + reach), 0, last_index).astype(int)
    k, j, i = np.mgrid[low[2] : high[2] + 1, low[1] : high[1] + 1, low[0] : high[0] + 1]
    index = np.stack([i.ravel(), j.ravel(), k.ravel()], axis=1)
    points = index @ near.lps_from_index[:3, :3].T + near.lps_from_index[:3, 3]
    hu = near.block[low[2] : high[2] + 1, low[1] : high[1] + 1, low[0] : high[0] + 1].ravel()
    local = (points - origin) @ frame.T
    close = (np.abs(local[:, 0]) <= half) & (np.hypot(local[:, 1], local[:, 2]) < reach_mm)
    return points[close], hu[close].astype(np.float64)


def _open(bar: Bar, points: Array) -> npt.NDArray[np.bool_]:
    """Return points (n,) where the coarse outline has no wall, or one that is not part of the bar."""
    cut = bar.sections
    along = (points - bar.centre_mm) @ bar.axis
    row = np.argmin(np.abs(along[:, None] - bar.along_mm), axis=1)
    away = points - cut.centre_mm[row]
    x = (away * cut.across[row]).sum(axis=1)
    y = (away * cut.up[row]).sum(axis=1)
    rays = cut.radius_mm.shape[1]
    ray = np.round(np.arctan2(y, x) / (2.0 * np.pi) * rays).astype(int) % rays
    radius, smooth = cut.radius_mm[row, ray], cut.smooth_mm[row, ray]
    stray = ~(np.abs(radius - smooth) < 0.8 + 0.15 * smooth)
    # Exclude only outside voxels: inside, the voxels belong to the bar in any case.
    return np.asarray(stray & (np.hypot(x, y) > 0.75 * smooth))


WALL = [tube_model.CORTEX, tube_model.THICKNESS]


def _solve(
    near: Neighbourhood, samples: tube_model.Samples, half: float, start: Array, slopes: Array, max_steps: int
) -> tuple[Array, Array, float, bool]:
    scale = max(MIN_SCALE_HU, near.noise_hu, SCALE_RATIO * (near.cortex_hu - near.tissue_hu))
    centre, width = _expected(near, start, slopes)

    # The solver asks for residuals and derivatives at the same place, one after the other.
    @functools.lru_cache(maxsize=1)
    def modelled(parameters: bytes) -> tuple[Array, Array]:
        return tube_model.model_hu(np.frombuffer(parameters).copy(), samples)

    def residuals(parameters: Array) -> Array:
        fit = (modelled(parameters.tobytes())[0] - samples.hu) / scale
        off = (parameters - centre) / width
        # The robust loss discounts large residuals. For a wall thinner than the blur only the product of
        # density and thickness is observable, so this transformation makes the loss of their priors
        # quadratic.
        off[WALL] *= np.sqrt(1.0 + 0.25 * off[WALL] ** 2)
        return np.concatenate([fit, off])

    def derivatives(parameters: Array) -> Array:
        off = (parameters[WALL] - centre[WALL]) / width[WALL]
        prior = 1.0 / width
        prior[WALL] *= (1.0 + 0.5 * off**2) / np.sqrt(1.0 + 0.25 * off**2)
        return np.concatenate([modelled(parameters.tobytes())[1] / scale, np.diag(prior)])

    low, high = _bounds(start)
    result = scipy.optimize.least_squares(
        residuals,
        np.clip(start, low + 1e-6, high - 1e-6),
        jac=derivatives,
        bounds=(low, high),
        loss="soft_l1",
        x_scale=np.minimum(width, 50.0),
        max_nfev=max_steps,
        ftol=MIN_GAIN_RATIO,
    )
    off, slopes_hu = modelled(result.x.tobytes())
    off = off - samples.hu
    scores = slopes_hu * (off / np.sqrt(1.0 + (off / scale) ** 2))[:, None] / scale**2
    covariance = _covariance(result.jac, scores, samples.rows[:, :3] * [half, 1.0, 1.0])
    residual = float(1.4826 * np.median(np.abs(off)))
    return result.x, covariance, residual, bool(result.status >= 0)


def _covariance(jacobian: Array, scores: Array, places_mm: Array) -> Array:
    """Return the covariance of the parameters, by a sandwich estimator with clusters of correlated residuals.

    The sums of the scores in cubes have the variance that noise, texture and misfit give them, however they
    are correlated. So no correlation is assumed, which would state the same error for noise and for misfit.

    Source: K.-Y. Liang, S. Zeger, Longitudinal data analysis using generalized linear models, Biometrika 73,
    1986.

    Args:
        jacobian: (n + p, p), of the n weighted residuals and p priors at the solution.
        scores: (n, p), the gradient of each residual's loss.
        places_mm: (n, 3), of the voxels.
    """
    data, priors = np.split(jacobian, [len(scores)])
    inverse = np.linalg.pinv(jacobian.T @ jacobian)
    used = float(np.trace(inverse @ (data.T @ data)))
    spread = np.zeros_like(inverse)
    # Two grids, so that the result depends less on where cubes begin.
    for shift in (0.0, 0.5):
        cubes, cube = np.unique(np.floor(places_mm / CLUSTER_MM + shift), axis=0, return_inverse=True)
        sums = np.zeros((len(cubes), scores.shape[1]))
        np.add.at(sums, cube, scores)
        free_ratio = max(1.0 - used / len(cubes), MIN_FREE_RATIO)
        spread += 0.5 * sums.T @ sums / free_ratio
    return np.asarray(inverse @ (spread + priors.T @ priors) @ inverse)


def _misfit_ratio(near: Neighbourhood, residual: float) -> float:
    misfit = np.sqrt(max(residual**2 - near.noise_hu**2, 0.0))
    return float(misfit / max(near.cortex_hu - near.tissue_hu, 50.0))


def _expected(near: Neighbourhood, start: Array, slopes: Array) -> tuple[Array, Array]:
    """Return prior mean and standard deviation of each parameter.

    `slopes`: slopes of the coarse line over the window and the sd of the fit about them: left, up, sd.
    """
    centre, width = np.zeros(tube_model.COUNT), np.full(tube_model.COUNT, 1e3)
    centre[tube_model.CENTRE] = [0.0, slopes[0], 0.0, 0.0, slopes[1], 0.0]
    width[tube_model.CENTRE] = [5.0, slopes[2], 0.6, 5.0, slopes[2], 0.6]
    centre[tube_model.AXES], width[tube_model.AXES] = start[tube_model.AXES], [1.0, 1.0, 1.0]
    width[tube_model.GROWTH] = [0.15, 0.2, 0.15, 0.2]
    width[tube_model.SHAPE] = 0.04
    # Blur hides the HU of a thin cortex, so that the densest voxels are below it.
    hidden_hu = HIDDEN_RATIO * max(USUAL_CORTEX_HU - near.cortex_hu, 0.0)
    centre[tube_model.CORTEX] = near.cortex_hu + hidden_hu
    width[tube_model.CORTEX] = np.hypot(max(0.25 * (near.cortex_hu - near.tissue_hu), 30.0), hidden_hu)
    centre[tube_model.THICKNESS], width[tube_model.THICKNESS] = np.log(1.3), 0.7
    width[tube_model.AROUND] = AROUND_SD_LOG
    centre[tube_model.MARROW], width[tube_model.MARROW] = start[tube_model.MARROW], 400.0
    centre[tube_model.BLURS], width[tube_model.BLURS] = np.log(_usual_blur_mm(near)), 0.6
    centre[tube_model.OUTSIDE] = [near.tissue_hu, 0.0, 0.0, 0.0, 0.0]
    width[tube_model.OUTSIDE] = [300.0, 150.0, 150.0, 100.0, 100.0]
    return centre, width


def _bounds(start: Array) -> tuple[Array, Array]:
    low, high = np.full(tube_model.COUNT, -np.inf), np.full(tube_model.COUNT, np.inf)
    low[tube_model.AXES], high[tube_model.AXES] = (
        start[tube_model.AXES] - [0.7, 0.7, 1.0],
        start[tube_model.AXES] + [0.7, 0.7, 1.0],
    )
    low[tube_model.CENTRE], high[tube_model.CENTRE] = -6.0, 6.0
    low[tube_model.GROWTH], high[tube_model.GROWTH] = -0.7, 1.5
    low[tube_model.SHAPE], high[tube_model.SHAPE] = -0.2, 0.2
    low[tube_model.THICKNESS], high[tube_model.THICKNESS] = np.log(0.25), np.log(8.0)
    low[tube_model.AROUND], high[tube_model.AROUND] = -1.0, 1.0
    low[tube_model.BLURS], high[tube_model.BLURS] = np.log(0.05), np.log(1.5)
    return low, high


def _unfitted(near: Neighbourhood, bar: Bar, parameters: Array, half: float) -> FittedBar:
    (left,), (up,) = planes_across(bar.axis[None])
    spread = np.zeros(tube_model.COUNT)
    spread[tube_model.CENTRE], spread[tube_model.AXES] = 0.7, 0.2
    return FittedBar(
        origin_mm=bar.centre_mm,
        axis=bar.axis,
        left=left,
        up=up,
        half_mm=half,
        parameters=parameters,
        covariance=np.diag(spread**2),
        residual_hu=near.noise_hu,
        misfit_ratio=1.0,
        fitted=False,
    )
