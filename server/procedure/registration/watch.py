"""Withdraws a registration, or its check, when tracking keeps saying that camera or reference were moved.

It withdraws once all images have said so for `registration.moved_after_s`.
"""

import structlog

from server.live import Instant, LiveHub
from server.procedure.following import Follower
from server.procedure.registered import check_name
from server.procedure.state import Procedure
from server.store import CaseStore, Document, DocumentKind
from tracker.errors import NavigationError
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot

MOVED = {
    AbsentReason.CAMERA_MOVED: "the camera stands elsewhere than when it was registered",
    AbsentReason.REFERENCE_MOVED: "the marker on the patient stands elsewhere than when it was registered",
}
WATCHER = "Coaxial"
REST_S = 0.05
log = structlog.get_logger(__name__)


class MoveWatch:
    """Looks at every image; a move that is said in all images for a while is written into the case.

    A move of the camera withdraws a registration, which is before it. A move of the marker on the patient
    withdraws the check: whether the patient moved with it, the next check tells.

    Args:
        hub: the live images.
        store: where registrations are kept.
        procedure: knows which vertebra is to be drilled.
        after_s: how long it must be said.
    """

    def __init__(self, hub: LiveHub, *, store: CaseStore, procedure: Procedure, after_s: float) -> None:
        self._store = store
        self._procedure = procedure
        self._after_s = after_s
        self._reason: AbsentReason | None = None
        self._since_s = 0.0
        self._lost_id: str | None = None
        self._follower = Follower(hub, self._look, name="watching for moves", rest_s=REST_S)

    def stop(self) -> None:
        """Look no more."""
        self._follower.stop()

    def _look(self, instant: Instant) -> None:
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
            # It is tried again after as long, as the move goes on being said.
            self._reason = None
            log.exception(error.message, code=error.code, remedy=error.remedy)

    def _begin(self, reason: AbsentReason, at_s: float) -> None:
        lost = self._lost_by(reason)
        self._reason, self._since_s = reason, at_s
        self._lost_id = None if lost is None else lost.id

    def _withdraw(self, reason: AbsentReason) -> None:
        lost = self._lost_by(reason)
        # What was made meanwhile is newer than the move that old images still tell.
        if lost is not None and lost.id == self._lost_id:
            self._store.withdraw(lost, by=WATCHER, reason=MOVED[reason])
            log.warning("withdrawn because something moved", document=lost.title, reason=MOVED[reason])

    def _lost_by(self, reason: AbsentReason) -> Document | None:
        case = self._store.opened()
        vertebra = None if case is None else self._procedure.active_vertebra(case.id)
        if case is None or vertebra is None:
            return None
        # A patient who moves with the marker is still where the registration says: a check tells.
        if reason is AbsentReason.REFERENCE_MOVED:
            return self._store.latest(case.id, DocumentKind.CHECK, check_name(vertebra))
        return self._store.latest(case.id, DocumentKind.REGISTRATION, vertebra)


def moved(snapshot: NavigationSnapshot) -> AbsentReason | None:
    """What tracking says was moved, if anything."""
    said = snapshot.vertebra.reason if isinstance(snapshot.vertebra, Absent) else snapshot.setup.withheld
    return said if said in MOVED else None
