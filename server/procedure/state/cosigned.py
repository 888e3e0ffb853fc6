"""Co-signatures: that a second person has looked at exactly this version of a plan or registration.

A co-signature is a document that depends on the signed version and holds its hash, so a changed plan is
unsigned at once by the rule that applies to every document. Where it is required, numbers are withheld and
every earlier step stays possible. Where nobody signs in, a signature counts as nobody's.
"""

import hashlib
import json
from collections.abc import Mapping
from enum import StrEnum

from server.config import CosignConfig, Section
from server.procedure.read import read_document
from server.procedure.state.records import HOLDS, Finding, Lack, StepName
from server.store import CaseStore, Current, Document, DocumentKind
from tracker.errors import NavigationError


class Signed(StrEnum):
    """What is co-signed."""

    PLAN = "plan"
    REGISTRATION = "registration"


STEP_OF = {Signed.PLAN: StepName.PLAN, Signed.REGISTRATION: StepName.REGISTER}
REMEDY = "Have a second person look at it and sign it, on the supervisor's page."


class KeptSignature(Section):
    """What a case keeps of a signature: it stands on the document that was signed."""

    what: Signed
    document_id: str
    title: str
    """Of the document, in words."""
    content_sha256: str
    """Of the document's content as it was signed."""
    signer_id: str
    signer_role: str
    second_person: bool
    """Whether it is known that somebody else made the document; false where nobody signs in."""
    signer_invited_by: str = ""
    """The name of who had invited the signer; empty where that is not known."""


def content_sha256(document: Document) -> str:
    """What tells a document's content from every other, however its keys are ordered."""
    text = json.dumps(
        document.content, sort_keys=True, ensure_ascii=False, allow_nan=False, separators=(",", ":")
    )
    return hashlib.sha256(text.encode()).hexdigest()


def kept_signature(document: Document) -> KeptSignature:
    """The signature in a document of a case.

    Raises:
        InvalidInput: SIGNATURE_DOCUMENT_INVALID.
    """
    return read_document(
        KeptSignature, document, code="SIGNATURE_DOCUMENT_INVALID", remedy="Have it signed again."
    )


def signatures_of(store: CaseStore, document: Document) -> tuple[tuple[Document, KeptSignature], ...]:
    """All signatures of exactly this version that hold, the oldest first."""
    found: list[tuple[Document, KeptSignature]] = []
    sha256 = content_sha256(document)
    for one in store.all(document.case_id, DocumentKind.SIGNATURE):
        try:
            kept = kept_signature(one)
        except NavigationError:
            continue
        fits = kept.document_id == document.id and kept.content_sha256 == sha256
        if fits and isinstance(store.standing(one), Current):
            found.append((one, kept))
    return tuple(sorted(found, key=lambda pair: pair[0].made_at))


def is_cosigned(store: CaseStore, document: Document) -> bool:
    """Whether somebody else than its maker has signed exactly this version."""
    return any(
        kept.second_person and not may_have_made(one.made_by, document)
        for one, kept in signatures_of(store, document)
    )


def may_have_made(name: str, document: Document) -> bool:
    """Whether somebody of this name made the document, or took it in from an archive."""
    return any(is_same_name(name, maker) for maker in document.makers)


def is_same_name(one: str, other: str) -> bool:
    """Whether two names are of one person, as people write them."""
    return " ".join(one.split()).casefold() == " ".join(other.split()).casefold()


def lacking(
    store: CaseStore, case_id: str, findings: Mapping[StepName, Finding], cosign: CosignConfig
) -> dict[StepName, Lack]:
    """The co-signatures that are required and not there, of steps that are done otherwise."""
    required = {
        StepName.PLAN: cosign.plan == "required",
        StepName.REGISTER: cosign.registration == "required",
    }
    lacks: dict[StepName, Lack] = {}
    for step, is_required in required.items():
        finding = findings[step]
        if not is_required or finding.state not in HOLDS or not finding.document_id:
            continue
        document = store.document(case_id, finding.document_id)
        if not is_cosigned(store, document):
            lacks[step] = Lack(said=f"{document.title} is not signed by a second person", remedy=REMEDY)
    return lacks
