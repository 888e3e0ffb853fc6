"""From the tracking process to everybody: the newest report becomes the newest instant.

One thread draws the overlay and encodes it once for all viewers, while there are any. Newest wins: what came
while it was busy is dropped, and counted. Whatever happens, an instant goes out at least once a second, and
never with a picture that is known to be dead. Alarms are looked for with every image, before it is drawn, and
twenty times a second where none comes: they go out with the image that raised them, and silence raises its
own.
"""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import structlog

from server.alarms import no_alarms
from server.live import Instant, LiveHub, Problem, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.board import Board, Posted
from server.loop.report import Report, ReportUnpacker
from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import QUIET, AlarmPicture

Image: TypeAlias = npt.NDArray[np.uint8]
Look: TypeAlias = Callable[[NavigationSnapshot | None, SourceStatus, ProcessStatus], AlarmPicture]
HEARTBEAT_S = 0.9
TICK_S = 0.05
# An alarm that is told between two images goes out with the picture before it, if that is as young as this.
SHOWN_AGAIN_S = 0.15

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """How the outgoing picture is made.

    Attributes:
        draw: a new image with the overlay of a snapshot and of its alarms.
        encode: JPEG of an image.
        is_watched: whether anybody watches in any size; if not, nothing is drawn.
        is_watched_in_full: whether anybody watches that JPEG; if not, it is not made.
    """

    draw: Callable[[Image, NavigationSnapshot, AlarmPicture], Image]
    encode: Callable[[Image], bytes]
    is_watched: Callable[[], bool] = lambda: True
    is_watched_in_full: Callable[[], bool] = lambda: True


@dataclass(frozen=True, slots=True, kw_only=True)
class Shown:
    """An image with all that belongs to it, or nothing at all."""

    snapshot: NavigationSnapshot | None = None
    image: Image | None = None
    jpeg: bytes = b""
    drawn: Image | None = None
    server_ms: dict[str, float] = field(default_factory=dict)


class Publisher:
    """Publishes what the tracking process reports, in a thread of its own."""

    def __init__(self, *, board: Board, hub: LiveHub, picture: Picture, look: Look = no_alarms) -> None:
        self._board = board
        self._hub = hub
        self._picture = picture
        self._look = look
        self._stop = threading.Event()
        self._sequence = 0
        self._dropped = 0
        self._generation = -1
        self._read = 0
        self._tracked = 0
        self._unpacker = ReportUnpacker()
        self._last: Instant | None = None
        self._last_at_s = 0.0
        self._problem: Problem | None = None
        self._alarms = QUIET
        self._shown = Shown()
        self._told = ""
        self._thread = threading.Thread(target=self._run, name="publisher", daemon=True)

    def start(self) -> None:
        """Begin to publish."""
        self._thread.start()

    def stop(self) -> None:
        """Publish no more."""
        self._stop.set()
        self._board.wake()
        self._thread.join(1.0)

    def _run(self) -> None:
        while not self._stop.is_set():
            try:
                self.publish_newest()
            except Exception:
                # A thread that ends here would leave a server that looks alive and shows nothing.
                log.exception("an instant could not be published")
                self._stop.wait(HEARTBEAT_S)
            self._board.wait(min(self._last_at_s + HEARTBEAT_S - time.monotonic(), TICK_S))

    def publish_newest(self) -> None:
        """Publish the newest report, a change of the process, or a sign of life when it is due."""
        posted = self._board.posted
        report, image = self._newest(posted)
        if report is None:
            self._publish_without_image(posted)
            return
        self._board.note_running(posted.generation)
        self._board.note_source(report.source)
        self._board.note_begun(report.begun)
        self._problem = report.problem
        snapshot = None if image is None else report.snapshot
        self._watch(snapshot, report.source)
        shown = Shown() if snapshot is None or image is None else self._drawn(snapshot, image)
        now = self._board.posted
        if now.generation != posted.generation:
            # It died while its picture was drawn.
            self._publish_without_image(now)
            return
        self._publish(now.process, report.source, shown)

    def _newest(self, posted: Posted) -> tuple[Report | None, Image | None]:
        if posted.generation != self._generation:
            self._generation, self._read, self._tracked, self._problem = posted.generation, 0, 0, None
        if posted.ring is None:
            return None, None
        entry = posted.ring.newest(after=self._read)
        if entry is None:
            return None, None
        self._read = entry.sequence
        report = self._unpacker.unpack(entry.note)
        shown = 1 if report.snapshot is not None else 0
        self._dropped += max(0, report.tracked_images - self._tracked - shown)
        self._tracked = report.tracked_images
        return report, entry.image

    def _publish_without_image(self, posted: Posted) -> None:
        """Tell a change of the process or of the alarms at once, otherwise only that the server is alive."""
        last, now_s = self._last, time.monotonic()
        source = self._board.source
        if posted.process.state is not ProcessState.RUNNING:
            source = replace(source, state=SourceState.OPENING, problem=None, rate_hz=0.0)
        self._watch(None, source)
        process = self._status(posted.process)
        changed = last is None or (last.process.state, last.process.problem) != (
            process.state,
            process.problem,
        )
        if changed or now_s - self._last_at_s >= HEARTBEAT_S:
            self._publish(posted.process, source, Shown())
        elif last is not None and last.alarms.revision != self._alarms.revision:
            snapshot = self._shown.snapshot
            young = snapshot is not None and now_s - snapshot.captured_at_s <= SHOWN_AGAIN_S
            self._publish(posted.process, source, self._shown if young else Shown())

    def _watch(self, snapshot: NavigationSnapshot | None, source: SourceStatus) -> None:
        """Look for alarms; when that fails, it is told as a trouble, and the picture goes on."""
        try:
            self._alarms = self._look(snapshot, source, self._board.posted.process)
        except Exception as error:  # noqa: BLE001  told once below, and shown on the page
            self._tell_failed(
                error, code="ALARMS_FAILED", what="alarms cannot be raised", remedy="Do not navigate. "
            )

    def _status(self, process: ProcessStatus) -> ProcessStatus:
        problem = process.problem or (self._problem if process.state is ProcessState.RUNNING else None)
        return replace(process, problem=problem, dropped_images=self._dropped)

    def _publish(self, process: ProcessStatus, source: SourceStatus, shown: Shown) -> None:
        instant = Instant(
            sequence=self._sequence,
            source=source,
            process=self._status(process),
            snapshot=shown.snapshot,
            jpeg=shown.jpeg,
            drawn=shown.drawn,
            image=shown.image,
            server_ms=shown.server_ms,
            alarms=self._alarms,
        )
        self._shown = shown
        self._sequence += 1
        self._last, self._last_at_s = instant, time.monotonic()
        self._hub.publish(instant)

    def _drawn(self, snapshot: NavigationSnapshot, image: Image) -> Shown:
        """The picture of a snapshot; nothing at all when it cannot be drawn, and why in the status."""
        if not self._picture.is_watched():
            # Whoever comes now gets this image drawn for them alone; the next one is drawn here.
            return Shown(snapshot=snapshot, image=image)
        started_s = time.monotonic()
        try:
            drawn = self._picture.draw(image, snapshot, self._alarms)
            drawn_s = time.monotonic()
            jpeg = self._picture.encode(drawn) if self._picture.is_watched_in_full() else b""
        except Exception as error:  # noqa: BLE001  told once below, and shown on the page
            self._tell_failed(error, code="OVERLAY_FAILED", what="the overlay cannot be drawn")
            return Shown()
        done_s = time.monotonic()
        server_ms = {"overlay": (drawn_s - started_s) * 1e3}
        if jpeg:
            server_ms["encode"] = (done_s - drawn_s) * 1e3
        return Shown(snapshot=snapshot, image=image, jpeg=jpeg, drawn=drawn, server_ms=server_ms)

    def _tell_failed(self, error: Exception, *, code: str, what: str, remedy: str = "") -> None:
        sentence = f"{type(error).__name__}: {error}"
        self._problem = Problem(
            code=code,
            message=f"{what}: {sentence}",
            remedy=f"{remedy}Start the program again; if it stays, report it with the log.",
        )
        if self._told != f"{code} {sentence}":
            self._told = f"{code} {sentence}"
            log.error(what, exc_info=error)
