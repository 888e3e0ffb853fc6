"""Damped Gauss-Newton refinement of a planar pose and its cluster-robust covariance."""

import numpy as np

from tracker.camera.blur_kernels import clamp_blur
from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import copy_pose, copy_vector, rotate_by, solve_banded
from tracker.photometric.equation_kernels import (
    PLANAR_COUNT,
    add_priors,
    normal_equations,
    pixel_reliability,
    robust_sd,
    weighted_row,
)
from tracker.photometric.illumination_kernels import (
    GRID_EXTENT,
    MAX_SPLINE_PARAMETERS,
    PLANAR,
    SPLINE_SUPPORT,
    bandwidth_of,
    evaluate_illumination,
    illumination_first,
    spline_derivatives,
    spline_indices,
)
from tracker.photometric.render_kernels import predict
from tracker.photometric.response_kernels import (
    BLUR,
    ILLUMINATION,
    RESPONSE,
    apply_response,
    fit_planar_illumination,
)

# A step that lowers the cost by less moves the pose by less than one standard deviation; the next one, by
# quadratic convergence, by less than a tenth.
CONVERGED_COST_CHI2 = 0.3
MIN_CURVATURE_RATIO = 0.3
# What `predict` computes. No literals, see `compiled`.
ALL_DERIVATIVES, POSE_DERIVATIVES = np.int64(1), np.int64(0)
# Maximum growth of the blur's variance in one step.
MAX_WIDENED = 4.0


@compiled
def corner_motion_px(rotation, translation, lens, side_mm, step):
    """Return the largest motion of a marker corner in the image, in px, under a pose step (6,)."""
    farthest = 0.0
    for k in range(4):
        x = 0.5 * side_mm if k in (1, 2) else -0.5 * side_mm
        y = 0.5 * side_mm if k in (0, 1) else -0.5 * side_mm
        ax = rotation[0, 0] * x + rotation[0, 1] * y
        ay = rotation[1, 0] * x + rotation[1, 1] * y
        az = rotation[2, 0] * x + rotation[2, 1] * y
        vx = step[0] + step[4] * az - step[5] * ay
        vy = step[1] + step[5] * ax - step[3] * az
        vz = step[2] + step[3] * ay - step[4] * ax
        z = translation[2] + az
        du = lens[0] * (vx - (translation[0] + ax) / z * vz) / z
        dv = lens[1] * (vy - (translation[1] + ay) / z * vz) / z
        farthest = max(farthest, np.sqrt(du * du + dv * dv))
    return farthest


@compiled
def _apply_step(rotation, translation, parameters, step, share, min_blur):
    """Apply a fraction of a step in place; return False where the marker would face away from the camera."""
    blur = parameters[BLUR : BLUR + 3]
    max_blur = MAX_WIDENED * max(blur[0], blur[1])
    for k in range(3):
        translation[k] += share * step[k]
    rotate_by(rotation, step[3:6], share)
    for k in range(6, len(parameters)):
        parameters[k] += share * step[k]
    clamp_blur(blur, min_blur, max_blur)
    parameters[RESPONSE] = min(max(parameters[RESPONSE], -0.9), 0.9)
    facing = (
        rotation[0, 2] * translation[0] + rotation[1, 2] * translation[1] + rotation[2, 2] * translation[2]
    )
    return facing < 0.0


@compiled
def _damped_step(a, g, damping, order, band, step, rotation, translation, lens, side_mm, max_px):
    """Solve for the Levenberg-Marquardt step.

    Returns the predicted decrease of the cost in squared grey levels and the allowed fraction of the step; 0
    for none. The unknowns are permuted by `order` so that the banded part of the matrix is exploited.
    """
    n = len(g)
    damped, sides, solved = np.empty((n, n)), np.empty(n), np.empty(n)
    for m in range(n):
        sides[m] = g[order[m]]
        for k in range(m, n):
            damped[m, k] = a[order[m], order[k]]
        damped[m, m] *= 1.0 + damping
    if not solve_banded(damped, band, sides, solved):
        return 0.0, 0.0
    gain = 0.0
    for m in range(n):
        step[order[m]] = solved[m]
        gain += sides[m] * solved[m]
    moved = corner_motion_px(rotation, translation, lens, side_mm, step)
    rotated = np.sqrt(step[3] ** 2 + step[4] ** 2 + step[5] ** 2)
    if not np.isfinite(moved):
        return 0.0, 0.0
    return gain, min(max_px / max(moved, 1e-12), 0.4 / max(rotated, 1e-12), 1.0)


@compiled
def _cost(rows, values, dark_contrast, parameters, illumination, reliability, scale, cutoff, workspace):
    """Return the robust sum of squared residuals plus the cost of the priors, in squared grey levels.

    `workspace`: a matrix (n, n) and a vector (n,) that are overwritten.
    """
    cost, unit = 0.0, 1.0 / (cutoff * scale) ** 2
    for i in range(len(values)):
        r = (
            values[i]
            - dark_contrast[i, 0]
            - dark_contrast[i, 1] * apply_response(rows[0, i], parameters[RESPONSE])
        )
        z = r * r * reliability[i] * unit
        cost += z / (1.0 + z)
    return cost / unit + add_priors(workspace[0], workspace[1], parameters, scale, illumination)


@compiled
def refine_pose(
    rays, values, lens, rotation, translation, side_mm, tex, parameters, illumination, scale, min_blur,
    max_iterations, cutoff, max_px, min_gain_chi2
):  # fmt: skip
    """Fit pose, blur, response and illumination to pixels in place, by damped Gauss-Newton.

    `parameters` holds blur, response and illumination, in and out. `scale` is the sd of the residuals in grey
    levels; where it is 0, planar illumination and the sd are estimated first. The iteration ends when the
    predicted decrease of chi-square is below `min_gain_chi2`. Returns the normal matrix with the priors, the
    scale, the mean robust weight, whether the fit is valid, and the last prediction: `rows`, `at`,
    `dark_contrast` and `reliability`.
    """
    n, count = len(values), len(parameters)
    rows, at, dark_contrast, reliability = np.empty((10, n)), np.empty((n, 2)), np.empty((n, 2)), np.ones(n)
    seen = (rows, at, dark_contrast, reliability)
    a, g, step = np.zeros((count, count)), np.zeros(count), np.zeros(count)
    failed = (a, 0.0, 0.0, False, seen)
    blur = parameters[BLUR : BLUR + 3]
    if n < 2 * PLANAR_COUNT or not predict(
        rays, lens, rotation, translation, side_mm, blur, tex, rows, at, ALL_DERIVATIVES
    ):
        return failed
    if scale == 0.0:
        if illumination[0] == PLANAR and not fit_planar_illumination(
            rows[0], at, values, parameters, 2.0, cutoff
        ):
            return failed
        evaluate_illumination(at, parameters, illumination, dark_contrast)
        scale = robust_sd(rows, values, dark_contrast, parameters[RESPONSE], reliability)
    pixel_reliability(at, lens, rotation, translation, side_mm, parameters, illumination, scale, reliability)
    evaluate_illumination(at, parameters, illumination, dark_contrast)
    cost, total = normal_equations(
        rows, at, values, dark_contrast, parameters, illumination, reliability, scale, cutoff, a, g
    )
    old_rotation, old_translation, old = rotation.copy(), translation.copy(), parameters.copy()
    damping, order, band, workspace = (
        1e-6,
        illumination_first(illumination),
        bandwidth_of(illumination),
        (a.copy(), g.copy()),
    )
    for _ in range(max_iterations):
        gain, share = _damped_step(
            a, g, damping, order, band, step, rotation, translation, lens, side_mm, max_px
        )
        if share == 0.0:
            return failed
        copy_pose(rotation, translation, old_rotation, old_translation)
        copy_vector(parameters, old)
        facing = _apply_step(rotation, translation, parameters, step, share, min_blur)
        if facing and gain < min_gain_chi2 * scale * scale and share == 1.0:
            break
        new_cost = np.inf
        if facing and predict(
            rays, lens, rotation, translation, side_mm, blur, tex, rows, at, ALL_DERIVATIVES
        ):
            evaluate_illumination(at, parameters, illumination, dark_contrast)
            new_cost = _cost(
                rows, values, dark_contrast, parameters, illumination, reliability, scale, cutoff, workspace
            )
        fallen = (cost - new_cost) / (scale * scale)
        if not fallen >= 0.0:
            copy_pose(old_rotation, old_translation, rotation, translation)
            copy_vector(old, parameters)
            # Converged within the linearisation error of the texture; otherwise the step was too long.
            if fallen > -CONVERGED_COST_CHI2 or damping > 1.0:
                break
            damping = max(100.0 * damping, 1e-2)
            continue
        damping *= 0.1
        ends = share == 1.0 and fallen < CONVERGED_COST_CHI2
        typical = robust_sd(rows, values, dark_contrast, parameters[RESPONSE], reliability)
        if not ends and abs(typical - scale) > 0.1 * scale:
            scale = typical
            pixel_reliability(
                at, lens, rotation, translation, side_mm, parameters, illumination, scale, reliability
            )
        cost, total = normal_equations(
            rows, at, values, dark_contrast, parameters, illumination, reliability, scale, cutoff, a, g
        )
        if ends:
            break
    reliable = 0.0
    for one in reliability:
        reliable += one
    return a, scale, total / reliable, True, seen


@compiled
def robust_cost(
    rays, values, lens, rotation, translation, side_mm, tex, parameters, illumination, scale, cutoff
):
    """Return the robust chi-square of a fit in units of `scale`, priors included; inf where not visible.

    The priors separate poses with equal residuals: less probable illumination costs more.
    """
    n = len(values)
    rows, at, dark_contrast, reliability = np.empty((10, n)), np.empty((n, 2)), np.empty((n, 2)), np.ones(n)
    blur = parameters[BLUR : BLUR + 3]
    if not predict(rays, lens, rotation, translation, side_mm, blur, tex, rows, at, POSE_DERIVATIVES):
        return np.inf
    evaluate_illumination(at, parameters, illumination, dark_contrast)
    pixel_reliability(at, lens, rotation, translation, side_mm, parameters, illumination, scale, reliability)
    workspace = (np.zeros((len(parameters), len(parameters))), np.zeros(len(parameters)))
    return _cost(
        rows, values, dark_contrast, parameters, illumination, reliability, scale, cutoff, workspace
    ) / (scale * scale)


@compiled
def clustered_covariance(values, seen, parameters, illumination, scale, cutoff, inverse, blocks):
    """Return the cluster-robust (sandwich) covariance (6, 6) of the pose.

    Scores are summed in blocks x blocks parts of the marker before their outer products are added, so
    correlated errors within a block are included (Liang and Zeger 1986). Errors of different blocks are
    assumed independent. `seen`: the prediction of `refine_pose`. `inverse`: (6, parameters), the pose rows of
    the inverse normal matrix.
    """
    rows, at, dark_contrast, reliability = seen
    n = len(values)
    scores, there = np.zeros((blocks * blocks, len(parameters))), np.zeros(blocks * blocks)
    spread = np.zeros((6, 6))
    row, weight = np.empty(ILLUMINATION), np.empty(SPLINE_SUPPORT)
    where, derivative = np.empty(MAX_SPLINE_PARAMETERS, np.int64), np.empty(MAX_SPLINE_PARAMETERS)
    unit = 1.0 / (cutoff * scale) ** 2
    weights, stiffness = 0.0, 0.0
    for i in range(n):
        x, y = at[i, 0], at[i, 1]
        signal, r, w, _ = weighted_row(
            rows, i, values[i], dark_contrast, parameters[RESPONSE], reliability, unit, row
        )
        z = r * r * reliability[i] * unit
        weights += w
        stiffness += reliability[i] * (1.0 - 3.0 * z) / (1.0 + z) ** 3
        c = min(max(int((x + GRID_EXTENT) * 0.5 / GRID_EXTENT * blocks), 0), blocks - 1)
        b = min(max(int((y + GRID_EXTENT) * 0.5 / GRID_EXTENT * blocks), 0), blocks - 1)
        there[b * blocks + c] = 1.0
        score = scores[b * blocks + c]
        splines = spline_indices(x, y, illumination, where)
        spline_derivatives(x, y, signal, dark_contrast[i, 1], parameters, illumination, weight, derivative)
        r *= w
        for k in range(ILLUMINATION):
            score[k] += r * row[k]
        for k in range(splines):
            score[where[k]] += r * derivative[k]
    moved = np.zeros((blocks * blocks, 6))
    for block in range(blocks * blocks):
        for m in range(6):
            for k in range(len(parameters)):
                moved[block, m] += inverse[m, k] * scores[block, k]
    count = 0.0
    for one in there:
        count += one
    for block in range(blocks * blocks):
        for m in range(6):
            for k in range(6):
                spread[m, k] += moved[block, m] * moved[block, k]
    # The normal matrix contains the weights, but the derivative of the robust score by the pose is smaller.
    answer = weights / max(stiffness, MIN_CURVATURE_RATIO * weights)
    answer *= answer * count / max(count - 6.0, 1.0)
    for m in range(6):
        for k in range(6):
            spread[m, k] *= answer
    return spread
