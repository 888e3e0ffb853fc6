"""What the store gives out: frozen records of cases, documents and files."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TypeAlias

SAYS_ARCHIVE = ", says the archive"


class DocumentKind(StrEnum):
    """What a document is about. PATIENT alone may say who the patient is; it never leaves with a case."""

    PATIENT = "patient"
    CAMERA = "camera"
    MARKER = "marker"
    TOOL = "tool"
    CT = "ct"
    SURFACE = "surface"
    PLAN = "plan"
    REGISTRATION = "registration"
    CHECK = "check"
    CONFIRMATION = "confirmation"
    SIGNATURE = "signature"
    SNAPSHOT = "snapshot"
    ALARM = "alarm"
    AUDIT = "audit"


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One patient's operation: all that was made for it is kept under it.

    Attributes:
        id: 16 hexadecimal digits; stands in addresses and logs, where the name must not.
        name: as people call it; any text, not unique.
        created_at: UTC, ISO 8601 with milliseconds.
        changed_at: when something was last added, renamed or withdrawn in it.
        copied_from: the id under which its archive was made, if it came as one.
    """

    id: str
    name: str
    created_at: str
    changed_at: str
    copied_from: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Withdrawal:
    """That a document no longer holds.

    Attributes:
        at: UTC, ISO 8601 with milliseconds.
        by: who said so.
        reason: why, in words.
    """

    at: str
    by: str
    reason: str


def says_archive(name: str) -> str:
    """The name of somebody for whom an archive alone vouches; nobody signed in here under it."""
    return name if name.endswith(SAYS_ARCHIVE) else f"{name}{SAYS_ARCHIVE}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Imported:
    """That a document came in with an archive, in which anybody may have written anything.

    Attributes:
        by: who took it in.
        at: when, UTC, ISO 8601 with milliseconds.
    """

    by: str
    at: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Heading:
    """What is known of a document without reading it.

    Attributes:
        case_id: the case.
        id: unique within its case, also after the case was copied out and in.
        kind: what it is about.
        name: tells it from others of its kind, as "main" or "L3 left".
        version: 1, 2, 3 ... for its kind and name.
        made_at: UTC, ISO 8601 with milliseconds.
        made_by: who made it; where it was imported, only the archive says so: show `maker`.
        stands_on: ids of the documents that it was made from.
        files: ids of the files that belong to it.
        withdrawn: that it no longer holds; None while nobody said so.
        imported: that it came in with an archive; None where it was made here.
    """

    case_id: str
    id: str
    kind: DocumentKind
    name: str
    version: int
    made_at: str
    made_by: str
    stands_on: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    withdrawn: Withdrawal | None = None
    imported: Imported | None = None

    @property
    def maker(self) -> str:
        """Who made it, in words that people may be shown."""
        return self.made_by if self.imported is None else says_archive(self.made_by)

    @property
    def makers(self) -> tuple[str, ...]:
        """All who may have made it: who took it in may have written it, too."""
        return (self.made_by,) if self.imported is None else (self.made_by, self.imported.by)

    @property
    def title(self) -> str:
        """The document in words."""
        return f"{self.kind.value} '{self.name}' version {self.version}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Document(Heading):
    """One version of one thing that set-up made; it never changes once it is stored.

    Attributes:
        content: what was stored, as JSON has it (tuples have become lists); a copy for each reader.
    """

    content: Mapping[str, object]


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredFile:
    """A file of a case, whole on the disk.

    Attributes:
        case_id: the case.
        id: its name in the case's folder, made by the store; a document's content may refer to it.
        path: where it can be read; never to be written.
        size_bytes: of the whole file.
        sha256: of the whole file, hexadecimal.
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
    """The document and all that it stands on are the newest, and none of them was withdrawn."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OutOfDate:
    """The document no longer holds.

    Attributes:
        reason: why, in a sentence without its full stop.
    """

    reason: str


Standing: TypeAlias = Current | OutOfDate


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A document in the list of its case.

    Attributes:
        heading: everything but its content.
        standing: whether it holds.
    """

    heading: Heading
    standing: Standing


@dataclass(frozen=True, slots=True, kw_only=True)
class Damage:
    """A file that is not as it was stored.

    Attributes:
        file_id: which one.
        problem: "missing", "size" or "content".
        told: the same in words, with numbers.
        documents: titles of the documents that need it.
    """

    file_id: str
    problem: str
    told: str
    documents: tuple[str, ...]
