"""Messages of a running server against the ground truth of their images."""

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from websockets.sync.client import connect

from server.stream.judgement_messages import DeviationMessage
from server.stream.messages import LiveMessage
from server.stream.pose_messages import AbsentMessage, MarkerSeenMessage, MarkerUnseenMessage, ToolMessage
from server.stream.snapshot_messages import SnapshotMessage
from tests.benchmarks.claims import Claim, Judgement, judge
from tests.benchmarks.running_server import PATIENCE_S, RunningServer
from tests.benchmarks.tables import Table, number, pair
from tests.benchmarks.timing import STAGES as TRACKER_STAGES
from tracker.geometry import Rigid
from tracker.navigation import AbsentReason
from tracker.rehearsal import Theatre

# The first images after the start include loading and settling.
SETTLING_S = 2.0
STAGES = ("waiting", *TRACKER_STAGES, "navigation", "overlay", "encode")


@dataclass(frozen=True, slots=True, kw_only=True)
class ReceivedMessage:
    """One message and its time of arrival.

    Attributes:
        snapshot: what it says.
        sequence: of the message; a gap is what this reader skipped.
        image_age_ms: its age at the sending, as the message states it.
        latency_ms: from the grab of the image to the message in this reader's hands.
    """

    snapshot: SnapshotMessage
    sequence: int
    image_age_ms: float
    latency_ms: float


def listen(server: RunningServer, *, seconds: float) -> list[ReceivedMessage]:
    """Return the `/ws/live` messages with an image, for this long after settling."""
    received: list[ReceivedMessage] = []
    for one in _messages(server):
        received.append(one)
        if one.snapshot.captured_at_s - received[0].snapshot.captured_at_s > SETTLING_S + seconds:
            break
    start_s = received[0].snapshot.captured_at_s + SETTLING_S
    return [one for one in received if one.snapshot.captured_at_s >= start_s]


def _messages(server: RunningServer) -> Iterator[ReceivedMessage]:
    with connect(server.socket_address("/ws/live"), proxy=None, compression=None) as socket:
        while True:
            text = socket.recv(timeout=PATIENCE_S)
            came_s = time.monotonic()
            message = LiveMessage.model_validate_json(text)
            if message.snapshot is not None and message.image_age_ms is not None:
                yield ReceivedMessage(
                    snapshot=message.snapshot,
                    sequence=message.sequence,
                    image_age_ms=message.image_age_ms,
                    latency_ms=(came_s - message.snapshot.captured_at_s) * 1e3,
                )


def judge_messages(
    theatre: Theatre, received: Sequence[ReceivedMessage], *, live_rate_hz: float
) -> list[Judgement]:
    """Evaluate each message against the ground truth of its image."""
    return [
        judge(theatre, one.snapshot.image_number / live_rate_hz, claim_of_message(one.snapshot))
        for one in received
    ]


def claim_of_message(snapshot: SnapshotMessage) -> Claim | str:
    """Return the drill pose of a message, or the reason why there is none."""
    sighting = next(marker.sighting for marker in snapshot.markers if marker.name == "drill")
    tool = next(tool for tool in snapshot.tools if tool.name == "drill")
    if isinstance(sighting, MarkerUnseenMessage):
        return sighting.reason.value
    if isinstance(tool.pose, AbsentMessage) and tool.pose.reason is AbsentReason.POSE_UNCERTAIN:
        return tool.pose.reason.value
    if not (
        isinstance(sighting, MarkerSeenMessage)
        and sighting.camera_from_marker is not None
        and isinstance(tool.pose, ToolMessage)
        and isinstance(tool.deviation, DeviationMessage)
    ):
        raise RuntimeError("a message has a seen marker without its tool, in a theatre where all is known")
    pose, deviation = sighting.camera_from_marker, tool.deviation
    return Claim(
        camera_from_marker=Rigid(
            rotation=np.array(pose.rotation), translation_mm=np.array(pose.translation_mm)
        ),
        corners_px=np.array(sighting.corners_px),
        found_by=sighting.found_by,
        tip_in_camera_mm=np.array(tool.pose.camera_from_tool.translation_mm),
        entry_offset_mm=math.inf if deviation.entry_offset_mm is None else deviation.entry_offset_mm,
        angle_deg=deviation.angle_deg,
        depth_mm=deviation.depth_mm,
    )


def pace_table(title: str, received: Sequence[ReceivedMessage]) -> Table:
    """Table of message age and skipped images."""
    first, last = received[0].snapshot, received[-1].snapshot
    spent_s = last.captured_at_s - first.captured_at_s
    return Table(
        title=title,
        columns=[
            "messages",
            "messages a second",
            "age when sent ms",
            "age when received ms",
            "images that no message carries",
            "of these skipped by this reader",
        ],
        rows=[
            [
                str(len(received)),
                number((len(received) - 1) / spent_s, 1),
                pair([one.image_age_ms for one in received], 99.0, 1),
                pair([one.latency_ms for one in received], 99.0, 1),
                str(last.image_number - first.image_number + 1 - len(received)),
                str(received[-1].sequence - received[0].sequence + 1 - len(received)),
            ]
        ],
    )


def stage_table(title: str, received: Sequence[ReceivedMessage]) -> Table:
    """Table of the stage times in the messages."""
    present = {name for one in received for name in one.snapshot.stage_ms}
    names = [*(name for name in STAGES if name in present), *sorted(present - set(STAGES))]
    return Table(
        title=title,
        columns=["stage", "ms"],
        rows=[
            [
                name,
                pair(
                    [one.snapshot.stage_ms[name] for one in received if name in one.snapshot.stage_ms], 99.0
                ),
            ]
            for name in names
        ],
    )
