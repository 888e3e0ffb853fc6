"""Cameras calibrated from views whose truth is known, and views that must be rejected."""

from collections.abc import Callable
from dataclasses import replace

import cv2
import numpy as np
import pytest

from tests.benchmarks.calibration.cameras import BOARD, KnownCamera, known_camera, seen_view
from tests.tracker.camera.rendered import CAMERA, POSES, picture
from tracker.camera import CheckerBoard, DotBoard
from tracker.camera.calibration import CalibrationReport, CalibrationSettings, calibrate
from tracker.camera.calibration.blocks import Block
from tracker.camera.calibration.uncertainty import uncertainty
from tracker.camera.detection import BoardView, find_board
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array


def views_of(camera: KnownCamera, rng: np.random.Generator, count: int = 10) -> list[BoardView]:
    return [seen_view(camera.model, BOARD, rng, noise_px=0.2) for _ in range(count)]


def calibrated(views: list[BoardView], camera: KnownCamera, *, coefficients: int = 5) -> CalibrationReport:
    settings = CalibrationSettings(coefficients=coefficients)
    return calibrate(views, size_wh_px=camera.model.size_wh_px, settings=settings)


@pytest.fixture(scope="module")
def camera() -> KnownCamera:
    return known_camera(np.random.default_rng(7))


@pytest.fixture(scope="module")
def views(camera: KnownCamera) -> list[BoardView]:
    return views_of(camera, np.random.default_rng(8))


def test_every_number_lies_in_its_interval_as_often_as_is_said() -> None:
    inside, every = 0, 0
    for seed in range(5):
        rng = np.random.default_rng(seed)
        known = known_camera(rng)
        report = calibrated(views_of(known, rng), known)
        true_value = known.true_value_from_name
        inside += sum(one.low_95 <= true_value[one.name] <= one.high_95 for one in report.parameters)
        every += len(report.parameters)
    # `python -m tests.benchmarks calibration` has 400 cameras. Here 45 values, with neighbours correlated.
    assert 0.85 <= inside / every < 1.0


def test_the_rms_is_the_noise_and_all_views_are_used(camera: KnownCamera, views: list[BoardView]) -> None:
    report = calibrated(views, camera)
    assert report.views_used == len(views)
    assert report.noise_px == pytest.approx(0.2, rel=0.05)
    assert report.rms_px == pytest.approx(0.2 * np.sqrt(2.0), rel=0.05)
    assert not report.is_noise_correlated
    assert report.pixel_aspect_ratio == pytest.approx(
        camera.model.matrix[1, 1] / camera.model.matrix[0, 0], 2e-3
    )


def test_a_view_that_is_good_in_any_photo_stays_among_better_ones(camera: KnownCamera) -> None:
    rng = np.random.default_rng(11)
    noises_px = [0.02] * 9 + [0.15]
    views = [seen_view(camera.model, BOARD, rng, noise_px=noise_px) for noise_px in noises_px]
    report = calibrated(views, camera)
    assert report.views_used == 10
    assert report.is_noise_correlated


def test_errors_that_are_alike_within_a_view_widen_the_intervals(
    camera: KnownCamera, views: list[BoardView]
) -> None:
    rng = np.random.default_rng(5)
    bent = [
        replace(
            view,
            image_points_px=view.image_points_px
            + np.sin(view.object_points_mm[:, :2] / 20.0 + rng.uniform(0, 6)) * rng.normal(0, 0.5, 2),
        )
        for view in views
    ]
    report = calibrated(bent, camera)
    assert report.is_noise_correlated
    assert report.parameter("fx").degrees_of_freedom == len(views) - 1
    assert report.parameter("fx").sd > 2.0 * calibrated(views, camera).parameter("fx").sd


def test_a_correlation_too_weak_to_be_detected_widens_the_intervals() -> None:
    rng = np.random.default_rng(5)
    jacobians = rng.normal(size=(6, 100, 3))
    pulls = rng.normal(0.0, 40.0, (6, 3))
    views = [
        Block(
            information=one.T @ one,
            gradient=pull - pulls.mean(axis=0),
            squares_px2=100.0,
            coordinates=100,
            own=6,
        )
        for one, pull in zip(jacobians, pulls, strict=True)
    ]
    quiet = [replace(one, gradient=np.zeros(3)) for one in views]
    wide = np.diag(uncertainty(views, is_noise_correlated=False).covariance)
    narrow = np.diag(uncertainty(quiet, is_noise_correlated=False).covariance)
    assert (wide > 2.0 * narrow).all()
    assert (np.diag(uncertainty(views, is_noise_correlated=True).covariance) >= narrow).all()


@pytest.mark.parametrize(
    ("spoilt", "word"),
    [
        pytest.param(lambda px: px.reshape(10, 14, 2)[:, ::-1].reshape(-1, 2), "mirrored", id="mirrored"),
        pytest.param(lambda px: np.random.default_rng(1).permutation(px), "order", id="shuffled"),
        pytest.param(
            lambda px: np.roll(px.reshape(10, 14, 2), 3, axis=1).reshape(-1, 2), "order", id="rolled"
        ),
        pytest.param(lambda px: px + [[3.0 * (i % 5), 0] for i in range(len(px))], "lie off", id="wild"),
    ],
)
def test_a_view_in_a_wrong_order_is_left_out_with_the_reason(
    camera: KnownCamera, spoilt: Callable[[Array], Array], word: str
) -> None:
    rng = np.random.default_rng(21)
    some = [seen_view(camera.model, BOARD, rng, noise_px=0.2) for _ in range(40)]
    whole = [view for view in some if view.ids.size == 140][:9]
    bad = replace(whole[4], image_points_px=spoilt(whole[4].image_points_px))
    report = calibrated([*whole[:4], bad, *whole[5:]], camera)
    assert [view.used for view in report.views] == [True] * 4 + [False] + [True] * (len(whole) - 5)
    assert word in report.views[4].reason
    assert report.noise_px < 0.25


def test_single_bad_points_cost_no_view(camera: KnownCamera, views: list[BoardView]) -> None:
    px = np.array(views[2].image_points_px)
    px[[3, 30, 77]] += [[9.0, 0.0], [0.0, -7.0], [5.0, 5.0]]
    report = calibrated([*views[:2], replace(views[2], image_points_px=px), *views[3:]], camera)
    assert report.views[2].used
    assert report.views[2].dropped_points == 3
    assert sum(view.dropped_points for view in report.views) <= 4


def test_blurred_views_stay(camera: KnownCamera, views: list[BoardView]) -> None:
    rng = np.random.default_rng(2)
    px = views[1].image_points_px
    blurred = replace(views[1], image_points_px=px + rng.normal(0, 0.4, px.shape))
    report = calibrated([views[0], blurred, *views[2:]], camera)
    assert report.views_used == len(views)
    assert report.is_noise_correlated


@pytest.mark.parametrize(("lens", "taken"), [(4, (4, 5)), (5, (4, 5)), (8, (5, 8))])
def test_the_lens_model_is_one_that_holds_on_views_held_out(lens: int, taken: tuple[int, ...]) -> None:
    rng = np.random.default_rng(3)
    known = known_camera(rng, coefficients=lens)
    report = calibrate(views_of(known, rng), size_wh_px=known.model.size_wh_px)
    rms_px = dict(report.choice.held_out_rms_px)
    assert report.choice.coefficients in taken
    assert set(rms_px) == {4, 5, 8}
    assert rms_px[report.choice.coefficients] < 1.01 * min(rms_px.values())


def test_what_the_views_cannot_tell_is_warned_of(camera: KnownCamera) -> None:
    rng = np.random.default_rng(4)
    small = DotBoard(columns=6, rows=5, pitch_mm=4.0)
    tilts = [((10.0 * np.cos(a), 10.0 * np.sin(a), 0.0), (0.0, 0.0, 300.0)) for a in (0.0, 2.0, 4.0)]
    seen = []
    for (x, y, z), middle in tilts:
        points = np.asarray(small.object_points_mm) - [10, 8, 0]
        px, _ = cv2.projectPoints(
            points, np.radians([x, y, z]), np.array(middle), camera.model.matrix, camera.model.distortion
        )
        noisy = px.reshape(-1, 2) + rng.normal(0, 0.1, (30, 2))
        seen.append(
            BoardView(ids=np.arange(30), object_points_mm=small.object_points_mm, image_points_px=noisy)
        )
    report = calibrated(seen, camera, coefficients=4)
    assert {"FEW_VIEWS", "ONE_DISTANCE", "CORNERS_UNCOVERED", "FOCAL_LENGTH_UNCERTAIN"} <= {
        one.code for one in report.warnings
    }


def test_too_few_views_are_rejected(camera: KnownCamera, views: list[BoardView]) -> None:
    for some in ([], views[:1], views[:2]):
        with pytest.raises(CalibrationError) as reported:
            calibrated(some, camera)
        assert reported.value.code == "TOO_FEW_VIEWS"


def test_views_from_one_place_and_parallel_views_are_rejected(camera: KnownCamera) -> None:
    rng = np.random.default_rng(6)
    first = seen_view(camera.model, BOARD, rng, noise_px=0.0)
    same = [
        replace(
            first, image_points_px=first.image_points_px + rng.normal(0, 0.2, first.image_points_px.shape)
        )
        for _ in range(6)
    ]
    with pytest.raises(CalibrationError) as reported:
        calibrated(same, camera)
    assert reported.value.code == "VIEWS_FROM_ONE_PLACE"
    parallel = [seen_view(camera.model, BOARD, rng, noise_px=0.2, parallel=True) for _ in range(6)]
    with pytest.raises(CalibrationError) as reported:
        calibrated(parallel, camera)
    assert reported.value.code == "VIEWS_ALL_PARALLEL"


def test_views_of_two_cameras_show_in_the_rms(camera: KnownCamera, views: list[BoardView]) -> None:
    other = known_camera(np.random.default_rng(99))
    mixed = [*views[:5], *views_of(other, np.random.default_rng(98), 5)]
    report = calibrated(mixed, camera)
    # No view is dropped to hide it: the gate on the RMS detects it.
    assert report.rms_px > 1.0
    assert report.views_used == len(mixed)


def test_an_odd_number_of_coefficients_is_rejected(camera: KnownCamera, views: list[BoardView]) -> None:
    with pytest.raises(InvalidInput) as reported:
        calibrated(views, camera, coefficients=6)
    assert reported.value.code == "COEFFICIENTS_INVALID"


@pytest.mark.parametrize(
    "board",
    [
        pytest.param(DotBoard(columns=12, rows=9, pitch_mm=9.0), id="dots"),
        pytest.param(CheckerBoard(columns=9, rows=6, square_mm=12.0), id="checkerboard"),
    ],
)
def test_pictures_of_a_board_give_the_camera_that_took_them(board: DotBoard | CheckerBoard) -> None:
    found = [find_board(picture(board, pose, seed=n), board) for n, pose in enumerate(POSES)]
    report = calibrate(
        [view for view in found if isinstance(view, BoardView)],
        size_wh_px=CAMERA.size_wh_px,
        settings=CalibrationSettings(coefficients=4),
    )
    assert report.views_used == len(POSES)
    assert report.rms_px < 0.35
    assert report.camera.matrix[0, 0] == pytest.approx(620.0, rel=0.01)
    assert report.pixel_aspect_ratio == pytest.approx(660.0 / 620.0, rel=0.003)
    assert report.parameter("k1").value == pytest.approx(-0.22, abs=0.04)
