"""Registrations as the open case keeps them, version by version, each of one vertebra.

A vertebra has one registration for all its channels. It depends on the plan, the camera and the tool that
touched: going to the other side keeps it, and any new version of the plan ends it, because landmarks may
have moved. A failed check is stored and counts even where no check is required.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from server.errors import SetupOrderError
from server.procedure.opened import opened_case
from server.procedure.registered import KeptRegistration, Value, kept_registration
from server.procedure.registration.ground import Ground
from server.procedure.state import Brought, Procedure
from server.store import CaseStore, Document, DocumentKind, Standing
from tracker.registration import Registration


@dataclass(frozen=True, slots=True, kw_only=True)
class ShelvedRegistration:
    """A registration with its document.

    Attributes:
        kept: what is kept of it.
        document: as it is stored.
        standing: whether it still holds.
    """

    kept: KeptRegistration
    document: Document
    standing: Standing


class RegistrationRepository:
    """Where registrations of the open case lie; safe to use from any thread.

    Args:
        store: where they are kept.
        procedure: knows which vertebra is to be drilled, and which run of the server this is.
        brought: by the settings.
    """

    def __init__(self, store: CaseStore, *, procedure: Procedure, brought: Brought) -> None:
        self._store = store
        self._procedure = procedure
        self._brought = brought

    def newest(self, vertebra: str | None = None) -> ShelvedRegistration:
        """The newest registration of a vertebra; of the one that is to be drilled if none is named.

        Raises:
            SetupOrderError: NO_CASE_OPEN, REGISTER_MISSING.
            InvalidInput: REGISTRATION_DOCUMENT_INVALID.
            RegistrationError: REFERENCE_DIFFERS.
        """
        case = opened_case(self._store)
        name = vertebra or self._procedure.active_vertebra(case.id)
        document = None if name is None else self._store.latest(case.id, DocumentKind.REGISTRATION, name)
        if document is None:
            raise SetupOrderError(
                "REGISTER_MISSING",
                f"{name or 'the vertebra that is to be drilled'} is not registered",
                "Register: touch the landmarks of the plan.",
                {"vertebra": name},
            )
        return ShelvedRegistration(
            kept=kept_registration(document, reference=self._brought.reference),
            document=document,
            standing=self._store.standing(document),
        )

    def current(self, vertebra: str | None = None) -> ShelvedRegistration:
        """The same, if it holds.

        Raises:
            SetupOrderError: NO_CASE_OPEN, REGISTER_MISSING.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
        """
        newest = self.newest(vertebra)
        document = newest.document
        self._store.current(document.case_id, DocumentKind.REGISTRATION, document.name)
        return newest

    def put(
        self,
        ground: Ground,
        registration: Registration,
        *,
        numbers: dict[str, Value],
        made_from: dict[str, object],
        made_by: str,
        from_s: float | None,
        also_on: Sequence[str] = (),
        expected_version: int | None = None,
    ) -> Document:
        """Keep a registration that passed its gate, as the next version of its vertebra's.

        Raises:
            StoreConflict: VERSION_CONFLICT.
        """
        kept = KeptRegistration.of(
            registration,
            vertebra=ground.vertebra.name,
            reference=ground.reference,
            run=self._procedure.run,
            numbers=numbers,
            made_from=made_from,
            from_s=from_s,
        )
        return self._store.put(
            ground.case_id,
            DocumentKind.REGISTRATION,
            ground.vertebra.name,
            kept.model_dump(mode="json"),
            made_by=made_by,
            stands_on=[*ground.documents, *also_on],
            expected_version=expected_version,
        )

    def put_again(self, shelved: ShelvedRegistration, kept: KeptRegistration, *, made_by: str) -> Document:
        """Keep a changed registration on the same ground, as the next version.

        Raises:
            StoreConflict: VERSION_CONFLICT, somebody else changed it meanwhile.
        """
        document = shelved.document
        return self._store.put(
            document.case_id,
            DocumentKind.REGISTRATION,
            document.name,
            kept.model_dump(mode="json"),
            made_by=made_by,
            stands_on=document.stands_on,
            expected_version=document.version,
        )
