"""The hand on the bone: landmarks touched, surface swept, a good drill hole and one through the wall."""

import numpy as np
import pytest

from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.rehearsal import Phase, Scene, Skill, Theatre, TheatreSettings, Truth
from tracker.rehearsal.anatomy import bone_field, bone_normals, canal_field

SEEDS = (1,)
RADIUS_MM = 2.0


def played(scene: Scene, seed: int, step_s: float = 0.05) -> tuple[Theatre, list[Truth]]:
    theatre = Theatre(TheatreSettings(seed=seed, scene=scene, reference=True))
    return theatre, [theatre.truth_at(at_s) for at_s in np.arange(0.0, theatre.cycle_s, step_s)]


def vertebra_from_tool(truth: Truth) -> Rigid[Vertebra, Tool]:
    return truth.camera_from_vertebra.inverse @ truth.camera_from_tool


def tip(truth: Truth) -> Array:
    return vertebra_from_tool(truth).translation_mm


def test_landmarks_lie_on_the_bone_far_apart_and_the_check_is_none_of_them() -> None:
    theatre = Theatre(TheatreSettings())
    points = np.array([one.point_in_vertebra_mm for one in theatre.landmarks])
    assert len({one.name for one in theatre.landmarks}) == len(points) >= 6
    assert np.abs(bone_field(points)).max() < 1e-3
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    assert spread[2] > 20.0, "in no plane: turned about none of their lines do they look the same"
    apart = np.linalg.norm(points - theatre.check_landmark.point_in_vertebra_mm, axis=1)
    assert apart.min() > 4.0
    for one in theatre.landmarks:
        assert ("left" in one.name) == (one.point_in_vertebra_mm[0] > 5.0)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_tip_rests_on_each_landmark_with_hand_tremor(seed: int) -> None:
    theatre, truths = played(Scene.LANDMARKS, seed, 0.02)
    order = [truth.touched for truth in truths if truth.touched]
    assert list(dict.fromkeys(order)) == [one.name for one in theatre.landmarks]
    for landmark in theatre.landmarks:
        there = [truth for truth in truths if truth.touched == landmark.name]
        assert len(there) * 0.02 > 1.5
        assert all(truth.marker_in_view and truth.phase is Phase.TOUCH for truth in there)
        tips = np.array([tip(truth) for truth in there])
        tremor_mm = float(np.sqrt(((tips - tips.mean(axis=0)) ** 2).sum(axis=1).mean()))
        assert 0.08 < tremor_mm < 0.15
        assert 0.0 < np.linalg.norm(tips.mean(axis=0) - landmark.point_in_vertebra_mm) < 0.7
        assert np.abs(bone_field(tips)).max() < 0.2


@pytest.mark.parametrize("scene", [Scene.LANDMARKS, Scene.CHECK])
def test_a_tip_rests_for_the_configured_time(scene: Scene) -> None:
    theatre = Theatre(TheatreSettings(scene=scene, rest_s=5.0))
    step_s = 0.05
    touched = [theatre.truth_at(at_s).touched for at_s in np.arange(0.0, theatre.cycle_s, step_s)]
    for name in {one for one in touched if one}:
        assert touched.count(name) * step_s == pytest.approx(5.0, abs=2 * step_s)


def test_between_landmarks_the_hand_lifts_off_and_never_jumps() -> None:
    _, truths = played(Scene.LANDMARKS, 3, 0.01)
    tips = np.array([tip(truth) for truth in truths])
    assert np.linalg.norm(np.diff(tips, axis=0), axis=1).max() < 3.0
    moving = np.array([truth.phase is Phase.MOVE for truth in truths])
    assert bone_field(tips[moving]).max() > 15.0
    assert bone_field(tips[moving]).min() > -0.4, "around the bone, not through it"


@pytest.mark.parametrize("seed", SEEDS)
def test_the_sweep_touches_bone_whose_normals_leave_no_motion_free(seed: int) -> None:
    _, truths = played(Scene.SWEEP, seed)
    swept = [truth for truth in truths if truth.phase is Phase.SWEEP]
    assert len(swept) * 0.05 > 20.0
    assert all(truth.marker_in_view for truth in swept)
    tips = np.array([tip(truth) for truth in swept])
    assert np.abs(bone_field(tips)).max() < 0.2
    normals = bone_normals(tips)
    arms = (tips - tips.mean(axis=0)) / 25.0
    slides = np.linalg.svd(np.hstack([normals, np.cross(arms, normals)]), compute_uv=False)
    assert slides[-1] > 0.2 * slides[0]


def test_the_check_rests_on_the_landmark_that_was_left() -> None:
    theatre, truths = played(Scene.CHECK, 2)
    there = np.array([tip(truth) for truth in truths if truth.touched])
    assert {truth.touched for truth in truths} == {"", theatre.check_landmark.name}
    assert np.linalg.norm(there - theatre.check_landmark.point_in_vertebra_mm, axis=1).max() < 1.0


def drilled(skill: Skill, seed: int) -> tuple[Theatre, list[Truth]]:
    theatre = Theatre(TheatreSettings(seed=seed, skill=skill))
    return theatre, [theatre.truth_at(at_s) for at_s in np.arange(0.0, 40.0, 0.05)]


def mantle(truth: Truth, depth_mm: float) -> Array:
    """Points around the drill's cylinder, from its tip back to 4 mm below the entry."""
    place = vertebra_from_tool(truth)
    back = np.linspace(0.0, max(depth_mm - 4.0, 0.0), 30)[:, None]
    angle = np.linspace(0.0, 2.0 * np.pi, 36)[None, :]
    local = np.stack(
        [RADIUS_MM * np.cos(angle) + 0 * back, RADIUS_MM * np.sin(angle) + 0 * back, 0 * angle - back],
        axis=-1,
    )
    return place.move_points(local.reshape(-1, 3))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_good_hand_stays_over_a_millimetre_off_the_wall_and_in_the_picture(seed: int) -> None:
    theatre, truths = drilled(Skill.GOOD, seed)
    channel, deepest = theatre.channels[0], 0.0
    for truth in truths:
        assert truth.marker_in_view
        depth = float((tip(truth) - channel.entry_in_vertebra_mm) @ channel.axis_in_vertebra)
        deepest = max(deepest, depth)
        if depth > 6.0:
            assert bone_field(mantle(truth, depth)).max() < -1.0
        beside = tip(truth) - channel.entry_in_vertebra_mm - depth * channel.axis_in_vertebra
        assert channel.radius_mm - RADIUS_MM - np.linalg.norm(beside) > 1.0
    assert deepest > 26.0


@pytest.mark.parametrize("seed", SEEDS)
def test_a_breaching_hand_goes_through_the_wall_to_the_canal_at_a_known_time(seed: int) -> None:
    theatre, truths = drilled(Skill.BREACHING, seed)
    channel = theatre.channels[0]
    through = []
    for truth in truths:
        depth = float((tip(truth) - channel.entry_in_vertebra_mm) @ channel.axis_in_vertebra)
        if depth > 6.0 and bone_field(mantle(truth, depth)).max() > 0.0:
            through.append(truth)
    assert 18.0 < through[0].at_s < 20.0
    deepest = max(float(-canal_field(mantle(truth, 12.0)).min()) for truth in through)
    assert deepest > 1.0, "the wall between pedicle and canal, not another one"
    assert all(truth.marker_in_view for truth in through)
