"""Import of documents with an archive: person and time."""

import sqlalchemy as sa
from alembic import op

revision = "2"
down_revision = "1"
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
# Name for imports before this migration. It marks all documents of an imported case, because it is unknown
# which of them were made here later.
NOT_WRITTEN_DOWN = "somebody (not written down)"


def upgrade() -> None:
    """Add the two columns."""
    op.execute("DROP TRIGGER documents_never_change")
    op.add_column("documents", sa.Column("imported_by", sa.String))
    op.add_column("documents", sa.Column("imported_at", sa.String))
    documents = sa.table(
        "documents", sa.column("case_id"), sa.column("imported_by"), sa.column("imported_at")
    )
    cases = sa.table("cases", sa.column("id"), sa.column("changed_at"), sa.column("copied_from"))
    changed_at = sa.select(cases.c.changed_at).where(cases.c.id == documents.c.case_id).scalar_subquery()
    op.execute(
        documents.update()
        .where(documents.c.case_id.in_(sa.select(cases.c.id).where(cases.c.copied_from.is_not(None))))
        .values(imported_by=NOT_WRITTEN_DOWN, imported_at=changed_at)
    )
    op.execute(
        f"CREATE TRIGGER documents_never_change BEFORE UPDATE OF {', '.join(NEVER_CHANGED)} ON documents "
        "BEGIN SELECT RAISE(ABORT, 'a stored document never changes'); END"
    )
