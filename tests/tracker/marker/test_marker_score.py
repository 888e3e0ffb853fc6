"""The paper's two scores, by hand and on rendered markers."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import (
    NEIGHBOURS,
    STRAIGHT,
    Image8,
    Print,
    camera_of,
    code_image,
    code_model,
    rendered,
)
from tests.tracker.scenes import facing_at_px as placed
from tracker import CameraModel, InvalidInput, MarkerModel
from tracker.edges import edgels_of, gradient_of
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import (
    Agreement,
    ScoreSettings,
    model_agreement,
    reach_px,
    shape_mismatch_of,
    target_coverage_ratio,
)
from tracker.pose import side_px_of
from tracker.pose.refinement import projected_edges

CAMERA = camera_of((320, 240), focal_px=400.0)
MIDDLE = (160.3, 121.7)


def _agreement(model: float, target: float, error: float) -> Agreement:
    return Agreement(
        model_coverage_ratio=model,
        inner_coverage_ratio=1.0,
        target_coverage_ratio=target,
        fit_error_px2=error,
        normalised_fit_error=error,
        contrast=400.0,
    )


@pytest.mark.parametrize(
    ("model", "target", "error", "weight", "score", "target_score"),
    [
        pytest.param(1.0, 1.0, 0.0, 0.25, 1.0, 1.0, id="perfect"),
        pytest.param(0.8, 0.6, 0.0, 0.25, 0.8, 0.6, id="no fit error: the coverages themselves"),
        pytest.param(0.8, 0.6, 0.5, 0.25, 0.7, 0.525, id="half of the fit error costs an eighth"),
        pytest.param(0.8, 0.6, 1.0, 0.25, 0.6, 0.45, id="the greatest fit error costs a quarter"),
        pytest.param(0.8, 0.6, 1.0, 1.0, 0.0, 0.0, id="weight one: the greatest fit error takes all"),
        pytest.param(0.8, 0.6, 1.0, 0.0, 0.8, 0.6, id="weight zero: the fit error has no say"),
        pytest.param(0.0, 1.0, 0.0, 0.25, 0.0, 1.0, id="nothing of the model is there"),
    ],
)
def test_score_is_coverage_less_the_weighted_fit_error(
    model: float, target: float, error: float, weight: float, score: float, target_score: float
) -> None:
    settings = ScoreSettings(fit_error_weight=weight)
    agreement = _agreement(model, target, error)
    assert agreement.score_ratio(settings) == pytest.approx(score, abs=1e-12)
    assert agreement.target_score_ratio(settings) == pytest.approx(target_score, abs=1e-12)


@pytest.mark.parametrize(
    "name",
    [
        "accept_score_ratio",
        "accept_target_score_ratio",
        "accept_inner_coverage_ratio",
        "verified_threshold_ratio",
        "fit_error_weight",
    ],
)
@pytest.mark.parametrize("value", [-0.01, 1.01, float("nan")])
def test_a_setting_outside_0_to_1_is_rejected_by_name(name: str, value: float) -> None:
    with pytest.raises(InvalidInput, match=name) as caught:
        replace(ScoreSettings(), **{name: value})
    assert caught.value.code == "SCORE_SETTING_INVALID"


@pytest.mark.parametrize(
    ("side_px", "reach"), [(10, 2.0), (50, 2.0), (60, 2.4), (100, 4.0), (120, 4.8), (400, 5.0)]
)
def test_the_reach_grows_with_the_marker_within_its_limits(side_px: float, reach: float) -> None:
    assert reach_px(side_px) == pytest.approx(reach)


def _laid(
    image: Image8, model: MarkerModel, pose: Rigid[Camera, Marker], *, camera: CameraModel = CAMERA
) -> Agreement:
    """Return the agreement of the model with the image at this pose, with its target coverage."""
    gradient = gradient_of(image)
    corners = camera.px_from_camera(pose.move_points(model.corners_mm))
    side = side_px_of(corners)
    active = model.level_for(side)
    projected = projected_edges(camera, pose, active)
    assert projected is not None
    agreement = model_agreement(gradient, active, *projected, side_px=side)
    ratio = target_coverage_ratio(
        edgels_of(gradient),
        gradient,
        *projected,
        corners_px=corners,
        side_px=side,
        contrast=agreement.contrast,
    )
    return replace(agreement, target_coverage_ratio=ratio)


@pytest.mark.parametrize("side_px", [30, 48, 70, 110])
@pytest.mark.parametrize("tilt_deg", [0, 40])
def test_the_model_agrees_fully_with_its_own_image(side_px: float, tilt_deg: float) -> None:
    pose = placed(CAMERA, MIDDLE, side_px, tilt_deg=tilt_deg, about_deg=30, roll_deg=25)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
    agreement = _laid(image, code_model(), pose)
    assert agreement.model_coverage_ratio > 0.99
    assert agreement.inner_coverage_ratio > 0.99
    assert agreement.target_coverage_ratio > 0.97
    assert agreement.fit_error_px2 < 0.06
    assert agreement.normalised_fit_error < 0.03
    assert agreement.score_ratio(ScoreSettings()) > 0.98


def test_the_contrast_is_that_of_the_ink() -> None:
    pose = placed(CAMERA, MIDDLE, 90)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)], noise_grey=0.0)
    # Black 30 on white 215; blur of 0.6 px and the pixel take a third of a sharp step's response.
    assert _laid(image, code_model(), pose).contrast == pytest.approx(4 * 185 * 0.7, rel=0.15)


@pytest.mark.parametrize("shift_px", [2.5, 4.0, 6.0])
def test_coverage_falls_beside_the_marker(shift_px: float) -> None:
    pose = placed(CAMERA, MIDDLE, 50)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
    beside = placed(CAMERA, (MIDDLE[0] + shift_px, MIDDLE[1] + shift_px), 50)
    assert _laid(image, code_model(), beside).model_coverage_ratio < 0.45


def test_a_quarter_rotation_matches_the_outline_but_not_the_inside() -> None:
    pose = placed(CAMERA, MIDDLE, 60)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
    turned = _laid(image, code_model(), placed(CAMERA, MIDDLE, 60, roll_deg=90))
    assert turned.inner_coverage_ratio < 0.6
    assert turned.model_coverage_ratio > 0.6


def test_an_extra_edge_lowers_only_the_target_coverage() -> None:
    pose = placed(CAMERA, MIDDLE, 70)
    picture = code_image()
    picture[5:25, 40:60] = 255  # a white spot in the black border
    agreement = _laid(rendered(CAMERA, [Print(picture=picture, pose=pose)]), code_model(), pose)
    assert agreement.model_coverage_ratio > 0.97
    assert 0.6 < agreement.target_coverage_ratio < 0.93


def test_a_uniform_image_has_no_coverage() -> None:
    image = np.full((240, 320), 128, np.uint8)
    agreement = _laid(image, code_model(), placed(CAMERA, MIDDLE, 50))
    assert agreement == Agreement(
        model_coverage_ratio=0.0,
        inner_coverage_ratio=0.0,
        target_coverage_ratio=0.0,
        fit_error_px2=reach_px(50.0) ** 2,
        normalised_fit_error=1.0,
        contrast=0.0,
    )


def test_a_shift_common_to_all_edges_is_no_fit_error() -> None:
    pose = placed(CAMERA, MIDDLE, 60)
    gradient = gradient_of(rendered(CAMERA, [Print(picture=code_image(), pose=pose)]))
    active = code_model().level_for(60)
    projected = projected_edges(CAMERA, pose, active)
    assert projected is not None
    points, normals = projected
    moved = points - 0.4 * normals
    as_error = model_agreement(gradient, active, moved, normals, side_px=60.0)
    as_shift = model_agreement(gradient, active, moved, normals, side_px=60.0, shift_px=0.4)
    assert as_error.fit_error_px2 == pytest.approx(0.16, abs=0.06)
    assert as_shift.fit_error_px2 < 0.05


def _contradicts(image: Image8, pose: Rigid[Camera, Marker]) -> tuple[bool, float, float]:
    model = code_model()
    corners = CAMERA.px_from_camera(pose.move_points(model.corners_mm))
    answer = shape_mismatch_of(image, model.square, corners, side_px=side_px_of(corners))
    return answer.is_other_shape, answer.inside_ratio, answer.occluded_ratio


@pytest.mark.parametrize(("side_px", "tilt_deg"), [(36, 0), (36, 45), (70, 20)])
def test_one_inverted_field_is_another_shape(side_px: float, tilt_deg: float) -> None:
    pose = placed(CAMERA, MIDDLE, side_px, tilt_deg=tilt_deg, about_deg=70, roll_deg=12)
    for fields in NEIGHBOURS:
        image = rendered(CAMERA, [Print(picture=code_image(fields), pose=pose)])
        is_other, inside, _ = _contradicts(image, pose)
        assert is_other, fields
        # One field of nine in the middle half of the square is a thirty-sixth of it.
        assert 0.25 / 36 < inside < 2.0 / 36, fields


@pytest.mark.parametrize(("side_px", "tilt_deg"), [(24, 0), (36, 50), (60, 35), (90, 10)])
def test_the_marker_itself_has_no_shape_mismatch(side_px: float, tilt_deg: float) -> None:
    for seed in range(4):
        pose = placed(
            CAMERA, MIDDLE, side_px, tilt_deg=tilt_deg, about_deg=seed * 50, roll_deg=12 + 61 * seed
        )
        image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)], seed=seed, noise_grey=4.0)
        assert _contradicts(image, pose) == (False, 0.0, 0.0)


@pytest.mark.parametrize("about_deg", [0, 60, 135, 250])
def test_uneven_illumination_is_no_shape_mismatch(about_deg: float) -> None:
    pose = placed(CAMERA, MIDDLE, 80, roll_deg=20)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)], noise_grey=0.0).astype(np.float64)
    v, u = np.mgrid[0:240, 0:320]
    along = ((u - 160) * np.cos(np.radians(about_deg)) + (v - 120) * np.sin(np.radians(about_deg))) / 40.0
    glare = 35.0 * np.clip(along + 1.0, 0.0, 2.0)  # 0 at one side of the marker, 70 grey levels at the other
    lit = np.asarray(np.clip(image * 0.7 + glare, 0, 255), np.uint8)
    assert not _contradicts(lit, pose)[0]


def test_half_the_contrast_is_no_shape_mismatch() -> None:
    pose = placed(CAMERA, MIDDLE, 60)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
    assert not _contradicts(np.asarray(image // 3 + 100, np.uint8), pose)[0]


@pytest.mark.parametrize("grey", [180, 230])
def test_a_bright_finger_over_the_border_is_an_occlusion_and_no_shape_mismatch(grey: int) -> None:
    pose = placed(CAMERA, MIDDLE, 90)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
    image[100:130, 170:] = grey
    is_other, inside, covered = _contradicts(image, pose)
    assert not is_other
    assert inside == 0.0
    # The square reaches from 115 to 205: the finger is over 30 x 35 px of 90 x 90.
    assert 0.08 < covered < 0.14


def test_a_spot_wholly_inside_is_a_shape_mismatch() -> None:
    pose = placed(CAMERA, MIDDLE, 90)
    picture = code_image()
    picture[45:80, 90:110] = 255  # in the black of the right border, not touching the outline
    is_other, inside, covered = _contradicts(rendered(CAMERA, [Print(picture=picture, pose=pose)]), pose)
    assert is_other
    assert inside > 0.02
    assert covered == 0.0


def test_the_negative_and_a_uniform_image_are_shape_mismatches() -> None:
    pose = placed(CAMERA, MIDDLE, 90)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
    negative = np.asarray(255 - image, np.uint8)
    for other in (negative, np.full_like(image, 128)):
        # Everything reaches the border: nothing of the marker is there.
        assert _contradicts(other, pose)[2] == 1.0


def test_the_model_agrees_without_lens_distortion() -> None:
    camera = camera_of((320, 240), focal_px=400.0, distortion=STRAIGHT)
    pose = placed(camera, (60.0, 60.0), 60, tilt_deg=30)
    image = rendered(camera, [Print(picture=code_image(), pose=pose)])
    assert _laid(image, code_model(), pose, camera=camera).score_ratio(ScoreSettings()) > 0.98
