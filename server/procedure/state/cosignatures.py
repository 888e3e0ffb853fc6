"""Co-signatures: a second person has reviewed exactly this version of a plan or registration.

A co-signature is a document that depends on the signed version and contains its hash, so a changed plan is
unsigned by the rule that applies to every document. If a co-signature is required and missing, numbers are
withheld and every earlier step stays possible. Without sign-in a signature has no verified signer.
"""

import hashlib
import json
from collections.abc import Mapping
from enum import StrEnum

from server.config import CosignConfig, Section
from server.procedure.documents import parse_document
from server.procedure.state.records import VALID_STATES, Finding, MissingCosignature, StepName
from server.store import CaseStore, Document, DocumentKind
from server.texts import reason
from tracker.errors import NavigationError


class CosignTarget(StrEnum):
    """What a co-signature applies to."""

    PLAN = "plan"
    REGISTRATION = "registration"


class SignatureRecord(Section):
    """A signature as stored in a case. Its document depends on the signed document."""

    what: CosignTarget
    document_id: str
    title: str
    """Title of the signed document."""
    content_sha256: str
    """SHA-256 of its content when it was signed."""
    signer_id: str
    signer_role: str
    second_person: bool
    """Whether the signer is known to be another person than the author; false without sign-in."""
    signer_invited_by: str = ""
    """Name of the person who invited the signer; empty if unknown."""


def content_sha256(document: Document) -> str:
    """Return the SHA-256 of a document's content, independent of the order of its keys."""
    text = json.dumps(
        document.content, sort_keys=True, ensure_ascii=False, allow_nan=False, separators=(",", ":")
    )
    return hashlib.sha256(text.encode()).hexdigest()


def signature_from_document(document: Document) -> SignatureRecord:
    """Parse the signature in a case document.

    Raises:
        InvalidInput: SIGNATURE_DOCUMENT_INVALID.
    """
    return parse_document(
        SignatureRecord, document, code="SIGNATURE_DOCUMENT_INVALID", remedy="Have it signed again."
    )


def signatures_of(store: CaseStore, document: Document) -> tuple[tuple[Document, SignatureRecord], ...]:
    """Return all valid signatures of exactly this version, oldest first."""
    found: list[tuple[Document, SignatureRecord]] = []
    sha256 = content_sha256(document)
    for one in store.all(document.case_id, DocumentKind.SIGNATURE):
        try:
            record = signature_from_document(one)
        except NavigationError:
            continue
        fits = record.document_id == document.id and record.content_sha256 == sha256
        if fits and store.is_current(one):
            found.append((one, record))
    # Not by time stamps, because clocks can be set back.
    place = {one: n for n, one in enumerate(store.ids(document.case_id))}
    return tuple(sorted(found, key=lambda pair: place[pair[0].id]))


def is_cosigned(store: CaseStore, document: Document) -> bool:
    """Return whether a person other than the author has signed exactly this version."""
    return any(
        record.second_person and not may_have_made(one.made_by, document)
        for one, record in signatures_of(store, document)
    )


def may_have_made(name: str, document: Document) -> bool:
    """Return whether a person of this name created the document or imported it from an archive."""
    return any(is_same_name(name, maker) for maker in document.makers)


def is_same_name(one: str, other: str) -> bool:
    """Compare two names, ignoring case and repeated spaces."""
    return " ".join(one.split()).casefold() == " ".join(other.split()).casefold()


def missing_cosignatures(
    store: CaseStore, case_id: str, findings: Mapping[StepName, Finding], cosign: CosignConfig
) -> dict[StepName, MissingCosignature]:
    """Return the missing co-signatures of steps that are otherwise valid."""
    required = {
        StepName.PLAN: cosign.plan == "required",
        StepName.REGISTER: cosign.registration == "required",
    }
    missing_cosignature: dict[StepName, MissingCosignature] = {}
    for step, is_required in required.items():
        finding = findings[step]
        if not is_required or finding.state not in VALID_STATES or not finding.document_id:
            continue
        document = store.document(case_id, finding.document_id)
        if not is_cosigned(store, document):
            missing_cosignature[step] = MissingCosignature(
                reason=reason("NOT_COSIGNED", {"title": document.title_text})
            )
    return missing_cosignature
