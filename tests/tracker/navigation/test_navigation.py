"""Deviation by hand, absent values with their reasons, and consistency within a snapshot."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import camera_of, corners_px_of, facing
from tracker import PlanError, Seen, Sighting, ToolModel, Unseen, UnseenReason
from tracker.errors import InvalidInput
from tracker.geometry import Rigid, Tool, Vertebra, rotation_from_vector
from tracker.navigation import (
    Absent,
    AbsentReason,
    NavigationSnapshot,
    Setup,
    ToolPose,
    VertebraPose,
    deviation_from_channel,
    navigate,
)
from tracker.plan import Channel
from tracker.pose import marker_point_covariance_mm2
from tracker.registration import Registration

# From the origin 40 mm along +y.
CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=np.zeros(3),
    target_in_vertebra_mm=np.array([0.0, 40.0, 0.0]),
    radius_mm=4.0,
)


def _drill(
    tip_mm: tuple[float, float, float], direction: tuple[float, float, float]
) -> Rigid[Vertebra, Tool]:
    # The same construction, for a frame of the test's choice.
    placed = ToolModel.from_tip_and_axis(
        name="drill",
        marker="drill",
        tip_in_marker_mm=tip_mm,
        axis_in_marker=direction,
        radius_mm=2.0,
        length_mm=100.0,
    ).marker_from_tool
    return Rigid(rotation=placed.rotation, translation_mm=placed.translation_mm)


TAN_30 = float(np.tan(np.radians(30)))


@pytest.mark.parametrize(
    ("tip_mm", "direction", "entry_offset_mm", "angle_deg", "depth_mm", "remaining_mm", "tip_offset_mm"),
    [
        pytest.param((0, 0, 0), (0, 1, 0), 0, 0, 0, 40, 0, id="at-the-entry-on-the-axis"),
        pytest.param((0, 25, 0), (0, 1, 0), 0, 0, 25, 15, 0, id="deep-on-the-axis"),
        pytest.param((0, -7, 0), (0, 1, 0), 0, 0, -7, 47, 0, id="seven-before-the-bone"),
        pytest.param((0, 42, 0), (0, 1, 0), 0, 0, 42, -2, 0, id="two-past-the-end"),
        pytest.param((3, 10, 4), (0, 1, 0), 5, 0, 10, 30, 5, id="beside-the-axis-and-parallel"),
        pytest.param((0, 10, 0), (TAN_30, 1, 0), 10 * TAN_30, 30, 10, 30, 0, id="tip-on-the-axis-and-tilted"),
        pytest.param((0, -10, 0), (0, 1, TAN_30), 10 * TAN_30, 30, -10, 50, 0, id="aiming-past-the-entry"),
        pytest.param((-10, -10, 0), (1, 1, 0), 0, 45, -10, 50, 10, id="aiming-at-the-entry-from-45-degrees"),
        pytest.param((0, 10, 0), (0, -1, 0), 0, 180, 10, 30, 0, id="pointing-backwards"),
        pytest.param(
            (0, 10, 0), (1, 0, 0), np.inf, 90, 10, 30, 0, id="across-it-never-meets-the-entry-plane"
        ),
        pytest.param((2, 0, 0), (0, 0, 1), np.inf, 90, 0, 40, 2, id="across-within-the-entry-plane"),
        pytest.param((0, 10, 0), (0, 5, 0), 0, 0, 10, 30, 0, id="direction-of-any-length"),
    ],
)
def test_deviation_is_what_a_hand_computes(
    tip_mm: tuple[float, float, float],
    direction: tuple[float, float, float],
    entry_offset_mm: float,
    angle_deg: float,
    depth_mm: float,
    remaining_mm: float,
    tip_offset_mm: float,
) -> None:
    deviation = deviation_from_channel(_drill(tip_mm, direction), CHANNEL)
    assert deviation.entry_offset_mm == pytest.approx(entry_offset_mm, abs=1e-9)
    assert deviation.angle_deg == pytest.approx(angle_deg, abs=1e-9)
    assert deviation.depth_mm == pytest.approx(depth_mm, abs=1e-9)
    assert deviation.remaining_mm == pytest.approx(remaining_mm, abs=1e-9)
    assert deviation.tip_offset_mm == pytest.approx(tip_offset_mm, abs=1e-9)


def test_the_deviation_does_not_depend_on_where_the_patient_lies() -> None:
    move: Rigid[Vertebra, Vertebra] = Rigid(
        rotation=rotation_from_vector([0.4, -1.2, 0.7]), translation_mm=np.array([120.0, -60.0, 900.0])
    )
    moved = replace(
        CHANNEL,
        entry_in_vertebra_mm=move.move_points(CHANNEL.entry_in_vertebra_mm),
        target_in_vertebra_mm=move.move_points(CHANNEL.target_in_vertebra_mm),
    )
    drill = _drill((2.0, 11.0, -1.0), (0.1, 1.0, -0.2))
    here, there = deviation_from_channel(drill, CHANNEL), deviation_from_channel(move @ drill, moved)
    # Values in the patient's directions rotate with the patient.
    for name in ("entry_offset_mm", "angle_deg", "depth_mm", "remaining_mm", "tip_offset_mm"):
        assert getattr(there, name) == pytest.approx(getattr(here, name), abs=1e-9)


def test_turning_the_drill_about_its_own_axis_changes_nothing() -> None:
    drill = _drill((2.0, 11.0, -1.0), (0.1, 1.0, -0.2))
    spin: Rigid[Tool, Tool] = Rigid(rotation=rotation_from_vector([0, 0, 1.3]), translation_mm=np.zeros(3))
    assert deviation_from_channel(drill @ spin, CHANNEL).entry_offset_mm == pytest.approx(
        deviation_from_channel(drill, CHANNEL).entry_offset_mm
    )


@pytest.mark.parametrize(
    ("target_mm", "radius_mm"),
    [
        pytest.param((0.0, 0.9, 0.0), 4.0, id="shorter than a millimetre"),
        pytest.param((0.0, 0.0, 0.0), 4.0, id="no length"),
        pytest.param((0.0, 40.0, 0.0), 0.0, id="no radius"),
        pytest.param((0.0, 40.0, 0.0), -1.0, id="negative radius"),
        pytest.param((0.0, 40.0, 0.0), float("nan"), id="radius not a number"),
        pytest.param((0.0, float("nan"), 0.0), 4.0, id="target not a number"),
    ],
)
def test_a_channel_that_cannot_be_drilled_is_rejected(
    target_mm: tuple[float, float, float], radius_mm: float
) -> None:
    with pytest.raises(PlanError) as caught:
        Channel(
            name="L3 left",
            entry_in_vertebra_mm=np.zeros(3),
            target_in_vertebra_mm=np.array(target_mm),
            radius_mm=radius_mm,
        )
    assert caught.value.code == "CHANNEL_INVALID"


def test_a_channel_knows_its_length_and_direction_and_cannot_be_written() -> None:
    channel = replace(CHANNEL, target_in_vertebra_mm=np.array([3.0, 0.0, 4.0]))
    assert channel.length_mm == pytest.approx(5.0)
    np.testing.assert_allclose(channel.axis_in_vertebra, [0.6, 0.0, 0.8])
    with pytest.raises(ValueError, match="read-only"):
        channel.entry_in_vertebra_mm[0] = 1.0


@pytest.mark.parametrize("axis", [(0, 0, 0), (np.nan, 0, 1), (0, np.inf, 0)])
def test_a_tool_without_a_direction_is_rejected(axis: tuple[float, float, float]) -> None:
    with pytest.raises(InvalidInput) as caught:
        _drill((0, 0, 0), axis)
    assert caught.value.code == "TOOL_AXIS_INVALID"


@pytest.mark.parametrize("axis", [(0, -1, 0), (0, 0, 1), (0, 0, -1), (3, -2, 0.5)])
def test_the_tool_s_z_is_its_drilling_direction_and_its_origin_the_tip(
    axis: tuple[float, float, float],
) -> None:
    pose = _drill((1, 2, 3), axis)
    np.testing.assert_allclose(
        pose.rotate_directions([0, 0, 1]), np.array(axis) / np.linalg.norm(axis), atol=1e-9
    )
    np.testing.assert_allclose(pose.move_points([0, 0, 0]), [1, 2, 3])


CAMERA = camera_of()
CAMERA_FROM_MARKER = facing([20, -10, 420], tilt_deg=25, about_deg=40, roll_deg=10)
SEEN = Seen(
    camera_from_marker=CAMERA_FROM_MARKER,
    pose_covariance=np.diag([0.01, 0.01, 0.2, 1e-5, 1e-5, 1e-6]),
    corners_px=corners_px_of(CAMERA, CAMERA_FROM_MARKER),
    score_ratio=0.9,
    target_score_ratio=0.8,
    model_coverage_ratio=0.92,
    target_coverage_ratio=0.82,
    fit_error_px2=0.04,
    found_by="search",
)
UNSEEN = Unseen(reason=UnseenReason.SCORE_TOO_LOW, best_score_ratio=0.6)
TWICE = Unseen(reason=UnseenReason.MARKER_TWICE, best_score_ratio=0.9)
TOOL = ToolModel.from_tip_and_axis(
    name="drill",
    marker="square",
    tip_in_marker_mm=[0, -120, -10],
    axis_in_marker=[0, -1, 0],
    radius_mm=2.0,
    length_mm=118.0,
)
SETUP = Setup(
    camera=CAMERA,
    camera_calibrated=True,
    tools={"drill": TOOL},
    channel=CHANNEL,
    registration=Registration.known_to_camera(Rigid.from_vector([1.0, 0.2, -0.4], [10, 60, 500])),
)


def _snapshot(setup: Setup, sighting: Sighting) -> NavigationSnapshot:
    return navigate(
        setup=setup,
        sightings={"square": sighting},
        image_number=41,
        captured_at_s=1.375,
        size_wh_px=(640, 480),
        stage_ms={"edges": 2.0},
        skipped_images=3,
    )


NO_PLAN = Absent(reason=AbsentReason.NO_PLAN)
NOT_REGISTERED = Absent(reason=AbsentReason.NOT_REGISTERED)


@pytest.mark.parametrize(
    ("setup", "sighting", "tool", "deviation"),
    [
        pytest.param(SETUP, UNSEEN, "MARKER_UNSEEN", "MARKER_UNSEEN", id="marker not seen"),
        pytest.param(SETUP, TWICE, "MARKER_TWICE", "MARKER_TWICE", id="marker twice in view"),
        pytest.param(
            replace(SETUP, camera_calibrated=False),
            SEEN,
            "CAMERA_NOT_CALIBRATED",
            "CAMERA_NOT_CALIBRATED",
            id="camera not calibrated: no millimetres",
        ),
        pytest.param(
            replace(SETUP, camera_calibrated=False),
            UNSEEN,
            "MARKER_UNSEEN",
            "MARKER_UNSEEN",
            id="not seen and not calibrated",
        ),
        pytest.param(replace(SETUP, channel=NO_PLAN), SEEN, None, "NO_PLAN", id="no plan"),
        pytest.param(
            replace(SETUP, registration=NOT_REGISTERED),
            SEEN,
            None,
            "NOT_REGISTERED",
            id="not registered",
        ),
        pytest.param(
            replace(SETUP, channel=NO_PLAN, registration=NOT_REGISTERED),
            UNSEEN,
            "MARKER_UNSEEN",
            "MARKER_UNSEEN",
            id="nothing at all: what is nearest to mend comes first",
        ),
        pytest.param(SETUP, SEEN, None, None, id="everything is there"),
    ],
)
def test_absent_values_have_their_reason(
    setup: Setup, sighting: Sighting, tool: str | None, deviation: str | None
) -> None:
    snapshot = _snapshot(setup, sighting)
    for value, reason in ((snapshot.tools["drill"], tool), (snapshot.deviations["drill"], deviation)):
        if reason is None:
            assert not isinstance(value, Absent)
        else:
            assert value == Absent(reason=AbsentReason(reason))


def test_without_tools_there_are_none() -> None:
    snapshot = _snapshot(replace(SETUP, tools={}), SEEN)
    assert snapshot.tools == {}
    assert snapshot.deviations == {}


def test_one_snapshot_is_made_of_one_pose() -> None:
    """Tool, covariance and deviation all follow from the sighting stored with them."""
    snapshot = _snapshot(SETUP, SEEN)
    tool, deviation = snapshot.tools["drill"], snapshot.deviations["drill"]
    assert isinstance(tool, ToolPose)
    assert snapshot.sightings["square"] is SEEN
    np.testing.assert_allclose(
        tool.camera_from_tool.matrix, (CAMERA_FROM_MARKER @ TOOL.marker_from_tool).matrix
    )
    np.testing.assert_allclose(
        tool.camera_from_tool.translation_mm, CAMERA_FROM_MARKER.move_points([0, -120, -10])
    )
    np.testing.assert_allclose(
        tool.tip_covariance_mm2,
        marker_point_covariance_mm2(CAMERA_FROM_MARKER, SEEN.pose_covariance, [0, -120, -10]),
    )
    assert isinstance(snapshot.vertebra, VertebraPose)
    assert deviation == deviation_from_channel(
        snapshot.vertebra.camera_from_vertebra.inverse @ tool.camera_from_tool, CHANNEL
    )
    assert (snapshot.image_number, snapshot.captured_at_s, snapshot.size_wh_px) == (41, 1.375, (640, 480))
    assert (snapshot.skipped_images, snapshot.stage_ms) == (3, {"edges": 2.0})
    assert snapshot.setup is SETUP
