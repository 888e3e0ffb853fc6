"""The verdict follows from the displayed, rounded figures only."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.navigation.assessed import LIMITS, assessed_at, drill, drill_reference, judged_at
from tests.tracker.navigation.bones import ROD_CHANNEL, drill_at
from tracker.navigation import (
    Assessment,
    Correction,
    Direction,
    Figure,
    FigureName,
    Status,
    Verdict,
    assess,
    deviation_from_channel,
)
from tracker.navigation.clearance import NearestWall, WallSource
from tracker.navigation.directions import Wall
from tracker.navigation.figures import drill_figures, rounded, rounded_down, rounded_up
from tracker.navigation.uncertainty import UncertainPose

OVER = {Status.OVER, Status.THROUGH}


@pytest.mark.parametrize(
    ("drill", "verdict", "corrections"),
    [
        pytest.param({"depth_mm": 30.0}, Verdict.ON_PATH, (), id="on-the-axis"),
        pytest.param(
            {"depth_mm": -10.0, "medial_mm": 2.5},
            Verdict.CORRECT_ENTRY,
            ((2.5, Direction.LATERAL),),
            id="comes-in-medially",
        ),
        pytest.param(
            {"depth_mm": -10.0, "medial_mm": -2.0, "cranial_mm": 1.2},
            Verdict.CORRECT_ENTRY,
            ((2.0, Direction.MEDIAL), (1.2, Direction.CAUDAL)),
            id="comes-in-laterally-and-too-high",
        ),
        pytest.param(
            {"depth_mm": -10.0, "medial_mm": -2.0, "cranial_mm": 0.9},
            Verdict.CORRECT_ENTRY,
            ((2.0, Direction.MEDIAL),),
            id="the-smaller-part-is-left-out-under-half-of-the-larger",
        ),
        pytest.param(
            {"depth_mm": 5.0, "medial_deg": 6.0},
            Verdict.CORRECT_ANGLE,
            ((6.0, Direction.LATERAL),),
            id="runs-too-far-to-the-middle",
        ),
        pytest.param(
            {"depth_mm": 5.0, "cranial_deg": -7.0},
            Verdict.CORRECT_ANGLE,
            ((7.0, Direction.CRANIAL),),
            id="runs-too-far-to-the-feet",
        ),
        pytest.param(
            # Entry 1.7 of 1.8 mm and angle 2.0 of 5.7 degrees: each is allowed, both are through the wall.
            {"depth_mm": 2.0, "medial_mm": 1.7, "medial_deg": 2.0},
            Verdict.CORRECT_END,
            ((math.nan, Direction.LATERAL),),
            id="within-entry-and-angle-and-through-at-the-end",
        ),
        pytest.param(
            {"depth_mm": 30.0, "medial_mm": 2.3},
            Verdict.NEAR_WALL,
            ((math.nan, Direction.LATERAL),),
            id="near-the-medial-wall",
        ),
        pytest.param(
            {"depth_mm": 30.0, "cranial_mm": 1.8, "unsure": 7.0, "tolerance_mm": 2.9},
            Verdict.BREACH_LIKELY,
            ((math.nan, Direction.CAUDAL),),
            id="probably-through",
        ),
        pytest.param({"depth_mm": 30.0, "unsure": 10.0}, Verdict.UNCERTAIN, (), id="uncertain"),
        pytest.param(
            {"depth_mm": 30.0, "unsure": 10.0, "min_error_95_mm": 1.8},
            Verdict.UNCERTAIN,
            (),
            id="uncertain-now-although-the-set-up-just-suffices",
        ),
        pytest.param(
            {"depth_mm": 30.0, "unsure": 10.0, "min_error_95_mm": 1.81},
            Verdict.SETUP_INSUFFICIENT,
            (),
            id="uncertain-in-every-image",
        ),
        pytest.param(
            {"depth_mm": 30.0, "min_error_95_mm": 1.81},
            Verdict.ON_PATH,
            (),
            id="within-its-limit-although-the-bound-says-otherwise",
        ),
        pytest.param(
            {"depth_mm": 30.0, "cranial_mm": 2.4, "unsure": 7.0, "min_error_95_mm": 1.81},
            Verdict.BREACH_LIKELY,
            ((math.nan, Direction.CAUDAL),),
            id="a-likely-breach-goes-before-a-set-up-that-does-not-suffice",
        ),
        pytest.param(
            {"depth_mm": 56.2, "unsure": 10.0, "min_error_95_mm": 1.81},
            Verdict.TOO_DEEP,
            (),
            id="too-deep-with-a-set-up-that-does-not-suffice",
        ),
        pytest.param(
            {"depth_mm": 30.0, "medial_mm": -3.8, "unsure": 10.0, "min_error_95_mm": 1.81},
            Verdict.THROUGH_WALL,
            ((math.nan, Direction.MEDIAL),),
            id="through-with-a-set-up-that-does-not-suffice",
        ),
        pytest.param({"depth_mm": 56.2}, Verdict.TOO_DEEP, (), id="too-deep"),
        pytest.param(
            {"depth_mm": 30.0, "medial_mm": -3.8},
            Verdict.THROUGH_WALL,
            ((math.nan, Direction.MEDIAL),),
            id="through-the-lateral-wall",
        ),
        pytest.param(
            {"depth_mm": 60.0, "medial_mm": 60.0},
            Verdict.CORRECT_ENTRY,
            ((60.0, Direction.LATERAL),),
            id="beside-the-patient-no-depth-is-too-deep",
        ),
        pytest.param({"depth_mm": 0.0, "medial_deg": 89.99}, Verdict.CORRECT_ANGLE, (), id="across"),
    ],
)
def test_a_drill_has_the_verdict_of_its_figures_and_the_way_back(
    drill: dict[str, float], verdict: Verdict, corrections: tuple[tuple[float, Direction], ...]
) -> None:
    assessment = assessed_at(**drill)
    assert assessment.verdict is verdict
    assert repr(assessment.corrections) == repr(
        tuple(Correction(amount=mm, towards=to) for mm, to in corrections)
    )


def test_the_wall_that_is_meant_is_named_and_so_is_what_it_was_measured_against() -> None:
    assessment = assessed_at(30.0, cranial_mm=-2.3)
    assert (assessment.wall, assessment.against) == (Wall.CAUDAL, WallSource.BONE)
    assert assessed_at(-10.0).wall is None


def test_no_risk_is_stated_where_no_wall_is_known() -> None:
    """0 % would be said of a drill in another pedicle, too."""
    for place in ({"depth_mm": 30.0, "medial_mm": 40.0}, {"depth_mm": -10.0}):
        figures = assessed_at(**place).figures
        assert math.isnan(figures[FigureName.WALL].value)
        assert (math.isnan(figures[FigureName.RISK].value), figures[FigureName.RISK].status) == (
            True,
            Status.OUTSIDE,
        )
    beside, before = assessed_at(30.0, medial_mm=40.0).figures, assessed_at(-10.0).figures
    assert math.isnan(beside[FigureName.END].value)
    assert before[FigureName.END].value <= 1.0


@pytest.mark.parametrize(
    ("clearance_mm", "shown", "status"),
    [
        (1.04, 1.0, Status.WITHIN),
        (0.999, 0.9, Status.OVER),
        (0.04, 0.0, Status.OVER),
        (-0.001, -0.1, Status.THROUGH),
    ],
)
def test_bone_is_rounded_down_so_that_through_is_never_shown_as_nought(
    clearance_mm: float, shown: float, status: Status
) -> None:
    wall = _with_clearance(clearance_mm).figures[FigureName.WALL]
    assert (wall.value, wall.status) == (shown, status)


@pytest.mark.parametrize(("remaining_mm", "shown"), [(0.04, 0.0), (-0.04, -0.1)])
def test_depth_to_go_is_rounded_down_too(remaining_mm: float, shown: float) -> None:
    assessment = assessed_at(55.0 - remaining_mm)
    to_go = assessment.figures[FigureName.TO_GO]
    assert to_go.value == shown
    assert (to_go.status is Status.THROUGH) == (assessment.verdict is Verdict.TOO_DEEP) == (shown < 0.0)


def test_a_figure_equal_to_its_limit_on_the_screen_is_within_it() -> None:
    # 1.84 against 1.85 and 1.75: shown as 1.8 of 1.8, and as 1.8 of 1.7.
    for tolerance_mm, status in ((1.85, Status.WITHIN), (1.75, Status.OVER)):
        entry = assessed_at(-10.0, medial_mm=1.84, tolerance_mm=tolerance_mm).figures[FigureName.ENTRY]
        assert (entry.value, entry.limit, entry.status) == (1.8, math.floor(tolerance_mm * 10) / 10, status)


def test_the_error_is_that_of_the_whole_chain_and_not_of_the_marker_alone() -> None:
    # A registration with 0.5 mm uncertainty, and a marker with 0.01 mm.
    registered = np.diag([0.5**2] * 3 + [0.0] * 3)
    place = drill_at(ROD_CHANNEL, 30.0)
    judged = drill_reference().analyse(UncertainPose(pose=place, covariance=registered), drill(), ROD_CHANNEL)
    assessment = assess(deviation_from_channel(place, ROD_CHANNEL), judged, ROD_CHANNEL, LIMITS)
    error = assessment.figures[FigureName.ERROR]
    assert error.value == pytest.approx(0.5 * 2.4478, abs=0.011)
    assert assessment.figures[FigureName.ENTRY].error_95 == error.value


def test_without_a_pedicle_nothing_is_praised_and_depth_still_counts() -> None:
    for depth_mm, verdict in ((30.0, Verdict.NOT_ASSESSED), (56.0, Verdict.TOO_DEEP)):
        deviation = deviation_from_channel(drill_at(ROD_CHANNEL, depth_mm), ROD_CHANNEL)
        assessment = assess(deviation, None, ROD_CHANNEL, LIMITS)
        assert assessment.verdict is verdict
        assert assessment.figures[FigureName.ENTRY].status is Status.UNLIMITED
        assert math.isnan(assessment.figures[FigureName.WALL].value)


DRILLS = st.fixed_dictionaries(
    {
        "depth_mm": st.floats(-40.0, 70.0),
        "medial_mm": st.floats(-8.0, 8.0),
        "cranial_mm": st.floats(-8.0, 8.0),
        "medial_deg": st.floats(-40.0, 40.0),
        "cranial_deg": st.floats(-40.0, 40.0),
    }
)


@settings(deadline=None, max_examples=60)
@given(drill=DRILLS, scale=st.floats(0.2, 12.0), tolerance_mm=st.floats(0.0, 3.0))
def test_the_verdict_is_the_worst_that_the_figures_say_and_on_path_only_within_all(
    drill: dict[str, float], scale: float, tolerance_mm: float
) -> None:
    assessment = assessed_at(**drill, unsure=scale, tolerance_mm=tolerance_mm)
    assert_consistent(assessment)


@settings(deadline=None, max_examples=100)
@given(drill=DRILLS, scale=st.floats(0.2, 12.0), tolerance_mm=st.floats(0.0, 3.0), min_mm=st.floats(0.0, 6.0))
def test_a_set_up_that_does_not_suffice_makes_no_verdict_calmer(
    drill: dict[str, float], scale: float, tolerance_mm: float, min_mm: float
) -> None:
    placed = {**drill, "unsure": scale, "tolerance_mm": tolerance_mm}
    unknown, known = assessed_at(**placed), assessed_at(**placed, min_error_95_mm=min_mm)
    assert known.figures == unknown.figures or "nan" in repr(known.figures)
    if unknown.verdict is not Verdict.UNCERTAIN:
        assert known.verdict is unknown.verdict
        return
    if min_mm <= known.figures[FigureName.ERROR].limit:
        assert known.verdict is Verdict.UNCERTAIN
        return
    is_likely = known.figures[FigureName.RISK].status is Status.OVER
    assert known.verdict is (Verdict.BREACH_LIKELY if is_likely else Verdict.SETUP_INSUFFICIENT)
    # No headline that only asks for a correction hides it.
    assert known.verdict.severity > Verdict.NEAR_WALL.severity


def assert_consistent(assessment: Assessment) -> None:
    """The rules of every assessment, restated from the rounded figures alone."""
    f, verdict = assessment.figures, assessment.verdict
    over = {name for name in FigureName if _is_over(name, f[name])}
    assert over == {name for name in FigureName if f[name].status in OVER}
    if verdict is Verdict.ON_PATH:
        assert not over
    if FigureName.WALL in over and f[FigureName.WALL].value < 0.0:
        assert verdict is Verdict.THROUGH_WALL
    about = {
        Verdict.THROUGH_WALL: FigureName.WALL,
        Verdict.TOO_DEEP: FigureName.TO_GO,
        Verdict.UNCERTAIN: FigureName.ERROR,
        Verdict.SETUP_INSUFFICIENT: FigureName.ERROR,
        Verdict.BREACH_LIKELY: FigureName.RISK,
        Verdict.NEAR_WALL: FigureName.WALL,
        Verdict.CORRECT_ENTRY: FigureName.ENTRY,
        Verdict.CORRECT_ANGLE: FigureName.ANGLE,
        Verdict.CORRECT_END: FigureName.END,
    }
    if verdict in about:
        assert about[verdict] in over, "a verdict names a figure that is over its limit"
    for correction in assessment.corrections:
        assert math.isnan(correction.amount) or correction.amount > 0.0


def _is_over(name: FigureName, figure: Figure) -> bool:
    if figure.status in (Status.UNLIMITED, Status.OUTSIDE):
        return False
    if name is FigureName.WALL:
        return figure.value < figure.limit
    if name is FigureName.TO_GO:
        return figure.value < 0.0
    return not figure.value <= figure.limit


@given(value=st.floats(-1e4, 1e4), decimals=st.integers(0, 2))
def test_rounding_has_its_direction_and_never_a_negative_zero(value: float, decimals: int) -> None:
    correction = 10.0**-decimals
    near, down, up = (round_(value, decimals=decimals) for round_ in (rounded, rounded_down, rounded_up))
    assert down <= value + 2e-9
    assert up >= value - 2e-9
    assert down <= near <= up or abs(near - value) < 2e-9
    assert abs(near - value) <= correction / 2 + 1e-9
    assert all(math.copysign(1.0, each) > 0.0 for each in (near, down, up) if each == 0.0)


@pytest.mark.parametrize("length_mm", [47.0, 46.95, 47.04, 55.25])
def test_depth_and_what_is_to_go_add_to_the_length_shown(length_mm: float) -> None:
    channel = replace(
        ROD_CHANNEL,
        target_in_vertebra_mm=ROD_CHANNEL.entry_in_vertebra_mm + length_mm * ROD_CHANNEL.axis_in_vertebra,
    )
    for step in range(-200, 600):
        depth_mm = 0.1037 * step
        deviation = deviation_from_channel(drill_at(channel, depth_mm), channel)
        figures = drill_figures(deviation, None, channel, LIMITS)
        depth, to_go = figures[FigureName.DEPTH], figures[FigureName.TO_GO]
        assert rounded(depth.value + to_go.value) == depth.limit == rounded(length_mm)
        # Towards danger: what is to go is never shown too long, and the depth too short only by the rounding
        # of the length.
        assert to_go.value <= length_mm - depth_mm + 1e-6
        assert depth.value >= depth_mm - max(length_mm - depth.limit, 0.0) - 1e-6
        assert abs(depth.value - depth_mm) < 0.15
        assert (depth.value > depth.limit) == (to_go.value < 0.0) == (to_go.status is Status.THROUGH)


def _with_clearance(clearance_mm: float) -> Assessment:
    judged = judged_at(30.0)
    now = judged.clearance.now
    assert isinstance(now, NearestWall)
    clearance = replace(judged.clearance, now=replace(now, clearance_mm=clearance_mm))
    deviation = deviation_from_channel(drill_at(ROD_CHANNEL, 30.0), ROD_CHANNEL)
    return assess(deviation, replace(judged, clearance=clearance), ROD_CHANNEL, LIMITS)
