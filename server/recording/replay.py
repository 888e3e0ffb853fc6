"""Tracks a recording again with its images, setup and times, and compares results and alarms.

The file contains the tracking state before the first image, so that every later result must be identical in
all digits. After missing images the comparison pauses until the next state.
"""

import json
import math
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import structlog

from server.alarms.evaluation import AlarmEvaluation, AlarmState, AlarmStep, Circumstances
from server.capture.shot import Shot
from server.errors import RecordingError
from server.loop.tracking import Tracking
from server.loop.tracking_state import StateError, TrackingState, restore_state
from server.recording.messages import (
    AlarmStepMessage,
    SessionMessage,
    TrackedMessage,
    alarm_step_message,
    controls_of,
    library_versions,
    machine_name,
)
from server.recording_file import (
    CodecError,
    RecordedMessage,
    RecordingReader,
    Topic,
    decoded_value,
    rejecting_other_content,
)
from server.recording_file.codec import Json
from server.recording_file.topics import FORMAT_VERSION
from server.stream.snapshot_messages import snapshot_message
from tracker.errors import InvalidInput, NavigationError
from tracker.geometry import Camera, Marker, Rigid
from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import AlarmLimits

# Maximum time for which an image waits for the alarm step that observed it.
MAX_REMEMBERED = 600
# Fields of a snapshot message that are not reproducible: stage times, and the age in older recordings.
NOT_COMPARED = frozenset({"age_ms", "stage_ms"})

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """One value that differs from the recorded one.

    Attributes:
        image_number: Number of the image; for alarms the last image before the step.
        what: Path of the value in the message.
        recorded, replayed: The values.
    """

    image_number: int
    what: str
    recorded: Json
    replayed: Json

    @property
    def size(self) -> float:
        """Absolute difference of two numbers; infinite for other values."""
        one, other = self.recorded, self.replayed
        are_numbers = all(
            isinstance(value, int | float) and type(value) is not bool for value in (one, other)
        )
        return abs(one - other) if are_numbers else math.inf

    def __str__(self) -> str:
        """Return the path and both values."""
        by = f", {self.size:.3g} apart" if math.isfinite(self.size) else ""
        return (
            f"image {self.image_number}: {self.what} was {_short(self.recorded)} and is now "
            f"{_short(self.replayed)}{by}"
        )


@dataclass(slots=True)
class Differences:
    """The first and the largest of all differences of one kind."""

    images: int = 0
    first: Difference | None = None
    worst: Difference | None = None

    def add(self, found: list[Difference]) -> None:
        """Add the differences of one image or step."""
        if not found:
            return
        self.images += 1
        self.first = self.first or found[0]
        worst = max(found, key=lambda one: one.size)
        if self.worst is None or worst.size > self.worst.size:
            self.worst = worst


@dataclass(slots=True)
class ReplayReport:
    """Result of a check.

    Attributes:
        session: Source of the recording; None if the file does not state it.
        images: Number of compared images.
        unchecked_images: Number of recorded images without a state before them in the file.
        missing_images: Number of tracked images that are not in the file.
        steps, unchecked_steps: Number of alarm steps that were compared, and that were not.
        poses, alarms: Differences.
        remarks: Notes of the recording, and reasons why something was not compared.
        is_whole: Whether the file is complete.
        is_damaged: Whether a part of the file is damaged.
        incomplete_reason: Why it was not read to its end.
    """

    session: SessionMessage | None = None
    images: int = 0
    unchecked_images: int = 0
    missing_images: int = 0
    steps: int = 0
    unchecked_steps: int = 0
    poses: Differences = field(default_factory=Differences)
    alarms: Differences = field(default_factory=Differences)
    remarks: list[str] = field(default_factory=list)
    is_whole: bool = False
    is_damaged: bool = False
    incomplete_reason: str = ""

    @property
    def is_equal(self) -> bool:
        """Whether something was compared, all of it is equal, and no part of the file is damaged."""
        is_same = self.poses.first is None and self.alarms.first is None
        return self.images > 0 and is_same and not self.is_damaged

    @property
    def changed_versions(self) -> list[str]:
        """Differences between the recording machine and this one that may change digits."""
        if self.session is None:
            return []
        now = {**library_versions(), "machine": machine_name()}
        then = {**self.session.libraries, "machine": self.session.machine}
        return [
            f"{name}: recorded with {then.get(name, 'an unknown version')}, now {now[name]}"
            for name in now
            if then.get(name) != now[name]
        ]


def check_recording(path: Path, *, limits: AlarmLimits | None = None) -> ReplayReport:
    """Replay a recording and compare the results with the recorded ones.

    Args:
        path: The file.
        limits: Alarm limits; None for the recorded ones.

    Raises:
        RecordingError: RECORDING_NOT_READABLE, RECORDING_TOO_NEW.
    """
    reader = RecordingReader(path)
    replay = _Replay(limits)
    with rejecting_other_content(path):
        for message in reader.messages():
            replay.take(message)
    replay.end()
    report = replay.report
    report.is_whole, report.incomplete_reason = reader.is_whole, reader.incomplete_reason
    report.is_damaged = reader.is_damaged
    return report


class _Replay:
    def __init__(self, limits: AlarmLimits | None) -> None:
        self.report = ReplayReport()
        self._limits = limits
        self._states: dict[int, TrackingState] = {}
        self._tracking: Tracking | None = None
        self._tracked: TrackedMessage | None = None
        self._image: RecordedMessage | None = None
        self._snapshots: dict[int, NavigationSnapshot] = {}
        self._newest = -1
        self._alarms: AlarmEvaluation | None = None
        self._steps: deque[AlarmState | tuple[AlarmStepMessage, Json] | None] = deque()

    def take(self, message: RecordedMessage) -> None:
        match message.topic:
            case Topic.SESSION:
                self._take_session(message.json())
            case Topic.STATE:
                self._take_state(message)
            case Topic.TRACKED:
                self._tracked, self._image = TrackedMessage.model_validate(message.json()), None
            case Topic.IMAGE:
                self._image = message
            case Topic.SNAPSHOT:
                self._compare(message.json())
            case Topic.NOTE:
                self._take_note(message.json())
            case Topic.ALARM_STATE:
                self._steps.append(self._alarm_state(message))
            case Topic.ALARM_STEP:
                content = message.json()
                self._steps.append((AlarmStepMessage.model_validate_json(message.content), content))
            case _:  # neither an input of the replay nor compared with its results
                pass
        self._compare_steps()

    def end(self) -> None:
        """Count the steps whose image was not read."""
        self.report.unchecked_steps += sum(isinstance(one, tuple) for one in self._steps)

    def _take_session(self, content: Json) -> None:
        if content.get("format_version", 0) > FORMAT_VERSION:
            raise RecordingError(
                "RECORDING_TOO_NEW",
                f"the recording has format {content['format_version']}, this version reads up to "
                f"{FORMAT_VERSION}",
                "Replay it with the version of Coaxial that recorded it.",
                {"format_version": content["format_version"], "max_format_version": FORMAT_VERSION},
            )
        self.report.session = SessionMessage.model_validate(content)

    def _take_state(self, message: RecordedMessage) -> None:
        try:
            state = decoded_value(message.json())
        except (CodecError, ValueError) as error:
            self._remark(f"the state before image {message.sequence} cannot be used: {error}")
            self._tracking = None
            return
        self._states = {message.sequence: state}

    def _alarm_state(self, message: RecordedMessage) -> AlarmState | None:
        try:
            state: AlarmState = decoded_value(message.json())
        except (CodecError, ValueError) as error:
            self._remark(f"the alarm state cannot be used: {error}")
            return None
        if self._limits is None:
            return state
        return replace(state, limits=self._limits, engine={**state.engine, "_limits": self._limits})

    def _take_note(self, content: Json) -> None:
        code, text = str(content["code"]), str(content["message"])
        if code in ("IMAGES_MISSING", "STATE_MISSING", "PROCESS_CHANGED"):
            # What follows depends on images that are not here.
            self._tracking = None
            self.report.missing_images += int(content["images"])
        if code == "STEPS_MISSING":
            self._steps.append(None)
        if code != "STOPPED":
            self._remark(text)

    def _compare(self, recorded: Json) -> None:
        tracked, image = self._tracked, self._image
        number = int(recorded["image_number"])
        if tracked is None or tracked.image_number != number:
            return
        state = self._states.pop(number, None)
        if state is not None:
            self._tracking = self._restored(state, tracked)
        pixels = None if image is None else image.image
        if pixels is None and self._tracking is not None:
            self._remark(f"image {number} cannot be decoded")
            self._tracking = None
        if self._tracking is None or pixels is None:
            self.report.unchecked_images += 1
            return
        shot = Shot.live(
            pixels,
            number=number,
            captured_at_s=tracked.captured_at_s,
            is_predicted=tracked.is_predicted,
        )
        if self._tracking.preparation.external is not None:
            shot = replace(shot, poses=_poses_in(recorded))
        self.report.images += 1
        self._newest = number
        try:
            snapshot = self._tracking.process(
                shot,
                skipped_images=tracked.skipped_images,
                controls=controls_of(tracked.controls),
                device=tracked.device,
                clock=lambda: 0.0,
            )
        except NavigationError as error:
            self.report.poses.add(
                [
                    Difference(
                        image_number=number, what="tracking", recorded="a result", replayed=error.message
                    )
                ]
            )
            return
        replayed = json.loads(snapshot_message(snapshot).model_dump_json())
        self.report.poses.add(list(differences(number, recorded, replayed, ignored=NOT_COMPARED)))
        self._snapshots[number] = snapshot
        while len(self._snapshots) > MAX_REMEMBERED:
            del self._snapshots[next(iter(self._snapshots))]

    def _restored(self, state: TrackingState, tracked: TrackedMessage) -> Tracking:
        try:
            return restore_state(state, at_s=tracked.captured_at_s)
        except StateError as error:
            self._remark(f"tracking starts again at image {tracked.image_number}, because {error}")
            return Tracking(state.preparation)

    def _compare_steps(self) -> None:
        while self._steps:
            head = self._steps[0]
            if isinstance(head, tuple):
                step, recorded = head
                number = step.image_number
                if self._alarms is not None and number is not None and number not in self._snapshots:
                    if number > self._newest and self._tracking is not None:
                        # Its image follows later in the file.
                        return
                    self._alarms = None
                self._steps.popleft()
                self._compare_step(step, recorded)
                continue
            self._steps.popleft()
            self._alarms = None if head is None else AlarmEvaluation.restored(head)

    def _compare_step(self, message: AlarmStepMessage, recorded: Json) -> None:
        if self._alarms is None:
            self.report.unchecked_steps += 1
            return
        step = _step_of(message)
        number = message.image_number
        snapshot = None if number is None else self._snapshots[number]
        try:
            picture = self._alarms.apply(step, snapshot)
        except InvalidInput:
            self.report.unchecked_steps += 1
            return
        self.report.steps += 1
        replayed = json.loads(alarm_step_message(step, picture).model_dump_json())
        newest = self._alarms.snapshot
        at_image = -1 if newest is None else newest.image_number
        self.report.alarms.add(list(differences(at_image, recorded, replayed)))

    def _remark(self, text: str) -> None:
        if text not in self.report.remarks:
            self.report.remarks.append(text)


def _poses_in(recorded: Json) -> dict[str, Rigid[Camera, Marker]]:
    """Return the poses of an external tracker, which the message of their moment has in all digits."""
    seen = {one["name"]: one["sighting"] for one in recorded["markers"] if one["sighting"]["kind"] == "seen"}
    return {name: Rigid(**one["camera_from_marker"]) for name, one in seen.items()}


def differences(
    image_number: int,
    recorded: Json,
    replayed: Json,
    *,
    ignored: frozenset[str] = frozenset(),
    where: str = "",
) -> Iterator[Difference]:
    """Yield each value in which two messages differ."""
    if isinstance(recorded, Mapping) and isinstance(replayed, Mapping):
        for key in [*recorded, *(key for key in replayed if key not in recorded)]:
            if key not in ignored:
                place = f"{where}.{key}" if where else str(key)
                yield from differences(
                    image_number, recorded.get(key), replayed.get(key), ignored=ignored, where=place
                )
    elif isinstance(recorded, list) and isinstance(replayed, list) and len(recorded) == len(replayed):
        for index, (one, other) in enumerate(zip(recorded, replayed, strict=True)):
            yield from differences(image_number, one, other, ignored=ignored, where=f"{where}[{index}]")
    elif recorded != replayed:
        yield Difference(image_number=image_number, what=where, recorded=recorded, replayed=replayed)


def _step_of(message: AlarmStepMessage) -> AlarmStep:
    return AlarmStep(
        call=message.call,
        at_s=message.at_s,
        image_number=message.image_number,
        circumstances=Circumstances(**message.circumstances.model_dump()),
        numbers=tuple(message.numbers),
        pause_s=message.pause_s,
        by=message.by,
    )


def _short(value: Json) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 120 else f"{text[:117]}..."
