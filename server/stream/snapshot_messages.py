"""One image and all that was concluded from it, as it goes over the wire."""

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field

from server.stream.along_messages import AlongMessage, along_message
from server.stream.assessment_messages import AssessmentMessage, assessment_message
from server.stream.judgement_messages import (
    DeviationMessage,
    JudgementMessage,
    deviation_message,
    judgement_message,
)
from server.stream.message import Message
from server.stream.place_messages import (
    AbsentMessage,
    MarkerMessage,
    ToolMessage,
    VertebraMessage,
    marker_message,
    tool_message,
    vertebra_message,
)
from tracker.navigation import (
    Absent,
    AbsentReason,
    MovesSeen,
    NavigationSnapshot,
    Watched,
    moves_seen_by,
)
from tracker.navigation.watch import NeverSeen, SceneState
from tracker.registration import AnchoredTo, Method


class ToolStateMessage(Message):
    """One tool by name: where it is, how far from the channel, what that means, and the figures as shown."""

    name: str
    marker: str
    pose: Annotated[ToolMessage | AbsentMessage, Field(discriminator="kind")]
    deviation: Annotated[DeviationMessage | AbsentMessage, Field(discriminator="kind")]
    judgement: Annotated[JudgementMessage | AbsentMessage, Field(discriminator="kind")]
    assessment: Annotated[AssessmentMessage | AbsentMessage, Field(discriminator="kind")]
    along: AlongMessage | None
    """The drill in the view along the channel; null where there is no deviation."""


class WatchMessage(Message):
    """What holds plan and patient together, and whether something moved."""

    moves_seen_by: MovesSeen
    """By what a move of patient or camera is noticed."""
    camera_moved: bool
    """Since the registration; another one takes it back."""
    reference_moved: bool
    """Since the registration; a check on anatomy takes it back."""
    scene: SceneState
    """What stands still around the field of work, and what it says of the camera."""


class SnapshotMessage(Message):
    """One image and all that was concluded from it."""

    image_number: int
    captured_at_s: float
    """Monotonic clock of the server."""
    age_ms: float
    """From the grab to the moment this message was made."""
    width_px: int
    height_px: int
    camera_calibrated: bool
    registered_by: Method | None
    """How plan and patient were registered; null when they are not."""
    anchored_to: AnchoredTo | None
    """What that is fixed to; null when they are not registered."""
    reference: str | None
    """The marker on the patient; null where there is none."""
    channel_name: str | None
    withheld: AbsentReason | None
    """Why no number is given although all is known, as NOT_CONFIRMED after a start; null otherwise."""
    vertebra: Annotated[VertebraMessage | AbsentMessage, Field(discriminator="kind")]
    watched: WatchMessage
    markers: list[MarkerMessage]
    tools: list[ToolStateMessage]
    shown_tool: str | None
    """Whose figures are shown: of those that have any, the most severe verdict; null where none has."""
    stage_ms: dict[str, float]
    """Time of each stage, of the tracking process and of the server."""
    skipped_images: int


def snapshot_message(
    snapshot: NavigationSnapshot, server_ms: Mapping[str, float], *, now_s: float
) -> SnapshotMessage:
    """The message of a snapshot, as sent at monotonic time `now_s`."""
    setup, registration = snapshot.setup, snapshot.setup.registration
    return SnapshotMessage(
        image_number=snapshot.image_number,
        captured_at_s=snapshot.captured_at_s,
        age_ms=(now_s - snapshot.captured_at_s) * 1000.0,
        width_px=snapshot.size_wh_px[0],
        height_px=snapshot.size_wh_px[1],
        camera_calibrated=setup.camera_calibrated,
        registered_by=None if isinstance(registration, Absent) else registration.method,
        anchored_to=None if isinstance(registration, Absent) else registration.anchored_to,
        reference=setup.reference or None,
        channel_name=None if isinstance(setup.channel, Absent) else setup.channel.name,
        withheld=setup.withheld,
        vertebra=vertebra_message(snapshot.vertebra),
        watched=_watched(snapshot),
        markers=[
            marker_message(
                name,
                sighting,
                unseen_s=_unseen_s(snapshot.watched, name),
                calibrated=setup.camera_calibrated,
            )
            for name, sighting in snapshot.sightings.items()
        ],
        tools=[_tool_state(snapshot, name) for name in snapshot.tools],
        shown_tool=snapshot.shown_tool or None,
        stage_ms={**snapshot.stage_ms, **server_ms},
        skipped_images=snapshot.skipped_images,
    )


def _tool_state(snapshot: NavigationSnapshot, name: str) -> ToolStateMessage:
    return ToolStateMessage(
        name=name,
        marker=snapshot.setup.tools[name].marker,
        pose=tool_message(snapshot.tools[name]),
        deviation=deviation_message(snapshot.deviations[name]),
        judgement=judgement_message(snapshot.judgements[name]),
        assessment=assessment_message(snapshot.assessments[name]),
        along=along_message(snapshot, name),
    )


def _watched(snapshot: NavigationSnapshot) -> WatchMessage:
    watched = snapshot.watched
    return WatchMessage(
        moves_seen_by=moves_seen_by(snapshot),
        camera_moved=watched.camera_moved,
        reference_moved=watched.reference_moved,
        scene=watched.scene,
    )


def _unseen_s(watched: Watched, marker: str) -> float | None:
    age_s = watched.unseen_s.get(marker)
    return None if age_s is None or isinstance(age_s, NeverSeen) else age_s
