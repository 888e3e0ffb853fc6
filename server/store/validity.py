"""Validity of documents: nothing that they depend on was replaced or withdrawn."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.store.documents import IN_ORDER, imported_of, links_of, withdrawal_of
from server.store.records import Current, DocumentKind, Heading, OutOfDate, Validity
from server.store.tables import BasisRow, DocumentRow
from server.texts import Text, Value, reason, withdrawal_text


@dataclass(frozen=True, slots=True, kw_only=True)
class _Fault:
    """Why a document is invalid: the nearest document in its lineage that was replaced or withdrawn."""

    steps: int
    title: Text
    code: str
    values: Mapping[str, Value]


class Lineage:
    """Documents of one case with their dependencies, in topological order."""

    def __init__(self, headings: Sequence[Heading], newest: Mapping[tuple[DocumentKind, str], int]) -> None:
        self.headings = {heading.id: heading for heading in headings}
        self._newest = newest
        self._faults: dict[str, _Fault] = {}
        for heading in headings:
            fault = self._own_fault(heading) or self._inherited_fault(heading)
            if fault is not None:
                self._faults[heading.id] = fault

    def validity(self, document_id: str) -> Validity:
        """Return whether a document is valid."""
        fault = self._faults.get(document_id)
        if fault is None:
            return Current()
        code = fault.code if fault.steps == 0 else f"BASIS_{fault.code}"
        return OutOfDate(why=reason(code, {"title": fault.title, **fault.values}))

    def _own_fault(self, heading: Heading) -> _Fault | None:
        if heading.withdrawn is not None:
            why = withdrawal_text(heading.withdrawn.reason)
            values: dict[str, Value] = {"by": heading.withdrawn.by, "why": why}
            return _Fault(steps=0, title=heading.title_text, code="WITHDRAWN", values=values)
        newest = self._newest[heading.kind, heading.name]
        if newest > heading.version:
            return _Fault(steps=0, title=heading.title_text, code="REPLACED", values={"version": newest})
        return None

    def _inherited_fault(self, heading: Heading) -> _Fault | None:
        faults = [self._faults[basis] for basis in heading.depends_on if basis in self._faults]
        nearest = min(faults, key=lambda fault: fault.steps, default=None)
        return None if nearest is None else replace(nearest, steps=nearest.steps + 1)


def lineage_of(session: Session, case_id: str, document_id: str | None = None) -> Lineage:
    """Return the lineage of one document, or of all documents of the case; contents are not read."""
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
        DocumentRow.imported_at,
        DocumentRow.imported_by,
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
            depends_on=tuple(bases[row.id]),
            files=tuple(files[row.id]),
            withdrawn=withdrawal_of(row.withdrawn_at, row.withdrawn_by, row.withdrawn_reason),
            imported=imported_of(row.imported_at, row.imported_by),
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
