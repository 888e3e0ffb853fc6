"""Message of one image and its navigation results."""

from typing import Annotated

from pydantic import Field

from server.stream.along_messages import BullseyeMessage, bullseye_message
from server.stream.assessment_messages import AssessmentMessage, assessment_message
from server.stream.judgement_messages import (
    DeviationMessage,
    JudgementMessage,
    deviation_message,
    judgement_message,
)
from server.stream.message import Message
from server.stream.pose_messages import (
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
    MotionDetection,
    MotionState,
    NavigationSnapshot,
    ScrewSize,
    Setup,
    motion_detected_by,
)
from tracker.navigation.monitoring import NeverSeen, SceneState
from tracker.registration import AnchoredTo, Method


class ToolStateMessage(Message):
    """One tool by name: pose, deviation from the channel, conclusion, and displayed figures."""

    name: str
    marker: str
    pose: Annotated[ToolMessage | AbsentMessage, Field(discriminator="kind")]
    deviation: Annotated[DeviationMessage | AbsentMessage, Field(discriminator="kind")]
    judgement: Annotated[JudgementMessage | AbsentMessage, Field(discriminator="kind")]
    assessment: Annotated[AssessmentMessage | AbsentMessage, Field(discriminator="kind")]
    along: BullseyeMessage | None
    """View of the drill along the channel; null without a deviation."""


class ScrewMessage(Message):
    """A screw planned on the axis of the channel, starting at its entry."""

    diameter_mm: float
    length_mm: float


class PlacedScrewMessage(Message):
    """A screw that was placed in this vertebra."""

    name: str
    """Of its channel."""
    head_in_vertebra_mm: list[float]
    """Where its axis meets the entry plane."""
    tip_in_vertebra_mm: list[float]
    diameter_mm: float


class ChannelMessage(Message):
    """The planned channel with which the drill is compared, in the vertebra frame (LPS of its CT, in mm)."""

    entry_in_vertebra_mm: list[float]
    target_in_vertebra_mm: list[float]
    """The planned end of the drilling."""
    radius_mm: float
    screw: ScrewMessage | None
    """Null where none is planned."""
    ct_id: str | None
    """Of the CT on which it was planned, as `GET /api/navigation/ct` states it; null without one."""
    placed_screws: list[PlacedScrewMessage]
    """Screws already placed in the same vertebra, in the same frame."""


class MotionMonitorMessage(Message):
    """State of the motion monitor: whether patient, camera or reference moved."""

    motion_detected_by: MotionDetection
    """What detects a move of patient or camera."""
    camera_moved: bool
    """Since the registration; a new registration resets it."""
    reference_moved: bool
    """Since the registration; a check on anatomy resets it."""
    scene: SceneState
    """State of the static background around the field of work, and the camera motion seen in it."""


class SnapshotMessage(Message):
    """One image and its navigation results."""

    image_number: int
    captured_at_s: float
    """Monotonic clock of the server."""
    width_px: int
    height_px: int
    camera_calibrated: bool
    registered_by: Method | None
    """Registration method; null without a registration."""
    anchored_to: AnchoredTo | None
    """What the registration is fixed to; null without one."""
    reference: str | None
    """The reference marker on the patient; null without one."""
    channel_name: str | None
    channel: ChannelMessage | None
    """Null without a plan."""
    withheld: AbsentReason | None
    """Why no number is given although all is known, as NOT_CONFIRMED after a restart; null otherwise."""
    vertebra: Annotated[VertebraMessage | AbsentMessage, Field(discriminator="kind")]
    motion: MotionMonitorMessage
    markers: list[MarkerMessage]
    tools: list[ToolStateMessage]
    displayed_tool: str | None
    """The tool whose figures are displayed: the one with the most severe verdict; null without any."""
    stage_ms: dict[str, float]
    """Time of each stage of the tracking process."""
    skipped_images: int


def snapshot_message(snapshot: NavigationSnapshot) -> SnapshotMessage:
    """Return the message of a snapshot."""
    setup, registration = snapshot.setup, snapshot.setup.registration
    return SnapshotMessage(
        image_number=snapshot.image_number,
        captured_at_s=snapshot.captured_at_s,
        width_px=snapshot.size_wh_px[0],
        height_px=snapshot.size_wh_px[1],
        camera_calibrated=setup.camera_calibrated,
        registered_by=None if isinstance(registration, Absent) else registration.method,
        anchored_to=None if isinstance(registration, Absent) else registration.anchored_to,
        reference=setup.reference or None,
        channel_name=None if isinstance(setup.channel, Absent) else setup.channel.name,
        channel=channel_message(setup),
        withheld=setup.withheld,
        vertebra=vertebra_message(snapshot.vertebra),
        motion=_watched(snapshot),
        markers=[
            marker_message(
                name,
                sighting,
                unseen_s=_unseen_s(snapshot.motion, name),
                calibrated=setup.camera_calibrated,
            )
            for name, sighting in snapshot.sightings.items()
        ],
        tools=[_tool_state(snapshot, name) for name in snapshot.tools],
        displayed_tool=snapshot.displayed_tool or None,
        stage_ms=dict(snapshot.stage_ms),
        skipped_images=snapshot.skipped_images,
    )


def channel_message(setup: Setup) -> ChannelMessage | None:
    """Return the message of the planned channel; None without a plan."""
    channel, screw = setup.channel, setup.screw
    if isinstance(channel, Absent):
        return None
    return ChannelMessage(
        entry_in_vertebra_mm=channel.entry_in_vertebra_mm.tolist(),
        target_in_vertebra_mm=channel.target_in_vertebra_mm.tolist(),
        radius_mm=channel.radius_mm,
        screw=screw_message(screw),
        ct_id=setup.ct_id or None,
        placed_screws=[
            PlacedScrewMessage(
                name=one.name,
                head_in_vertebra_mm=one.head_in_vertebra_mm.tolist(),
                tip_in_vertebra_mm=one.tip_in_vertebra_mm.tolist(),
                diameter_mm=2.0 * one.radius_mm,
            )
            for one in setup.placed_screws
        ],
    )


def screw_message(screw: ScrewSize | None) -> ScrewMessage | None:
    """Return the message of a screw's size; None without one."""
    if screw is None:
        return None
    return ScrewMessage(diameter_mm=2.0 * screw.radius_mm, length_mm=screw.length_mm)


def _tool_state(snapshot: NavigationSnapshot, name: str) -> ToolStateMessage:
    return ToolStateMessage(
        name=name,
        marker=snapshot.setup.tools[name].marker,
        pose=tool_message(snapshot.tools[name]),
        deviation=deviation_message(snapshot.deviations[name]),
        judgement=judgement_message(snapshot.analyses[name]),
        assessment=assessment_message(snapshot.assessments[name]),
        along=bullseye_message(snapshot, name),
    )


def _watched(snapshot: NavigationSnapshot) -> MotionMonitorMessage:
    motion = snapshot.motion
    return MotionMonitorMessage(
        motion_detected_by=motion_detected_by(snapshot),
        camera_moved=motion.camera_moved,
        reference_moved=motion.reference_moved,
        scene=motion.scene,
    )


def _unseen_s(motion: MotionState, marker: str) -> float | None:
    age_s = motion.unseen_s.get(marker)
    return None if age_s is None or isinstance(age_s, NeverSeen) else age_s
