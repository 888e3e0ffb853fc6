"""All parts between a source and the live hub, started and stopped together."""

from collections.abc import Callable

from server.alarms import without_alarms
from server.capture.address import SourceKind, source_from_text
from server.capture.rehearsal import PlayedScene
from server.config import Config
from server.live import LiveHub, Problem
from server.logs import LogSettings
from server.loop.phone_inbox import PhoneInbox
from server.loop.publisher import AlarmCheck, ChannelProposal, Publisher
from server.loop.ring import RECORDED_SLOTS, SLOTS
from server.loop.shared_status import ProcessView, SharedStatus
from server.loop.staging import SceneOrder
from server.loop.supervisor import Supervisor, WatchdogSettings
from server.loop.worker import WorkerOrder
from server.setup import CaseSetup


class TrackingSystem:
    """Captures and tracks in a separate process, and publishes to `hub`.

    Attributes:
        hub: publishes the newest instant.
        inbox: images of a phone; None for every other source.
    """

    def __init__(self, config: Config, *, log: LogSettings, watchdog: WatchdogSettings | None = None) -> None:
        self.hub = LiveHub()
        source = source_from_text(config.camera.source)
        self.inbox = PhoneInbox() if source.kind is SourceKind.PHONE else None
        self._status = SharedStatus(source.name)
        order = WorkerOrder(config=config, log=log, inbox=self.inbox)
        slots = SLOTS if config.recording.when == "never" else RECORDED_SLOTS
        self._supervisor = Supervisor(order=order, status=self._status, watchdog=watchdog, slots=slots)
        self._publisher: Publisher | None = None

    @property
    def pid(self) -> int | None:
        """The tracking process, None while there is none."""
        return self._supervisor.pid

    def start(self) -> None:
        """Start the tracking process; call it from the main thread. Nothing is published yet."""
        self._supervisor.start()

    def publish(
        self,
        *,
        check_alarms: AlarmCheck = without_alarms,
        picture_problem: Callable[[], Problem | None] = lambda: None,
        propose_channel: ChannelProposal = lambda _: None,
    ) -> None:
        """Start publishing; `picture_problem` returns why no picture can be drawn, or None."""
        self._publisher = Publisher(
            status=self._status,
            hub=self.hub,
            check_alarms=check_alarms,
            picture_problem=picture_problem,
            propose_channel=propose_channel,
        )
        self._publisher.start()

    def wake(self) -> None:
        """Publish changes at once, without waiting for an image. From any thread."""
        self._status.wake()

    def adopt(self, case: CaseSetup) -> None:
        """Use the data of this case, from the next image on and after restarts. From any thread."""
        self._supervisor.adopt(case)

    def record(self, *, is_recording: bool) -> None:
        """Make the tracking process send its state for a recording. From any thread."""
        self._supervisor.record(is_recording=is_recording)

    @property
    def current(self) -> ProcessView:
        """The tracking process with its ring."""
        return self._status.current

    @property
    def tracks_from_s(self) -> float:
        """Start of the present tracking process, monotonic; -inf before the first."""
        return self._supervisor.tracks_from_s

    def play(self, scene: SceneOrder) -> None:
        """Rehearse this scene, as soon as it is ready and after restarts. From any thread."""
        self._supervisor.play(scene)

    @property
    def played_scene(self) -> PlayedScene | None:
        """Scene of the rehearsal, as last reported; None before the first report."""
        return self._status.played_scene

    def stop(self) -> None:
        """Stop process and threads; does nothing if they were not started."""
        if self._publisher is not None:
            self._publisher.stop()
        self._supervisor.stop()
        if self.inbox is not None:
            self.inbox.close()
