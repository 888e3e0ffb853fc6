"""Everything between a source and the live hub, started and stopped as one."""

from server.alarms import no_alarms
from server.capture.address import SourceKind, source_from_text
from server.capture.rehearsal import Begun
from server.config import Config
from server.live import LiveHub
from server.logs import LogSettings
from server.loop.board import Board
from server.loop.phone_inbox import PhoneInbox
from server.loop.publisher import Look, Picture, Publisher
from server.loop.staging import SceneOrder
from server.loop.supervisor import Supervisor, Watch
from server.loop.worker import WorkerOrder
from server.setup import CaseSetup


class Tracked:
    """Captures and tracks in a process of its own, and publishes to `hub`.

    Attributes:
        hub: where the newest instant is published.
        inbox: where a phone's images go; None for every other source.
    """

    def __init__(self, config: Config, *, log: LogSettings, watch: Watch | None = None) -> None:
        self.hub = LiveHub()
        source = source_from_text(config.camera.source)
        self.inbox = PhoneInbox() if source.kind is SourceKind.PHONE else None
        self._board = Board(source.name)
        order = WorkerOrder(config=config, log=log, inbox=self.inbox)
        self._supervisor = Supervisor(order=order, board=self._board, watch=watch)
        self._publisher: Publisher | None = None

    @property
    def pid(self) -> int | None:
        """The tracking process, None while there is none."""
        return self._supervisor.pid

    def start(self) -> None:
        """Start the tracking process; call it from the main thread. Nothing is published yet."""
        self._supervisor.start()

    def publish(self, picture: Picture, *, look: Look = no_alarms) -> None:
        """Begin to publish, with pictures made in this way, and the alarms of whoever looks for them."""
        self._publisher = Publisher(board=self._board, hub=self.hub, picture=picture, look=look)
        self._publisher.start()

    def wake(self) -> None:
        """Have what has changed beside the images published at once. From any thread."""
        self._board.wake()

    def adopt(self, case: CaseSetup) -> None:
        """Work with what this case knows, from the next image on and over restarts. From any thread."""
        self._supervisor.adopt(case)

    @property
    def tracks_from_s(self) -> float:
        """Since when the tracking process of now runs, monotonic; -inf before the first."""
        return self._supervisor.tracks_from_s

    def play(self, scene: SceneOrder) -> None:
        """Rehearse this scene, as soon as it is ready and over restarts. From any thread."""
        self._supervisor.play(scene)

    @property
    def begun(self) -> Begun | None:
        """What of the rehearsal is played, as last reported; None before the first report."""
        return self._board.begun

    def stop(self) -> None:
        """End the process and the threads; harmless when they were not started."""
        if self._publisher is not None:
            self._publisher.stop()
        self._supervisor.stop()
        if self.inbox is not None:
            self.inbox.close()
