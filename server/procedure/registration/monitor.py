"""Withdraws a registration, or its check, after a move of the camera or of the reference marker.

Tracking must report the move in all images for `registration.moved_after_s`.
"""

import structlog

from server.live import Instant, LiveHub
from server.procedure.live_listener import LiveListener
from server.procedure.registration_record import check_name
from server.procedure.state import Procedure
from server.store import CaseStore, Document, DocumentKind
from server.texts import WITHDRAWALS
from tracker.errors import NavigationError
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot

MOVED = {
    AbsentReason.CAMERA_MOVED: WITHDRAWALS["CAMERA_MOVED"]["en"],
    AbsentReason.REFERENCE_MOVED: WITHDRAWALS["REFERENCE_MOVED"]["en"],
}
WITHDRAWN_BY = "Coaxial"
MIN_PAUSE_S = 0.05
log = structlog.get_logger(__name__)


class RegistrationMonitor:
    """Withdraws the documents that a persistent move invalidates.

    A move of the camera withdraws the registration. A move of the reference marker withdraws the check only:
    the patient may have moved with the marker, which the next check decides.

    Args:
        hub: the live images.
        store: where registrations are stored.
        procedure: provides the vertebra of the active channel.
        after_s: how long the move must be reported.
    """

    def __init__(self, hub: LiveHub, *, store: CaseStore, procedure: Procedure, after_s: float) -> None:
        self._store = store
        self._procedure = procedure
        self._after_s = after_s
        self._reason: AbsentReason | None = None
        self._since_s = 0.0
        self._lost_id: str | None = None
        self._listener = LiveListener(hub, self._process, name="watching for moves", min_pause_s=MIN_PAUSE_S)

    def stop(self) -> None:
        """Stop monitoring."""
        self._listener.stop()

    def _process(self, instant: Instant) -> None:
        snapshot = instant.snapshot
        reason = None if snapshot is None else moved(snapshot)
        if snapshot is None or reason is None:
            self._reason = None
            return
        try:
            if reason is not self._reason:
                self._begin(reason, snapshot.captured_at_s)
            elif snapshot.captured_at_s - self._since_s >= self._after_s:
                self._withdraw(reason)
                self._begin(reason, snapshot.captured_at_s)
        except NavigationError as error:
            # Retried after `after_s`, because the move is still reported.
            self._reason = None
            log.exception(error.message, code=error.code, remedy=error.remedy)

    def _begin(self, reason: AbsentReason, at_s: float) -> None:
        lost = self._lost_by(reason)
        self._reason, self._since_s = reason, at_s
        self._lost_id = None if lost is None else lost.id

    def _withdraw(self, reason: AbsentReason) -> None:
        lost = self._lost_by(reason)
        # A document made meanwhile is newer than the move that older images still report.
        if lost is not None and lost.id == self._lost_id:
            self._store.withdraw(lost, by=WITHDRAWN_BY, reason=MOVED[reason])
            log.warning("document withdrawn after a move", document=lost.title, reason=MOVED[reason])

    def _lost_by(self, reason: AbsentReason) -> Document | None:
        case = self._store.get_open_case()
        vertebra = None if case is None else self._procedure.active_vertebra(case.id)
        if case is None or vertebra is None:
            return None
        # A patient who moved with the marker is still registered correctly; a check decides.
        if reason is AbsentReason.REFERENCE_MOVED:
            return self._store.latest(case.id, DocumentKind.CHECK, check_name(vertebra))
        return self._store.latest(case.id, DocumentKind.REGISTRATION, vertebra)


def moved(snapshot: NavigationSnapshot) -> AbsentReason | None:
    """Return which part tracking reports as moved, or None."""
    reason = snapshot.vertebra.reason if isinstance(snapshot.vertebra, Absent) else snapshot.setup.withheld
    return reason if reason in MOVED else None
