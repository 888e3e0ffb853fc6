"""Co-signatures of plan and registration, given and taken back, each bound to one version and its content."""

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias

from server.errors import SetupOrderError
from server.procedure.opened import opened_case
from server.procedure.plan.kept import MAIN_PLAN
from server.procedure.state import Procedure
from server.procedure.state.cosigned import (
    KeptSignature,
    Signed,
    content_sha256,
    is_cosigned,
    kept_signature,
    may_have_made,
    signatures_of,
)
from server.security import ANYBODY, Person, Role
from server.security.audit import note
from server.store import CaseStore, Current, Document, DocumentKind, Imported, Standing
from tracker.errors import NavigationError

Requirement: TypeAlias = Literal["required", "offered"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Signature:
    """One signature that holds.

    Attributes:
        id: of its document.
        by: who signed.
        signer_id: the same person; never told to others.
        at: UTC, ISO 8601.
        second_person: whether it is known that somebody else made what was signed.
        invited_by: who had invited the signer; empty where that is not known.
        invited_by_maker: that was who made what was signed, and may have invited themselves.
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
    """The plan, or the registration of the vertebra that is to be drilled, with its signatures.

    Attributes:
        what: which of both.
        requirement: whether nobody navigates without.
        document_id: of the newest version; empty where there is none.
        title: in words.
        made_by: who made that version; of what came in with an archive, in words that say so.
        made_at: UTC, ISO 8601.
        said_maker: the bare name, as an archive has it.
        imported: that it came in with an archive; None where it was made here.
        sha256: of its content; empty where there is none.
        out_of_date: why it does not hold; empty where it does.
        signatures: of exactly this version.
        is_cosigned: whether a second person has signed it.
        was_signed: an earlier version was, so that somebody may expect this one to be.
    """

    what: Signed
    requirement: Requirement
    document_id: str = ""
    title: str = ""
    made_by: str = ""
    made_at: str = ""
    said_maker: str = ""
    imported: Imported | None = None
    sha256: str = ""
    out_of_date: str = ""
    signatures: tuple[Signature, ...] = ()
    is_cosigned: bool = False
    was_signed: bool = False


class SignatureDesk:
    """Where plan and registration of the open case are co-signed. From any thread; waits for the disk.

    Args:
        store: where signatures are kept.
        procedure: knows which vertebra is to be drilled, and what must be signed.
    """

    def __init__(self, store: CaseStore, procedure: Procedure) -> None:
        self._store = store
        self._procedure = procedure
        self._lock = threading.Lock()
        self._known: tuple[Signable, ...] = ()
        # Called when plan, registration or signatures are others than before.
        self.tell: Callable[[], None] = lambda: None
        store.call_after_writing(self.refresh)
        self.refresh()

    @property
    def known(self) -> tuple[Signable, ...]:
        """As after the last change of the store; without waiting for the disk."""
        return self._known

    def refresh(self) -> None:
        """Look again, and tell if something changed."""
        with self._lock:
            now = self.overview()
            is_new, self._known = now != self._known, now
        if is_new:
            self.tell()

    def overview(self) -> tuple[Signable, ...]:
        """Plan and registration of the open case as they stand now."""
        case = self._store.opened()
        return tuple(self._signable(what, None if case is None else case.id) for what in Signed)

    def sign(self, what: Signed, document_id: str, person: Person) -> tuple[Signable, ...]:
        """Sign exactly this version; a second time changes nothing.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING, REGISTRATION_MISSING, SIGNED_VERSION_OLD,
                SIGNED_BY_MAKER.
            OutOfDateError: DOCUMENT_OUT_OF_DATE.
        """
        case_id = opened_case(self._store).id
        document = self._newest(what, case_id)
        if document is None:
            raise SetupOrderError(
                f"{what.name}_MISSING", f"there is no {what.value} to be signed", "Make it first, then sign."
            )
        self._reject(what, document, document_id, person)
        self._store.current(case_id, document.kind, document.name)
        if any(kept.signer_id == person.id for _, kept in signatures_of(self._store, document)):
            return self.overview()
        kept = KeptSignature(
            what=what,
            document_id=document.id,
            title=document.title,
            content_sha256=content_sha256(document),
            signer_id=person.id,
            signer_role=person.role.value,
            second_person=person.id != ANYBODY.id,
            signer_invited_by=person.invited_by,
        )
        name = f"{what.value} {document.name[:60]} by {person.id[:60]}"
        content = kept.model_dump(mode="json")
        # A version that is newer than what was read here puts this signature out of date at once.
        self._store.put(
            case_id,
            DocumentKind.SIGNATURE,
            name,
            content,
            made_by=person.name,
            stands_on=[document.id],
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

    def take_back(self, signature_id: str, person: Person) -> tuple[Signable, ...]:
        """Take back one's own signature; the operator, anybody's.

        Raises:
            SetupOrderError: NO_CASE_OPEN, SIGNATURE_NOT_YOURS.
            NotStored: DOCUMENT_UNKNOWN.
            InvalidInput: SIGNATURE_DOCUMENT_INVALID.
        """
        document = self._store.document(opened_case(self._store).id, signature_id)
        kept = kept_signature(document)
        if person.role is not Role.OPERATOR and kept.signer_id != person.id:
            raise SetupOrderError(
                "SIGNATURE_NOT_YOURS",
                f"this was signed by {document.made_by}, not by {person.name}",
                "Leave it to who signed, or to the operator.",
            )
        self._store.withdraw(document, by=person.name, reason="the signature was taken back")
        return self.overview()

    def _reject(self, what: Signed, document: Document, document_id: str, person: Person) -> None:
        if document.id != document_id:
            raise SetupOrderError(
                "SIGNED_VERSION_OLD",
                f"the {what.value} was changed since it was looked at: it is {document.title} now",
                "Look at the newest version, then sign that one.",
                {"newest_id": document.id, "asked_id": document_id},
            )
        if person.id != ANYBODY.id and may_have_made(person.name, document):
            taken_in = "" if document.imported is None else f", and taken in by {document.imported.by}"
            raise SetupOrderError(
                "SIGNED_BY_MAKER",
                f"{document.title} was made by {document.maker}{taken_in}, and who made it cannot co-sign it",
                "Have somebody else look at it and sign.",
                {"made_by": list(document.makers)},
            )

    def _newest(self, what: Signed, case_id: str) -> Document | None:
        if what is Signed.PLAN:
            return self._store.latest(case_id, DocumentKind.PLAN, MAIN_PLAN)
        vertebra = self._procedure.active_vertebra(case_id)
        return None if vertebra is None else self._store.latest(case_id, DocumentKind.REGISTRATION, vertebra)

    def _signable(self, what: Signed, case_id: str | None) -> Signable:
        cosign = self._procedure.cosign
        requirement = cosign.plan if what is Signed.PLAN else cosign.registration
        document = None if case_id is None else self._newest(what, case_id)
        if document is None:
            return Signable(what=what, requirement=requirement)
        signatures = tuple(
            Signature(
                id=one.id,
                by=one.made_by,
                signer_id=kept.signer_id,
                at=one.made_at,
                second_person=kept.second_person and not may_have_made(one.made_by, document),
                invited_by=kept.signer_invited_by,
                invited_by_maker=may_have_made(kept.signer_invited_by, document),
            )
            for one, kept in signatures_of(self._store, document)
        )
        return Signable(
            what=what,
            requirement=requirement,
            document_id=document.id,
            title=document.title,
            made_by=document.maker,
            made_at=document.made_at,
            said_maker=document.made_by,
            imported=document.imported,
            sha256=content_sha256(document),
            out_of_date=_why(self._store.standing(document)),
            signatures=signatures,
            is_cosigned=is_cosigned(self._store, document),
            was_signed=not signatures and self._was_signed(what, document),
        )

    def _was_signed(self, what: Signed, document: Document) -> bool:
        earlier = {one.id for one in self._store.history(document.case_id, document.kind, document.name)}
        for one in self._store.all(document.case_id, DocumentKind.SIGNATURE):
            try:
                kept = kept_signature(one)
            except NavigationError:
                continue
            if kept.what is what and kept.document_id in earlier:
                return True
        return False


def _why(standing: Standing) -> str:
    return "" if isinstance(standing, Current) else standing.reason
