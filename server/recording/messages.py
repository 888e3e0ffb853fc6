"""Messages of a recording, in addition to those of `server.stream`."""

import platform
from collections.abc import Mapping
from importlib import metadata

from pydantic import Field

from server.alarms.evaluation import AlarmCall, AlarmStep
from server.capture.address import source_from_text
from server.config import Config
from server.number_format import finite
from server.recording_file.topics import FORMAT_VERSION
from server.stream.message import Message
from server.stream.pose_messages import PoseMessage, pose_message
from tracker.camera import CameraControl
from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import (
    Alarm,
    AlarmSnapshot,
    AlarmState,
    Change,
    Condition,
    Presence,
    Sound,
)
from tracker.pose import Seen

# Libraries on which the last digits of a pose depend.
LIBRARIES = ("numpy", "opencv-python-headless", "numba", "scipy")


class SessionMessage(Message):
    """Source of a recording, with the program and machine that recorded it."""

    format_version: int
    product_version: str
    libraries: dict[str, str]
    """Versions of the libraries that compute poses."""
    python: str
    machine: str
    """System and processor architecture."""
    started_at: str
    """UTC, ISO 8601."""
    unix_offset_s: float
    """Unix time minus monotonic time."""
    case_id: str
    source: str
    settings: dict[str, object]


class TrackedMessage(Message):
    """Input of tracking for one image, other than its pixels."""

    image_number: int
    captured_at_s: float
    skipped_images: int
    controls: dict[str, int] | None
    """Controls of the camera; null for other sources."""
    device: str = ""
    """Identity of the camera; empty if unknown."""
    is_predicted: bool
    """Whether the image was decoded from video with predicted images, such as H.264."""


class MarkerPoseMessage(Message):
    """Pose of a marker in the camera's frame."""

    marker: str
    camera_from_marker: PoseMessage
    covariance: list[list[float]]
    """6 rows of 6: translation [mm], then a left-multiplied rotation vector in the camera's frame [rad]."""


class PosesMessage(Message):
    """Poses of the markers that were seen in one image; empty without a calibrated camera."""

    image_number: int
    poses: list[MarkerPoseMessage]


class CircumstancesMessage(Message):
    """Inputs of the alarms other than images and time."""

    camera_works: bool
    tracker_works: bool
    navigating: bool | None
    registration_current: bool
    calibration_current: bool
    checked_at_s: float | None
    armed_screens: int
    lost_screens: int
    free_disk_mb: float | None
    recording_runs: bool
    hold_requested_by: str


class RecordedAlarmMessage(Message):
    """One alarm after a step."""

    number: int
    condition: Condition
    state: AlarmState
    presence: Presence
    value: float | None
    limit: float | None
    worst: float | None


class AlarmEventMessage(Message):
    """A transition, an acknowledgement or a pause."""

    change: Change
    number: int | None
    condition: Condition | None
    by: str


class AlarmStepMessage(Message):
    """One step of the alarms, and the alarms after it."""

    call: AlarmCall
    at_s: float
    image_number: int | None
    circumstances: CircumstancesMessage
    numbers: list[int]
    pause_s: float
    by: str
    revision: int
    sound: Sound
    sound_number: int
    alarms: list[RecordedAlarmMessage]
    events: list[AlarmEventMessage]


class DocumentMessage(Message):
    """A document of the case that is in use."""

    id: str
    kind: str
    name: str
    made_at: str
    made_by: str
    sha256: str
    """SHA-256 of the content as JSON with sorted keys and without spaces."""
    content: dict[str, object]


class DocumentsMessage(Message):
    """All documents of the case that are in use."""

    documents: list[DocumentMessage]


class NoteMessage(Message):
    """A remark on the recording itself."""

    code: str
    """IMAGES_MISSING, STEPS_MISSING, STATE_MISSING, PROCESS_CHANGED, STOPPED."""
    message: str
    images: int = Field(default=0)
    """Number of missing images."""


def session_message(
    config: Config, *, case_id: str, started_at: str, unix_offset_s: float, product_version: str
) -> SessionMessage:
    """Return the first message of a recording; passwords in the address of the source are masked."""
    settings = config.model_dump(mode="json")
    source = source_from_text(config.camera.source).name
    settings["camera"]["source"] = source
    return SessionMessage(
        format_version=FORMAT_VERSION,
        product_version=product_version,
        libraries=library_versions(),
        python=platform.python_version(),
        machine=machine_name(),
        started_at=started_at,
        unix_offset_s=unix_offset_s,
        case_id=case_id,
        source=source,
        settings=settings,
    )


def library_versions() -> dict[str, str]:
    """Return the versions of the libraries that compute poses."""
    return {name: metadata.version(name) for name in LIBRARIES}


def machine_name() -> str:
    """Return system and architecture."""
    return f"{platform.system()} {platform.machine()}"


def controls_message(controls: Mapping[CameraControl, int] | None) -> dict[str, int] | None:
    """Return the camera's controls by name; None without a camera."""
    return None if controls is None else {control.value: value for control, value in controls.items()}


def controls_of(message: Mapping[str, int] | None) -> dict[CameraControl, int] | None:
    """Return the camera's controls of a message."""
    return None if message is None else {CameraControl(name): value for name, value in message.items()}


def alarm_step_message(step: AlarmStep, picture: AlarmSnapshot) -> AlarmStepMessage:
    """Return the message of a step and its result."""
    return AlarmStepMessage(
        call=step.call,
        at_s=step.at_s,
        image_number=step.image_number,
        circumstances=CircumstancesMessage.model_validate(step.circumstances, from_attributes=True),
        numbers=list(step.numbers),
        pause_s=step.pause_s,
        by=step.by,
        revision=picture.revision,
        sound=picture.sound,
        sound_number=picture.sound_number,
        alarms=[_alarm(one) for one in picture.alarms],
        events=[
            AlarmEventMessage(
                change=event.change,
                number=None if event.alarm is None else event.alarm.number,
                condition=event.condition,
                by=event.by,
            )
            for event in picture.events
        ],
    )


def poses_message(snapshot: NavigationSnapshot) -> PosesMessage:
    """Return the poses of the markers in an image."""
    sightings = snapshot.sightings if snapshot.setup.camera_calibrated else {}
    return PosesMessage(
        image_number=snapshot.image_number,
        poses=[
            MarkerPoseMessage(
                marker=name,
                camera_from_marker=pose_message(one.camera_from_marker),
                covariance=one.pose_covariance.tolist(),
            )
            for name, one in sightings.items()
            if isinstance(one, Seen)
        ],
    )


def _alarm(alarm: Alarm) -> RecordedAlarmMessage:
    measure, peak = alarm.measure, alarm.peak
    return RecordedAlarmMessage(
        number=alarm.number,
        condition=alarm.condition,
        state=alarm.state,
        presence=alarm.presence,
        value=None if measure is None else finite(measure.value),
        limit=None if measure is None else finite(measure.limit),
        worst=None if peak is None else finite(peak.measure.value),
    )
