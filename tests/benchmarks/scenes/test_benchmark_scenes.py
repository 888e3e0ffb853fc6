"""The rendered scenes are where they are said to be, as bright and as noisy as they are said to be."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.benchmarks.scenes.area import coverage_image
from tests.benchmarks.scenes.bound import bound_of, information_of
from tests.benchmarks.scenes.conditions import BASE, Condition, conditions_of
from tests.benchmarks.scenes.faces import CODE, FACES, PLAIN, SAIL, circle
from tests.benchmarks.scenes.hand import RATE_HZ, SPEEDS, Hand, hand_scenes
from tests.benchmarks.scenes.placement import empty_scene, posed, random_scene, scene_at
from tests.benchmarks.scenes.rigs import RIG_A, RIG_B, Rig
from tests.benchmarks.scenes.scene import (
    BLACK,
    WHITE,
    Scene,
    image_of,
    mean_of,
    noise_variance_grey2,
    window_mean_of,
    window_of,
)
from tracker.geometry import Array

EVEN = replace(BASE, gradient_ratio=0.0)
RIGS = pytest.mark.parametrize("rig", [RIG_A, RIG_B, RIG_A.bent(), RIG_B.bent()], ids=["A", "B", "Ad", "Bd"])


def frontal(rig: Rig, condition: Condition = EVEN, *, about_deg: float = 0.0) -> Scene:
    pose = posed(np.array([0.0, 0.0, 950.0]), tilt_deg=0.0, about_deg=about_deg, roll_deg=0.0)
    return scene_at(rig, PLAIN, condition, (pose,), seed=1, background=False)


def moments(outline: Array) -> tuple[float, Array]:
    """Area and centroid of a polygon."""
    ends = np.roll(outline, -1, axis=0)
    cross = outline[:, 0] * ends[:, 1] - ends[:, 0] * outline[:, 1]
    area = 0.5 * cross.sum()
    return abs(float(area)), ((outline + ends) * cross[:, None]).sum(axis=0) / (6.0 * area)


def dark_mass(scene: Scene) -> tuple[float, Array]:
    """Area and middle of what is dark, in pixels of the whole image; paper counts 0, ink counts 1."""
    window = window_of(scene)
    dark = (255.0 * WHITE - window_mean_of(scene, window)) / (255.0 * (WHITE - BLACK))
    v, u = np.indices(dark.shape)
    middle = np.array([(dark * u).sum(), (dark * v).sum()]) / dark.sum()
    return float(dark.sum()), middle + np.array([window.left, window.top])


def test_coverage_of_a_triangle_is_what_a_hand_computes() -> None:
    # Half of the first pixel, whose middle is (0, 0), and of no other.
    triangle = np.array([[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5]])
    np.testing.assert_allclose(
        coverage_image([triangle], [2.0], (2, 2)), [[1.0, 0.0], [0.0, 0.0]], atol=1e-12
    )
    np.testing.assert_allclose(
        coverage_image([triangle[::-1]], [2.0], (2, 2)), [[1.0, 0.0], [0.0, 0.0]], atol=1e-12
    )


def test_coverage_beyond_the_image_is_cut_off_and_nothing_else() -> None:
    disc = circle(3.3, 2.1, 6.0)
    whole = coverage_image([disc + 20.0], [1.0], (60, 60))
    np.testing.assert_allclose(whole.sum(), math.pi * 36.0, rtol=1e-12)
    np.testing.assert_allclose(coverage_image([disc], [1.0], (8, 5)), whole[20:25, 20:28], atol=1e-12)


@RIGS
def test_the_square_is_seen_where_opencv_projects_it(rig: Rig) -> None:
    edge = np.linspace(0.0, 1.0, 41)[:-1, None]
    for seed in range(6):
        scene = random_scene(rig, PLAIN, EVEN, seed=seed, background=False)
        corners = PLAIN.corners_mm
        sides = [a + edge * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
        area, centroid = moments(rig.px_of(scene.pose, np.concatenate(sides)))
        found, middle = dark_mass(scene)
        assert np.abs(middle - centroid).max() < 0.002
        assert abs(math.sqrt(found) - math.sqrt(area)) < 0.002


def test_the_blur_of_a_straight_edge_agrees_with_the_lens() -> None:
    # The image of a dark half-plane: a Gaussian integrated over the pixel, its middle at the projected edge.
    scene = frontal(RIG_A)
    row = mean_of(scene)[round(float(scene.corners_px[:, 1].mean()))].astype(np.float64)
    left = float(scene.corners_px[:, 0].min())
    at = np.arange(round(left) - 3, round(left) + 4)
    fine = (np.arange(400) + 0.5) / 400 - 0.5
    shares = [np.mean([math.erf((u + f - left) / 0.6 / math.sqrt(2)) for f in fine]) for u in at]
    wanted = 255.0 * (WHITE + (BLACK - WHITE) * (0.5 + 0.5 * np.array(shares)))
    np.testing.assert_allclose(row[at], wanted, atol=0.25)


def test_nothing_of_the_background_shines_through_the_board() -> None:
    scene = random_scene(RIG_A, PLAIN, EVEN, seed=3)
    plain = replace(scene, background_seed=None)
    window = window_of(scene)
    inside = coverage_image([scene.corners_px - [window.left, window.top]], [1.0], window.size_wh) > 0.99
    off = window_mean_of(scene, window) - window_mean_of(plain, window)
    assert np.abs(off[inside]).max() < 1e-3


def test_a_window_shows_what_the_whole_image_shows() -> None:
    for name in ("base", "cover20", "motion4", "shadow0.5", "glare0.4"):
        scene = random_scene(RIG_A, SAIL, conditions_of(RIG_A)[name], seed=6)
        window = window_of(scene)
        (width, height), left, top = window.size_wh, window.left, window.top
        part = mean_of(scene)[top : top + height, left : left + width]
        np.testing.assert_allclose(window_mean_of(scene, window), part, atol=1e-3)


@pytest.mark.parametrize("ratio", [0.05, 0.10, 0.30])
def test_a_finger_covers_the_share_that_was_asked_for(ratio: float) -> None:
    scene = random_scene(RIG_B, PLAIN, replace(BASE, occlusion_ratio=ratio), seed=8)
    assert scene.finger is not None
    window = window_of(scene)
    inside = coverage_image([scene.corners_px - [window.left, window.top]], [1.0], window.size_wh)
    share = scene.finger.share(window.left, window.top, window.size_wh)
    assert (share * inside).sum() / inside.sum() == pytest.approx(ratio, abs=0.005)


def test_motion_and_defocus_do_not_move_the_middle_of_the_marker() -> None:
    middles = []
    for condition in (EVEN, replace(EVEN, motion_px=6.0), replace(EVEN, blur_px=2.0)):
        scene = random_scene(RIG_A, PLAIN, condition, seed=2, background=False)
        middles.append(dark_mass(scene)[1])
    np.testing.assert_allclose(middles[1:], [middles[0]] * 2, atol=0.01)


def test_noise_has_the_variance_that_the_bound_counts_with() -> None:
    scene = frontal(RIG_A)
    mean = mean_of(scene)
    draws = [image_of(replace(scene, noise_seed=(number,))) - mean for number in range(8)]
    measured = np.mean(np.square(draws)) / noise_variance_grey2(mean, scene.condition).mean()
    assert measured == pytest.approx(1.0, abs=0.01)


def test_the_same_seed_gives_the_same_image_and_another_one_another() -> None:
    hard = conditions_of(RIG_A)["hard2"]
    first, again = (image_of(random_scene(RIG_A, CODE, hard, seed=5)) for _ in range(2))
    assert (first == again).all()
    assert (first != image_of(random_scene(RIG_A, CODE, hard, seed=7))).any()
    assert (image_of(empty_scene(RIG_A, seed=1)) != image_of(empty_scene(RIG_A, seed=2))).any()


def test_every_face_and_condition_is_judged_on_the_same_poses() -> None:
    poses = {
        random_scene(RIG_A, face, condition, seed=4).pose.translation_mm.tobytes()
        for face in FACES
        for condition in conditions_of(RIG_A).values()
        if condition.tilt_deg == BASE.tilt_deg and not condition.has_bent_lens
    }
    assert len(poses) == 1


def test_a_face_as_the_tracker_gets_it_is_the_face_that_is_rendered() -> None:
    for face in FACES:
        pose = posed(np.array([0.0, 0.0, 60.0]), tilt_deg=0.0, about_deg=0.0, roll_deg=0.0)
        scene = scene_at(RIG_A, face, replace(EVEN, blur_px=0.3), (pose,), seed=1, background=False)
        left, top = np.rint(scene.corners_px[0]).astype(int)
        right, bottom = np.rint(scene.corners_px[2]).astype(int)
        seen = mean_of(scene)[top:bottom, left:right] > 255.0 * 0.5 * (WHITE + BLACK)
        rows = ((np.arange(bottom - top) + 0.5) / (bottom - top) * 400).astype(int)
        columns = ((np.arange(right - left) + 0.5) / (right - left) * 400).astype(int)
        assert np.mean(seen == (face.image[np.ix_(rows, columns)] > 127)) > 0.99


@pytest.mark.parametrize("speed", ["slow", "normal", "fast"])
def test_a_hand_is_about_as_fast_as_it_is_called(speed: str) -> None:
    mm_per_s = []
    for seed in range(6):
        hand = Hand(RIG_B, speed, seed=seed)
        at = [hand.pose_at(number / 200).translation_mm for number in range(800)]
        mm_per_s.append(np.sqrt(np.mean(np.sum(np.square(np.diff(at, axis=0)), axis=1))) * 200)
    assert np.mean(mm_per_s) == pytest.approx(SPEEDS[speed][0], rel=0.35)


def test_images_of_a_moving_hand_are_blurred_by_its_way_while_the_shutter_is_open() -> None:
    scenes = list(hand_scenes(RIG_B, SAIL, "fast", seed=1, count=30))
    assert [at_s for at_s, _ in scenes] == [number / RATE_HZ for number in range(30)]
    ways = []
    for _, scene in scenes:
        first, last = (RIG_B.px_of(scene.board.poses[end], np.zeros((1, 3)))[0] for end in (0, -1))
        ways.append(float(np.linalg.norm(last - first)))
    assert 0.5 < np.median(ways) < 8.0


def test_the_bound_of_a_straight_edge_is_what_a_hand_computes() -> None:
    # Two sides of length L across x, all else known: information = 2 L step^2 integral(edge'^2) / variance.
    scene = frontal(RIG_A, replace(EVEN, full_well_electrons=1e12, read_noise_grey=2.0))
    information = information_of(scene)
    side_px = float(scene.corners_px[1, 0] - scene.corners_px[0, 0])
    step = 255.0 * (WHITE - BLACK)
    at = np.linspace(-6.0, 6.0, 24_001)
    slope = [
        (math.erf((x + 0.5) / 0.6 / math.sqrt(2)) - math.erf((x - 0.5) / 0.6 / math.sqrt(2))) / 2.0
        for x in at
    ]
    squared = float(np.trapezoid(np.square(slope), at))
    px_per_mm = side_px / PLAIN.side_mm
    wanted = 2.0 * side_px * step**2 * squared / (4.0 + 1.0 / 12.0) * px_per_mm**2
    assert information[0, 0] == pytest.approx(wanted, rel=0.03)
    assert information[1, 1] == pytest.approx(wanted, rel=0.03)


def test_the_bound_goes_with_noise_and_with_the_root_of_the_light() -> None:
    quiet = replace(EVEN, full_well_electrons=1e12, read_noise_grey=4.0)
    tips = [bound_of(frontal_of_sail(replace(quiet, read_noise_grey=grey))).tip_mm for grey in (4.0, 8.0)]
    assert tips[1] / tips[0] == pytest.approx(2.0, rel=0.01)
    shot_only = replace(EVEN, full_well_electrons=200.0, read_noise_grey=0.0)
    tips = [
        bound_of(frontal_of_sail(replace(shot_only, illumination_ratio=ratio))).tip_mm
        for ratio in (1.0, 0.25)
    ]
    assert tips[1] / tips[0] == pytest.approx(2.0, rel=0.02)


def test_the_bound_knows_that_light_blur_and_cover_take_something_away() -> None:
    plain = bound_of(frontal_of_sail(BASE)).tip_mm
    for worse in (
        replace(BASE, blur_px=1.5),
        replace(BASE, occlusion_ratio=0.3),
        replace(BASE, illumination_ratio=0.15),
    ):
        assert bound_of(frontal_of_sail(worse)).tip_mm > 1.1 * plain


def frontal_of_sail(condition: Condition) -> Scene:
    return random_scene(RIG_A, SAIL, condition, seed=9)
