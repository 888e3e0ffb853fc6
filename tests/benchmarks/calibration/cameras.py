"""Cameras with known parameters, and noisy views of a board."""

from dataclasses import dataclass

import numpy as np

from tracker.camera import Board, CameraModel, DotBoard
from tracker.camera.detection import BoardView
from tracker.errors import InvalidInput
from tracker.geometry import Array, rotation_from_vector

BOARD = DotBoard(columns=14, rows=10, pitch_mm=8.0)
MAX_TILT_DEG = 40.0


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownCamera:
    """A camera with known parameters."""

    model: CameraModel

    @property
    def true_value_from_name(self) -> dict[str, float]:
        """Return the parameters as `CalibrationReport.parameters` names them; others are zero."""
        k = self.model.matrix
        lens = dict(
            zip(("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"), self.model.distortion, strict=False)
        )
        return {"fx": k[0, 0], "fy": k[1, 1], "cx": k[0, 2], "cy": k[1, 2], **lens}


def known_camera(rng: np.random.Generator, *, coefficients: int = 5) -> KnownCamera:
    """Return a random camera: slightly non-square pixels, radial distortion, offset principal point.

    Some draws fold the corners of the image, which no lens does; they are drawn again.
    """
    while True:
        try:
            return _drawn_camera(rng, coefficients)
        except InvalidInput:
            continue


def _drawn_camera(rng: np.random.Generator, coefficients: int) -> KnownCamera:
    width, height = 1280, 720
    focal = rng.uniform(900.0, 1500.0)
    matrix = np.array(
        [
            [focal, 0.0, width / 2 + rng.normal(0.0, 15.0)],
            [0.0, focal * rng.uniform(0.95, 1.1), height / 2 + rng.normal(0.0, 15.0)],
            [0.0, 0.0, 1.0],
        ]
    )
    k1 = rng.uniform(-0.35, 0.1)
    lens = np.array(
        [k1, -0.4 * k1 + rng.normal(0.0, 0.03), *rng.normal(0.0, 0.001, 2), *rng.normal(0.0, 0.05, 1)]
    )
    if coefficients == 4:
        lens = lens[:4]
    if coefficients == 8:
        lens = np.concatenate([lens, [0.1, 0.05, 0.02]])
    return KnownCamera(model=CameraModel(matrix=matrix, distortion=lens, size_wh_px=(width, height)))


def seen_view(
    model: CameraModel,
    board: Board,
    rng: np.random.Generator,
    *,
    noise_px: float,
    common_px: float = 0.0,
    parallel: bool = False,
) -> BoardView:
    """Return a random view of the board, tilted in any direction; points outside the image are dropped.

    `common_px`: standard deviation of an error that neighbouring points share, over two pitches of the board.
    """
    points = np.asarray(board.object_points_mm)
    width, height = model.size_wh_px
    while True:
        rotation, translation = _pose(points, model, rng, parallel=parallel)
        in_camera = points @ rotation.T + translation
        if in_camera[:, 2].min() < 30.0:
            continue
        px = model.px_from_camera(in_camera)
        inside = ((px > 2) & (px < np.array([width, height]) - 3)).all(axis=1)
        if inside.mean() < 0.75:
            continue
        noisy = px + rng.normal(0.0, noise_px, px.shape)
        if common_px > 0.0:
            noisy += common_px * _common_error(points, rng)
        return BoardView(
            ids=np.flatnonzero(inside), object_points_mm=points[inside], image_points_px=noisy[inside]
        )


def _common_error(points_mm: Array, rng: np.random.Generator) -> Array:
    """Return a smooth random field (n, 2) of unit variance over the board's points."""
    squared = ((points_mm[:, None] - points_mm[None]) ** 2).sum(axis=2)
    pitch_mm = float(np.sqrt(np.where(squared > 0.0, squared, np.inf).min()))
    correlation = np.exp(-squared / (2.0 * (2.0 * pitch_mm) ** 2)) + 1e-6 * np.eye(len(points_mm))
    return np.asarray(np.linalg.cholesky(correlation) @ rng.normal(size=(len(points_mm), 2)))


def _pose(
    points: Array, model: CameraModel, rng: np.random.Generator, *, parallel: bool
) -> tuple[Array, Array]:
    spread = float(np.linalg.norm(np.ptp(points, axis=0)))
    distance = spread * float(model.matrix[0, 0]) / model.size_wh_px[0] * rng.uniform(1.0, 2.2)
    turn = rng.uniform(0, 2 * np.pi)
    tilt = 0.0 if parallel else np.radians(rng.uniform(0.0, MAX_TILT_DEG))
    rotation = rotation_from_vector(
        tilt * np.array([np.cos(turn), np.sin(turn), 0.0])
    ) @ rotation_from_vector(np.array([0.0, 0.0, rng.uniform(-0.5, 0.5)]))
    at = rng.uniform([0.2, 0.2], [0.8, 0.8]) * model.size_wh_px
    middle = distance * np.append((at - model.matrix[:2, 2]) / np.diag(model.matrix)[:2], 1.0)
    return rotation, middle - rotation @ points.mean(axis=0)
