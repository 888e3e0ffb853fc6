"""A few images of the rehearsal, tracked and recorded through the ring, without a process."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from server.alarms import AlarmService
from server.alarms.evaluation import AlarmState, AlarmStep
from server.capture.shot import Shot
from server.config import Config
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.logs import LogSettings
from server.loop.report import Report, ReportPacker
from server.loop.ring import ImageRing
from server.loop.tracking import Tracking
from server.loop.tracking_state import tracking_state_bytes
from server.recording.messages import session_message
from server.recording.process import (
    AlarmsBegin,
    AlarmsNeeded,
    Recording,
    RecordingOrder,
    RingChanged,
    StateNeeded,
    StepsTaken,
    ToServer,
)
from server.recording_file import WriterLimits
from server.setup import Preparation, build_setup
from tracker.geometry import Camera, Marker, Rigid
from tracker.navigation.alarms import AlarmSnapshot

BEGIN_S, RATE_HZ = 14.0, 30.0
WIDTH, HEIGHT = 640, 360
SOURCE = SourceStatus(name="rehearsal", state=SourceState.RUNNING)
RUNNING = ProcessStatus(state=ProcessState.RUNNING)
Image = npt.NDArray[np.uint8]


@dataclass
class RecordedTheatre:
    """Tracks images and records them; the test decides which, and when.

    Attributes:
        path: of the file.
        images: rendered images, one a number.
        preparation: the setup.
        config: the settings.
    """

    path: Path
    images: list[Image]
    preparation: Preparation
    config: Config
    limits: WriterLimits = field(default_factory=lambda: WriterLimits(max_bytes=1e12, min_free_bytes=0))
    sent: list[ToServer] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.now_s = BEGIN_S
        self.tracking = Tracking(self.preparation)
        self.alarms = AlarmService(self.config, clock=lambda: self.now_s)
        self.ring = ImageRing(slots=4, image_bytes=WIDTH * HEIGHT * 3)
        self._packer = ReportPacker()
        self._tracked = 0
        self.recording: Recording | None = None
        self.send: Callable[[ToServer], None] = self.sent.append
        self._needs_state = False

    def begin(self) -> None:
        """Begin the recording, in the middle of the stream."""
        order = RecordingOrder(
            path=self.path,
            limits=self.limits,
            session=session_message(
                self.config,
                case_id="0" * 16,
                started_at="2026-01-01T00:00:00Z",
                unix_offset_s=1.7e9,
                product_version="0",
            ),
            log=LogSettings(as_json=True),
        )
        self.recording = Recording(order, send=self.send, clock=lambda: self.now_s)
        self.recording.take(RingChanged(ring=self.ring))
        self.recording.tick()
        self._answer()

    def track(
        self,
        number: int,
        *,
        jpeg: bytes = b"",
        read: bool = True,
        image: Image | None = None,
        is_predicted: bool = False,
        poses: Mapping[str, Rigid[Camera, Marker]] | None = None,
    ) -> None:
        """Track an image, let the alarms see it, and let the recording read."""
        self.now_s = BEGIN_S + number / RATE_HZ
        pixels = self.images[number] if image is None else image
        state = 0
        if self._needs_state:
            self._needs_state = False
            state = self.ring.write_state(tracking_state_bytes(self.tracking))
        shot = Shot(
            image=pixels,
            number=number,
            captured_at_s=self.now_s,
            source_time_s=0.0,
            is_predicted=is_predicted,
            poses=poses,
        )
        snapshot = self.tracking.process(shot, skipped_images=0, clock=lambda: 0.0)
        self._tracked += 1
        report = Report(
            source=SOURCE,
            snapshot=snapshot,
            tracked_images=self._tracked,
            state=state,
            is_predicted=is_predicted,
        )
        self.ring.write(self._packer.pack(report), pixels, encoded=jpeg)
        if read:
            self.read()
        self.now_s += 0.005
        self.alarms.observe(snapshot, SOURCE, RUNNING)
        self.now_s += 0.02
        self.alarms.observe(None, SOURCE, RUNNING)

    def answer_state(self) -> None:
        """Send the state with the next image."""
        self._needs_state = True

    def read(self) -> None:
        """Let the recording read all that is in the ring."""
        if self.recording is not None:
            self.recording.read_all()
            self.recording.tick()
            self._answer()

    def end(self) -> None:
        """End the recording."""
        assert self.recording is not None
        self.recording.read_all()
        self.recording.note("STOPPED", "the test ended it")
        self.recording.close()

    def _answer(self) -> None:
        """Do what the server does for the recording process."""
        for message in self.sent:
            if isinstance(message, StateNeeded):
                self._needs_state = True
            elif isinstance(message, AlarmsNeeded):
                self.alarms.record_steps(self._take_step, self._begin_alarms)
        self.sent.clear()

    def _take_step(self, step: AlarmStep, picture: AlarmSnapshot) -> None:
        assert self.recording is not None
        self.recording.take(StepsTaken(steps=((step, picture),)))

    def _begin_alarms(self, state: AlarmState, at_s: float) -> None:
        assert self.recording is not None
        self.recording.take(AlarmsBegin(state=state, at_s=at_s))


def made_config() -> Config:
    """Return settings of a small rehearsal with a patient marker."""
    rehearsal = {"seed": 3, "skill": "good", "width": WIDTH, "height": HEIGHT, "reference": True}
    return Config.model_validate(
        {"rehearsal": rehearsal, "alarms": {"drill_unseen_after_ms": 100}, "recording": {"min_free_gb": 0.0}}
    )


def rendered(config: Config, count: int) -> tuple[Preparation, list[Image]]:
    """Return the setup and `count` images of the drilling."""
    preparation = build_setup(config)
    theatre = preparation.theatre
    assert theatre is not None
    renderer = theatre.renderer()
    return preparation, [renderer.image_at(BEGIN_S + number / RATE_HZ) for number in range(count)]


Recorder = Callable[[Path], RecordedTheatre]
