"""Local minima of the pose over needles, view prior and touched points, the most likely first."""

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np

from tracker.geometry import Array, Camera, Rigid, Vertebra, rotation_from_vector, vector_from_rotation
from tracker.registration.needles.residuals import NeedleProblem, NeedleResiduals

ROUNDS, STEPS, SMALLEST_STEP = 4, 40, 1e-2
# Starts whose Mahalanobis distance from the ruler exceeds this are skipped.
MAX_START_MAHALANOBIS = 5.0
SAME_MM, SAME_DEG = 0.5, 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Solution:
    """One local minimum.

    Attributes:
        residual_model: the residuals linearised about the pose.
        pose: camera from vertebra.
        covariance: (6, 6) of a step, [mm, rad].
        chi2: sum of squared whitened residuals.
        cost: chi2 plus the log determinant of the covariance; smaller is more likely.
    """

    residual_model: NeedleResiduals
    pose: Rigid[Camera, Vertebra]
    covariance: Array
    chi2: float
    cost: float


def solve_poses(task: NeedleProblem) -> list[Solution]:
    """Return the distinct poses from all starts, the most likely first."""
    found: list[Solution] = []
    for start in _starts(task):
        one = _settled(task, start)
        if not any(_is_same(one.pose, other.pose, task.middle_mm) for other in found):
            found.append(one)
    return sorted(found, key=lambda one: one.cost)


def solve_from_view(task: NeedleProblem) -> Solution:
    """Return the pose from the view prior only, to compare many problems."""
    return _settled(task, _placed(task, task.view.rotation), rounds=3)


def _settled(task: NeedleProblem, start: Rigid[Camera, Vertebra], *, rounds: int = ROUNDS) -> Solution:
    pose = start
    for _ in range(rounds):
        before, pose = pose, _min(NeedleResiduals(task, pose), pose)
        if _is_same(before, pose, task.middle_mm, ratio=0.02):
            break
    residual_model = NeedleResiduals(task, pose)
    jacobian, residuals = residual_model.jacobian(pose), residual_model.residuals(pose)
    chi2 = float(residuals @ residuals)
    return Solution(
        residual_model=residual_model,
        pose=pose,
        covariance=np.asarray(np.linalg.inv(jacobian.T @ jacobian), dtype=np.float64),
        chi2=chi2,
        cost=chi2 + residual_model.log_spread,
    )


def _min(residual_model: NeedleResiduals, pose: Rigid[Camera, Vertebra]) -> Rigid[Camera, Vertebra]:
    """Minimise the residuals by Levenberg-Marquardt."""
    residuals, damping = residual_model.residuals(pose), 1e-3
    for _ in range(STEPS):
        jacobian = residual_model.jacobian(pose)
        square = jacobian.T @ jacobian
        damped = square + damping * np.diag(np.diag(square))
        step = np.asarray(-np.linalg.solve(damped, jacobian.T @ residuals), dtype=np.float64)
        tried = residual_model.moved(pose, step)
        after = residual_model.residuals(tried)
        if after @ after < residuals @ residuals:
            pose, residuals, damping = tried, after, damping * 0.1
        else:
            damping *= 10.0
        # Converged: a hundredth of a standard deviation changes no displayed digit.
        if step @ square @ step < SMALLEST_STEP**2:
            break
    return pose


def _starts(task: NeedleProblem) -> Iterator[Rigid[Camera, Vertebra]]:
    """Yield the view prior, the same tilted to each side, and the P3P solutions."""
    yield _placed(task, task.view.rotation)
    spreads, axes = np.linalg.eigh(task.view.rotation_covariance)
    for spread, axis in zip(spreads[1:], axes.T[1:], strict=True):
        for side in (-2.0, 2.0):
            yield _placed(task, rotation_from_vector(side * np.sqrt(spread) * axis) @ task.view.rotation)
    if len(task.places) == 3 and all(one.entry_is_seen for one in task.seen):
        yield from _of_three_points(task)


def _of_three_points(task: NeedleProblem) -> Iterator[Rigid[Camera, Vertebra]]:
    points = np.stack([one.point_lps_mm for one in task.places])
    image = (task.entries - task.middle_px) / task.focal_px
    count, turns, shifts = cv2.solveP3P(points, image, np.eye(3), None, cv2.SOLVEPNP_P3P)
    for turn, shift in zip(turns[:count], shifts[:count], strict=True):
        pose: Rigid[Camera, Vertebra] = Rigid.from_vector(turn.ravel(), shift.ravel())
        off = vector_from_rotation(pose.rotation @ task.view.rotation.T)
        if off @ np.linalg.solve(task.view.rotation_covariance, off) < MAX_START_MAHALANOBIS**2:
            yield pose


def _placed(task: NeedleProblem, rotation: Array) -> Rigid[Camera, Vertebra]:
    """Return this rotation at the view's distance, centred on the needles' ends or the touched points."""
    if task.view.touched:
        off = [one.point_in_camera_mm - rotation @ one.point_lps_mm for one in task.view.touched]
        return Rigid(rotation=rotation, translation_mm=np.mean(off, axis=0))
    x, y = ((task.entries.mean(axis=0) - task.middle_px) / task.focal_px).tolist()
    sight = np.array([x, y, 1.0]) / np.linalg.norm([x, y, 1.0])
    return Rigid(rotation=rotation, translation_mm=task.view.distance_mm * sight - rotation @ task.middle_mm)


def _is_same(
    one: Rigid[Camera, Vertebra], other: Rigid[Camera, Vertebra], middle_mm: Array, *, ratio: float = 1.0
) -> bool:
    apart_mm = float(np.linalg.norm(one.move_points(middle_mm) - other.move_points(middle_mm)))
    turned = np.degrees(np.linalg.norm(vector_from_rotation(one.rotation @ other.rotation.T)))
    return apart_mm < SAME_MM * ratio and float(turned) < SAME_DEG * ratio
