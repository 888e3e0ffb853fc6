"""Export of a case as an archive.

The archive is completed before its first byte is sent, so that a slow client does not lock the case, the
length is known, and a damaged file is reported instead of sent in a partial archive. This needs the disk
space of a second copy, and seconds for a CT. The patient's identity is a separate kind of document, so that
it can be excluded.

What the disk has damaged is left out on request only; the manifest then states what is missing.
"""

import hashlib
import json
import os
import re
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from server.store.archive.schema import (
    CASE,
    COMPLETE_VERSION,
    DOCUMENTS,
    FILE_ID,
    FILES,
    FORMAT,
    ID,
    MANIFEST,
    VERSION,
    CaseSchema,
    DocumentSchema,
    FileSchema,
    ManifestSchema,
    MissingDocumentSchema,
    MissingFileSchema,
    MissingSchema,
    PartSchema,
    WithdrawalSchema,
)
from server.store.case_database import CaseDatabase
from server.store.cases import case_of, case_row
from server.store.documents import document_damaged, every_document
from server.store.errors import translate_errors
from server.store.files import CHUNK_BYTES, all_files, file_damaged, find_damage, known_files
from server.store.records import Case, Damage, Document, DocumentKind, Heading, StoredFile
from server.store.validation import validate_name
from server.store.validity import Lineage, lineage_of
from tracker.errors import InvalidInput

FAST = 1  # zlib's level: half of the size for a tenth of the time
ZIP64_FROM_BYTES = 2**31


@dataclass(frozen=True, slots=True, kw_only=True)
class Archive:
    """A case as one file.

    Attributes:
        case_id: the case.
        path: in the home's temporary folder; the caller deletes it.
        size_bytes: size of the file.
        missing: number of documents and files that it does not contain because they are damaged.
    """

    case_id: str
    path: Path
    size_bytes: int
    missing: int


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


def pack(database: CaseDatabase, case_id: str, *, with_identity: bool, without_damaged: bool) -> Archive:
    """Create the archive of a case.

    Args:
        database: the database.
        case_id: the case.
        with_identity: whether it contains the name of the case and the patient's identity.
        without_damaged: whether damaged documents and files are left out, and stated as missing.

    Raises:
        NotFound: CASE_UNKNOWN.
        StoreError: CASE_DAMAGED; FILE_DAMAGED, DOCUMENT_DAMAGED, one differs from the stored one and is not
            left out.
    """
    path = database.home.new_temporary(".zip")
    with database.in_use(case_id), translate_errors(database.home.folder):
        try:
            with zipfile.ZipFile(path, "x", zipfile.ZIP_DEFLATED, compresslevel=FAST) as archive:
                # Before anything is written, because a part of a zip file cannot be taken back.
                damages = find_damage(database, case_id) if without_damaged else None
                missing = _write_all(
                    database, case_id, _Writer(archive), archive, with_identity=with_identity, damages=damages
                )
            size_bytes = path.stat().st_size
            return Archive(case_id=case_id, path=path, size_bytes=size_bytes, missing=missing.count)
        except BaseException:
            path.unlink(missing_ok=True)
            raise


def _write_all(
    database: CaseDatabase,
    case_id: str,
    writer: _Writer,
    archive: zipfile.ZipFile,
    *,
    with_identity: bool,
    damages: Sequence[Damage] | None,
) -> MissingSchema:
    """Write all parts but those of `damages`, and return what is missing; None allows no damage."""
    with database.read_session() as session:
        case = case_of(case_row(session, case_id))
        lineage = lineage_of(session, case_id)
        headings = lineage.headings.values()
        if damages is None:
            files = all_files(database, session, case_id)
            for damaged in (*(one.id for one in headings if one.is_damaged), *lineage.unknown_bases):
                raise document_damaged(case_id, damaged)
        else:
            files = known_files(database, session, case_id)
        missing = _missing(lineage, files, damages or (), with_identity=with_identity)
        lost = {one.id for one in missing.files}
        files = tuple(file for file in files if file.id not in lost)
        database.home.reject_without_space(sum(file.size_bytes for file in files))
        writer.write(CASE, iter([_case_text(case, files, with_identity=with_identity)]))
        lines = (
            _document_line(document)
            for document in every_document(session, case_id, without_damaged=damages is not None)
            if with_identity or document.kind is not DocumentKind.PATIENT
        )
        writer.write(DOCUMENTS, lines)
    for file in files:
        if not file.path.exists():
            raise file_damaged(file, "it is missing")
        part = writer.write(f"{FILES}{file.id}", _pieces(file.path), expected_bytes=file.size_bytes)
        if part.sha256 != file.sha256:
            raise file_damaged(file, "its SHA-256 differs")
    manifest = ManifestSchema(
        format=FORMAT,
        version=VERSION if missing.count else COMPLETE_VERSION,
        made_at=database.now,
        parts=writer.parts,
        missing=missing,
    )
    excluded = None if missing.count else {"missing"}
    archive.writestr(MANIFEST, manifest.model_dump_json(indent=1, exclude=excluded))
    return missing


def _missing(
    lineage: Lineage, files: Iterable[StoredFile], damages: Iterable[Damage], *, with_identity: bool
) -> MissingSchema:
    damaged = (one for one in lineage.headings.values() if one.is_damaged)
    documents = [
        _missing_document(one) for one in damaged if with_identity or one.kind is not DocumentKind.PATIENT
    ]
    documents += [
        MissingDocumentSchema(id=unknown, kind=None, name="", version=0) for unknown in lineage.unknown_bases
    ]
    return MissingSchema(documents=documents, files=_missing_files(files, damages))


def _missing_document(heading: Heading) -> MissingDocumentSchema:
    # What is read as id and name of a damaged version can be neither; it is stated in another form then.
    title = f"{heading.kind} {heading.name} {heading.version}"
    return MissingDocumentSchema(
        id=heading.id if re.fullmatch(ID, heading.id) else _id_from(title),
        kind=heading.kind,
        name=heading.name if _is_valid_name(heading.name) else ascii(heading.name),
        version=heading.version,
    )


def _is_valid_name(name: str) -> bool:
    try:
        return validate_name(name, of="name of a document") == name
    except InvalidInput:
        return False


def _missing_files(known: Iterable[StoredFile], damages: Iterable[Damage]) -> list[MissingFileSchema]:
    stored = {file.id: file for file in known}
    missing = []
    for damage in damages:
        if damage.problem == "document":
            continue
        file, is_id = stored.get(damage.file_id), re.fullmatch(FILE_ID, damage.file_id)
        missing.append(
            MissingFileSchema(
                id=damage.file_id if is_id else f"{_id_from(damage.file_id)}.lost",
                size_bytes=0 if file is None else file.size_bytes,
                sha256="" if file is None else file.sha256,
                problem=damage.why.message["en"],
            )
        )
    return missing


def _id_from(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


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
