"""The live message, and the function that makes it from an instant.

These models are the wire schema: OpenAPI has them through `GET /api/live`, and the page's types are generated
from there, so that a renamed field fails the build. The same message is sent as JSON on `/ws/live`, as the
header of each image on `/ws/view`, and returned by `GET /api/live`.

A message is an envelope, which differs between viewers, and a content, which is that of the instant. Both are
flat parts of one JSON object, so that a content serialised once can be sent in many envelopes.
"""

from functools import lru_cache

from server.live import (
    CameraMode,
    CameraStatus,
    ImageClock,
    Instant,
    Problem,
    ProcessState,
    ProcessStatus,
    SourceState,
    SourceStatus,
)
from server.stream.alarm_messages import AlarmsMessage, alarms_message
from server.stream.assessment_messages import HeadlineMessage, TextMessage, headline_message, text_message
from server.stream.message import Message as Message  # noqa: PLC0414  the doors take it from here
from server.stream.snapshot_messages import SnapshotMessage, snapshot_message
from server.texts import (
    PREDICTED_VIDEO,
    Language,
    error_reason,
    flicker_note,
    headline_of,
    requested_language,
)
from tracker.errors import NavigationError
from tracker.plan.pedicle import Side


class ProblemMessage(Message):
    """The common shape of all errors."""

    code: str
    message: str
    remedy: str
    context: dict[str, object]
    language: Language
    """Language of message and remedy: as requested by `Accept-Language`; English without a translation."""


class LiveProblemMessage(Message):
    """A present fault in every language, in the messages that all viewers share."""

    code: str
    message: TextMessage
    remedy: TextMessage
    is_translated: bool
    """Whether message and remedy are translated; otherwise they are in English for every language."""
    context: dict[str, object]


class CameraModeMessage(Message):
    """Pixel format, size and rate of a camera."""

    fourcc: str
    """Pixel format: "MJPG", "YUYV", "BayerRG8"; empty where unknown."""
    width_px: int
    height_px: int
    rate_hz: float
    """0 where unknown."""


class CameraNoteMessage(Message):
    """A camera problem that can be improved, and stops nothing."""

    code: str
    message: TextMessage
    remedy: TextMessage


class CameraStatusMessage(Message):
    """Status of a camera."""

    clock: ImageClock
    """Clock of the capture times: the camera driver's, the camera's own, the stream's sender's, the browser's
    of the phone that sends it, or this machine's at the arrival."""
    requested: CameraModeMessage | None
    granted: CameraModeMessage | None
    controls: dict[str, int]
    """Control values, in the driver's units; only controls that the camera has."""
    note: CameraNoteMessage | None
    """Lamps that flicker in its images, or a codec that makes poses less certain; null without either."""


class SourceMessage(Message):
    """The source of images."""

    name: str
    state: SourceState
    problem: LiveProblemMessage | None
    images: int
    skipped_images: int
    rate_hz: float
    camera: CameraStatusMessage | None
    """Null for files and rendered images."""


class ProcessMessage(Message):
    """The process that captures and tracks."""

    state: ProcessState
    restarts: int
    problem: LiveProblemMessage | None


class LiveEnvelope(Message):
    """The fields of a live message that differ between viewers."""

    sent_at_s: float
    """Monotonic clock of the server."""
    image_age_ms: float | None
    """Time from the capture of the image to the sending; null without a snapshot."""
    shown_scale_ratio: float
    """Scale of the picture that comes with this message, relative to the camera's image: 1, 0.5 or 0.25. All
    pixels in the message are those of the camera's image."""


class ProposedChannelMessage(Message):
    """Another planned channel, to which the drill is nearer than to the active one."""

    vertebra: str
    side: Side
    is_registered: bool
    """Whether its vertebra has a valid registration."""


class LiveContent(Message):
    """The fields of a live message that all viewers share."""

    sequence: int
    """Grows by one with each instant; a gap is what this client skipped."""
    source: SourceMessage
    process: ProcessMessage
    snapshot: SnapshotMessage | None
    """Null before the first image and while capture or tracking is down."""
    headline: HeadlineMessage
    """Of this image and its alarms."""
    alarms: AlarmsMessage
    """Evaluated with this image."""
    proposed_channel: ProposedChannelMessage | None
    """Null while the drill is not nearer to another channel, or its figures are not live."""


class LiveMessage(LiveContent, LiveEnvelope):
    """The present state of capture, tracking and alarms."""


def live_message(instant: Instant, *, now_s: float) -> LiveMessage:
    """Return the message of an instant, sent at monotonic time `now_s`."""
    return LiveMessage(
        **dict(live_envelope(instant, now_s=now_s)), **dict(live_content(instant, now_s=now_s))
    )


def live_envelope(instant: Instant, *, now_s: float, shown_scale_ratio: float = 1.0) -> LiveEnvelope:
    """Return the envelope of an instant, sent at monotonic time `now_s` with a picture of this scale."""
    snapshot = instant.snapshot
    return LiveEnvelope(
        sent_at_s=now_s,
        image_age_ms=None if snapshot is None else (now_s - snapshot.captured_at_s) * 1000.0,
        shown_scale_ratio=shown_scale_ratio,
    )


def live_content(instant: Instant, *, now_s: float) -> LiveContent:
    """Return the content of an instant; the durations of its alarms are those at monotonic time `now_s`."""
    return LiveContent(
        sequence=instant.sequence,
        source=source_message(instant.source),
        process=process_message(instant.process),
        snapshot=None if instant.snapshot is None else snapshot_message(instant.snapshot),
        headline=headline_message(headline_of(instant.snapshot, instant.alarms)),
        alarms=alarms_message(instant.alarms, now_s=now_s),
        proposed_channel=None
        if instant.proposed_channel is None
        else ProposedChannelMessage.model_validate(instant.proposed_channel, from_attributes=True),
    )


def source_message(source: SourceStatus) -> SourceMessage:
    """Return the message of the source of images."""
    return SourceMessage(
        name=source.name,
        state=source.state,
        problem=None if source.problem is None else _live_problem_message(source.problem),
        images=source.images,
        skipped_images=source.skipped_images,
        rate_hz=source.rate_hz,
        camera=_camera_message(source.camera),
    )


def _camera_message(camera: CameraStatus | None) -> CameraStatusMessage | None:
    if camera is None:
        return None
    return CameraStatusMessage(
        clock=camera.clock,
        requested=_mode_message(camera.requested),
        granted=_mode_message(camera.granted),
        controls={control.value: value for control, value in camera.controls.items()},
        note=_note_message(camera),
    )


def _note_message(camera: CameraStatus) -> CameraNoteMessage | None:
    if camera.flicker is not None:
        rate_hz = 0.0 if camera.granted is None else camera.granted.rate_hz
        note = flicker_note(camera.flicker, exposure_ms=camera.exposure_ms, rate_hz=rate_hz)
    elif camera.is_predicted:
        note = PREDICTED_VIDEO
    else:
        return None
    return CameraNoteMessage(
        code=note.code, message=text_message(note.message), remedy=text_message(note.remedy)
    )


def _mode_message(mode: CameraMode | None) -> CameraModeMessage | None:
    if mode is None:
        return None
    width, height = mode.size_wh_px
    return CameraModeMessage(fourcc=mode.fourcc, width_px=width, height_px=height, rate_hz=mode.rate_hz)


def process_message(process: ProcessStatus) -> ProcessMessage:
    """Return the message of the tracking process."""
    return ProcessMessage(
        state=process.state,
        restarts=process.restarts,
        problem=None if process.problem is None else _live_problem_message(process.problem),
    )


# A problem persists for many images, and its translation is searched for among all templates: 0.5 ms.
@lru_cache(maxsize=16)
def _live_problem_message(problem: Problem) -> LiveProblemMessage:
    why = error_reason(problem.code, problem.message, problem.remedy, problem.context)
    return LiveProblemMessage(
        code=problem.code,
        message=text_message(why.message),
        remedy=text_message(why.remedy),
        is_translated=why.is_translated,
        context=problem.context,
    )


def problem_message(problem: Problem | None) -> ProblemMessage | None:
    """Return the message of a problem; None without one."""
    return None if problem is None else translated_problem(problem)


def translated_problem(problem: Problem | NavigationError) -> ProblemMessage:
    """Return the message of a problem or error in the language of the request."""
    language = requested_language()
    why = error_reason(problem.code, problem.message, problem.remedy, problem.context)
    return ProblemMessage(
        code=problem.code,
        message=why.message[language],
        remedy=why.remedy[language],
        context=problem.context,
        language=why.language(language),
    )
