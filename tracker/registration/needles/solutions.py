"""All poses that needles, view and touched points allow, the likeliest first."""

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np

from tracker.geometry import Array, Camera, Rigid, Vertebra, rotation_from_vector, vector_from_rotation
from tracker.registration.needles.equations import Equations, Task

ROUNDS, STEPS, SMALLEST_STEP = 4, 40, 1e-2
# A start that the ruler contradicts by more than this many standard deviations leads nowhere.
FARTHEST_START = 5.0
SAME_MM, SAME_DEG = 0.5, 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Solution:
    """One pose at which all agree better than beside it.

    Attributes:
        equations: about the pose.
        pose: camera from vertebra.
        covariance: (6, 6) of a step, [mm, rad].
        chi2: sum of the squared residuals.
        cost: the same, and what the spreads themselves add; less is likelier.
    """

    equations: Equations
    pose: Rigid[Camera, Vertebra]
    covariance: Array
    chi2: float
    cost: float


def solutions(task: Task) -> list[Solution]:
    """The different poses found from all starts, the likeliest first."""
    found: list[Solution] = []
    for start in _starts(task):
        one = _settled(task, start)
        if not any(_is_same(one.pose, other.pose, task.middle_mm) for other in found):
            found.append(one)
    return sorted(found, key=lambda one: one.cost)


def nearest_solution(task: Task) -> Solution:
    """The pose found from the measured view alone: to compare many tasks by."""
    return _settled(task, _placed(task, task.view.rotation), rounds=3)


def _settled(task: Task, start: Rigid[Camera, Vertebra], *, rounds: int = ROUNDS) -> Solution:
    pose = start
    for _ in range(rounds):
        before, pose = pose, _min(Equations(task, pose), pose)
        if _is_same(before, pose, task.middle_mm, ratio=0.02):
            break
    equations = Equations(task, pose)
    slopes, residuals = equations.slopes(pose), equations.residuals(pose)
    chi2 = float(residuals @ residuals)
    return Solution(
        equations=equations,
        pose=pose,
        covariance=np.asarray(np.linalg.inv(slopes.T @ slopes), dtype=np.float64),
        chi2=chi2,
        cost=chi2 + equations.log_spread,
    )


def _min(equations: Equations, pose: Rigid[Camera, Vertebra]) -> Rigid[Camera, Vertebra]:
    """Down to the pose with the least residuals, by Levenberg and Marquardt's steps."""
    residuals, damping = equations.residuals(pose), 1e-3
    for _ in range(STEPS):
        slopes = equations.slopes(pose)
        square = slopes.T @ slopes
        damped = square + damping * np.diag(np.diag(square))
        step = np.asarray(-np.linalg.solve(damped, slopes.T @ residuals), dtype=np.float64)
        tried = equations.moved(pose, step)
        after = equations.residuals(tried)
        if after @ after < residuals @ residuals:
            pose, residuals, damping = tried, after, damping * 0.1
        else:
            damping *= 10.0
        # A hundredth of a standard deviation moves no number that anybody reads.
        if step @ square @ step < SMALLEST_STEP**2:
            break
    return pose


def _starts(task: Task) -> Iterator[Rigid[Camera, Vertebra]]:
    """The measured view; the same tilted to each side; and what three points alone allow."""
    yield _placed(task, task.view.rotation)
    spreads, axes = np.linalg.eigh(task.view.rotation_covariance)
    for spread, axis in zip(spreads[1:], axes.T[1:], strict=True):
        for side in (-2.0, 2.0):
            yield _placed(task, rotation_from_vector(side * np.sqrt(spread) * axis) @ task.view.rotation)
    if len(task.places) == 3 and all(one.entry_is_seen for one in task.seen):
        yield from _of_three_points(task)


def _of_three_points(task: Task) -> Iterator[Rigid[Camera, Vertebra]]:
    points = np.stack([one.point_lps_mm for one in task.places])
    image = (task.entries - task.middle_px) / task.focal_px
    count, turns, shifts = cv2.solveP3P(points, image, np.eye(3), None, cv2.SOLVEPNP_P3P)
    for turn, shift in zip(turns[:count], shifts[:count], strict=True):
        pose: Rigid[Camera, Vertebra] = Rigid.from_vector(turn.ravel(), shift.ravel())
        off = vector_from_rotation(pose.rotation @ task.view.rotation.T)
        if off @ np.linalg.solve(task.view.rotation_covariance, off) < FARTHEST_START**2:
            yield pose


def _placed(task: Task, rotation: Array) -> Rigid[Camera, Vertebra]:
    """The view's distance and this rotation, laid on the needles' ends, or on the touched points."""
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
