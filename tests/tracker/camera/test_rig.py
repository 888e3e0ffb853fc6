"""Cameras of one rig: their relative poses, and rejections."""

import numpy as np
import pytest

from tests.benchmarks.calibration.cameras import BOARD, KnownCamera, known_camera
from tracker.camera.calibration import CalibrationReport, CalibrationSettings, calibrate
from tracker.camera.detection import BoardView
from tracker.camera.rig import calibrate_rig
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array, rotation_from_vector

PLACES = {
    "left": (np.eye(3), np.zeros(3)),
    "right": (rotation_from_vector(np.array([0.01, 0.08, -0.02])), np.array([-60.0, 2.0, 4.0])),
    "third": (rotation_from_vector(np.array([-0.05, -0.06, 0.01])), np.array([30.0, 40.0, -3.0])),
}
NOISE_PX = 0.2


def shots_of(
    cameras: dict[str, KnownCamera], rng: np.random.Generator, count: int = 12
) -> list[dict[str, BoardView]]:
    points = np.asarray(BOARD.object_points_mm)
    shots: list[dict[str, BoardView]] = []
    while len(shots) < count:
        turn = rotation_from_vector(rng.uniform(-0.6, 0.6, 3))
        middle = np.array([rng.uniform(-30, 30), rng.uniform(-20, 20), rng.uniform(210, 330)])
        in_first = (points - points.mean(axis=0)) @ turn.T + middle
        shot = {}
        for name, camera in cameras.items():
            rotation, translation = PLACES[name]
            px = camera.model.px_from_camera(in_first @ rotation.T + translation)
            inside = ((px > 0) & (px < np.array(camera.model.size_wh_px) - 1)).all(axis=1)
            if inside.sum() > 60:
                noisy = px + rng.normal(0.0, NOISE_PX, px.shape)
                shot[name] = BoardView(
                    ids=np.flatnonzero(inside), object_points_mm=points[inside], image_points_px=noisy[inside]
                )
        if len(shot) > 1:
            shots.append(shot)
    return shots


def each_alone(
    shots: list[dict[str, BoardView]], cameras: dict[str, KnownCamera]
) -> dict[str, CalibrationReport]:
    return {
        name: calibrate(
            [shot[name] for shot in shots if name in shot],
            size_wh_px=camera.model.size_wh_px,
            settings=CalibrationSettings(coefficients=5),
        )
        for name, camera in cameras.items()
    }


def rig_of(*names: str, seed: int = 1) -> tuple[list[dict[str, BoardView]], dict[str, CalibrationReport]]:
    rng = np.random.default_rng(seed)
    cameras = {name: known_camera(rng) for name in names}
    shots = shots_of(cameras, rng)
    return shots, each_alone(shots, cameras)


def off_in_sds(place: Array, truth: tuple[Array, Array], covariance: Array) -> float:
    rotation, translation = truth
    turned = place[:3, :3] @ rotation.T
    small = (
        np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]]) / 2
    )
    off = np.concatenate([place[:3, 3] - translation, small])
    return float(np.sqrt(off @ np.linalg.solve(covariance, off) / 6.0))


def test_three_cameras_stand_where_they_are_within_what_is_said() -> None:
    shots, reports = rig_of("left", "right", "third")
    rig = calibrate_rig(shots, reports)
    assert rig.rms_px == pytest.approx(NOISE_PX * np.sqrt(2.0), rel=0.05)
    assert not rig.is_noise_correlated
    for camera in rig.cameras[1:]:
        assert off_in_sds(camera.camera_from_first.matrix, PLACES[camera.name], camera.covariance) < 2.0
        assert camera.baseline_mm == pytest.approx(np.linalg.norm(PLACES[camera.name][1]), abs=3 * 0.5)
        assert 0.0 < camera.baseline_sd_mm < 0.5
    assert all(set(shot.used) and not shot.reason for shot in rig.shots)


def test_the_stated_uncertainty_of_a_place_is_true() -> None:
    ratios = []
    for seed in range(3):
        shots, reports = rig_of("left", "right", seed=seed)
        camera = calibrate_rig(shots, reports).cameras[1]
        ratios.append(off_in_sds(camera.camera_from_first.matrix, PLACES["right"], camera.covariance))
    assert 0.6 < np.sqrt(np.mean(np.square(ratios))) < 1.5


def test_two_pairs_that_were_swapped_are_left_out_with_the_reason() -> None:
    shots, reports = rig_of("left", "right")
    shots[3], shots[7] = ({**shots[3], "right": shots[7]["right"]}, {**shots[7], "right": shots[3]["right"]})
    rig = calibrate_rig(shots, reports)
    assert [bool(shot.reason) for shot in rig.shots] == [n in (3, 7) for n in range(len(shots))]
    assert rig.rms_px < 1.1 * NOISE_PX * np.sqrt(2.0)


def test_pairs_that_do_not_belong_together_are_rejected() -> None:
    shots, reports = rig_of("left", "right")
    rolled = [{**shot, "right": shots[n - 1]["right"]} for n, shot in enumerate(shots)]
    with pytest.raises(CalibrationError) as reported:
        calibrate_rig(rolled, reports)
    assert reported.value.code == "RIG_VIEWS_DISAGREE"


def test_cameras_that_share_no_views_are_rejected() -> None:
    shots, reports = rig_of("left", "right")
    apart = [{name: shot[name]} for shot in shots for name in shot]
    with pytest.raises(CalibrationError) as reported:
        calibrate_rig(apart, reports)
    assert reported.value.code == "RIG_UNCONNECTED"


def test_one_camera_is_no_rig() -> None:
    shots, reports = rig_of("left", "right")
    with pytest.raises(InvalidInput):
        calibrate_rig(shots, {"left": reports["left"]})
