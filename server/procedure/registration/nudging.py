"""Nudges by hand in the theatre: each one, and each undone one, makes a new version of the registration."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime

import numpy as np

from server.clock import utc_now, utc_text
from server.config import RegistrationConfig
from server.procedure.registered import KeptNudge, KeptNudges, KeptRegistration
from server.procedure.registration.ground import GroundFinder
from server.procedure.registration.repository import RegistrationRepository, ShelvedRegistration
from server.store import Document
from tracker.geometry import Array
from tracker.registration.nudge import Nudge, NudgedRegistration, NudgeLimits


@dataclass(frozen=True, slots=True, kw_only=True)
class NudgesStatus:
    """The nudges that hold.

    Attributes:
        shelved: the registration with them.
        nudges: the oldest first.
        shift_mm: how far all of them lead at the entry point.
        turn_deg: how far they turn it.
        limits: how far they may.
    """

    shelved: ShelvedRegistration
    nudges: tuple[KeptNudge, ...]
    shift_mm: float
    turn_deg: float
    limits: NudgeLimits


class NudgeStep:
    """Nudges the registration of the vertebra that is to be drilled. Safe to use from any thread.

    Args:
        grounds: says where the entry point is.
        shelf: where registrations are kept.
        gate: how far nudges may lead.
        clock: the wall clock, in UTC.
    """

    def __init__(
        self,
        *,
        grounds: GroundFinder,
        repository: RegistrationRepository,
        gate: RegistrationConfig,
        clock: Callable[[], datetime] = utc_now,
    ) -> None:
        self._grounds = grounds
        self._repository = repository
        self._limits = NudgeLimits(max_mm=gate.max_nudge_mm, max_deg=gate.max_nudge_deg)
        self._clock = clock

    def status(self) -> NudgesStatus:
        """The nudges that hold now.

        Raises:
            SetupOrderError: NO_CASE_OPEN, REGISTER_MISSING.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
        """
        shelved = self._repository.current()
        nudged, kept = self._nudged(shelved)
        return NudgesStatus(
            shelved=shelved,
            nudges=kept,
            shift_mm=nudged.shift_mm,
            turn_deg=nudged.turn_deg,
            limits=self._limits,
        )

    def apply(self, nudge: Nudge, *, made_by: str) -> Document:
        """One nudge more; it has to be checked on anatomy again.

        Raises:
            SetupOrderError: NO_CASE_OPEN, REGISTER_MISSING.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
            RegistrationError: NUDGE_TOO_FAR.
            StoreConflict: VERSION_CONFLICT, somebody else nudged it in the same moment.
        """
        shelved = self._repository.current()
        nudged, kept = self._nudged(shelved)
        after = nudged.nudged(nudge)
        at = utc_text(self._clock())
        one = KeptNudge(kind=nudge.kind, axis=nudge.axis, amount=nudge.amount, made_by=made_by, made_at=at)
        return self._put(shelved, after, (*kept, one), made_by=made_by)

    def undo(self, *, made_by: str) -> Document:
        """The last nudge taken back.

        Raises:
            RegistrationError: NUDGE_NONE.
            SetupOrderError, OutOfDateError, StoreConflict: as `apply`.
        """
        shelved = self._repository.current()
        nudged, kept = self._nudged(shelved)
        return self._put(shelved, nudged.undone(), kept[:-1], made_by=made_by)

    def _nudged(self, shelved: ShelvedRegistration) -> tuple[NudgedRegistration, tuple[KeptNudge, ...]]:
        registration, kept = shelved.kept.registration, shelved.kept.nudged
        if kept is None:
            made = NudgedRegistration(
                made=registration, pivot_mm=self._middle_entry(shelved), limits=self._limits
            )
            return made, ()
        nudges = tuple(Nudge(kind=one.kind, axis=one.axis, amount=one.amount) for one in kept.nudges)
        nudged = NudgedRegistration(
            made=kept.made(registration),
            pivot_mm=np.array(kept.pivot_lps_mm),
            limits=self._limits,
            nudges=nudges,
        )
        return nudged, tuple(kept.nudges)

    def _middle_entry(self, shelved: ShelvedRegistration) -> Array:
        ground = self._grounds.find(vertebra=shelved.kept.vertebra, tool=None)
        return np.asarray(np.mean(ground.entries_mm, axis=0))

    def _put(
        self,
        shelved: ShelvedRegistration,
        after: NudgedRegistration,
        nudges: tuple[KeptNudge, ...],
        *,
        made_by: str,
    ) -> Document:
        registration = after.registration
        changed = KeptRegistration.of(
            registration,
            vertebra=shelved.kept.vertebra,
            reference=shelved.kept.reference,
            run=shelved.kept.run,
            numbers={
                **shelved.kept.numbers,
                "nudges": len(nudges),
                "nudged_mm": after.shift_mm,
                "nudged_deg": after.turn_deg,
            },
            made_from=shelved.kept.made_from,
            from_s=shelved.kept.from_s,
        )
        kept = KeptNudges(
            anchor_from_vertebra=after.made.anchor_from_vertebra.matrix.tolist(),
            covariance=after.made.covariance.tolist(),
            pivot_lps_mm=after.pivot_mm.tolist(),
            nudges=list(nudges),
        )
        with_nudges = changed.model_copy(update={"nudged": kept if nudges else None})
        return self._repository.put_again(shelved, with_nudges, made_by=made_by)
