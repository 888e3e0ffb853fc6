"""A rehearsed theatre with the whole path from camera to viewers; the test sets the clock."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pytest

from server.alarms import AlarmService
from server.capture.shot import Shot
from server.config import Config, RehearsalEventConfig
from server.live import Instant, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.publisher import Publisher
from server.loop.report import Report, ReportPacker
from server.loop.ring import ImageRing
from server.loop.shared_status import SharedStatus
from server.loop.tracking import Tracking
from server.overlay import draw_overlay
from server.scene.door import Door
from server.scene.stage import Stage
from server.setup import build_setup
from server.stream.messages import LiveMessage, live_message
from server.stream.pose_messages import AbsentMessage
from tests.server.loop.fake_workers import Seen
from tracker.navigation import AbsentReason
from tracker.rehearsal import Renderer

# The drill is well inside the bone, and its marker and the reference are in view.
BEGIN_S = 14.0
RATE_HZ = 30.0
WIDTH, HEIGHT = 960, 540
# On the shaft behind the tip, where nothing else is drawn.
SHAFT_MM = np.linspace(25.0, 85.0, 61)
DRAWN_BY = 40
SOURCE = SourceStatus(name="rehearsal", state=SourceState.RUNNING)
GONE = SourceStatus(name="rehearsal", state=SourceState.RECONNECTING)


@dataclass(frozen=True, slots=True, kw_only=True)
class PublishedImage:
    """All outputs of one instant.

    Attributes:
        at_s: time of publication.
        message: the JSON.
        is_drawn: whether the drill's line is in the picture.
        is_on_stage: whether the drill is in the 3-D scene.

    """

    at_s: float
    message: LiveMessage
    is_drawn: bool
    is_on_stage: bool

    @property
    def is_in_message(self) -> bool:
        """Whether the JSON contains the drill's position or its distance to the channel."""
        snapshot = self.message.snapshot
        return snapshot is not None and any(
            "absent" not in {tool.pose.kind, tool.deviation.kind, tool.judgement.kind, tool.assessment.kind}
            for tool in snapshot.tools
        )

    @property
    def is_hinted_at(self) -> bool:
        """Whether the JSON contains anything about the drill's position."""
        snapshot = self.message.snapshot
        reported = snapshot is not None and any(
            {tool.pose.kind, tool.deviation.kind, tool.judgement.kind, tool.assessment.kind} != {"absent"}
            for tool in snapshot.tools
        )
        return reported or self.is_drawn or self.is_on_stage

    @property
    def reason(self) -> AbsentReason | None:
        """The reason for missing numbers, if they are missing."""
        snapshot = self.message.snapshot
        deviation = None if snapshot is None else snapshot.tools[0].deviation
        return deviation.reason if isinstance(deviation, AbsentMessage) else None

    @property
    def alarms(self) -> Mapping[str, str]:
        """State by condition of the alarms in sight."""
        return {one.condition.value: one.state.value for one in self.message.alarms.alarms}


class ShownTheatre:
    """The rehearsal with these events, through tracking, alarms, overlay and publication.

    Attributes:
        now_s: the time, which each image advances by a thirtieth of a second.
        renderer: the static background, which the next theatre may reuse.

    """

    def __init__(
        self,
        events: Sequence[RehearsalEventConfig],
        patch: pytest.MonkeyPatch,
        *,
        reference: bool = True,
        after: Renderer | None = None,
    ) -> None:
        self.now_s = BEGIN_S
        self._number = 0
        rehearsal = {
            "seed": 3,
            "skill": "good",
            "width": WIDTH,
            "height": HEIGHT,
            "reference": reference,
            "events": [one.model_dump() for one in events],
        }
        alarms = {"drill_unseen_after_ms": 200, "reference_unseen_after_ms": 200}
        config = Config.model_validate({"rehearsal": rehearsal, "alarms": alarms})
        preparation = build_setup(config)
        assert preparation.theatre is not None
        self._theatre = preparation.theatre
        renderer = self._theatre.renderer(after=after)
        assert isinstance(renderer, Renderer)
        self.renderer = renderer
        self._tracking = Tracking(preparation)
        self._service = AlarmService(config, clock=lambda: self.now_s)
        self._service.report_screen("theatre-one", armed=True)
        self._hub, self._board = Seen(), SharedStatus("rehearsal")
        self._ring, self._packer = ImageRing(), ReportPacker()
        self._raw = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
        self._publisher = Publisher(
            status=self._board,
            hub=self._hub,
            check_alarms=self._service.observe,
        )
        self._board.post(ProcessStatus(state=ProcessState.RUNNING), self._ring)
        self._door = Door()
        self._stage = Stage(self._door, setup=preparation.setup, surface=preparation.surface)
        patch.setattr("server.loop.publisher.time.monotonic", lambda: self.now_s)

    def close(self) -> None:
        """Free the shared memory."""
        self._ring.close()
        self._door.stop()

    def image(self) -> PublishedImage:
        """Publish one more image, a thirtieth of a second after the last."""
        self._raw = self.renderer.image_at(self.now_s)
        shot = Shot(image=self._raw, number=self._number, captured_at_s=self.now_s, source_time_s=self.now_s)
        snapshot = self._tracking.process(shot, skipped_images=0, clock=lambda: self.now_s)
        report = Report(source=SOURCE, snapshot=snapshot, tracked_images=self._number + 1)
        self._ring.write(self._packer.pack(report), shot.image)
        return self._published()

    def no_image(self, source: SourceStatus | None = None) -> PublishedImage:
        """Let this time pass without an image; the source reports its loss, or nothing."""
        if source is not None:
            self._ring.write(self._packer.pack(Report(source=source, tracked_images=self._number)), None)
        return self._published()

    def _published(self) -> PublishedImage:
        self._publisher.publish_newest()
        instant = self._hub.instants[-1]
        self._stage.show(instant)
        shown = PublishedImage(
            at_s=self.now_s,
            message=live_message(instant, now_s=self.now_s),
            is_drawn=self._is_drawn(instant),
            is_on_stage=any(handle.visible for handle in self._stage._tools.values()),
        )
        self._number += 1
        self.now_s = BEGIN_S + self._number / RATE_HZ
        return shown

    def _is_drawn(self, instant: Instant) -> bool:
        """Whether most pixels along the shaft were drawn into."""
        if instant.image is None or instant.snapshot is None:
            return False
        at_s = BEGIN_S + instant.snapshot.image_number / RATE_HZ
        tool = self._theatre.truth_at(at_s).camera_from_tool
        points = tool.move_points(np.outer(-SHAFT_MM, [0.0, 0.0, 1.0]))
        columns, rows = np.rint(self._theatre.camera.px_from_camera(points)).astype(int).T
        inside = (columns >= 0) & (columns < WIDTH) & (rows >= 0) & (rows < HEIGHT)
        assert inside.sum() > 20
        drawn = draw_overlay(instant.image, instant.snapshot, instant.alarms)
        on_shaft = rows[inside], columns[inside]
        change = np.abs(drawn[on_shaft].astype(int) - instant.image[on_shaft].astype(int)).max(axis=1)
        return bool((change > DRAWN_BY).mean() > 0.5)
