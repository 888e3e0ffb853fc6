"""The first schema that is migrated: cases, documents with their dependencies, and files.

Schemas 1 and 2 existed only during development; their databases are rejected.
"""

import sqlalchemy as sa
from alembic import op

revision = "3"
down_revision = None
branch_labels = None
depends_on = None

NEVER_CHANGED = (
    "case_id",
    "id",
    "kind",
    "name",
    "version",
    "content",
    "made_at",
    "made_by",
    "imported_by",
    "imported_at",
)


def upgrade() -> None:
    """Create the tables."""
    op.create_table(
        "cases",
        sa.Column("id", sa.String, primary_key=True),
        sa.Column("name", sa.String, nullable=False),
        sa.Column("state", sa.String, nullable=False),
        sa.Column("created_at", sa.String, nullable=False),
        sa.Column("changed_at", sa.String, nullable=False),
        sa.Column("copied_from", sa.String),
        _checksum(),
        sa.CheckConstraint("state IN ('arriving', 'here', 'leaving')", name="case_state"),
    )
    op.create_table(
        "open_case",
        sa.Column("only", sa.Integer, primary_key=True),
        sa.Column("case_id", sa.String, sa.ForeignKey("cases.id", ondelete="CASCADE"), nullable=False),
        sa.CheckConstraint("only = 1", name="one_case_is_open"),
    )
    op.create_table(
        "documents",
        _case(),
        sa.Column("id", sa.String, primary_key=True),
        sa.Column("kind", sa.String, nullable=False),
        sa.Column("name", sa.String, nullable=False),
        sa.Column("version", sa.Integer, nullable=False),
        sa.Column("content", sa.String, nullable=False),
        sa.Column("made_at", sa.String, nullable=False),
        sa.Column("made_by", sa.String, nullable=False),
        sa.Column("withdrawn_at", sa.String),
        sa.Column("withdrawn_by", sa.String),
        sa.Column("withdrawn_reason", sa.String),
        sa.Column("imported_by", sa.String),
        sa.Column("imported_at", sa.String),
        _checksum(),
        sa.UniqueConstraint("case_id", "kind", "name", "version", name="one_document_a_version"),
        sa.CheckConstraint("version >= 1", name="versions_count_from_one"),
    )
    op.create_table(
        "newest_versions",
        _case(),
        sa.Column("kind", sa.String, primary_key=True),
        sa.Column("name", sa.String, primary_key=True),
        sa.Column("version", sa.Integer, nullable=False),
    )
    op.create_table(
        "files",
        _case(),
        sa.Column("id", sa.String, primary_key=True),
        sa.Column("state", sa.String, nullable=False),
        sa.Column("size_bytes", sa.Integer, nullable=False),
        sa.Column("sha256", sa.String, nullable=False),
        sa.Column("made_at", sa.String, nullable=False),
        _checksum(),
        sa.CheckConstraint("state IN ('coming', 'whole')", name="file_state"),
    )
    _link("bases", to="documents", column="basis_id", index="bases_by_basis")
    _link("document_files", to="files", column="file_id", index="document_files_by_file")
    op.execute(
        f"CREATE TRIGGER documents_never_change BEFORE UPDATE OF {', '.join(NEVER_CHANGED)} ON documents "
        "BEGIN SELECT RAISE(ABORT, 'a stored document never changes'); END"
    )


def _case() -> sa.Column[str]:
    return sa.Column("case_id", sa.String, sa.ForeignKey("cases.id", ondelete="CASCADE"), primary_key=True)


def _checksum() -> sa.Column[str]:
    return sa.Column("checksum", sa.String, nullable=False)


def _link(name: str, *, to: str, column: str, index: str) -> None:
    """Create a table that links documents to other records of their case."""
    op.create_table(
        name,
        sa.Column("case_id", sa.String, primary_key=True),
        sa.Column("document_id", sa.String, primary_key=True),
        sa.Column("place", sa.Integer, primary_key=True),
        sa.Column(column, sa.String, nullable=False),
        sa.ForeignKeyConstraint(
            ["case_id", "document_id"], ["documents.case_id", "documents.id"], ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(["case_id", column], [f"{to}.case_id", f"{to}.id"], ondelete="CASCADE"),
    )
    op.create_index(index, name, ["case_id", column])
