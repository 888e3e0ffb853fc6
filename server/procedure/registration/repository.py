"""Repository of the registrations in the open case, one per vertebra, with versions.

A vertebra has one registration for all its channels. It depends on the plan, the camera and the tool that
captured the points. It stays valid when the other side becomes active, and any new version of the plan
invalidates it, because landmarks may have moved. A failed check is stored and counts even if no check is
required.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from server.errors import SetupOrderError
from server.procedure.open_case import require_open_case
from server.procedure.registration.context import RegistrationContext
from server.procedure.registration_record import (
    RegistrationEvidence,
    RegistrationRecord,
)
from server.procedure.state import Procedure, SetupDefaults
from server.store import CaseStore, Document, DocumentKind, Validity
from tracker.registration import Registration


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredRegistration:
    """A registration with its document.

    Attributes:
        record: its content.
        document: the stored document.
        validity: whether it is still valid.
    """

    record: RegistrationRecord
    document: Document
    validity: Validity


class RegistrationRepository:
    """Reads and stores the registrations of the open case. Thread-safe.

    Args:
        store: the case store.
        procedure: provides the vertebra of the active channel, and the run of the server.
        defaults: setup from the settings.
    """

    def __init__(self, store: CaseStore, *, procedure: Procedure, defaults: SetupDefaults) -> None:
        self._store = store
        self._procedure = procedure
        self._defaults = defaults

    def newest(self, vertebra: str | None = None) -> StoredRegistration:
        """Return the newest registration of a vertebra; by default of that of the active channel.

        Raises:
            SetupOrderError: NO_CASE_OPEN, REGISTER_MISSING.
            InvalidInput: REGISTRATION_DOCUMENT_INVALID.
            RegistrationError: REFERENCE_DIFFERS.
        """
        case = require_open_case(self._store)
        name = vertebra or self._procedure.active_vertebra(case.id)
        document = None if name is None else self._store.latest(case.id, DocumentKind.REGISTRATION, name)
        if document is None:
            raise SetupOrderError(
                "REGISTER_MISSING",
                f"{name or 'the vertebra of the active channel'} is not registered",
                "Register by touching the landmarks of the plan.",
                {"vertebra": name, "unregistered": name or "the vertebra of the active channel"},
            )
        return StoredRegistration(
            record=self._defaults.registration_from(document),
            document=document,
            validity=self._store.validity(document),
        )

    def current(self, vertebra: str | None = None) -> StoredRegistration:
        """Return the newest registration if it is valid.

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
        context: RegistrationContext,
        registration: Registration,
        evidence: RegistrationEvidence,
        *,
        made_by: str,
        also_on: Sequence[str] = (),
        expected_version: int | None = None,
    ) -> Document:
        """Store an accepted registration as the next version for its vertebra.

        Raises:
            StoreConflict: VERSION_CONFLICT.
        """
        record = RegistrationRecord.of(
            registration,
            evidence,
            vertebra=context.vertebra.name,
            reference=context.reference,
            run=self._procedure.run,
        )
        return self._store.put(
            context.case_id,
            DocumentKind.REGISTRATION,
            context.vertebra.name,
            record.model_dump(mode="json"),
            made_by=made_by,
            depends_on=[*context.documents, *also_on],
            expected_version=expected_version,
        )

    def put_again(self, stored: StoredRegistration, record: RegistrationRecord, *, made_by: str) -> Document:
        """Store a changed registration with the same dependencies, as the next version.

        Raises:
            StoreConflict: VERSION_CONFLICT, another person has changed it since.
        """
        document = stored.document
        return self._store.put(
            document.case_id,
            DocumentKind.REGISTRATION,
            document.name,
            record.model_dump(mode="json"),
            made_by=made_by,
            depends_on=document.depends_on,
            expected_version=document.version,
        )
