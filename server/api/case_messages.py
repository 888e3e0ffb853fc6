"""Messages about cases and their documents."""

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field

from server.api.requester import MadeBy
from server.store import (
    Case,
    Current,
    Damage,
    Document,
    DocumentKind,
    Entry,
    Heading,
    ImportRecord,
    StoredFile,
    Validity,
    Withdrawal,
)
from server.stream.messages import Message
from server.texts import requested_language, worded

Words = Annotated[str, Field(min_length=1, max_length=1000)]


class CaseMessage(Message):
    """A case."""

    id: str
    """Used in addresses instead of the name, which may identify the patient."""
    name: str
    created_at: str
    """UTC, ISO 8601 with milliseconds, like all times here."""
    changed_at: str
    copied_from: str | None
    """Id of the exported case if this case was imported."""
    is_damaged: bool
    """Whether the disk changed its name or times; giving it its name again makes it usable."""


class CasesMessage(Message):
    """All cases, newest first."""

    opened_id: str | None
    """The open case; null if none is open."""
    cases: list[CaseMessage]


class CaseNameMessage(Message):
    """A case's name."""

    name: Words


class ConfirmationMessage(Message):
    """Confirmation of a deletion."""

    confirm: Words
    """The name of the case, exactly."""


class WithdrawalMessage(Message):
    """Withdrawal of a document."""

    at: str
    by: str
    reason: str


class WithdrawMessage(Message):
    """Request to withdraw a document."""

    by: MadeBy
    reason: Words


class RestoreMessage(Message):
    """Request to go on with an older version of a document."""

    by: MadeBy


class ImportedMessage(Message):
    """Import of a document with an archive; the contents of archives are not authenticated."""

    claimed_maker: str
    """Author as claimed by the archive; not authenticated on this server."""
    by: str
    """Who imported it."""
    at: str


class HeadingMessage(Message):
    """One version of a document, without its content."""

    id: str
    kind: DocumentKind
    name: str
    version: int
    made_at: str
    made_by: str
    """Author; for imported documents a text that states the import."""
    imported: ImportedMessage | None
    """Import of the document; null if it was made on this server."""
    depends_on: list[str]
    """Ids of the documents that it depends on."""
    files: list[str]
    """Ids of its files."""
    withdrawn: WithdrawalMessage | None
    current: bool
    """Whether it and all its dependencies are the newest versions and not withdrawn."""
    out_of_date: str | None
    """Why it is not current; null if it is."""
    is_damaged: bool
    """Whether the disk changed this version: only kind, name and version are known, and times and names are
    empty."""


class DocumentsMessage(Message):
    """All versions of all documents of a case, oldest first."""

    documents: list[HeadingMessage]


class DocumentMessage(Message):
    """One version of a document with its content."""

    heading: HeadingMessage
    content: dict[str, object]


class FileMessage(Message):
    """A file of a case."""

    id: str
    size_bytes: int
    sha256: str
    made_at: str


class FilesMessage(Message):
    """All files of a case, oldest first."""

    files: list[FileMessage]


class DamageMessage(Message):
    """A damaged file or document."""

    file_id: str
    """Id of the file or document."""
    problem: str
    """missing, size or content of a file; document."""
    message: str
    documents: list[str]
    """Titles of the documents that need it."""


class VerificationMessage(Message):
    """Result of the integrity check of a case."""

    sound: bool
    damages: list[DamageMessage]


class ImportedCaseMessage(CaseMessage):
    """A case imported from an archive."""

    damages: list[DamageMessage]
    """Documents and files that were damaged before the export, and are not in the archive."""


def case_message(case: Case) -> CaseMessage:
    """Return the message of a case."""
    return CaseMessage.model_validate(case, from_attributes=True)


def imported_message(imported: ImportRecord | None, *, claimed_maker: str) -> ImportedMessage | None:
    """Return the message of an import; None for a document made on this server."""
    if imported is None:
        return None
    return ImportedMessage(claimed_maker=claimed_maker, by=imported.by, at=imported.at)


def heading_message(heading: Heading, validity: Validity) -> HeadingMessage:
    """Return the message of a document without its content."""
    return HeadingMessage(
        id=heading.id,
        kind=heading.kind,
        name=heading.name,
        version=heading.version,
        made_at=heading.made_at,
        made_by=heading.maker,
        imported=imported_message(heading.imported, claimed_maker=heading.made_by),
        depends_on=list(heading.depends_on),
        files=list(heading.files),
        withdrawn=_withdrawal_message(heading.withdrawn),
        current=isinstance(validity, Current),
        out_of_date=None if isinstance(validity, Current) else validity.why.message[requested_language()],
        is_damaged=heading.is_damaged,
    )


def document_message(document: Document, validity: Validity) -> DocumentMessage:
    """Return the message of a document with its content."""
    return DocumentMessage(heading=heading_message(document, validity), content=_worded(document.content))


def _worded(content: Mapping[str, object]) -> dict[str, object]:
    localized = worded(content, requested_language())
    return dict(localized) if isinstance(localized, Mapping) else {}


def documents_message(entries: tuple[Entry, ...]) -> DocumentsMessage:
    """Return the message of all documents of a case."""
    return DocumentsMessage(documents=[heading_message(entry.heading, entry.validity) for entry in entries])


def files_message(files: tuple[StoredFile, ...]) -> FilesMessage:
    """Return the message of the files of a case."""
    return FilesMessage(files=[FileMessage.model_validate(file, from_attributes=True) for file in files])


def imported_case_message(case: Case, damages: tuple[Damage, ...]) -> ImportedCaseMessage:
    """Return the message of an imported case."""
    return ImportedCaseMessage(
        **case_message(case).model_dump(), damages=[_damage_message(damage) for damage in damages]
    )


def verification_message(damages: tuple[Damage, ...]) -> VerificationMessage:
    """Return the message of an integrity check."""
    return VerificationMessage(sound=not damages, damages=[_damage_message(damage) for damage in damages])


def _damage_message(damage: Damage) -> DamageMessage:
    language = requested_language()
    return DamageMessage(
        file_id=damage.file_id,
        problem=damage.problem,
        message=damage.why.message[language],
        documents=[title[language] for title in damage.documents],
    )


def _withdrawal_message(withdrawal: Withdrawal | None) -> WithdrawalMessage | None:
    if withdrawal is None:
        return None
    return WithdrawalMessage.model_validate(withdrawal, from_attributes=True)
