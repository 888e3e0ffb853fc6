"""Bundle adjustment of all cameras of a rig and all board poses.

Intrinsic and extrinsic parameters are fitted together, starting from a consensus over pairs (`consensus`).
The uncertainty of the intrinsics is then part of the baseline's, and a swapped pair is rejected instead of
averaged. `cv2.stereoCalibrate` supports only two cameras and ignores the uncertainty of earlier fits.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from tracker.camera.calibration.blocks import Block, derivatives, inverse, reduced, total_information
from tracker.camera.calibration.fit import projected
from tracker.camera.detection.view import BoardView
from tracker.camera.model import CameraModel
from tracker.geometry import Array, Camera, Pattern, Rigid, nearest_rotation, skew, vector_from_rotation

STEPS, SMALL_RATIO = 40, 1e-10
POSE = 6
From = TypeVar("From")


@dataclass(frozen=True, slots=True, kw_only=True)
class Bundle:
    """Parameters of a rig.

    Attributes:
        models: by camera; the first is the origin.
        camera_from_first: by camera.
        first_from_pattern: the board at each instant.
    """

    models: dict[str, CameraModel]
    camera_from_first: dict[str, Rigid[Camera, Camera]]
    first_from_pattern: tuple[Rigid[Camera, Pattern], ...]


Shots = Sequence[Mapping[str, BoardView]]


def adjusted(start: Bundle, shots: Shots) -> Bundle:
    """Return the fitted bundle (Levenberg-Marquardt; the Schur complement eliminates the board poses)."""
    bundle, error, damping = start, squares_px2(start, shots), 1e-3
    for _ in range(STEPS):
        parts = [_linear(bundle, shot, index) for index, shot in enumerate(shots)]
        blocks = [reduced(*part) for part in parts]
        information = total_information(blocks)
        gradient = np.sum([block.gradient for block in blocks], axis=0)
        for _ in range(10):
            step = inverse(information + damping * np.diag(np.diag(information))) @ gradient
            own = [np.linalg.solve(_damped(o, damping), o.T @ (r - s @ step)) for s, o, r in parts]
            trial = _moved(bundle, step, own)
            now = squares_px2(trial, shots)
            if now < error:
                break
            damping *= 8.0
        else:
            return bundle
        done = error - now < SMALL_RATIO * error
        bundle, error, damping = trial, now, damping / 20.0
        if done:
            return bundle
    return bundle


def _damped(own: Array, damping: float) -> Array:
    information = own.T @ own
    return np.asarray(information + damping * np.diag(np.diag(information)))


def rig_blocks(bundle: Bundle, shots: Shots) -> list[Block]:
    """Return the information of each instant about the shared parameters: lenses, then camera poses."""
    return [reduced(*_linear(bundle, shot, index)) for index, shot in enumerate(shots)]


def residuals_px(bundle: Bundle, index: int, name: str, view: BoardView) -> Array:
    """Return the residuals (n, 2) in px, observed minus projected."""
    pose = bundle.camera_from_first[name] @ bundle.first_from_pattern[index]
    model = bundle.models[name]
    turn = vector_from_rotation(pose.rotation)
    expected = projected(view.object_points_mm, turn, pose.translation_mm, model.matrix, model.distortion)
    return view.image_points_px - expected


def squares_px2(bundle: Bundle, shots: Shots) -> float:
    """Return the sum of all squared residuals."""
    return sum(
        float((residuals_px(bundle, index, name, view) ** 2).sum())
        for index, shot in enumerate(shots)
        for name, view in shot.items()
    )


def places_of(bundle: Bundle) -> dict[str, slice]:
    """Return the slice of each camera's pose, except the first, in the shared parameters."""
    at = sum(4 + model.distortion.size for model in bundle.models.values())
    names = list(bundle.models)[1:]
    return {name: slice(at + POSE * n, at + POSE * (n + 1)) for n, name in enumerate(names)}


def _lenses_of(bundle: Bundle) -> dict[str, slice]:
    at, slices = 0, {}
    for name, model in bundle.models.items():
        slices[name] = slice(at, at + 4 + model.distortion.size)
        at = slices[name].stop
    return slices


def _linear(bundle: Bundle, shot: Mapping[str, BoardView], index: int) -> tuple[Array, Array, Array]:
    """Return the Jacobians by shared parameters (m, p) and board pose (m, 6), and residuals (m,)."""
    lenses, places = _lenses_of(bundle), places_of(bundle)
    count = list(lenses.values())[-1].stop + POSE * len(places)
    shared, own, residuals = [], [], []
    board = bundle.first_from_pattern[index]
    for name, view in shot.items():
        camera, model = bundle.camera_from_first[name], bundle.models[name]
        pose = camera @ board
        turn = vector_from_rotation(pose.rotation)
        by_pose, by_lens = derivatives(
            view.object_points_mm, turn, pose.translation_mm, model.matrix, model.distortion
        )
        by_point = by_pose[:, 3:].reshape(-1, 2, 3)
        turned = view.object_points_mm @ board.rotation.T
        in_first = turned + board.translation_mm
        here = np.zeros((2 * len(turned), count))
        here[:, lenses[name]] = by_lens
        if name in places:
            here[:, places[name]] = _by_motion(by_point, in_first @ camera.rotation.T)
        shared.append(here)
        own.append(_by_motion(by_point @ camera.rotation, turned))
        residuals.append(residuals_px(bundle, index, name, view).ravel())
    return np.concatenate(shared), np.concatenate(own), np.concatenate(residuals)


def _by_motion(by_point: npt.NDArray[np.float64], turned: Array) -> Array:
    """Return the Jacobian by translation and rotation (2n, 6), from that by the point (n, 2, 3)."""
    by_turn = -np.einsum("nij,njk->nik", by_point, np.array([skew(one) for one in turned]))
    return np.concatenate([by_point, by_turn], axis=2).reshape(-1, POSE)


def _moved(bundle: Bundle, shared: Array, own: Sequence[Array]) -> Bundle:
    lenses, places = _lenses_of(bundle), places_of(bundle)
    models = {}
    for name, model in bundle.models.items():
        step = shared[lenses[name]]
        matrix = model.matrix + np.array([[step[0], 0, step[2]], [0, step[1], step[3]], [0, 0, 0]])
        models[name] = CameraModel(
            matrix=matrix,
            distortion=model.distortion + step[4:],
            size_wh_px=model.size_wh_px,
            is_fit=True,
        )
    cameras = {
        name: _stepped(place, shared[places[name]]) if name in places else place
        for name, place in bundle.camera_from_first.items()
    }
    boards = tuple(_stepped(pose, step) for pose, step in zip(bundle.first_from_pattern, own, strict=True))
    return Bundle(models=models, camera_from_first=cameras, first_from_pattern=boards)


def _stepped(pose: Rigid[Camera, From], step: Array) -> Rigid[Camera, From]:
    moved = pose.displaced(step)
    # Small rotations accumulate rounding errors.
    return Rigid(rotation=nearest_rotation(moved.rotation), translation_mm=moved.translation_mm)
