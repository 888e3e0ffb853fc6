"""Poses of an external tracker from messages: which belong together, and which are no measurement."""

from collections.abc import Mapping, Sequence

import numpy as np
import pytest

from server import openigtlink_wire as wire
from server.capture.pose_frames import PoseFrame, PoseFrames
from server.config import LimitsConfig
from server.openigtlink.feed import Feed
from server.openigtlink_wire import Message, Status, WireError
from tests.server.conftest import make_snapshot
from tests.server.openigtlink.spoken import contents
from tracker.geometry import Array
from tracker.navigation import ToolPose

DRILL, PATIENT = "DrillToTracker", "PatientToTracker"
T_S = 1_764_000_000.0


def at(x_mm: float) -> Array:
    """A quarter turn about z, this far along x."""
    return np.array([[0.0, -1, 0, x_mm], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])


def transform(
    name: str, matrix: Array, stamp_s: float = T_S, metadata: Mapping[str, str] | None = None
) -> Message:
    content = wire.transform_content(matrix)
    return Message(
        type="TRANSFORM", device=name, timestamp_s=stamp_s, content=content, metadata=metadata or {}
    )


def tracking_data(
    tools: Mapping[str, Array], stamp_s: float = T_S, kind: int = 2, metadata: Mapping[str, str] | None = None
) -> Message:
    content = b"".join(
        wire.TRACKED_TOOL.pack(name.encode(), kind, *matrix[:3].T.ravel()) for name, matrix in tools.items()
    )
    return Message(type="TDATA", device="Plus", timestamp_s=stamp_s, content=content, metadata=metadata or {})


def status(name: str, stamp_s: float = T_S, code: int = 16) -> Message:
    content = wire.status_content(Status(code=code, name="GONE", text="out of view"))
    return Message(type="STATUS", device=name, timestamp_s=stamp_s, content=content)


def taken(messages: Sequence[Message]) -> list[PoseFrame]:
    frames = PoseFrames([DRILL, PATIENT])
    return [frame for frame in map(frames.take, messages) if frame is not None]


def places(frames: Sequence[PoseFrame]) -> list[dict[str, float]]:
    """The x of each body in each frame."""
    return [{name: round(float(p.translation_mm[0]), 3) for name, p in one.poses.items()} for one in frames]


@pytest.mark.parametrize(
    ("messages", "expected"),
    [
        ([transform(DRILL, at(5)), transform(PATIENT, at(7))], [{DRILL: 5, PATIENT: 7}]),
        ([tracking_data({DRILL: at(5), PATIENT: at(7), "Pen": at(9)})], [{DRILL: 5, PATIENT: 7}]),
        # Of two moments: never in one frame.
        ([transform(DRILL, at(5)), transform(PATIENT, at(7), T_S + 0.02)], [{DRILL: 5}]),
        # What is missing is known at the next moment, and a complete one replaces it.
        ([tracking_data({DRILL: at(5)}), tracking_data({DRILL: at(6)}, T_S + 1)], [{DRILL: 5}]),
        (
            [transform(DRILL, at(5)), tracking_data({DRILL: at(6), PATIENT: at(7)}, T_S + 1)],
            [{DRILL: 6, PATIENT: 7}],
        ),
        # The same moment again, and an older one.
        (
            [tracking_data({DRILL: at(x), PATIENT: at(7)}, T_S - s) for x, s in ((5, 0), (6, 0), (4, 1))],
            [{DRILL: 5, PATIENT: 7}],
        ),
        # As Plus and Coaxial state that a pose is not valid.
        (
            [transform(DRILL, at(5), metadata={"TransformStatus": "OUT_OF_VIEW"}), transform(PATIENT, at(7))],
            [{PATIENT: 7}],
        ),
        (
            [
                tracking_data(
                    {DRILL: at(5), PATIENT: at(7)},
                    metadata={f"{DRILL}Status": "MISSING", f"{PATIENT}Status": "OK"},
                )
            ],
            [{PATIENT: 7}],
        ),
        ([transform(DRILL, np.eye(4)), transform(PATIENT, at(7))], [{PATIENT: 7}]),
        ([status(DRILL), transform(PATIENT, at(7))], [{PATIENT: 7}]),
        # A 3D tool has no rotation; a status that is OK, or of nothing that is tracked, states no pose.
        ([tracking_data({DRILL: at(5)}, kind=3), tracking_data({PATIENT: at(7)})], []),
        ([status("Plus"), status(DRILL, code=1), transform("Pen", at(1), 0.0)], []),
    ],
    ids=[
        "two transforms", "tracking data", "two moments", "a body missing", "a complete moment follows",
        "repeated and older", "status of a transform", "status in tracking data", "identity",
        "status message", "a 3D tool", "nothing tracked",
    ],
)  # fmt: skip
def test_a_frame_has_the_valid_poses_of_one_moment(
    messages: Sequence[Message], expected: list[dict[str, float]]
) -> None:
    assert places(taken(messages)) == expected


def test_a_pose_that_repeats_bit_by_bit_is_no_measurement_although_its_time_goes_on() -> None:
    frames = taken([tracking_data({DRILL: at(5), PATIENT: at(n)}, T_S + 0.1 * n) for n in range(5)])
    assert [DRILL in one.poses for one in frames] == [True, True, True, False, False]
    assert all(PATIENT in one.poses for one in frames)


@pytest.mark.parametrize(
    ("message", "reason"),
    [
        (transform(DRILL, at(5) @ np.diag([1, 1, -1, 1])), "not a rigid motion"),
        (transform(DRILL, at(5) @ np.diag([2, 2, 2, 1])), "not a rigid motion"),
        (transform(DRILL, np.full((4, 4), np.nan)), "not a rigid motion"),
        (transform(DRILL, at(1e6)), "1e+06 mm away"),
        (transform(DRILL, at(5), 0.0), "no time stamp"),
        (tracking_data({DRILL: at(5), DRILL + "\0": at(6)}), "twice"),
        (Message(type="TDATA", device="", timestamp_s=T_S, content=bytes(71)), "71 bytes"),
        (Message(type="TRANSFORM", device=DRILL, timestamp_s=T_S, content=bytes(47)), "47 bytes"),
        (Message(type="STATUS", device=DRILL, timestamp_s=T_S, content=b"\0"), "1 bytes"),
    ],
    ids=["mirrored", "scaled", "nan", "far", "no time", "twice", "TDATA cut", "TRANSFORM cut", "STATUS cut"],
)
def test_what_is_no_pose_is_rejected_with_its_reason(message: Message, reason: str) -> None:
    with pytest.raises(WireError, match=reason.replace("+", r"\+")):
        PoseFrames([DRILL]).take(message)


def test_what_this_program_sends_is_received_as_the_same_pose_or_as_its_absence() -> None:
    snapshot = make_snapshot(captured_at_s=100.0)
    tool = snapshot.tools["drill"]
    assert isinstance(tool, ToolPose)
    feed, frames = Feed(LimitsConfig()), PoseFrames(["drillToCamera"])
    sent = feed.messages(contents(snapshot), now_s=100.0, unix_offset_s=T_S)
    later = feed.expired(now_s=101.0, unix_offset_s=T_S)
    live, old = (one for one in map(frames.take, [*sent, *later]) if one is not None)
    pose = live.poses["drillToCamera"]
    np.testing.assert_allclose(pose.matrix, tool.camera_from_tool.matrix, atol=2e-5)
    assert (live.stamp_s, old.poses) == (T_S + 100.0, {})
