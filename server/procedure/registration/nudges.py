"""Manual corrections (nudges): each nudge and each undo stores a new version of the registration."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime

import numpy as np

from server.clock import utc_now, utc_text
from server.config import RegistrationConfig
from server.procedure.registration.context import RegistrationContextFinder
from server.procedure.registration.repository import RegistrationRepository, StoredRegistration
from server.procedure.registration_record import (
    NudgeHistory,
    NudgeRecord,
    RegistrationEvidence,
    RegistrationRecord,
)
from server.store import Document
from tracker.geometry import Array
from tracker.registration.nudge import Nudge, NudgedRegistration, NudgeLimits


@dataclass(frozen=True, slots=True, kw_only=True)
class NudgeStatus:
    """The current nudges.

    Attributes:
        stored: the registration with them.
        nudges: oldest first.
        shift_mm: total displacement between the entry points.
        rotation_deg: total rotation.
        limits: limits of both.
    """

    stored: StoredRegistration
    nudges: tuple[NudgeRecord, ...]
    shift_mm: float
    rotation_deg: float
    limits: NudgeLimits


class NudgeStep:
    """Applies nudges to the registration of the active vertebra. Thread-safe.

    Args:
        contexts: provides the entry points.
        repository: where registrations are stored.
        gate: limits of the nudges.
        clock: the wall clock, in UTC.
    """

    def __init__(
        self,
        *,
        contexts: RegistrationContextFinder,
        repository: RegistrationRepository,
        gate: RegistrationConfig,
        clock: Callable[[], datetime] = utc_now,
    ) -> None:
        self._contexts = contexts
        self._repository = repository
        self._limits = NudgeLimits(max_mm=gate.max_nudge_mm, max_deg=gate.max_nudge_deg)
        self._clock = clock

    def status(self) -> NudgeStatus:
        """Return the current nudges.

        Raises:
            SetupOrderError: NO_CASE_OPEN, REGISTER_MISSING.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
        """
        stored = self._repository.current()
        nudged, nudges = self._nudged(stored)
        return NudgeStatus(
            stored=stored,
            nudges=nudges,
            shift_mm=nudged.shift_mm,
            rotation_deg=nudged.rotation_deg,
            limits=self._limits,
        )

    def apply(self, nudge: Nudge, *, made_by: str) -> Document:
        """Apply a nudge; the registration then needs another check on anatomy.

        Raises:
            SetupOrderError: NO_CASE_OPEN, REGISTER_MISSING.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
            RegistrationError: NUDGE_TOO_FAR.
            StoreConflict: VERSION_CONFLICT, another person corrected it at the same time.
        """
        stored = self._repository.current()
        nudged, nudges = self._nudged(stored)
        after = nudged.nudged(nudge)
        at = utc_text(self._clock())
        one = NudgeRecord(kind=nudge.kind, axis=nudge.axis, amount=nudge.amount, made_by=made_by, made_at=at)
        return self._put(stored, after, (*nudges, one), made_by=made_by)

    def undo(self, *, made_by: str) -> Document:
        """Undo the last nudge.

        Raises:
            RegistrationError: NUDGE_NONE.
            SetupOrderError, OutOfDateError, StoreConflict: as `apply`.
        """
        stored = self._repository.current()
        nudged, nudges = self._nudged(stored)
        return self._put(stored, nudged.undone(), nudges[:-1], made_by=made_by)

    def _nudged(self, stored: StoredRegistration) -> tuple[NudgedRegistration, tuple[NudgeRecord, ...]]:
        registration, history = stored.record.registration, stored.record.nudged
        if history is None:
            made = NudgedRegistration(
                made=registration, pivot_mm=self._middle_entry(stored), limits=self._limits
            )
            return made, ()
        nudges = tuple(Nudge(kind=one.kind, axis=one.axis, amount=one.amount) for one in history.nudges)
        nudged = NudgedRegistration(
            made=history.made(registration),
            pivot_mm=np.array(history.pivot_lps_mm),
            limits=self._limits,
            nudges=nudges,
        )
        return nudged, tuple(history.nudges)

    def _middle_entry(self, stored: StoredRegistration) -> Array:
        context = self._contexts.find(vertebra=stored.record.vertebra, tool=None)
        return np.asarray(np.mean(context.entries_mm, axis=0))

    def _put(
        self,
        stored: StoredRegistration,
        after: NudgedRegistration,
        nudges: tuple[NudgeRecord, ...],
        *,
        made_by: str,
    ) -> Document:
        registration = after.registration
        changed = RegistrationRecord.of(
            registration,
            RegistrationEvidence(
                numbers={
                    **stored.record.numbers,
                    "nudges": len(nudges),
                    "nudged_mm": after.shift_mm,
                    "nudged_deg": after.rotation_deg,
                },
                made_from=stored.record.made_from,
                from_s=stored.record.from_s,
            ),
            vertebra=stored.record.vertebra,
            reference=stored.record.reference,
            run=stored.record.run,
        )
        history = NudgeHistory(
            anchor_from_vertebra=after.made.anchor_from_vertebra.matrix.tolist(),
            covariance=after.made.covariance.tolist(),
            pivot_lps_mm=after.pivot_mm.tolist(),
            nudges=list(nudges),
        )
        with_nudges = changed.model_copy(update={"nudged": history if nudges else None})
        return self._repository.put_again(stored, with_nudges, made_by=made_by)
