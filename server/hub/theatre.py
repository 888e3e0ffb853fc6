"""What the web process gives to the publisher: messages by a sink, alarms and audit by the outbox."""

import json
import sqlite3
import threading
import time
from collections import deque
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import cv2
import numpy as np
import structlog

from server.alarms import StoredAlarmLog
from server.alarms.entries import Line
from server.config import Config
from server.hub.connection import HubAddress, HubError
from server.hub.outbox import Outbox
from server.hub.pictures import PICTURE_WIDTH_PX
from server.hub.publisher import Outgoing, Publisher, PublisherSettings
from server.hub.subjects import Leaf
from server.live import Instant, LiveHub
from server.logs import LogSettings
from server.overlay import OverlayContent, draw_overlay, encode_jpeg
from server.security import AuditLog
from server.sinks import Sink, SinkStatus
from server.stream.scaling.message_cache import MessageCache

NAME = "hub"
PICTURE_QUALITY = 70
HEAD_PERIOD_S = 1.0
MAX_PENDING = 10_000
log = structlog.get_logger(__name__)


class HubPublication:
    """Publishes the theatre of a server; `HubPublication.of` returns None where it is off.

    Nothing waits for it: instants are skipped while the process is busy, and entries are appended by the
    alarm log's thread, after they were stored there.
    """

    def __init__(
        self,
        hub: LiveHub,
        settings: PublisherSettings,
        *,
        picture_rate_hz: float,
        alarms: StoredAlarmLog,
        audit: AuditLog,
        log_settings: LogSettings,
    ) -> None:
        self._outbox = Outbox(settings.home)
        self._picture_period_s = 1.0 / picture_rate_hz if picture_rate_hz > 0.0 else float("inf")
        self._picture_at_s = 0.0 if picture_rate_hz > 0.0 else float("inf")
        self._texts = MessageCache()
        self._audit = audit
        self._sent_head = 0
        self._pending: deque[tuple[Leaf, str]] = deque(maxlen=MAX_PENDING)
        self._lock = threading.Lock()
        self._stop = threading.Event()
        self._heads = threading.Thread(target=self._follow_audit, name="hub audit", daemon=True)
        self._sink = Sink(
            NAME, hub, write=self._outgoing, settings=log_settings, open_sink=partial(Publisher, settings)
        )
        alarms.on_stored = self._append_alarms

    @classmethod
    def of(
        cls,
        config: Config,
        hub: LiveHub,
        *,
        home: Path,
        alarms: StoredAlarmLog,
        audit: AuditLog,
        log_settings: LogSettings,
    ) -> "HubPublication | None":
        """Return the publication of the settings; None if it is off.

        Raises:
            HubError: HUB_THEATRE_MISSING, HUB_CREDENTIALS_UNUSABLE, HUB_OUTBOX_UNUSABLE.
        """
        if config.hub.url is None:
            return None
        if config.hub.theatre is None:
            raise HubError(
                "HUB_THEATRE_MISSING",
                f"hub.url is {config.hub.url}, but hub.theatre does not name this theatre",
                "Set hub.theatre to a name that no other theatre has, or hub.url to null.",
                {"url": config.hub.url},
            )
        settings = PublisherSettings(
            address=HubAddress.of(config.hub),
            theatre=config.hub.theatre,
            home=home,
            max_rate_hz=config.hub.max_rate_hz,
        )
        try:
            return cls(
                hub,
                settings,
                picture_rate_hz=config.hub.picture_rate_hz,
                alarms=alarms,
                audit=audit,
                log_settings=log_settings,
            )
        except sqlite3.Error as error:
            raise HubError(
                "HUB_OUTBOX_UNUSABLE",
                f"the outbox of the hub in {home} cannot be used: {error}",
                "Check the disk and the rights of this folder. A damaged outbox may be moved away while the "
                "server is stopped: what the hub has not stored yet is then in the theatre's own logs only.",
                {"folder": str(home), "library_error": str(error)},
            ) from error

    def start(self) -> None:
        """Start; returns at once."""
        self._heads.start()
        self._sink.start()

    def stop(self) -> None:
        """Give up the name on the hub, and stop."""
        self._stop.set()
        self._sink.stop()
        if self._heads.ident is not None:
            self._heads.join()
        self._outbox.close()

    @property
    def status(self) -> SinkStatus:
        """State of the publication. From any thread."""
        return self._sink.status

    def _outgoing(self, instant: Instant) -> Outgoing:
        snapshot, now_s = instant.snapshot, time.monotonic()
        picture = b""
        if snapshot is not None and instant.image is not None and now_s >= self._picture_at_s:
            self._picture_at_s = now_s + self._picture_period_s
            # Without figures, so that none in it is older than those beside it.
            drawn = draw_overlay(instant.image, snapshot, content=OverlayContent.GEOMETRY)
            height, width = drawn.shape[:2]
            size = (PICTURE_WIDTH_PX, max(1, round(height * PICTURE_WIDTH_PX / width)))
            small = cv2.resize(drawn, size, interpolation=cv2.INTER_AREA)
            picture = encode_jpeg(np.asarray(small, np.uint8), PICTURE_QUALITY)
        return Outgoing(
            text=self._texts.of(instant, now_s=time.monotonic()),
            captured_at_s=None if snapshot is None else snapshot.captured_at_s,
            picture=picture,
        )

    def _append_alarms(self, lines: Sequence[Line]) -> None:
        self._append([(Leaf.ALARM, json.dumps(line, ensure_ascii=False)) for line in lines])

    def _follow_audit(self) -> None:
        while True:
            head = self._audit.head
            if head.count != self._sent_head:
                self._sent_head = head.count
                self._append([(Leaf.AUDIT, json.dumps({"count": head.count, "sum": head.sum}))])
            elif self._pending:
                self._append([])
            if self._stop.wait(HEAD_PERIOD_S):
                return

    def _append(self, entries: Sequence[tuple[Leaf, str]]) -> None:
        """Append to the outbox; what a full disk rejects is tried again with the next entries."""
        with self._lock:
            self._pending.extend(entries)
            try:
                while self._pending:
                    leaf, content = self._pending[0]
                    self._outbox.append(leaf, [content])
                    self._pending.popleft()
            except sqlite3.Error as error:
                log.warning("the outbox of the hub cannot be written", why=str(error))
