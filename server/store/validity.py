"""Validity of documents: nothing that they depend on was replaced or withdrawn."""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, replace

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.store.documents import IN_ORDER, imported_of, links_of, withdrawal_of
from server.store.records import Current, DocumentKind, Heading, OutOfDate, Validity
from server.store.tables import DocumentRow
from server.texts import Text, Value, reason, withdrawal_text


@dataclass(frozen=True, slots=True, kw_only=True)
class _Fault:
    """Why a document is invalid: the nearest document in its lineage that was replaced or withdrawn."""

    steps: int
    title: Text
    code: str
    values: Mapping[str, Value]


class Lineage:
    """Documents of one case, each after those that it depends on.

    Attributes:
        headings: of all versions of all documents, by id.
        last_row: row of the last of them.
    """

    def __init__(self) -> None:
        self.headings: dict[str, Heading] = {}
        self.last_row = 0
        self._newest: defaultdict[DocumentKind, dict[str, Heading]] = defaultdict(dict)
        self._faults: dict[str, _Fault | None] = {}

    def add(self, heading: Heading) -> None:
        """Add the next version of a document."""
        self.headings[heading.id] = heading
        before = self._newest[heading.kind].get(heading.name)
        if before is None or before.version < heading.version:
            self._newest[heading.kind][heading.name] = heading
        self._faults.clear()

    def newest(self, kind: DocumentKind) -> Mapping[str, Heading]:
        """Return the newest version of each name, also if it is withdrawn."""
        return self._newest[kind]

    def validity(self, document_id: str) -> Validity:
        """Return whether a document is valid."""
        fault = self._fault(document_id)
        if fault is None:
            return Current()
        code = fault.code if fault.steps == 0 else f"BASIS_{fault.code}"
        return OutOfDate(why=reason(code, {"title": fault.title, **fault.values}))

    def _fault(self, document_id: str) -> _Fault | None:
        if document_id not in self._faults:
            heading = self.headings[document_id]
            self._faults[document_id] = self._own_fault(heading) or self._inherited_fault(heading)
        return self._faults[document_id]

    def _own_fault(self, heading: Heading) -> _Fault | None:
        if heading.withdrawn is not None:
            why = withdrawal_text(heading.withdrawn.reason)
            values: dict[str, Value] = {"by": heading.withdrawn.by, "why": why}
            return _Fault(steps=0, title=heading.title_text, code="WITHDRAWN", values=values)
        newest = self._newest[heading.kind][heading.name].version
        if newest > heading.version:
            return _Fault(steps=0, title=heading.title_text, code="REPLACED", values={"version": newest})
        return None

    def _inherited_fault(self, heading: Heading) -> _Fault | None:
        faults = [fault for basis in heading.depends_on if (fault := self._fault(basis)) is not None]
        nearest = min(faults, key=lambda fault: fault.steps, default=None)
        return None if nearest is None else replace(nearest, steps=nearest.steps + 1)


def lineage_of(session: Session, case_id: str) -> Lineage:
    """Return the lineage of a case; contents are not read."""
    lineage = Lineage()
    read_lineage(session, case_id, lineage)
    return lineage


def read_lineage(session: Session, case_id: str, lineage: Lineage) -> None:
    """Add the documents that were stored since the lineage was read; withdrawals since then are not seen."""
    columns = (
        IN_ORDER.label("row"),
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
    chosen = select(*columns).where(DocumentRow.case_id == case_id, lineage.last_row < IN_ORDER)
    rows = session.execute(chosen.order_by(IN_ORDER)).all()
    bases, files = links_of(session, case_id, [row.id for row in rows])
    for row in rows:
        lineage.last_row = row.row
        lineage.add(
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
        )
