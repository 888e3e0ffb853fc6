"""Immutable records of cases, documents and files."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import StrEnum
from pathlib import Path
from typing import NamedTuple, TypeAlias

from server.texts import Reason, Text, document_title

SAYS_ARCHIVE = ", says the archive"


class DocumentKind(StrEnum):
    """Kind of a document. Only PATIENT may identify the patient; exports leave it out by default."""

    PATIENT = "patient"
    CAMERA = "camera"
    MARKER = "marker"
    TOOL = "tool"
    CT = "ct"
    LABELS = "labels"
    SURFACE = "surface"
    PLAN = "plan"
    REGISTRATION = "registration"
    CHECK = "check"
    CONFIRMATION = "confirmation"
    PLACEMENT = "placement"
    SIGNATURE = "signature"
    CONSENT = "consent"
    COMMENT = "comment"
    SNAPSHOT = "snapshot"
    ALARM = "alarm"
    AUDIT = "audit"


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One operation on one patient.

    Attributes:
        id: 16 hexadecimal digits; used in URLs and logs, which must not contain the name.
        name: display name; any text, not unique.
        created_at: UTC, ISO 8601 with milliseconds.
        changed_at: time of the last change.
        copied_from: id of the exported case, if it was imported from an archive.
        is_damaged: whether its row does not match its checksum, so that name and times may be wrong.
    """

    id: str
    name: str
    created_at: str
    changed_at: str
    copied_from: str | None = None
    is_damaged: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Withdrawal:
    """The withdrawal of a document.

    Attributes:
        at: UTC, ISO 8601 with milliseconds.
        by: name of the person.
        reason: the reason.
    """

    at: str
    by: str
    reason: str


def says_archive(name: str) -> str:
    """Mark a name as stated by an archive only; nobody signed in to this server under it."""
    return name if name.endswith(SAYS_ARCHIVE) else f"{name}{SAYS_ARCHIVE}"


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportRecord:
    """The import of a document from an archive, whose contents are not authenticated.

    Attributes:
        by: name of the person who imported it.
        at: UTC, ISO 8601 with milliseconds.
    """

    by: str
    at: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Heading:
    """A document without its content.

    Attributes:
        case_id: the case.
        id: unique within its case; an export and import of the case keeps it.
        kind: its kind.
        name: unique within its kind, for example "main" or "L3 left".
        version: 1, 2, 3 ... for its kind and name.
        made_at: UTC, ISO 8601 with milliseconds.
        made_by: name of the author; for an imported document only stated by the archive: display `maker`.
        depends_on: ids of the documents that it was made from.
        files: ids of the files that belong to it.
        withdrawn: its withdrawal; None if it is not withdrawn.
        imported: its import; None if it was made here.
        is_damaged: whether the version is lost: its row is missing or does not match its checksum. Then only
            kind, name and version are known.
    """

    case_id: str
    id: str
    kind: DocumentKind
    name: str
    version: int
    made_at: str
    made_by: str
    depends_on: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    withdrawn: Withdrawal | None = None
    imported: ImportRecord | None = None
    is_damaged: bool = False

    @property
    def is_usable(self) -> bool:
        """Whether it is neither withdrawn nor damaged."""
        return self.withdrawn is None and not self.is_damaged

    @property
    def maker(self) -> str:
        """Author, for display."""
        return self.made_by if self.imported is None else says_archive(self.made_by)

    @property
    def makers(self) -> tuple[str, ...]:
        """All possible authors: the person who imported it may also have written it."""
        return (self.made_by,) if self.imported is None else (self.made_by, self.imported.by)

    @property
    def title(self) -> str:
        """Kind, name and version in English."""
        return self.title_text["en"]

    @property
    def title_text(self) -> Text:
        """Kind, name and version, for display."""
        return document_title(self.kind.value, self.name, self.version)


@dataclass(frozen=True, slots=True, kw_only=True)
class Document(Heading):
    """One version of a result of the procedure; immutable once it is stored.

    Attributes:
        content: the stored JSON (tuples become lists); readers share it, and must not change it.
    """

    content: Mapping[str, object]

    @classmethod
    def of(cls, heading: Heading, content: Mapping[str, object]) -> "Document":
        """Return the document with this heading."""
        return cls(**{field.name: getattr(heading, field.name) for field in fields(Heading)}, content=content)


class DocumentVersion(NamedTuple):
    """One version of a document, by what people call it."""

    case_id: str
    kind: DocumentKind
    name: str
    version: int


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredFile:
    """A complete file of a case.

    Attributes:
        case_id: the case.
        id: its name in the case's folder, generated by the store; a document may refer to it.
        path: path for reading; it must not be written.
        size_bytes: size of the file.
        sha256: SHA-256 of the file, hexadecimal.
        made_at: UTC, ISO 8601 with milliseconds.
    """

    case_id: str
    id: str
    path: Path
    size_bytes: int
    sha256: str
    made_at: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Current:
    """The document and all that it depends on are the newest versions, and none is withdrawn or damaged."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OutOfDate:
    """The document is no longer valid.

    Attributes:
        why: the reason.
    """

    why: Reason

    @property
    def reason(self) -> str:
        """The reason in English, as a sentence without its full stop, for errors and logs."""
        return self.why.message["en"]


Validity: TypeAlias = Current | OutOfDate


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A document in the list of its case.

    Attributes:
        heading: the document without its content.
        validity: whether it is valid.
    """

    heading: Heading
    validity: Validity


@dataclass(frozen=True, slots=True, kw_only=True)
class Damage:
    """A file or document that differs from what was stored.

    Attributes:
        file_id: the file, or the document.
        problem: "missing", "size", "content" or "document".
        why: what was found, with numbers.
        documents: titles of the documents that refer to it, or of the document itself.
    """

    file_id: str
    problem: str
    why: Reason
    documents: tuple[Text, ...]
