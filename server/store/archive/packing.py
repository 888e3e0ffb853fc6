"""Export of a case as an archive.

The archive is completed before its first byte is sent, so that a slow client does not lock the case, the
length is known, and a damaged file is reported instead of sent in a partial archive. This needs the disk
space of a second copy, and seconds for a CT. The patient's identity is a separate kind of document, so that
it can be excluded.
"""

import hashlib
import json
import os
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from server.store.archive.schema import (
    CASE,
    DOCUMENTS,
    FILES,
    FORMAT,
    MANIFEST,
    VERSION,
    CaseSchema,
    DocumentSchema,
    FileSchema,
    ManifestSchema,
    PartSchema,
    WithdrawalSchema,
)
from server.store.case_database import CaseDatabase
from server.store.cases import case_of, case_row
from server.store.documents import document_damaged, every_document
from server.store.errors import translate_errors
from server.store.files import CHUNK_BYTES, all_files, file_damaged
from server.store.records import Case, Document, DocumentKind, StoredFile
from server.store.validity import lineage_of

FAST = 1  # zlib's level: half of the size for a tenth of the time
ZIP64_FROM_BYTES = 2**31


@dataclass(frozen=True, slots=True, kw_only=True)
class Archive:
    """A case as one file.

    Attributes:
        case_id: the case.
        path: in the home's temporary folder; the caller deletes it.
        size_bytes: size of the file.
    """

    case_id: str
    path: Path
    size_bytes: int


class _Writer:
    """Writes parts, and records their sizes and checksums for the manifest."""

    def __init__(self, archive: zipfile.ZipFile) -> None:
        self._archive = archive
        self.parts: list[PartSchema] = []

    def write(self, path: str, pieces: Iterator[bytes], *, expected_bytes: int = 0) -> PartSchema:
        digest, size_bytes = hashlib.sha256(), 0
        entry = zipfile.ZipInfo(path)
        entry.compress_type = zipfile.ZIP_DEFLATED
        with self._archive.open(entry, "w", force_zip64=expected_bytes >= ZIP64_FROM_BYTES) as stream:
            for piece in pieces:
                digest.update(piece)
                size_bytes += len(piece)
                stream.write(piece)
        part = PartSchema(path=path, size_bytes=size_bytes, sha256=digest.hexdigest())
        self.parts.append(part)
        return part


def pack(database: CaseDatabase, case_id: str, *, with_identity: bool) -> Archive:
    """Create the archive of a case; without `with_identity` it has neither its name nor patient identity.

    Raises:
        NotFound: CASE_UNKNOWN.
        StoreError: FILE_DAMAGED, DOCUMENT_DAMAGED, one differs from the stored one.
    """
    path = database.home.new_temporary(".zip")
    with database.in_use(case_id), translate_errors(database.home.folder):
        try:
            with zipfile.ZipFile(path, "x", zipfile.ZIP_DEFLATED, compresslevel=FAST) as archive:
                _write_all(database, case_id, _Writer(archive), archive, with_identity=with_identity)
            return Archive(case_id=case_id, path=path, size_bytes=path.stat().st_size)
        except BaseException:
            path.unlink(missing_ok=True)
            raise


def _write_all(
    database: CaseDatabase, case_id: str, writer: _Writer, archive: zipfile.ZipFile, *, with_identity: bool
) -> None:
    with database.read_session() as session:
        case = case_of(case_row(session, case_id))
        files = all_files(database, session, case_id)
        for heading in lineage_of(session, case_id).headings.values():
            if heading.is_damaged:
                raise document_damaged(case_id, heading.id)
        database.home.reject_without_space(sum(file.size_bytes for file in files))
        writer.write(CASE, iter([_case_text(case, files, with_identity=with_identity)]))
        lines = (
            _document_line(document)
            for document in every_document(session, case_id)
            if with_identity or document.kind is not DocumentKind.PATIENT
        )
        writer.write(DOCUMENTS, lines)
    for file in files:
        if not file.path.exists():
            raise file_damaged(file, "it is missing")
        part = writer.write(f"{FILES}{file.id}", _pieces(file.path), expected_bytes=file.size_bytes)
        if part.sha256 != file.sha256:
            raise file_damaged(file, "its SHA-256 differs")
    manifest = ManifestSchema(format=FORMAT, version=VERSION, made_at=database.now, parts=writer.parts)
    archive.writestr(MANIFEST, manifest.model_dump_json(indent=1))


def _case_text(case: Case, files: tuple[StoredFile, ...], *, with_identity: bool) -> bytes:
    return (
        CaseSchema(
            id=case.id,
            name=case.name if with_identity else f"Case {case.id[:6]}",
            created_at=case.created_at,
            changed_at=case.changed_at,
            files=[FileSchema(id=file.id, made_at=file.made_at) for file in files],
        )
        .model_dump_json(indent=1)
        .encode()
    )


def _document_line(document: Document) -> bytes:
    withdrawn = document.withdrawn
    form = DocumentSchema(
        id=document.id,
        kind=document.kind,
        name=document.name,
        version=document.version,
        content=dict(document.content),
        made_at=document.made_at,
        made_by=document.made_by,
        stands_on=list(document.depends_on),
        files=list(document.files),
        withdrawn=None
        if withdrawn is None
        else WithdrawalSchema(at=withdrawn.at, by=withdrawn.by, reason=withdrawn.reason),
    )
    # Not with pydantic's serialiser, which shortens some floats.
    return json.dumps(form.model_dump(mode="python"), ensure_ascii=False).encode() + b"\n"


def _pieces(path: Path) -> Iterator[bytes]:
    with path.open("rb") as stream:
        while piece := os.read(stream.fileno(), CHUNK_BYTES):
            yield piece
