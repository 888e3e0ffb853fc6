"""Navigation by the poses of an external tracker, against formulas of plain matrices."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from server.capture.openigtlink import blank_picture
from server.capture.shot import Shot
from server.config import Config
from server.loop.tracking import Tracking
from server.overlay import draw_overlay
from server.procedure.registration.landmark_capture import tip_of
from server.setup import CaseSetup, build_setup
from server.stream.snapshot_messages import snapshot_message
from tracker.geometry import Array, Rigid
from tracker.navigation import Absent, Deviation, NavigationSnapshot, ToolPose
from tracker.plan import Channel
from tracker.pose import Seen
from tracker.registration import AnchoredTo, Method, Registration
from tracker.registration.capture import TipSample

DRILL, PATIENT = "DrillToTracker", "PatientToTracker"
LEVER_MM = 150.0
CONFIG = Config.model_validate(
    {
        "camera": {"source": "openigtlink"},
        "external_tracker": {
            "transforms": [DRILL, PATIENT], "sd_mm": 0.25, "sd_deg": 0.2, "latency_ms": 40.0
        },
        "reference": {"marker": PATIENT},
        "tools": {
            "drill": {
                "marker": DRILL,
                "tip_in_marker_mm": [0.0, -LEVER_MM, 0.0],
                "axis_in_marker": [0.0, -1.0, 0.0],
                "radius_mm": 1.5,
                "length_mm": 120.0,
            }
        },
    }
)  # fmt: skip


def matrix(turn_deg: tuple[float, float, float], place_mm: tuple[float, float, float]) -> Array:
    made = np.eye(4)
    made[:3, :3] = Rotation.from_rotvec(turn_deg, degrees=True).as_matrix()
    made[:3, 3] = place_mm
    return made


# Where patient and plan lie for the tracker, which is 1.2 m away.
TRACKER_FROM_PATIENT = matrix((20.0, -40.0, 110.0), (-150.0, 90.0, -1200.0))
PATIENT_FROM_CT = matrix((-70.0, 15.0, 5.0), (30.0, -60.0, 20.0))
CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=np.array([10.0, 20.0, 30.0]),
    target_in_vertebra_mm=np.array([10.0, -20.0, 30.0]),
    radius_mm=3.0,
)


def drill_in_ct(*, depth_mm: float, beside_mm: float) -> Array:
    """Body of a drill on a line parallel to the channel: both run along -y, of the body and of the CT."""
    pose = np.eye(4)
    pose[:3, 3] = [10.0 + beside_mm, 20.0 - depth_mm + LEVER_MM, 30.0]
    return pose


class Navigation:
    """Tracking in a case that is planned and registered."""

    def __init__(self) -> None:
        self.tracking = Tracking(build_setup(CONFIG))
        registration = Registration(
            method=Method.POINTS,
            anchored_to=AnchoredTo.REFERENCE,
            anchor_from_vertebra=Rigid.from_matrix(PATIENT_FROM_CT),
            covariance=np.eye(6) * 1e-6,
        )
        self.tracking.adopt(
            CaseSetup(channel=CHANNEL, registration=registration, registered_from_s=0.0, confirmed_from_s=0.0)
        )
        self.number = 0

    def take(self, poses: Mapping[str, Array]) -> NavigationSnapshot:
        self.number += 1
        at_s = 10.0 + self.number / 50.0
        shot = Shot(
            image=blank_picture(),
            number=self.number,
            captured_at_s=at_s,
            source_time_s=at_s,
            poses={name: Rigid.from_matrix(one) for name, one in poses.items()},
        )
        return self.tracking.process(shot, skipped_images=0)


def poses(*, depth_mm: float, beside_mm: float, moved: Array | None = None) -> dict[str, Array]:
    """What the tracker reports; `moved` moves the tracker."""
    tracker = (np.eye(4) if moved is None else moved) @ TRACKER_FROM_PATIENT
    drill = tracker @ PATIENT_FROM_CT @ drill_in_ct(depth_mm=depth_mm, beside_mm=beside_mm)
    return {DRILL: drill, PATIENT: tracker}


@pytest.mark.parametrize("moved", [None, matrix((0.0, 35.0, 0.0), (400.0, 0.0, 50.0))])
def test_depth_and_offset_in_the_plan_are_those_of_the_drill_wherever_the_tracker_stands(
    moved: Array | None,
) -> None:
    snapshot = Navigation().take(poses(depth_mm=12.0, beside_mm=2.0, moved=moved))
    deviation = snapshot.deviations["drill"]
    assert isinstance(deviation, Deviation)
    found = (deviation.depth_mm, deviation.tip_offset_mm, deviation.angle_deg)
    assert found == pytest.approx((12.0, 2.0, 0.0), abs=1e-4)
    placed = snapshot.vertebra_from_tool("drill")
    assert not isinstance(placed, Absent)
    np.testing.assert_allclose(placed.translation_mm, [10.0 + 2.0, 20.0 - 12.0, 30.0], atol=1e-9)


def test_the_stated_error_of_the_tracker_is_that_of_the_tip_at_the_end_of_its_lever() -> None:
    tool = Navigation().take(poses(depth_mm=12.0, beside_mm=2.0)).tools["drill"]
    assert isinstance(tool, ToolPose)
    # Along the lever the body's own error, across it also the rotation at 150 mm.
    expected = 0.25**2 * 3 + 2.0 * (np.radians(0.2) * LEVER_MM) ** 2
    assert float(np.trace(tool.tip_covariance_mm2)) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("missing", "reason"), [(DRILL, "MARKER_UNSEEN"), (PATIENT, "REFERENCE_UNSEEN")], ids=["drill", "patient"]
)
def test_a_body_without_a_valid_pose_takes_the_figures_away(missing: str, reason: str) -> None:
    navigation = Navigation()
    reported = poses(depth_mm=12.0, beside_mm=2.0)
    navigation.take(reported)
    snapshot = navigation.take({name: one for name, one in reported.items() if name != missing})
    deviation = snapshot.deviations["drill"]
    assert isinstance(deviation, Absent)
    assert deviation.reason == reason
    assert not isinstance(snapshot.sightings[missing], Seen)


def test_a_patient_that_moves_for_the_tracker_stops_navigation_until_a_check() -> None:
    navigation = Navigation()
    for _ in range(20):
        snapshot = navigation.take(poses(depth_mm=12.0, beside_mm=2.0))
    assert isinstance(snapshot.deviations["drill"], Deviation)
    bumped = matrix((0.0, 0.0, 0.0), (0.0, 15.0, 0.0))
    for _ in range(20):
        snapshot = navigation.take(poses(depth_mm=12.0, beside_mm=2.0, moved=bumped))
    deviation = snapshot.deviations["drill"]
    assert isinstance(deviation, Absent)
    assert deviation.reason == "REFERENCE_MOVED"


def test_a_landmark_is_captured_in_the_frame_of_the_body_on_the_patient() -> None:
    moved = matrix((0.0, 35.0, 0.0), (400.0, 0.0, 50.0))
    for one in (None, moved):
        tip = tip_of(Navigation().take(poses(depth_mm=12.0, beside_mm=2.0, moved=one)), "drill", PATIENT)
        assert isinstance(tip, TipSample)
        expected = PATIENT_FROM_CT @ [12.0, 8.0, 30.0, 1.0]
        np.testing.assert_allclose(tip.tip_in_anchor_mm, expected[:3], atol=1e-9)


def test_a_tool_of_a_printed_marker_is_not_used() -> None:
    tool = replace(build_setup(CONFIG).tools["drill"], marker="printed")
    case = CaseSetup(tools={"printed": tool, "own": replace(tool, marker=DRILL)})
    assert set(build_setup(CONFIG).with_case(case).tools) == {"drill", "own"}


def test_the_picture_states_that_there_is_no_camera_and_the_message_has_no_scores() -> None:
    snapshot = Navigation().take(poses(depth_mm=12.0, beside_mm=2.0))
    picture = blank_picture()
    middle = draw_overlay(picture, snapshot)[170:270, 300:660]
    assert (middle > 200).mean() > 0.01
    sightings = [one.sighting for one in snapshot_message(snapshot).markers]
    assert [(one.kind, getattr(one, "score_ratio", 0.0)) for one in sightings] == [("seen", None)] * 2
