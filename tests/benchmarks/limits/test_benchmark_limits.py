"""Claims are evaluated correctly, peers are treated fairly, and the tables state what was measured."""

from dataclasses import replace

import numpy as np
import pytest

from tests.benchmarks.figures import Share
from tests.benchmarks.limits.condition_tables import condition_tables, wrong
from tests.benchmarks.limits.conditions_run import DISTURBED_IMAGES, ConditionRun
from tests.benchmarks.limits.evaluation import Claim, Evaluation, Outcome, evaluate
from tests.benchmarks.limits.limit_figures import limit_figures
from tests.benchmarks.limits.limit_plots import limit_plots
from tests.benchmarks.limits.pace import HandRun, PaceRun
from tests.benchmarks.limits.pace_tables import pace_tables
from tests.benchmarks.limits.peers import APRILTAG_ABSENT, Aruco
from tests.benchmarks.limits.returning import ReturnRun, measure_returns
from tests.benchmarks.limits.run import LimitsRun, measure
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.scenes.bound import PARAMETERS
from tests.benchmarks.scenes.faces import SAIL
from tests.benchmarks.scenes.placement import empty_scene, posed, random_scene, scene_at
from tests.benchmarks.scenes.rigs import RIG_A, RIG_B
from tests.benchmarks.scenes.scene import Pose, Scene, image_of
from tracker.errors import InvalidInput
from tracker.geometry import Rigid, rotation_from_vector

CORRECT = Evaluation(
    outcome=Outcome.CORRECT,
    errors=dict.fromkeys(PARAMETERS, 0.5),
    mahalanobis_squared=(1.0, 2.0, 9.0),
    found_by="track",
)
MISSED = Evaluation(outcome=Outcome.MISSED, errors={})
WRONG = Evaluation(outcome=Outcome.WRONG, errors={})


def tilted_scene(tilt_deg: float) -> Scene:
    pose = posed(np.array([30.0, -20.0, 940.0]), tilt_deg=tilt_deg, about_deg=20.0, roll_deg=50.0)
    return scene_at(RIG_A, SAIL, random_scene(RIG_A, SAIL).condition, (pose,), seed=3)


def claim_at(pose: Pose, *, sd: float = 1.0) -> Claim:
    covariance = np.diag([sd**2] * 3 + [(0.01 * sd) ** 2] * 3)
    return Claim(pose=pose, corners_px=RIG_A.px_of(pose, SAIL.corners_mm), covariance=covariance)


def test_the_truth_has_no_error_and_lies_inside_its_ellipsoid() -> None:
    scene = tilted_scene(35.0)
    one = evaluate(scene, claim_at(scene.pose))
    assert one.outcome is Outcome.CORRECT
    assert max(one.errors.values()) < 1e-9
    assert one.covered == (True, True, True)
    assert not one.is_mirrored


def test_errors_are_reported_by_parameter() -> None:
    scene = tilted_scene(0.0)
    pose = scene.pose
    sight = pose.translation_mm / np.linalg.norm(pose.translation_mm)
    across = np.cross(sight, [0.0, 1.0, 0.0])
    rolled = pose.rotation @ rotation_from_vector([0.0, 0.0, np.radians(1.0)])
    off: Pose = Rigid(
        rotation=rolled,
        translation_mm=pose.translation_mm + 2.0 * sight + 0.3 * across / np.linalg.norm(across),
    )
    errors = evaluate(scene, claim_at(off)).errors
    assert errors["depth_mm"] == pytest.approx(2.0)
    assert errors["across_mm"] == pytest.approx(0.3)
    assert errors["roll_deg"] == pytest.approx(1.0)
    assert errors["tilt_deg"] == pytest.approx(0.0, abs=1e-9)
    # The roll alone moves a point 120 mm away by 2.09 mm across.
    assert np.hypot(2.0, 1.7) < errors["tip_mm"] < np.hypot(2.0, 2.5)


def test_the_second_planar_solution_is_called_mirrored_unless_both_are_one() -> None:
    for tilt_deg, expected in ((40.0, True), (2.0, False)):
        scene = tilted_scene(tilt_deg)
        other = posed(np.array(scene.pose.translation_mm), tilt_deg=-tilt_deg, about_deg=20.0, roll_deg=50.0)
        assert evaluate(scene, claim_at(other)).is_mirrored is expected


def test_a_claim_elsewhere_is_wrong_and_so_is_any_in_an_empty_image() -> None:
    scene = tilted_scene(20.0)
    moved: Pose = Rigid(
        rotation=scene.pose.rotation, translation_mm=scene.pose.translation_mm + np.array([10.0, 0.0, 0.0])
    )
    assert evaluate(scene, claim_at(moved)).outcome is Outcome.WRONG
    assert evaluate(empty_scene(RIG_A), claim_at(scene.pose)).outcome is Outcome.WRONG
    assert evaluate(empty_scene(RIG_A), None).outcome is Outcome.MISSED
    nowhere = replace(claim_at(scene.pose), corners_px=np.full((4, 2), np.nan))
    assert evaluate(scene, nowhere).outcome is Outcome.WRONG


def test_a_small_covariance_does_not_hold_a_large_error() -> None:
    scene = tilted_scene(30.0)
    turned = rotation_from_vector([0.0, 0.01, 0.0]) @ scene.pose.rotation
    pose: Pose = Rigid(rotation=turned, translation_mm=scene.pose.translation_mm)
    assert evaluate(scene, claim_at(pose, sd=1.0)).covered == (True, True, True)
    assert evaluate(scene, claim_at(pose, sd=0.1)).covered == (True, False, False)


def test_opencvs_marker_is_found_where_it_is() -> None:
    aruco = Aruco()
    for seed in range(4):
        scene = random_scene(RIG_B, aruco.face, seed=seed)
        one = evaluate(scene, aruco.search(RIG_B, image_of(scene)))
        assert one.outcome is Outcome.CORRECT
        assert one.errors["across_mm"] < 0.1
        assert one.errors["roll_deg"] < 0.5


def test_a_marker_that_comes_back_is_found_in_one_of_the_first_images() -> None:
    (run,) = measure_returns(RIG_A, count=3, seed=0, conditions=["base"])
    assert len(run.images) == len(run.claims) == 3
    assert max(run.images) <= 2
    assert wrong(run.claims) == 0
    assert {one.found_by for one in run.claims} == {"search"}


def invented_run(*, with_apriltag: bool) -> LimitsRun:
    peers = ["cv2.aruco", *(["AprilTag"] if with_apriltag else [])]
    base = ConditionRun(
        rig="A",
        condition="base",
        searched=[CORRECT, CORRECT, MISSED, WRONG],
        faces=["sail", "orbit", "code", "sail"],
        stepped=[CORRECT, CORRECT],
        peers={name: [CORRECT, MISSED, MISSED, MISSED] for name in peers},
    )
    pace = [
        PaceRun(
            rig=RIG_A,
            known=known,
            in_view=in_view,
            search_ms=[4.0, 4.0, 6.0],
            step_ms=[step_ms] * 3,
            peers_ms={name: [10.0, 10.0, 10.0] for name in peers},
            by_step_ms=[10.0] * 3,
        )
        for known, in_view, step_ms in ((1, 0, 9.0), (1, 1, 1.0), (4, 1, 2.0), (4, 4, 4.0))
    ]
    return LimitsRun(
        peers=peers,
        conditions={"A": [base]},
        hands=[HandRun(rig="A", speed="fast", stepped=[CORRECT, MISSED], ratios=[0.1, 0.2])],
        paces=pace,
        returns=[
            ReturnRun(rig="A", condition="hard1", images=[1, 5, 6, 33], claims=[CORRECT, WRONG, CORRECT])
        ],
        empty={"A": {"coaxial": [MISSED, MISSED], **{name: [MISSED] for name in peers}}},
        first_images=[],
    )


def test_tables_say_shares_medians_and_ratios() -> None:
    run = invented_run(with_apriltag=True)
    found, tip, *_ = condition_tables(run)
    assert list(found.rows[0]) == [
        *("base", "4", "0.500", "0.99", "0.250", "0.250", "2", "1.000", "–", "1", "0 / 0", "0"),
    ]
    assert list(tip.rows[0])[:3] == ["base", "2", "0.500 / 0.500"]
    time, hand, returns, empty = pace_tables(run)
    assert [list(row)[3:5] for row in time.rows[:2]] == [
        ["0.400 / 0.596", "–"],
        ["0.400 / 0.596", "0.4 / 1.5"],
    ]
    assert [list(row)[8] for row in time.rows[:4]] == ["1 / 2", "0.15 / 0.6", "–", "4.00 of one, goal 2.5"]
    assert list(hand.rows[0])[:4] == ["A fast", "2", "0.500", "0.500"]
    assert list(returns.rows[0]) == [
        *("A hard1", "4", "0.25", "0.25", "0.75", "0.75", "0.75", "0.95 within 6", "1"),
    ]
    assert list(empty.rows[0]) == ["A", "0 of 2", "0 of 1", "0 of 1"]


def test_a_peer_that_is_not_installed_is_marked_in_its_column() -> None:
    run = invented_run(with_apriltag=False)
    tables = [*condition_tables(run), *pace_tables(run)]
    assert sum(APRILTAG_ABSENT in cell for table in tables for row in table.rows for cell in row) > 5
    assert all(len(row) == len(table.columns) for table in tables for row in table.rows)
    assert "AprilTag" not in limit_plots(run)["found"]


def test_figures_count_what_the_tables_show() -> None:
    figures = limit_figures(invented_run(with_apriltag=True))
    assert figures["A base, found by search"] == Share(count=2, of=4)
    assert figures["A base, tracked by step"] == Share(count=2, of=2, in_a_row=DISTURBED_IMAGES)
    assert figures["A base by search, wrong"] == Share(count=1, of=4, is_good=False, is_strict=True)
    assert figures["A hard1 that comes back, found within 6 images"] == Share(count=3, of=4)
    assert figures["A hard1 that comes back, wrong"] == Share(count=1, of=3, is_good=False, is_strict=True)
    assert "768x576, 1 known, 1 in view, search by cv2.aruco, median" in figures


def test_a_condition_that_does_not_exist_is_rejected_by_name() -> None:
    with pytest.raises(InvalidInput) as caught:
        measure(BenchmarkOptions(conditions=("base", "fog")))
    assert caught.value.code == "BENCHMARK_CONDITION_UNKNOWN"
    assert "fog" in str(caught.value)
    with pytest.raises(InvalidInput) as caught:
        measure(BenchmarkOptions(rigs="AX"))
    assert caught.value.code == "BENCHMARK_RIG_UNKNOWN"


def test_a_condition_is_measured_from_end_to_end() -> None:
    run = measure(BenchmarkOptions(rigs="A", conditions=("base",), images=3, seed=11))
    (base,) = run.conditions["A"]
    assert [one.outcome for one in base.searched] == [Outcome.CORRECT] * 3
    assert [one.outcome for one in base.stepped] == [Outcome.CORRECT] * 4
    assert len(base.bounds) == len(base.of_bound) == 3
    assert all(0.0 < bound.tip_mm < 1.0 for bound in base.bounds)
