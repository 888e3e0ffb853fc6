"""Schema of an archive, which is a zip file.

manifest.json     its format version, size and SHA-256 of every other part, and what is missing
case.json         the case
documents.jsonl   one document per line, each after those that it depends on
files/...         the files

The key `stands_on` of a document lists its dependencies; it is part of the file format.
"""

import re
from typing import Annotated, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from server.store.records import DocumentKind
from tracker.errors import InvalidInput

FORMAT: Final = "coaxial-case"
# Version 2 states what is missing; a complete case is written as version 1, which earlier programs can read.
COMPLETE_VERSION: Final = 1
VERSION: Final = 2
MANIFEST, CASE, DOCUMENTS, FILES = "manifest.json", "case.json", "documents.jsonl", "files/"
ID = r"[0-9a-f]{16}"
FILE_ID = rf"{ID}(\.[a-z0-9]{{1,10}}){{1,2}}"
PART = re.compile(rf"{re.escape(CASE)}|{re.escape(DOCUMENTS)}|{FILES}{FILE_ID}")
MAX_PARTS = 20_000
MAX_MANIFEST_BYTES = 8 * 2**20
MAX_DOCUMENTS_BYTES = 512 * 2**20
MAX_UNPACKED_BYTES = 32 * 2**30

Id = Annotated[str, StringConstraints(pattern=rf"^{ID}$")]
FileId = Annotated[str, StringConstraints(pattern=rf"^{FILE_ID}$")]
Sha256 = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]
Time = Annotated[str, StringConstraints(pattern=r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")]
Count = Annotated[int, Field(ge=0, le=MAX_UNPACKED_BYTES)]
Kind = Annotated[DocumentKind, Field(strict=False)]


class ArchiveModel(BaseModel):
    """Base class: strict, without unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


class PartSchema(ArchiveModel):
    """One part of the archive."""

    path: str
    size_bytes: Count
    sha256: Sha256


class MissingFileSchema(ArchiveModel):
    """A file that was damaged, as it was stored; without size and checksum if its entry was damaged, too."""

    id: FileId
    size_bytes: Count
    sha256: Sha256 | Literal[""]
    problem: str


class MissingDocumentSchema(ArchiveModel):
    """A version of a document that was damaged.

    Without kind and name, and as version 0, if only its id is known from those that depend on it.
    """

    id: Id
    kind: Kind | None
    name: str
    version: Annotated[int, Field(ge=0, lt=2**63)]


class MissingSchema(ArchiveModel):
    """What is not in the archive because it was damaged when the case was exported."""

    documents: list[MissingDocumentSchema]
    files: list[MissingFileSchema]

    @property
    def count(self) -> int:
        """Number of documents and files."""
        return len(self.documents) + len(self.files)


class ManifestSchema(ArchiveModel):
    """Format, version and parts of the archive."""

    format: Literal["coaxial-case"]
    version: Literal[1, 2]
    made_at: Time
    parts: Annotated[list[PartSchema], Field(max_length=MAX_PARTS)]
    missing: MissingSchema = MissingSchema(documents=[], files=[])


class FileSchema(ArchiveModel):
    """A file of the case; its size and checksum are in the manifest."""

    id: FileId
    made_at: Time


class CaseSchema(ArchiveModel):
    """The case itself."""

    id: Id
    name: str
    created_at: Time
    changed_at: Time
    files: list[FileSchema]


class WithdrawalSchema(ArchiveModel):
    """The withdrawal of a document."""

    at: Time
    by: str
    reason: str


class DocumentSchema(ArchiveModel):
    """One version of a document."""

    id: Id
    kind: Kind
    name: str
    version: Annotated[int, Field(ge=1, lt=2**63)]
    content: dict[str, object]
    made_at: Time
    made_by: str
    stands_on: list[Id]
    files: list[FileId]
    withdrawn: WithdrawalSchema | None


def archive_error(why: str, **context: object) -> InvalidInput:
    """Return the error for an archive that cannot be imported."""
    return InvalidInput(
        "ARCHIVE_INVALID",
        f"the archive cannot be imported: {why}",
        "Export the case again on its server; nothing of this archive was stored.",
        {**context, "archive_problem": why},
    )
