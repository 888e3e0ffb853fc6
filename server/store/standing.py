"""Whether a document still holds: nothing that it stands on was replaced or withdrawn."""

from collections import deque
from collections.abc import Mapping, Sequence

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.store.documents import IN_ORDER, links_of, withdrawal_of
from server.store.records import Current, DocumentKind, Heading, OutOfDate, Standing
from server.store.tables import BasisRow, DocumentRow


class Lineage:
    """Documents of one case with everything that they stand on."""

    def __init__(self, headings: Sequence[Heading], newest: Mapping[tuple[DocumentKind, str], int]) -> None:
        self.headings = {heading.id: heading for heading in headings}
        self._newest = newest

    def standing(self, document_id: str) -> Standing:
        """Whether a document holds; the reason is the one nearest to it."""
        reached = {document_id}
        waiting: deque[tuple[str, tuple[str, ...]]] = deque([(document_id, ())])
        while waiting:
            current, path = waiting.popleft()
            heading = self.headings[current]
            fault = self._fault(heading)
            if fault:
                return OutOfDate(reason=_sentence(heading, path, fault))
            for basis in heading.stands_on:
                if basis not in reached:
                    reached.add(basis)
                    waiting.append((basis, (*path, current)))
        return Current()

    def _fault(self, heading: Heading) -> str:
        """What is wrong with this very document, empty if nothing."""
        if heading.withdrawn is not None:
            return f"was withdrawn by {heading.withdrawn.by}: {heading.withdrawn.reason}"
        newest = self._newest[heading.kind, heading.name]
        return f"was replaced by version {newest}" if newest > heading.version else ""


def _sentence(heading: Heading, path: tuple[str, ...], fault: str) -> str:
    return f"{heading.title} {fault}" if not path else f"it stands on {heading.title}, which {fault}"


def lineage_of(session: Session, case_id: str, document_id: str | None = None) -> Lineage:
    """The lineage of one document, or of all documents of the case; contents are not read."""
    columns = (
        DocumentRow.id,
        DocumentRow.kind,
        DocumentRow.name,
        DocumentRow.version,
        DocumentRow.made_at,
        DocumentRow.made_by,
        DocumentRow.withdrawn_at,
        DocumentRow.withdrawn_by,
        DocumentRow.withdrawn_reason,
    )
    chosen = select(*columns).where(DocumentRow.case_id == case_id).order_by(IN_ORDER)
    ids = None if document_id is None else _ancestors(session, case_id, document_id)
    if ids is not None:
        chosen = chosen.where(DocumentRow.id.in_(ids))
    bases, files = links_of(session, case_id, ids)
    headings = [
        Heading(
            case_id=case_id,
            id=row.id,
            kind=DocumentKind(row.kind),
            name=row.name,
            version=row.version,
            made_at=row.made_at,
            made_by=row.made_by,
            stands_on=tuple(bases[row.id]),
            files=tuple(files[row.id]),
            withdrawn=withdrawal_of(row.withdrawn_at, row.withdrawn_by, row.withdrawn_reason),
        )
        for row in session.execute(chosen)
    ]
    return Lineage(headings, _newest_versions(session, case_id))


def _ancestors(session: Session, case_id: str, document_id: str) -> list[str]:
    above = (
        select(DocumentRow.id)
        .where(DocumentRow.case_id == case_id, DocumentRow.id == document_id)
        .cte(recursive=True)
    )
    above = above.union(
        select(BasisRow.basis_id)
        .join(above, BasisRow.document_id == above.c.id)
        .where(BasisRow.case_id == case_id)
    )
    return list(session.scalars(select(above.c.id)))


def _newest_versions(session: Session, case_id: str) -> dict[tuple[DocumentKind, str], int]:
    newest = (
        select(DocumentRow.kind, DocumentRow.name, func.max(DocumentRow.version))
        .where(DocumentRow.case_id == case_id)
        .group_by(DocumentRow.kind, DocumentRow.name)
    )
    return {(DocumentKind(kind), name): version for kind, name, version in session.execute(newest)}
