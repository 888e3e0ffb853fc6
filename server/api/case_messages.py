"""What the answers about cases say."""

from typing import Annotated

from pydantic import Field

from server.api.doing import MadeBy
from server.store import (
    Case,
    Current,
    Damage,
    Document,
    DocumentKind,
    Entry,
    Heading,
    Imported,
    Standing,
    StoredFile,
    Withdrawal,
)
from server.stream.messages import Message

Words = Annotated[str, Field(min_length=1, max_length=1000)]


class CaseMessage(Message):
    """A case."""

    id: str
    """Stands in addresses, where the name must not."""
    name: str
    created_at: str
    """UTC, ISO 8601 with milliseconds, as all times here."""
    changed_at: str
    copied_from: str | None
    """The id under which its archive was made, if it came as one."""


class CasesMessage(Message):
    """All cases, the newest first."""

    opened_id: str | None
    """The case that is open; null when none is."""
    cases: list[CaseMessage]


class CaseNameMessage(Message):
    """A case's name."""

    name: Words


class ConfirmationMessage(Message):
    """The word of confirmation."""

    confirm: Words
    """The name of the case, exactly."""


class WithdrawalMessage(Message):
    """That a document no longer holds."""

    at: str
    by: str
    reason: str


class WithdrawMessage(Message):
    """The wish to withdraw a document."""

    by: MadeBy
    reason: Words


class ImportedMessage(Message):
    """That a document came in with an archive, in which anybody may have written anything."""

    said_maker: str
    """Who made it, as the archive says; nobody signed in here under this name to make it."""
    by: str
    """Who took it in."""
    at: str


class HeadingMessage(Message):
    """One version of a document, without its content."""

    id: str
    kind: DocumentKind
    name: str
    version: int
    made_at: str
    made_by: str
    """Who made it; of what came in with an archive, in words that say so."""
    imported: ImportedMessage | None
    """That it came in with an archive; null where it was made here."""
    stands_on: list[str]
    """Ids of the documents that it was made from."""
    files: list[str]
    """Ids of the files that belong to it."""
    withdrawn: WithdrawalMessage | None
    current: bool
    """Whether it and all that it stands on are the newest, and nothing of it was withdrawn."""
    out_of_date: str | None
    """Why it is not current, in a sentence; null when it is."""


class DocumentsMessage(Message):
    """Every version of every document of a case, in the order of making."""

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
    """All files of a case, the oldest first."""

    files: list[FileMessage]


class DamageMessage(Message):
    """A file that is not as it was stored."""

    file_id: str
    problem: str
    """missing, size or content."""
    told: str
    documents: list[str]
    """What needs it, in words."""


class VerificationMessage(Message):
    """Whether every file of a case is as it was stored."""

    sound: bool
    damages: list[DamageMessage]


def case_message(case: Case) -> CaseMessage:
    """A case, as it is told."""
    return CaseMessage(
        id=case.id,
        name=case.name,
        created_at=case.created_at,
        changed_at=case.changed_at,
        copied_from=case.copied_from,
    )


def imported_message(imported: Imported | None, *, said_maker: str) -> ImportedMessage | None:
    """That a document came in with an archive, as it is told; None where it was made here."""
    if imported is None:
        return None
    return ImportedMessage(said_maker=said_maker, by=imported.by, at=imported.at)


def heading_message(heading: Heading, standing: Standing) -> HeadingMessage:
    """A document without its content, as it is told."""
    return HeadingMessage(
        id=heading.id,
        kind=heading.kind,
        name=heading.name,
        version=heading.version,
        made_at=heading.made_at,
        made_by=heading.maker,
        imported=imported_message(heading.imported, said_maker=heading.made_by),
        stands_on=list(heading.stands_on),
        files=list(heading.files),
        withdrawn=_withdrawal_message(heading.withdrawn),
        current=isinstance(standing, Current),
        out_of_date=None if isinstance(standing, Current) else standing.reason,
    )


def document_message(document: Document, standing: Standing) -> DocumentMessage:
    """A document with its content, as it is told."""
    return DocumentMessage(heading=heading_message(document, standing), content=dict(document.content))


def documents_message(entries: tuple[Entry, ...]) -> DocumentsMessage:
    """The list of a case, as it is told."""
    return DocumentsMessage(documents=[heading_message(entry.heading, entry.standing) for entry in entries])


def files_message(files: tuple[StoredFile, ...]) -> FilesMessage:
    """The files of a case, as they are told."""
    return FilesMessage(
        files=[
            FileMessage(id=file.id, size_bytes=file.size_bytes, sha256=file.sha256, made_at=file.made_at)
            for file in files
        ]
    )


def verification_message(damages: tuple[Damage, ...]) -> VerificationMessage:
    """What was found, as it is told."""
    return VerificationMessage(
        sound=not damages,
        damages=[
            DamageMessage(
                file_id=damage.file_id,
                problem=damage.problem,
                told=damage.told,
                documents=list(damage.documents),
            )
            for damage in damages
        ],
    )


def _withdrawal_message(withdrawal: Withdrawal | None) -> WithdrawalMessage | None:
    if withdrawal is None:
        return None
    return WithdrawalMessage(at=withdrawal.at, by=withdrawal.by, reason=withdrawal.reason)
