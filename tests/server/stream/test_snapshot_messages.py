"""The navigation results of an image are sent completely: clearance, uncertainty, motion monitor."""

import dataclasses
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from server.live import Instant
from server.stream.assessment_messages import AssessmentMessage
from server.stream.judgement_messages import JudgementMessage, NearestWallMessage, NotEnteredMessage
from server.stream.messages import live_message
from server.stream.pose_messages import AbsentMessage, VertebraMessage
from server.stream.snapshot_messages import SnapshotMessage, snapshot_message
from tracker.navigation import (
    Absent,
    AbsentReason,
    Assessment,
    MotionDetection,
    MotionState,
    NavigationSnapshot,
    PlacedScrew,
    ScrewSize,
)
from tracker.navigation.clearance import NearestWall
from tracker.navigation.monitoring import NeverSeen, SceneState
from tracker.navigation.uncertainty import DrillAnalysis
from tracker.plan import Channel

SnapshotOf = Callable[..., NavigationSnapshot]


@pytest.fixture(scope="session")
def snapshot_of(snapshot_of: SnapshotOf) -> SnapshotOf:
    """Judged, which it is not elsewhere."""
    return partial(snapshot_of, judged=True)


def _sent(snapshot: NavigationSnapshot) -> SnapshotMessage:
    return snapshot_message(snapshot)


def _judgement(snapshot: NavigationSnapshot) -> JudgementMessage:
    judgement = _sent(snapshot).tools[0].judgement
    assert isinstance(judgement, JudgementMessage)
    return judgement


def test_the_judgement_is_sent_as_it_was_made(snapshot_of: SnapshotOf) -> None:
    snapshot = snapshot_of()
    judged = snapshot.analyses["drill"]
    assert isinstance(judged, DrillAnalysis)
    now = judged.clearance.now
    assert isinstance(now, NearestWall)
    sent = _judgement(snapshot)
    assert isinstance(sent.clearance.now, NearestWallMessage)
    assert sent.clearance.now.clearance_mm == now.clearance_mm
    assert sent.clearance.now.wall is now.wall
    assert sent.probability.lookahead_ratio == judged.lookahead.through_ratio
    assert sum(sent.probability.at_end_grade_ratio.values()) == pytest.approx(1.0)
    assert sent.certain.tolerance_mm == judged.certain.tolerance_mm
    np.testing.assert_array_equal(sent.spread.tip_ellipsoid_mm, judged.spread.tip_ellipsoid_mm)


@pytest.mark.parametrize(
    "theatre",
    [
        pytest.param({"tip_in_vertebra_mm": (0.0, 0.0, 12.0), "tilt_rad": 0.0}, id="on-the-axis"),
        pytest.param({"tilt_rad": 0.3}, id="through-the-wall"),
        pytest.param({"tilt_rad": 1.5707963}, id="across"),
        pytest.param({"tip_in_vertebra_mm": (0.0, 0.0, -8.0), "pose_variance": 2.0}, id="outside"),
    ],
)
def test_the_figures_and_their_verdict_are_sent_as_they_were_assessed(
    snapshot_of: SnapshotOf, theatre: dict[str, object]
) -> None:
    snapshot = snapshot_of(**theatre)
    assessed, sent = snapshot.assessments["drill"], _sent(snapshot).tools[0].assessment
    assert isinstance(assessed, Assessment)
    assert isinstance(sent, AssessmentMessage)
    assert (sent.verdict, sent.wall, sent.against) == (assessed.verdict, assessed.wall, assessed.against)
    for name, figure in assessed.figures.items():
        message = getattr(sent.figures, name.value)
        assert message.status is figure.status
        for key in ("value", "limit", "error_95"):
            number = getattr(figure, key)
            assert getattr(message, key) == (number if np.isfinite(number) else None)


def test_a_drill_outside_has_no_clearance(snapshot_of: SnapshotOf) -> None:
    judgement = _judgement(snapshot_of(tip_in_vertebra_mm=(0.0, 0.0, -8.0), tilt_rad=0.0))
    assert isinstance(judgement.clearance.now, NotEnteredMessage)


def test_without_numbers_the_judgement_has_their_reason(snapshot_of: SnapshotOf) -> None:
    sent = _sent(snapshot_of(seen=False))
    assert sent.tools[0].judgement == AbsentMessage(reason=AbsentReason.MARKER_UNSEEN)
    assert isinstance(sent.vertebra, VertebraMessage)


def test_the_vertebra_is_absent_with_its_reason(snapshot_of: SnapshotOf) -> None:
    sent = _sent(snapshot_of(registered=False))
    assert sent.vertebra == AbsentMessage(reason=AbsentReason.NOT_REGISTERED)
    assert sent.registered_by is None
    assert sent.anchored_to is None


def test_what_has_no_end_is_sent_as_nothing(
    snapshot_of: SnapshotOf, instant_of: Callable[..., Instant]
) -> None:
    across = snapshot_of(tilt_rad=1.5707963)
    message = live_message(instant_of(1, snapshot=across), now_s=1.0)
    text = message.model_dump_json()
    assert "Infinity" not in text
    assert "NaN" not in text
    assert _judgement(across).certain.entry_95_mm is None
    assert _sent(across).tools[0].deviation.model_dump()["entry_lateral_mm"] is None


@pytest.mark.parametrize(
    ("scene", "by"),
    [
        (SceneState.STILL, MotionDetection.FIXED_SCENE),
        (SceneState.MOVED, MotionDetection.FIXED_SCENE),
        (SceneState.UNSURE, MotionDetection.NONE),
        (SceneState.NO_TEXTURE, MotionDetection.NONE),
    ],
)
def test_by_what_a_move_is_seen_without_a_reference(
    snapshot_of: SnapshotOf, scene: SceneState, by: MotionDetection
) -> None:
    assert _sent(snapshot_of(motion=MotionState(scene=scene))).motion.motion_detected_by is by


def test_when_a_marker_was_seen_is_reported(snapshot_of: SnapshotOf) -> None:
    motion = MotionState(unseen_s={"drill": 1.5})
    assert _sent(snapshot_of(seen=False, motion=motion)).markers[0].unseen_s == 1.5
    never = MotionState(unseen_s={"drill": NeverSeen()})
    assert _sent(snapshot_of(seen=False, motion=never)).markers[0].unseen_s is None


def test_a_marker_on_the_patient_sees_moves_only_if_the_registration_is_fixed_to_it(
    snapshot_of: SnapshotOf,
) -> None:
    to_camera, none = snapshot_of(), snapshot_of(registered=False)
    for snapshot, by in ((to_camera, MotionDetection.NONE), (none, MotionDetection.REFERENCE)):
        setup = dataclasses.replace(snapshot.setup, reference="patient")
        sent = _sent(dataclasses.replace(snapshot, setup=setup))
        assert sent.reference == "patient"
        assert sent.motion.motion_detected_by is by


def test_the_channel_is_sent_with_the_screw_and_the_ct_on_which_it_was_planned(
    snapshot_of: SnapshotOf,
) -> None:
    snapshot = snapshot_of()
    channel = snapshot.setup.channel
    assert isinstance(channel, Channel)
    bare = _sent(snapshot).channel
    assert bare is not None
    assert (bare.screw, bare.ct_id) == (None, None)
    placed = PlacedScrew(
        name="L3 left",
        head_in_vertebra_mm=np.array([15.0, 14.0, 2.0]),
        tip_in_vertebra_mm=np.array([8.0, -26.0, 3.0]),
        radius_mm=2.75,
    )
    setup = dataclasses.replace(
        snapshot.setup,
        screw=ScrewSize(radius_mm=3.25, length_mm=45.0),
        ct_id="ct-of-case",
        placed_screws=(placed,),
    )
    sent = _sent(dataclasses.replace(snapshot, setup=setup)).channel
    assert sent is not None
    assert sent.model_dump() == {
        "entry_in_vertebra_mm": channel.entry_in_vertebra_mm.tolist(),
        "target_in_vertebra_mm": channel.target_in_vertebra_mm.tolist(),
        "radius_mm": channel.radius_mm,
        "screw": {"diameter_mm": 6.5, "length_mm": 45.0},
        "ct_id": "ct-of-case",
        "placed_screws": [
            {
                "name": "L3 left",
                "head_in_vertebra_mm": [15.0, 14.0, 2.0],
                "tip_in_vertebra_mm": [8.0, -26.0, 3.0],
                "diameter_mm": 5.5,
            }
        ],
    }
    unplanned = dataclasses.replace(snapshot.setup, channel=Absent(reason=AbsentReason.NO_PLAN))
    assert _sent(dataclasses.replace(snapshot, setup=unplanned)).channel is None
