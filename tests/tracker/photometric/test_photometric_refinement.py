"""Photometric pose refinement on rendered images with known truth."""

import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.scenes import Image8, Print, camera_of, code_model, facing_at_px, rendered
from tracker.geometry import Array, Camera, Marker, Rigid, rotation_from_vector, vector_from_rotation
from tracker.photometric import OccludedAt, RefinedPose, refine_poses, textures_of
from tracker.pose import flipped_pose

CAMERA = camera_of()
MODEL = code_model()
TEXTURES = textures_of(MODEL.square)


def _beside(pose: Rigid[Camera, Marker]) -> Rigid[Camera, Marker]:
    """Return the pose displaced by about a third of a pixel."""
    turn = rotation_from_vector([0.01, -0.012, 0.008])
    return Rigid(
        rotation=turn @ pose.rotation, translation_mm=pose.translation_mm * 1.004 + np.array([0.1, -0.1, 0.0])
    )


def _image(pose: Rigid[Camera, Marker], *, background: float = 170.0, blur_px: float = 0.6) -> Image8:
    return rendered(CAMERA, [Print(picture=MODEL.image, pose=pose)], background=background, blur_px=blur_px)


def _off_px(pose: Rigid[Camera, Marker], found: Rigid[Camera, Marker]) -> float:
    """Return the largest corner error in px."""
    there, here = (CAMERA.px_from_camera(one.move_points(MODEL.corners_mm)) for one in (found, pose))
    return float(np.abs(there - here).max())


def _fit(image: Image8, start: Rigid[Camera, Marker], side_px: float) -> RefinedPose:
    fits = refine_poses(
        image,
        CAMERA.lens,
        TEXTURES,
        [start],
        side_mm=MODEL.side_mm,
        side_px=side_px,
        noise_grey=1.0,
    )
    assert len(fits) == 1
    return fits[0]


@pytest.mark.parametrize("side_px", [30.0, 60.0, 150.0])
def test_a_pose_off_by_a_third_of_a_pixel_is_corrected(side_px: float) -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), side_px, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    found = _fit(_image(pose), _beside(pose), side_px).camera_from_marker
    turned = vector_from_rotation(found.rotation @ pose.rotation.T)
    assert np.degrees(np.linalg.norm(turned)) < 0.15
    # The pictures hold a marker to a two-thousandth of its side.
    assert _off_px(pose, found) < max(0.03, side_px / 2000.0)


def test_a_shadow_over_half_of_the_marker_does_not_move_it() -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image = _image(pose).astype(np.float64)
    columns = np.arange(image.shape[1])
    shade = 1.0 - 0.5 / (1.0 + np.exp(-(columns - 330.0) / 6.0))
    found = _fit(np.round(image * shade).astype(np.uint8), _beside(pose), 60.0).camera_from_marker
    assert _off_px(pose, found) < 0.1


def test_a_highlight_narrower_than_the_marker_does_not_move_it() -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), 80.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image = _image(pose).astype(np.float64)
    v, u = np.mgrid[0 : image.shape[0], 0 : image.shape[1]]
    blob = 90.0 * np.exp(-0.5 * (((u - 320.0) / 16.0) ** 2 + ((v - 215.0) / 10.0) ** 2))
    dark_contrast = np.clip(np.round(image + blob), 0, 255).astype(np.uint8)
    assert _off_px(pose, _fit(dark_contrast, _beside(pose), 80.0).camera_from_marker) < 0.04


def _typical_turn_deg(pose: Rigid[Camera, Marker], image: Array, *, seed: int) -> float:
    """Return the median rotation error, over noise, of a marker 30 px wide."""
    random = np.random.default_rng(seed)
    turns, near = [], np.s_[180:260, 290:370]
    for _ in range(15):
        noise = np.zeros_like(image)
        noise[near] = random.normal(0.0, 2.5, noise[near].shape)
        noisy = np.clip(np.round(image + noise), 0, 255).astype(np.uint8)
        found = _fit(noisy, _beside(pose), 30.0).camera_from_marker
        turns.append(np.degrees(np.linalg.norm(vector_from_rotation(found.rotation @ pose.rotation.T))))
    return float(np.median(turns))


def test_a_faint_shadow_is_detected_by_its_pattern_not_by_its_residuals() -> None:
    """With planar illumination alone the rotation error would be three times as large."""
    pose = facing_at_px(CAMERA, (330.0, 220.0), 30.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    columns = np.arange(_image(pose).shape[1])
    faint = _image(pose) * (1.0 - 0.3 / (1.0 + np.exp(-(columns - 332.0) / 3.0)))
    turned = [_typical_turn_deg(pose, image, seed=5) for image in (faint, _image(pose).astype(np.float64))]
    assert turned[0] < 1.6 * turned[1]


@pytest.mark.parametrize("kind", ["shadow", "highlight", "both"])
def test_spline_illumination_costs_little_information(kind: str) -> None:
    """Two free splines would cost 1.7 times as much under a shadow, and 1.5 times under both."""
    pose = facing_at_px(CAMERA, (330.0, 220.0), 30.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    plain = _image(pose).astype(np.float64)
    v, u = np.mgrid[0 : plain.shape[0], 0 : plain.shape[1]]
    shade = 1.0 - 0.5 / (1.0 + np.exp(-(u - 332.0) / 3.5))
    blob = 80.0 * np.exp(-0.5 * (((u - 323.0) / 8.0) ** 2 + ((v - 216.0) / 6.0) ** 2))
    dark_contrast = plain * (shade if kind != "highlight" else 1.0) + (blob if kind != "shadow" else 0.0)
    ratio = np.median(
        [
            _typical_turn_deg(pose, np.minimum(dark_contrast, 250.0), seed=seed)
            / _typical_turn_deg(pose, 0.9 * plain, seed=seed)
            for seed in (1, 2, 3)
        ]
    )
    assert ratio < {"shadow": 1.45, "highlight": 1.7, "both": 1.4}[kind]


def test_known_occlusion_has_no_weight() -> None:
    """An unknown round finger passes for a shadow and rotates the marker by degrees."""
    pose = facing_at_px(CAMERA, (330.0, 220.0), 30.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image, edge_px = _image(pose), 329.0
    columns = np.arange(image.shape[1])
    finger = 40.0 + 130.0 * np.exp(-(((columns - edge_px - 12.0) / 9.0) ** 2))
    image[:, columns > edge_px] = np.round(finger[columns > edge_px])

    def turned_deg(occluded_at: OccludedAt | None) -> float:
        fits = refine_poses(
            image,
            CAMERA.lens,
            TEXTURES,
            [_beside(pose)],
            side_mm=MODEL.side_mm,
            side_px=30.0,
            noise_grey=1.0,
            occluded_at=occluded_at,
        )
        turn = fits[0].camera_from_marker.rotation @ pose.rotation.T
        return float(np.degrees(np.linalg.norm(vector_from_rotation(turn))))

    def under_the_finger(at_ratio: Array) -> npt.NDArray[np.bool_]:
        points_mm = np.column_stack([at_ratio * MODEL.side_mm, np.zeros(len(at_ratio))])
        return np.asarray(CAMERA.px_from_camera(pose.move_points(points_mm))[:, 0] > edge_px - 1.5)

    assert turned_deg(under_the_finger) < 0.4
    assert turned_deg(None) > 2.0


def test_background_mixed_in_by_blur_does_not_move_it() -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), 30.0, tilt_deg=55.0, about_deg=20.0, roll_deg=50.0)
    found = [
        _fit(_image(pose, background=dark, blur_px=1.6), _beside(pose), 30.0).camera_from_marker
        for dark in (20.0, 225.0)
    ]
    assert _off_px(*found) < 0.05


@pytest.mark.parametrize(("side_px", "moved_px"), [(40.0, (5.0, -3.0)), (80.0, (4.0, 11.0))])
def test_a_motion_blurred_marker_is_located_at_mid_exposure(
    side_px: float, moved_px: tuple[float, float]
) -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), side_px, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    by_px = pose.translation_mm[2] / CAMERA.matrix[0, 0]
    images = []
    for moment in (np.arange(24) + 0.5) / 24 - 0.5:
        by_mm = np.array([*moved_px, 0.0]) * by_px * moment
        at_mm = pose.translation_mm + by_mm
        moved: Rigid[Camera, Marker] = Rigid(rotation=pose.rotation, translation_mm=at_mm)
        images.append(_image(moved).astype(np.float64))
    image: Image8 = np.asarray(np.round(np.mean(images, axis=0)), dtype=np.uint8)
    found = _fit(image, _beside(pose), side_px)
    assert _off_px(pose, found.camera_from_marker) < 0.05
    # As a bell of that variance, a smear leaves a tenth of the contrast unexplained.
    assert found.residual_sd_grey < 0.01 * found.contrast_grey


def test_a_pose_far_from_the_axis_of_a_distorting_lens_is_as_accurate() -> None:
    pose = facing_at_px(CAMERA, (585.0, 60.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    assert _off_px(pose, _fit(_image(pose), _beside(pose), 60.0).camera_from_marker) < 0.03


def test_correlated_errors_widen_the_covariance() -> None:
    """One image shows little of the correlation of its errors, so several are rendered."""
    pose = facing_at_px(CAMERA, (330.0, 220.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image = _image(pose).astype(np.float64)
    white, blocks = list[float](), list[float]()
    for seed in range(8):
        rng = np.random.default_rng(seed)
        alone = rng.normal(0.0, 6.0, image.shape)
        shared = np.kron(rng.normal(0.0, 6.0, (image.shape[0] // 4, image.shape[1] // 4)), np.ones((4, 4)))
        for noise, reported in ((alone, white), (shared, blocks)):
            noisy = np.clip(np.round(image + noise), 0, 255).astype(np.uint8)
            reported.append(_fit(noisy, _beside(pose), 60.0).variance_inflation)
    assert np.mean(white) < 1.2
    assert np.mean(blocks) > 2.1


def test_a_nonlinear_camera_response_does_not_change_the_depth() -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image = 255.0 * (_image(pose).astype(np.float64) / 255.0) ** (1.0 / 2.2)
    fit = _fit(np.round(image).astype(np.uint8), _beside(pose), 60.0)
    depth_mm = fit.camera_from_marker.translation_mm[2]
    assert fit.response > 0.3
    assert depth_mm == pytest.approx(pose.translation_mm[2], rel=4e-4)


@pytest.mark.parametrize(("shade", "requested"), [(0.0, 1), (0.6, 2)])
def test_few_pixels_reject_a_solution_under_planar_illumination_only(shade: float, requested: int) -> None:
    """Under a shadow, residuals of planar illumination say little of which solution is better."""
    pose = facing_at_px(CAMERA, (330.0, 220.0), 40.0, tilt_deg=30.0, about_deg=20.0, roll_deg=50.0)
    image = _image(pose).astype(np.float64)
    columns = np.arange(image.shape[1])
    dark_contrast = np.round(image * (1.0 - shade / (1.0 + np.exp(-(columns - 330.0) / 2.5)))).astype(
        np.uint8
    )
    starts = [flipped_pose(pose), pose]
    fits = refine_poses(
        dark_contrast, CAMERA.lens, TEXTURES, starts, side_mm=MODEL.side_mm, side_px=40.0, noise_grey=1.5
    )
    assert len(fits) == requested
    best = min(fits, key=lambda one: one.robust_chi2).camera_from_marker
    assert np.degrees(np.linalg.norm(vector_from_rotation(best.rotation @ pose.rotation.T))) < 0.5
