"""Co-signatures of plan and registration, each bound to one version and its content."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from server.errors import SetupOrderError
from server.procedure.open_case import require_open_case
from server.procedure.plan.repository import MAIN_PLAN
from server.procedure.state import Procedure
from server.procedure.state.cosignatures import (
    CosignTarget,
    SignatureRecord,
    content_sha256,
    is_cosigned,
    may_have_made,
    signature_from_document,
    signatures_of,
)
from server.security import LOCAL_USER, Person, Role
from server.security.audit import note
from server.store import CaseStore, Current, Document, DocumentKind, ImportRecord, Validity
from server.texts import NO_TEXT, WITHDRAWALS, Text
from tracker.errors import NavigationError

Requirement: TypeAlias = Literal["required", "offered"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Signature:
    """One valid signature.

    Attributes:
        id: id of its document.
        by: name of the signer.
        signer_id: id of the signer; not sent to others.
        at: UTC, ISO 8601.
        second_person: Whether author and signer are known to differ.
        invited_by: Person who invited the signer; empty if unknown.
        invited_by_maker: Whether the author invited the signer, and may be the same person.
    """

    id: str
    by: str
    signer_id: str
    at: str
    second_person: bool
    invited_by: str = ""
    invited_by_maker: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Signable:
    """The plan, or the registration of the vertebra to be drilled, with its signatures.

    Attributes:
        what: plan or registration.
        requirement: whether navigation needs the signature.
        document_id: of the newest version; empty where there is none.
        title: display title.
        made_by: maker of that version, as a display text for an imported one.
        made_at: UTC, ISO 8601.
        claimed_maker: maker's name as it stands in an imported archive.
        imported: origin of an imported version; None where it was made here.
        sha256: of its content; empty where there is none.
        out_of_date: reason why it is invalid; empty where it is valid.
        signatures: of exactly this version.
        is_cosigned: whether a second person signed this version.
        was_signed: whether an earlier version was signed and this one is not.
    """

    what: CosignTarget
    requirement: Requirement
    document_id: str = ""
    title: Text = field(default_factory=lambda: NO_TEXT)
    made_by: str = ""
    made_at: str = ""
    claimed_maker: str = ""
    imported: ImportRecord | None = None
    sha256: str = ""
    out_of_date: Text = field(default_factory=lambda: NO_TEXT)
    signatures: tuple[Signature, ...] = ()
    is_cosigned: bool = False
    was_signed: bool = False


class SignatureService:
    """Co-signs plan and registration of the open case. Thread-safe; waits for the disk.

    Args:
        store: storage of the signatures.
        procedure: provides the vertebra to be drilled and the signatures that are required.
    """

    def __init__(self, store: CaseStore, procedure: Procedure) -> None:
        self._store = store
        self._procedure = procedure
        self._lock = threading.Lock()
        self._known: tuple[Signable, ...] = ()
        # Called when plan, registration or signatures have changed.
        self.on_change: Callable[[], None] = lambda: None
        store.add_commit_listener(self.refresh)
        self.refresh()

    @property
    def known(self) -> tuple[Signable, ...]:
        """State after the last change of the store, without waiting for the disk."""
        return self._known

    def refresh(self) -> None:
        """Read the state again, and notify if it changed."""
        with self._lock:
            now = self.overview()
            is_new, self._known = now != self._known, now
        if is_new:
            self.on_change()

    def overview(self) -> tuple[Signable, ...]:
        """Return plan and registration of the open case in their present state."""
        case = self._store.get_open_case()
        return tuple(self._signable(what, None if case is None else case.id) for what in CosignTarget)

    def sign(self, what: CosignTarget, document_id: str, person: Person) -> tuple[Signable, ...]:
        """Sign exactly this version; a second signature of the same person changes nothing.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING, REGISTRATION_MISSING, SIGNED_VERSION_OLD,
                SIGNED_BY_MAKER.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
        """
        case_id = require_open_case(self._store).id
        document = self._newest(what, case_id)
        if document is None:
            raise SetupOrderError(
                f"{what.name}_MISSING", f"there is no {what.value} to sign", "Create it first, then sign."
            )
        self._reject(what, document, document_id, person)
        self._store.current(case_id, document.kind, document.name)
        if any(stored.signer_id == person.id for _, stored in signatures_of(self._store, document)):
            return self.overview()
        stored = SignatureRecord(
            what=what,
            document_id=document.id,
            title=document.title,
            content_sha256=content_sha256(document),
            signer_id=person.id,
            signer_role=person.role.value,
            second_person=person.id != LOCAL_USER.id,
            signer_invited_by=person.invited_by,
        )
        name = f"{what.value} {document.name[:60]} by {person.id[:60]}"
        content = stored.model_dump(mode="json")
        # A version newer than the one read here invalidates this signature at once.
        self._store.put(
            case_id,
            DocumentKind.SIGNATURE,
            name,
            content,
            made_by=person.name,
            depends_on=[document.id],
        )
        note(
            {
                "what": "signature",
                "of": document.title,
                "invited_by": person.invited_by,
                "invited_by_maker": may_have_made(person.invited_by, document),
                "from": None,
                "to": "signed",
            }
        )
        return self.overview()

    def withdraw(self, signature_id: str, person: Person) -> tuple[Signable, ...]:
        """Withdraw one's own signature, or as the operator anybody's.

        Raises:
            SetupOrderError: NO_CASE_OPEN, SIGNATURE_NOT_YOURS.
            NotFound: DOCUMENT_UNKNOWN.
            InvalidInput: SIGNATURE_DOCUMENT_INVALID.
        """
        document = self._store.document(require_open_case(self._store).id, signature_id)
        stored = signature_from_document(document)
        if person.role is not Role.OPERATOR and stored.signer_id != person.id:
            raise SetupOrderError(
                "SIGNATURE_NOT_YOURS",
                f"this was signed by {document.made_by}, not by {person.name}",
                "Ask the signer or the operator to withdraw it.",
                {"signer": document.made_by, "person": person.name},
            )
        self._store.withdraw(document, by=person.name, reason=WITHDRAWALS["SIGNATURE_WITHDRAWN"]["en"])
        return self.overview()

    def _reject(self, what: CosignTarget, document: Document, document_id: str, person: Person) -> None:
        if document.id != document_id:
            raise SetupOrderError(
                "SIGNED_VERSION_OLD",
                f"the {what.value} has changed since it was displayed; it is now {document.title}",
                "Review the newest version, then sign it.",
                {
                    "newest_id": document.id,
                    "requested_id": document_id,
                    "kind": what.value,
                    "title": document.title_text,
                },
            )
        if person.id != LOCAL_USER.id and may_have_made(person.name, document):
            taken_in = "" if document.imported is None else f" and imported by {document.imported.by}"
            raise SetupOrderError(
                "SIGNED_BY_MAKER",
                f"{document.title} was made by {document.maker}{taken_in}, and its author cannot co-sign it",
                "Have another person review and sign it.",
                {
                    "made_by": list(document.makers),
                    "title": document.title_text,
                    "maker": document.maker,
                    "import_phrase": taken_in,
                    "importer": None if document.imported is None else document.imported.by,
                },
            )

    def _newest(self, what: CosignTarget, case_id: str) -> Document | None:
        if what is CosignTarget.PLAN:
            return self._store.latest(case_id, DocumentKind.PLAN, MAIN_PLAN)
        vertebra = self._procedure.active_vertebra(case_id)
        return None if vertebra is None else self._store.latest(case_id, DocumentKind.REGISTRATION, vertebra)

    def _signable(self, what: CosignTarget, case_id: str | None) -> Signable:
        cosign = self._procedure.cosign
        requirement = cosign.plan if what is CosignTarget.PLAN else cosign.registration
        document = None if case_id is None else self._newest(what, case_id)
        if document is None:
            return Signable(what=what, requirement=requirement)
        signatures = tuple(
            Signature(
                id=one.id,
                by=one.made_by,
                signer_id=stored.signer_id,
                at=one.made_at,
                second_person=stored.second_person and not may_have_made(one.made_by, document),
                invited_by=stored.signer_invited_by,
                invited_by_maker=may_have_made(stored.signer_invited_by, document),
            )
            for one, stored in signatures_of(self._store, document)
        )
        return Signable(
            what=what,
            requirement=requirement,
            document_id=document.id,
            title=document.title_text,
            made_by=document.maker,
            made_at=document.made_at,
            claimed_maker=document.made_by,
            imported=document.imported,
            sha256=content_sha256(document),
            out_of_date=_out_of_date_reason(self._store.validity(document)),
            signatures=signatures,
            is_cosigned=is_cosigned(self._store, document),
            was_signed=not signatures and self._was_signed(what, document),
        )

    def _was_signed(self, what: CosignTarget, document: Document) -> bool:
        earlier = {one.id for one in self._store.history(document.case_id, document.kind, document.name)}
        for one in self._store.all(document.case_id, DocumentKind.SIGNATURE):
            try:
                stored = signature_from_document(one)
            except NavigationError:
                continue
            if stored.what is what and stored.document_id in earlier:
                return True
        return False


def _out_of_date_reason(validity: Validity) -> Text:
    return NO_TEXT if isinstance(validity, Current) else validity.why.message
