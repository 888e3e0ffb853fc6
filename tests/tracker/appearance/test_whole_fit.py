"""The whole-shape fit against pictures whose truth is known."""

import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.scenes import Image8, Print, camera_of, code_model, facing_at_px, rendered
from tracker.appearance import CoveredAt, WholeFit, textures_of, whole_fits
from tracker.geometry import Array, Camera, Marker, Rigid, rotation_from_vector, vector_from_rotation
from tracker.pose import other_solution

CAMERA = camera_of()
MODEL = code_model()
TEXTURES = textures_of(MODEL.square)


def _beside(pose: Rigid[Camera, Marker]) -> Rigid[Camera, Marker]:
    """The same, off by about a third of a pixel."""
    turn = rotation_from_vector([0.01, -0.012, 0.008])
    return Rigid(
        rotation=turn @ pose.rotation, translation_mm=pose.translation_mm * 1.004 + np.array([0.1, -0.1, 0.0])
    )


def _image(pose: Rigid[Camera, Marker], *, background: float = 170.0, blur_px: float = 0.6) -> Image8:
    return rendered(CAMERA, [Print(picture=MODEL.image, pose=pose)], background=background, blur_px=blur_px)


def _off_px(pose: Rigid[Camera, Marker], found: Rigid[Camera, Marker]) -> float:
    """The farthest that a corner is off."""
    there, here = (CAMERA.px_from_camera(one.move_points(MODEL.corners_mm)) for one in (found, pose))
    return float(np.abs(there - here).max())


def _fit(image: Image8, start: Rigid[Camera, Marker], side_px: float) -> WholeFit:
    fits = whole_fits(
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
def test_a_pose_that_is_a_third_of_a_pixel_off_is_put_right(side_px: float) -> None:
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
    lit = np.clip(np.round(image + blob), 0, 255).astype(np.uint8)
    assert _off_px(pose, _fit(lit, _beside(pose), 80.0).camera_from_marker) < 0.04


def _typical_turn_deg(pose: Rigid[Camera, Marker], image: Array, *, seed: int) -> float:
    """Median over noise of how far a marker 30 px wide is turned from the truth."""
    random = np.random.default_rng(seed)
    turns = []
    for _ in range(15):
        noisy = np.clip(np.round(image + random.normal(0.0, 2.5, image.shape)), 0, 255).astype(np.uint8)
        found = _fit(noisy, _beside(pose), 30.0).camera_from_marker
        turns.append(np.degrees(np.linalg.norm(vector_from_rotation(found.rotation @ pose.rotation.T))))
    return float(np.median(turns))


def test_a_faint_shadow_is_seen_by_its_pattern_not_by_how_much_it_leaves() -> None:
    """In even light alone the marker would be turned by three times as much."""
    pose = facing_at_px(CAMERA, (330.0, 220.0), 30.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    columns = np.arange(_image(pose).shape[1])
    faint = _image(pose) * (1.0 - 0.3 / (1.0 + np.exp(-(columns - 332.0) / 3.0)))
    turned = [_typical_turn_deg(pose, image, seed=5) for image in (faint, _image(pose).astype(np.float64))]
    assert turned[0] < 1.6 * turned[1]


@pytest.mark.parametrize("kind", ["shadow", "highlight", "both"])
def test_light_that_varies_costs_little_of_what_the_pixels_say(kind: str) -> None:
    """Two free fields for any light would make a shadow cost 1.7 times as much, and both 1.5 times."""
    pose = facing_at_px(CAMERA, (330.0, 220.0), 30.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    plain = _image(pose).astype(np.float64)
    v, u = np.mgrid[0 : plain.shape[0], 0 : plain.shape[1]]
    shade = 1.0 - 0.5 / (1.0 + np.exp(-(u - 332.0) / 3.5))
    blob = 80.0 * np.exp(-0.5 * (((u - 323.0) / 8.0) ** 2 + ((v - 216.0) / 6.0) ** 2))
    lit = plain * (shade if kind != "highlight" else 1.0) + (blob if kind != "shadow" else 0.0)
    ratio = np.median(
        [
            _typical_turn_deg(pose, np.minimum(lit, 250.0), seed=seed)
            / _typical_turn_deg(pose, 0.9 * plain, seed=seed)
            for seed in (1, 2, 3)
        ]
    )
    assert ratio < {"shadow": 1.45, "highlight": 1.7, "both": 1.4}[kind]


def test_what_is_known_to_be_covered_has_no_say() -> None:
    """A round finger passes for a shadow where it is not known of, and turns the marker by degrees."""
    pose = facing_at_px(CAMERA, (330.0, 220.0), 30.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image, edge_px = _image(pose), 329.0
    columns = np.arange(image.shape[1])
    finger = 40.0 + 130.0 * np.exp(-(((columns - edge_px - 12.0) / 9.0) ** 2))
    image[:, columns > edge_px] = np.round(finger[columns > edge_px])

    def turned_deg(covered_at: CoveredAt | None) -> float:
        fits = whole_fits(
            image,
            CAMERA.lens,
            TEXTURES,
            [_beside(pose)],
            side_mm=MODEL.side_mm,
            side_px=30.0,
            noise_grey=1.0,
            covered_at=covered_at,
        )
        turn = fits[0].camera_from_marker.rotation @ pose.rotation.T
        return float(np.degrees(np.linalg.norm(vector_from_rotation(turn))))

    def under_the_finger(at_ratio: Array) -> npt.NDArray[np.bool_]:
        points_mm = np.column_stack([at_ratio * MODEL.side_mm, np.zeros(len(at_ratio))])
        return np.asarray(CAMERA.px_from_camera(pose.move_points(points_mm))[:, 0] > edge_px - 1.5)

    assert turned_deg(under_the_finger) < 0.4
    assert turned_deg(None) > 2.0


def test_what_blur_brings_in_from_beyond_the_paper_does_not_move_it() -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), 30.0, tilt_deg=55.0, about_deg=20.0, roll_deg=50.0)
    found = [
        _fit(_image(pose, background=dark, blur_px=1.6), _beside(pose), 30.0).camera_from_marker
        for dark in (20.0, 225.0)
    ]
    assert _off_px(*found) < 0.05


@pytest.mark.parametrize(("side_px", "moved_px"), [(40.0, (5.0, -3.0)), (80.0, (4.0, 11.0))])
def test_a_drill_that_moves_while_the_shutter_is_open_is_where_it_was_in_the_middle(
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
    assert found.scale_grey < 0.01 * found.contrast_grey


def test_far_from_the_axis_of_a_strong_lens_a_pose_is_as_exact() -> None:
    pose = facing_at_px(CAMERA, (585.0, 60.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    assert _off_px(pose, _fit(_image(pose), _beside(pose), 60.0).camera_from_marker) < 0.03


def test_errors_that_neighbours_share_widen_what_is_stated() -> None:
    """One picture knows little of how its neighbours err, so that it is asked of many."""
    pose = facing_at_px(CAMERA, (330.0, 220.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image = _image(pose).astype(np.float64)
    white, blocks = list[float](), list[float]()
    for seed in range(24):
        rng = np.random.default_rng(seed)
        alone = rng.normal(0.0, 6.0, image.shape)
        shared = np.kron(rng.normal(0.0, 6.0, (image.shape[0] // 4, image.shape[1] // 4)), np.ones((4, 4)))
        for noise, told in ((alone, white), (shared, blocks)):
            noisy = np.clip(np.round(image + noise), 0, 255).astype(np.uint8)
            told.append(_fit(noisy, _beside(pose), 60.0).alike_ratio)
    assert np.mean(white) < 1.2
    assert np.mean(blocks) > 2.1


def test_a_camera_that_bends_its_response_is_told_from_depth() -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image = 255.0 * (_image(pose).astype(np.float64) / 255.0) ** (1.0 / 2.2)
    fit = _fit(np.round(image).astype(np.uint8), _beside(pose), 60.0)
    depth_mm = fit.camera_from_marker.translation_mm[2]
    assert fit.response > 0.3
    assert depth_mm == pytest.approx(pose.translation_mm[2], rel=4e-4)


@pytest.mark.parametrize(("shade", "asked"), [(0.0, 1), (0.6, 2)])
def test_a_few_pixels_rule_out_a_solution_in_even_light_only(shade: float, asked: int) -> None:
    """Under a shadow, what even light leaves says little of which solution is better."""
    pose = facing_at_px(CAMERA, (330.0, 220.0), 40.0, tilt_deg=30.0, about_deg=20.0, roll_deg=50.0)
    image = _image(pose).astype(np.float64)
    columns = np.arange(image.shape[1])
    lit = np.round(image * (1.0 - shade / (1.0 + np.exp(-(columns - 330.0) / 2.5)))).astype(np.uint8)
    starts = [other_solution(pose), pose]
    fits = whole_fits(lit, CAMERA.lens, TEXTURES, starts, side_mm=MODEL.side_mm, side_px=40.0, noise_grey=1.5)
    assert len(fits) == asked
    best = min(fits, key=lambda one: one.cost_sd2).camera_from_marker
    assert np.degrees(np.linalg.norm(vector_from_rotation(best.rotation @ pose.rotation.T))) < 0.5
