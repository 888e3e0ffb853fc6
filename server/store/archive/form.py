"""What stands in an archive, which is a zip.

manifest.json     its form, and size and SHA-256 of every other part
case.json         the case
documents.jsonl   a document a line, each after those that it stands on
files/...         the files
"""

import re
from typing import Annotated, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from server.store.records import DocumentKind
from tracker.errors import InvalidInput

FORMAT: Final = "coaxial-case"
VERSION: Final = 1
MANIFEST, CASE, DOCUMENTS, FILES = "manifest.json", "case.json", "documents.jsonl", "files/"
FILE_ID = r"[0-9a-f]{16}(\.[a-z0-9]{1,10}){1,2}"
PART = re.compile(rf"{re.escape(CASE)}|{re.escape(DOCUMENTS)}|{FILES}{FILE_ID}")
MAX_PARTS = 20_000
LARGEST_MANIFEST_BYTES = 8 * 2**20
LARGEST_DOCUMENTS_BYTES = 512 * 2**20
LARGEST_WHOLE_BYTES = 32 * 2**30

Id = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{16}$")]
FileId = Annotated[str, StringConstraints(pattern=rf"^{FILE_ID}$")]
Sha256 = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]
Time = Annotated[str, StringConstraints(pattern=r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")]
Count = Annotated[int, Field(ge=0, le=LARGEST_WHOLE_BYTES)]


class Form(BaseModel):
    """Common to everything in an archive: nothing unknown, nothing converted."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


class PartForm(Form):
    """One part of the archive."""

    path: str
    size_bytes: Count
    sha256: Sha256


class ManifestForm(Form):
    """What the archive is, and what belongs into it."""

    format: Literal["coaxial-case"]
    version: Literal[1]
    made_at: Time
    parts: Annotated[list[PartForm], Field(max_length=MAX_PARTS)]


class FileForm(Form):
    """A file of the case; its size and sum stand in the manifest."""

    id: FileId
    made_at: Time


class CaseForm(Form):
    """The case itself."""

    id: Id
    name: str
    created_at: Time
    changed_at: Time
    files: list[FileForm]


class WithdrawalForm(Form):
    """That a document no longer holds."""

    at: Time
    by: str
    reason: str


class DocumentForm(Form):
    """One version of a document."""

    id: Id
    kind: Annotated[DocumentKind, Field(strict=False)]
    name: str
    version: Annotated[int, Field(ge=1, le=2**31)]
    content: dict[str, object]
    made_at: Time
    made_by: str
    stands_on: list[Id]
    files: list[FileId]
    withdrawn: WithdrawalForm | None


def rejected(why: str, **context: object) -> InvalidInput:
    """The error for an archive that cannot be taken in."""
    return InvalidInput(
        "ARCHIVE_INVALID",
        f"the archive cannot be taken in: {why}",
        "Copy the case out again where it came from; nothing of this archive was kept.",
        context,
    )
