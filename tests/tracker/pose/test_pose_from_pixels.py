"""Selection among photometric fits, and the covariance for the alternatives."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import Print, camera_of, code_model, facing_at_px, rendered, seen
from tracker import Tracker
from tracker.geometry import Camera, Marker, Rigid
from tracker.photometric import RefinedPose, refine_poses, textures_of
from tracker.pose import ImageContext, Seen, flipped_pose, photometric_refinement
from tracker.pose.pose_ambiguity import PosePrediction

CAMERA = camera_of()
MODEL = code_model()
POSE = facing_at_px(CAMERA, (330.0, 220.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
IMAGE = rendered(CAMERA, [Print(picture=MODEL.image, pose=POSE)])
PIXELS = ImageContext(image=IMAGE, noise_grey=1.5, textures={MODEL.name: textures_of(MODEL.square)})


@pytest.fixture
def found() -> Seen:
    return seen(Tracker(camera=CAMERA, models=[MODEL]).search(IMAGE)[MODEL.name])


def _fit_at(pose: Rigid[Camera, Marker]) -> RefinedPose:
    fits = refine_poses(
        IMAGE,
        CAMERA.lens,
        PIXELS.textures[MODEL.name],
        [POSE],
        side_mm=MODEL.side_mm,
        side_px=60.0,
        noise_grey=1.5,
    )
    return replace(fits[0], camera_from_marker=pose)


def _given(monkeypatch: pytest.MonkeyPatch, fits: Sequence[RefinedPose]) -> None:
    monkeypatch.setattr(photometric_refinement, "refine_poses", lambda *_, **__: list(fits))
    # Both are assumed to lie on the edges, so that only their residuals decide.
    monkeypatch.setattr(photometric_refinement, "MAX_APART_PX", 1e3)


def test_where_the_better_fit_just_fails_the_worse_does_not_stand_in(
    monkeypatch: pytest.MonkeyPatch, found: Seen
) -> None:
    fit = _fit_at(POSE)
    better = replace(
        fit,
        robust_chi2=500.0,
        residual_sd_grey=1.01 * photometric_refinement.MAX_RESIDUAL_CONTRAST_RATIO * fit.contrast_grey,
    )
    worse = replace(better, camera_from_marker=flipped_pose(POSE), robust_chi2=520.0, residual_sd_grey=3.0)
    _given(monkeypatch, [better, worse])
    exact = photometric_refinement.refine_photometrically(
        CAMERA, MODEL, PIXELS, replace(found, delta_chi2=0.0)
    )
    assert exact == replace(found, delta_chi2=0.0)


def test_two_solutions_that_explain_alike_are_both_in_the_covariance(
    monkeypatch: pytest.MonkeyPatch, found: Seen
) -> None:
    better = replace(_fit_at(POSE), robust_chi2=500.0)
    worse = replace(better, camera_from_marker=flipped_pose(POSE), robust_chi2=505.0)
    _given(monkeypatch, [worse, better])
    exact = photometric_refinement.refine_photometrically(
        CAMERA, MODEL, PIXELS, replace(found, delta_chi2=0.0)
    )
    assert np.array_equal(exact.camera_from_marker.rotation, POSE.rotation)
    turned_deg = np.degrees(np.sqrt(np.linalg.eigvalsh(exact.pose_covariance[3:, 3:])[-1]))
    assert turned_deg > 10.0


@pytest.mark.parametrize(
    ("left_ratio", "noise_ratio", "factor"),
    [
        (0.0, 0.01, 1.6),
        (0.01, 0.01, 1.6),
        (0.04, 0.04, 1.15),
        (0.05, 0.06, 1.096),
        # This share of the residuals is not noise.
        (0.05, 0.04, 1.216),
        (0.05, 0.0, 1.6),
    ],
)
def test_what_residuals_do_not_tell_is_added_less_the_more_of_them_is_noise(
    monkeypatch: pytest.MonkeyPatch, found: Seen, left_ratio: float, noise_ratio: float, factor: float
) -> None:
    fit = _fit_at(POSE)
    # Its rotation is so certain that the arc's deviation from its tangent is negligible.
    sure = replace(fit, covariance=1e-4 * fit.covariance, residual_sd_grey=left_ratio * fit.contrast_grey)
    _given(monkeypatch, [sure])
    pixels = replace(PIXELS, noise_grey=noise_ratio * fit.contrast_grey)
    exact = photometric_refinement.refine_photometrically(
        CAMERA, MODEL, pixels, replace(found, delta_chi2=0.0)
    )
    assert exact.pose_covariance == pytest.approx(factor * sure.covariance, rel=1e-3, abs=0.0)


def _moved_by_px(pose: Rigid[Camera, Marker], moved_px: float) -> Rigid[Camera, Marker]:
    by_mm = moved_px * pose.translation_mm[2] / CAMERA.matrix[0, 0]
    return replace(pose, translation_mm=pose.translation_mm + np.array([by_mm, 0.0, 0.0]))


@pytest.mark.parametrize(
    ("motion_blur_px", "inlier_ratio", "is_by_pixels", "is_sure"),
    [
        (8.0, 0.8, True, True),
        (0.0, 0.8, False, False),
        (2.0, 0.8, False, False),
        # If pixels explain everything, their pose is used, with the probability from edges.
        (2.0, 0.9, True, False),
    ],
)
def test_a_fit_may_end_half_a_smear_from_where_edges_are(
    monkeypatch: pytest.MonkeyPatch,
    found: Seen,
    motion_blur_px: float,
    inlier_ratio: float,
    is_by_pixels: bool,
    is_sure: bool,
) -> None:
    there = _moved_by_px(found.camera_from_marker, 5.0)
    fit = replace(
        _fit_at(POSE), camera_from_marker=there, motion_blur_px=motion_blur_px, inlier_ratio=inlier_ratio
    )
    monkeypatch.setattr(photometric_refinement, "refine_poses", lambda *_, **__: [fit])
    exact = photometric_refinement.refine_photometrically(CAMERA, MODEL, PIXELS, found)
    assert exact.camera_from_marker is (there if is_by_pixels else found.camera_from_marker)
    # If pixels contradict edges, the stated error covers both.
    by_mm = there.translation_mm[0] - found.camera_from_marker.translation_mm[0]
    alone_mm2 = (fit.covariance if is_by_pixels else found.pose_covariance)[0, 0]
    assert 0.4 * by_mm**2 > 20.0 * alone_mm2
    assert (exact.pose_covariance[0, 0] < 2.0 * alone_mm2) == is_sure
    assert (exact.pose_covariance[0, 0] > 0.4 * by_mm**2) != is_sure
    assert (exact.delta_chi2 > 0.0) == is_sure


@pytest.mark.parametrize(("inlier_ratio", "is_by_pixels"), [(0.8, False), (0.9, True)])
def test_where_the_better_fit_ends_elsewhere_the_worse_does_not_stand_in(
    monkeypatch: pytest.MonkeyPatch, found: Seen, inlier_ratio: float, is_by_pixels: bool
) -> None:
    here = found.camera_from_marker
    there = flipped_pose(_moved_by_px(here, 6.0))
    worse = replace(_fit_at(here), robust_chi2=900.0, inlier_ratio=inlier_ratio)
    better = replace(worse, camera_from_marker=there, robust_chi2=500.0)
    monkeypatch.setattr(photometric_refinement, "refine_poses", lambda *_, **__: [worse, better])
    exact = photometric_refinement.refine_photometrically(CAMERA, MODEL, PIXELS, found)
    assert exact.camera_from_marker is (there if is_by_pixels else here)
    assert exact.delta_chi2 == 0.0
    turned_deg = np.degrees(np.sqrt(np.linalg.eigvalsh(exact.pose_covariance[3:, 3:])[-1]))
    assert turned_deg > 10.0


def _expected(near: Rigid[Camera, Marker], delta_chi2: float) -> PosePrediction:
    return PosePrediction(
        rotation=near.rotation,
        translation_mm=near.translation_mm,
        flipped=flipped_pose(near),
        delta_chi2=delta_chi2,
    )


@pytest.mark.parametrize(
    ("delta_chi2", "expected", "count"),
    [
        (1e3, _expected(POSE, 1e3), 1),
        (10.0, _expected(POSE, 1e3), 2),
        (np.inf, _expected(POSE, 1e3), 2),
        (1e3, None, 2),
        # Edges alone do not override what earlier images left open or decided otherwise.
        (1e3, _expected(POSE, 10.0), 2),
        (1e3, _expected(flipped_pose(POSE), 1e3), 2),
    ],
)
def test_the_other_solution_is_asked_of_the_pixels_unless_edges_and_time_have_decided(
    monkeypatch: pytest.MonkeyPatch,
    found: Seen,
    delta_chi2: float,
    expected: PosePrediction | None,
    count: int,
) -> None:
    starts: list[int] = []

    def reported(*args: object, **_: object) -> list[RefinedPose]:
        given = args[3]
        assert isinstance(given, list)
        starts.append(len(given))
        return []

    monkeypatch.setattr(photometric_refinement, "refine_poses", reported)
    photometric_refinement.refine_photometrically(
        CAMERA, MODEL, PIXELS, replace(found, delta_chi2=delta_chi2), expected=expected
    )
    assert starts == [count]
