"""The tables of the database in the current schema.

A change here needs a new file in `migrations/versions`; a test compares the two.
"""

from sqlalchemy import (
    CheckConstraint,
    Connection,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    UniqueConstraint,
    event,
)
from sqlalchemy.orm import DeclarativeBase, Mapped, Mapper, mapped_column

from server.store.checksums import case_checksum, file_checksum

# States of a case, and of a file. The values are stored in databases.
IMPORTING, PRESENT, DELETING = "arriving", "here", "leaving"
WRITING, COMPLETE = "coming", "whole"


class Table(DeclarativeBase):
    """Base class of all tables."""


class CaseRow(Table):
    """A case. A row that is being imported or deleted is invisible, and removed at the next start."""

    __tablename__ = "cases"
    __table_args__ = (CheckConstraint("state IN ('arriving', 'here', 'leaving')", name="case_state"),)

    id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]
    state: Mapped[str]
    created_at: Mapped[str]
    changed_at: Mapped[str]
    copied_from: Mapped[str | None]
    checksum: Mapped[str]


class OpenCaseRow(Table):
    """The open case; it stays open over a restart."""

    __tablename__ = "open_case"
    __table_args__ = (CheckConstraint("only = 1", name="one_case_is_open"),)

    only: Mapped[int] = mapped_column(primary_key=True)
    case_id: Mapped[str] = mapped_column(ForeignKey("cases.id", ondelete="CASCADE"))


class DocumentRow(Table):
    """One version of a document; only its withdrawal can be added, which changes its checksum."""

    __tablename__ = "documents"
    __table_args__ = (
        UniqueConstraint("case_id", "kind", "name", "version", name="one_document_a_version"),
        CheckConstraint("version >= 1", name="versions_count_from_one"),
    )

    case_id: Mapped[str] = mapped_column(ForeignKey("cases.id", ondelete="CASCADE"), primary_key=True)
    id: Mapped[str] = mapped_column(primary_key=True)
    kind: Mapped[str]
    name: Mapped[str]
    version: Mapped[int]
    content: Mapped[str]
    made_at: Mapped[str]
    made_by: Mapped[str]
    withdrawn_at: Mapped[str | None]
    withdrawn_by: Mapped[str | None]
    withdrawn_reason: Mapped[str | None]
    imported_by: Mapped[str | None]
    imported_at: Mapped[str | None]
    checksum: Mapped[str]


class NewestVersionRow(Table):
    """Number of the newest version of a document, so that a lost row does not make an older version valid."""

    __tablename__ = "newest_versions"

    case_id: Mapped[str] = mapped_column(ForeignKey("cases.id", ondelete="CASCADE"), primary_key=True)
    kind: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    version: Mapped[int]


class FileRow(Table):
    """A file in the case's folder. The row is created before the file, so that no file is without one."""

    __tablename__ = "files"
    __table_args__ = (CheckConstraint("state IN ('coming', 'whole')", name="file_state"),)

    case_id: Mapped[str] = mapped_column(ForeignKey("cases.id", ondelete="CASCADE"), primary_key=True)
    id: Mapped[str] = mapped_column(primary_key=True)
    state: Mapped[str]
    size_bytes: Mapped[int]
    sha256: Mapped[str]
    made_at: Mapped[str]
    checksum: Mapped[str]


class BasisRow(Table):
    """A dependency of a document on another one."""

    __tablename__ = "bases"
    __table_args__ = (
        ForeignKeyConstraint(
            ["case_id", "document_id"], ["documents.case_id", "documents.id"], ondelete="CASCADE"
        ),
        ForeignKeyConstraint(
            ["case_id", "basis_id"], ["documents.case_id", "documents.id"], ondelete="CASCADE"
        ),
        Index("bases_by_basis", "case_id", "basis_id"),
    )

    case_id: Mapped[str] = mapped_column(primary_key=True)
    document_id: Mapped[str] = mapped_column(primary_key=True)
    place: Mapped[int] = mapped_column(primary_key=True)
    basis_id: Mapped[str]


class DocumentFileRow(Table):
    """A file that belongs to a document."""

    __tablename__ = "document_files"
    __table_args__ = (
        ForeignKeyConstraint(
            ["case_id", "document_id"], ["documents.case_id", "documents.id"], ondelete="CASCADE"
        ),
        ForeignKeyConstraint(["case_id", "file_id"], ["files.case_id", "files.id"], ondelete="CASCADE"),
        Index("document_files_by_file", "case_id", "file_id"),
    )

    case_id: Mapped[str] = mapped_column(primary_key=True)
    document_id: Mapped[str] = mapped_column(primary_key=True)
    place: Mapped[int] = mapped_column(primary_key=True)
    file_id: Mapped[str]


@event.listens_for(CaseRow, "before_insert")
@event.listens_for(CaseRow, "before_update")
def _add_case_checksum(_mapper: Mapper[CaseRow], _connection: Connection, row: CaseRow) -> None:
    row.checksum = case_checksum(row)


@event.listens_for(FileRow, "before_insert")
@event.listens_for(FileRow, "before_update")
def _add_file_checksum(_mapper: Mapper[FileRow], _connection: Connection, row: FileRow) -> None:
    row.checksum = file_checksum(row)
