"""Publishes the newest report of the tracking process as the newest instant.

Reports that arrive while one is published are dropped and counted. An instant is published at least once a
second, and never with an image that is known to be stale. Alarms are evaluated with every image before it is
published, so that they are published with the image that raised them, and twenty times a second without an
image, so that missing images raise an alarm. Overlays are drawn elsewhere (`server/stream/scaling`).
"""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import structlog

from server.alarms import without_alarms
from server.live import (
    Instant,
    LiveHub,
    Problem,
    ProcessState,
    ProcessStatus,
    ProposedChannel,
    SourceState,
    SourceStatus,
)
from server.loop.report import Report, ReportUnpacker
from server.loop.shared_status import ProcessView, SharedStatus
from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import QUIET, AlarmSnapshot

Image: TypeAlias = npt.NDArray[np.uint8]
ChannelProposal: TypeAlias = Callable[[NavigationSnapshot], ProposedChannel | None]
AlarmCheck: TypeAlias = Callable[[NavigationSnapshot | None, SourceStatus, ProcessStatus], AlarmSnapshot]
HEARTBEAT_S = 0.9
TICK_S = 0.05
# An alarm between two images is published with the previous image, if that is no older than this.
SHOWN_AGAIN_S = 0.15

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class PublishedImage:
    """An image with its snapshot and the channel proposed with it; all are None without an image."""

    snapshot: NavigationSnapshot | None = None
    image: Image | None = None
    proposed_channel: ProposedChannel | None = None


class Publisher:
    """Publishes what the tracking process reports, in its own thread."""

    def __init__(
        self,
        *,
        status: SharedStatus,
        hub: LiveHub,
        check_alarms: AlarmCheck = without_alarms,
        picture_problem: Callable[[], Problem | None] = lambda: None,
        propose_channel: ChannelProposal = lambda _: None,
    ) -> None:
        self._propose_channel = propose_channel
        self._shared = status
        self._hub = hub
        self._picture_problem = picture_problem
        self._check_alarms = check_alarms
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
        self._shown = PublishedImage()
        self._logged_failure = ""
        self._thread = threading.Thread(target=self._run, name="publisher", daemon=True)

    def start(self) -> None:
        """Start publishing."""
        self._thread.start()

    def stop(self) -> None:
        """Stop publishing."""
        self._stop.set()
        self._shared.wake()
        self._thread.join(1.0)

    def _run(self) -> None:
        while not self._stop.is_set():
            try:
                self.publish_newest()
            except Exception:
                # If this thread ended, the server would look alive and show nothing.
                log.exception("an instant could not be published")
                self._stop.wait(HEARTBEAT_S)
            self._shared.wait(min(self._last_at_s + HEARTBEAT_S - time.monotonic(), TICK_S))

    def publish_newest(self) -> None:
        """Publish the newest report, a change of the process, or a heartbeat when it is due."""
        current = self._shared.current
        report, image = self._newest(current)
        if report is None:
            self._publish_without_image(current)
            return
        self._shared.set_running(current.generation)
        self._shared.set_source(report.source)
        self._shared.set_played_scene(report.played_scene)
        self._problem = report.problem
        snapshot = None if image is None else report.snapshot
        self._update_alarms(snapshot, report.source)
        shown = PublishedImage()
        if snapshot is not None:
            proposed = self._propose_channel(snapshot)
            shown = PublishedImage(snapshot=snapshot, image=image, proposed_channel=proposed)
        now = self._shared.current
        if now.generation != current.generation:
            # The process died while its image was processed.
            self._publish_without_image(now)
            return
        self._publish(now.process, report.source, shown)

    def _newest(self, current: ProcessView) -> tuple[Report | None, Image | None]:
        if current.generation != self._generation:
            self._generation, self._read, self._tracked, self._problem = current.generation, 0, 0, None
        if current.ring is None:
            return None, None
        entry = current.ring.newest(after=self._read)
        if entry is None:
            return None, None
        self._read = entry.sequence
        report = self._unpacker.unpack(entry.payload)
        shown = 1 if report.snapshot is not None else 0
        self._dropped += max(0, report.tracked_images - self._tracked - shown)
        self._tracked = report.tracked_images
        return report, entry.image

    def _publish_without_image(self, current: ProcessView) -> None:
        """Publish a change of process or alarms at once, otherwise a heartbeat."""
        last, now_s = self._last, time.monotonic()
        source = self._shared.source
        if current.process.state is not ProcessState.RUNNING:
            source = replace(source, state=SourceState.OPENING, problem=None, rate_hz=0.0)
        self._update_alarms(None, source)
        process = self._status(current.process)
        changed = last is None or (last.process.state, last.process.problem) != (
            process.state,
            process.problem,
        )
        if changed or now_s - self._last_at_s >= HEARTBEAT_S:
            self._publish(current.process, source, PublishedImage())
        elif last is not None and last.alarms.revision != self._alarms.revision:
            snapshot = self._shown.snapshot
            young = snapshot is not None and now_s - snapshot.captured_at_s <= SHOWN_AGAIN_S
            self._publish(current.process, source, self._shown if young else PublishedImage())

    def _update_alarms(self, snapshot: NavigationSnapshot | None, source: SourceStatus) -> None:
        """Evaluate the alarms; a failure is reported as a problem, and the video continues."""
        try:
            self._alarms = self._check_alarms(snapshot, source, self._shared.current.process)
        except Exception as error:  # noqa: BLE001  logged once below, and shown on the page
            self._report_failure(error)

    def _status(self, process: ProcessStatus) -> ProcessStatus:
        problem = process.problem
        if problem is None and process.state is ProcessState.RUNNING:
            problem = self._problem or self._picture_problem()
        return replace(process, problem=problem, dropped_images=self._dropped)

    def _publish(self, process: ProcessStatus, source: SourceStatus, shown: PublishedImage) -> None:
        instant = Instant(
            sequence=self._sequence,
            source=source,
            process=self._status(process),
            snapshot=shown.snapshot,
            image=shown.image,
            alarms=self._alarms,
            proposed_channel=shown.proposed_channel,
        )
        self._shown = shown
        self._sequence += 1
        self._last, self._last_at_s = instant, time.monotonic()
        self._hub.publish(instant)

    def _report_failure(self, error: Exception) -> None:
        reason = f"{type(error).__name__}: {error}"
        self._problem = Problem(
            code="ALARMS_FAILED",
            message=f"alarms cannot be raised: {reason}",
            remedy="Do not navigate. Restart the program; if the error persists, send the server log to the "
            "maintainer.",
            context={"library_error": reason},
        )
        if self._logged_failure != reason:
            self._logged_failure = reason
            log.error("alarms cannot be raised", exc_info=error)
