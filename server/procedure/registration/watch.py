"""Withdraws a registration when tracking says, and goes on saying, that camera or reference were moved."""

import structlog

from server.live import Instant, LiveHub
from server.procedure.following import Follower
from server.procedure.state import Procedure
from server.store import CaseStore, DocumentKind
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
    """Looks at every image; a move that is said in all images for a while withdraws the registration.

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
        if reason is not self._reason:
            self._reason, self._since_s = reason, snapshot.captured_at_s
        if snapshot.captured_at_s - self._since_s >= self._after_s:
            self._reason = None
            self._withdraw(MOVED[reason])

    def _withdraw(self, why: str) -> None:
        try:
            case = self._store.opened()
            vertebra = None if case is None else self._procedure.active_vertebra(case.id)
            if case is None or vertebra is None:
                return
            document = self._store.latest(case.id, DocumentKind.REGISTRATION, vertebra)
            if document is not None:
                self._store.withdraw(document, by=WATCHER, reason=why)
                log.warning("a registration was withdrawn", document=document.title, reason=why)
        except NavigationError as error:
            # It is tried again after as long, as the move goes on being said.
            log.exception(error.message, code=error.code, remedy=error.remedy)


def moved(snapshot: NavigationSnapshot) -> AbsentReason | None:
    """What tracking says was moved, if anything."""
    said = snapshot.vertebra.reason if isinstance(snapshot.vertebra, Absent) else snapshot.setup.withheld
    return said if said in MOVED else None
