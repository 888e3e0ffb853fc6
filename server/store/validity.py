"""Validity of documents: nothing that they depend on was replaced or withdrawn, or damaged by the disk."""

import hashlib
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from sqlalchemy.orm import Session

from server.store.documents import (
    IN_ORDER,
    StoredDocument,
    newest_version,
    recorded_versions,
    stored_documents,
)
from server.store.records import Current, DocumentKind, Heading, OutOfDate, Validity
from server.texts import Text, Value, reason, withdrawal_text

KINDS = frozenset(kind.value for kind in DocumentKind)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Fault:
    """Why a document is invalid: the nearest document in its lineage that is not what it depends on."""

    steps: int
    title: Text
    code: str
    values: Mapping[str, Value]


class Lineage:
    """Documents of one case, each after those that it depends on.

    Attributes:
        case_id: the case.
        headings: of all versions of all documents, by id; those that are damaged come last.
        last_row: row of the last of them.
    """

    def __init__(self, case_id: str = "") -> None:
        self.case_id = case_id
        self.headings: Mapping[str, Heading] = {}
        self.last_row = 0
        self._intact: dict[str, Heading] = {}
        # Ids of damaged rows by what is read as their kind, name and version.
        self._damaged_rows: dict[tuple[object, object, object], str] = {}
        self._newest: defaultdict[DocumentKind, dict[str, Heading]] = defaultdict(dict)
        self._faults: dict[str, _Fault | None] = {}

    def add(self, document: StoredDocument) -> None:
        """Add the next version of a document; `complete` has to follow."""
        self.last_row = document.row
        if document.heading is None:
            self._damaged_rows[document.kind, document.name, document.version] = f"{document.id}"
        else:
            self._intact[document.heading.id] = document.heading

    def complete(self, recorded: Mapping[tuple[str, str], object]) -> None:
        """Find which versions are lost, after documents were added.

        A version counts as lost where no intact row has it; which one a damaged row is does not follow from
        what it contains.

        Args:
            recorded: number of the newest version by kind and name.
        """
        self.headings = self._intact | {one.id: one for one in self._lost(recorded)}
        self._faults.clear()
        self._newest.clear()
        for heading in self.headings.values():
            before = self._newest[heading.kind].get(heading.name)
            if before is None or before.version < heading.version:
                self._newest[heading.kind][heading.name] = heading

    def _lost(self, recorded: Mapping[tuple[str, str], object]) -> Iterator[Heading]:
        intact: defaultdict[tuple[str, str], set[int]] = defaultdict(set)
        for heading in self._intact.values():
            intact[heading.kind.value, heading.name].add(heading.version)
        for kind, name in dict.fromkeys((*intact, *recorded)):
            if kind not in KINDS or not isinstance(name, str):
                continue  # a damaged record of a document whose own record is missing, therefore
            found = intact[kind, name]
            max_intact = max(found, default=0)
            newest = newest_version(max_intact, recorded.get((kind, name)))
            lost = {*range(1, max_intact)} - found | {newest} - found
            for version in sorted(lost):
                digest = hashlib.sha256(f"{kind} {name} {version}".encode()).hexdigest()
                yield Heading(
                    case_id=self.case_id,
                    id=self._damaged_rows.get((kind, name, version), digest[:16]),
                    kind=DocumentKind(kind),
                    name=name,
                    version=version,
                    made_at="",
                    made_by="",
                    is_damaged=True,
                )

    @property
    def unknown_bases(self) -> tuple[str, ...]:
        """Ids of documents that others depend on, and of which nothing else is known."""
        bases = {basis for one in self._intact.values() for basis in one.depends_on}
        return tuple(sorted(bases - self.headings.keys()))

    def newest(self, kind: DocumentKind) -> Mapping[str, Heading]:
        """Return the newest version of each name, also if it is withdrawn or damaged."""
        return self._newest[kind]

    def last_intact(self, kind: DocumentKind, name: str) -> Heading | None:
        """Return the newest version that is not damaged; None if there is none."""
        named = (one for one in self._intact.values() if (one.kind, one.name) == (kind, name))
        return max(named, key=lambda one: one.version, default=None)

    def validity(self, document_id: str) -> Validity:
        """Return whether a document is valid."""
        fault = self._fault(document_id)
        if fault is None:
            return Current()
        code = fault.code if fault.steps == 0 else f"BASIS_{fault.code}"
        return OutOfDate(why=reason(code, {"title": fault.title, **fault.values}))

    def _fault(self, document_id: str) -> _Fault | None:
        if document_id not in self._faults:
            heading = self.headings.get(document_id)
            if heading is None:
                # A dependency whose row is lost, and with it which document it was.
                title: Text = {"en": f"document {document_id}", "de": f"Dokument {document_id}"}
                return _Fault(steps=0, title=title, code="DAMAGED", values={})
            self._faults[document_id] = self._own_fault(heading) or self._inherited_fault(heading)
        return self._faults[document_id]

    def _own_fault(self, heading: Heading) -> _Fault | None:
        if heading.is_damaged:
            return _Fault(steps=0, title=heading.title_text, code="DAMAGED", values={})
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
    """Return the lineage of a case; contents are compared with their checksums, and not kept."""
    lineage = Lineage(case_id)
    for document in new_documents(session, lineage):
        lineage.add(document)
    lineage.complete(recorded_versions(session, case_id))
    return lineage


def new_documents(session: Session, lineage: Lineage) -> Iterator[StoredDocument]:
    """Yield the documents that were stored since the lineage was read, but not withdrawals since then."""
    return stored_documents(session, lineage.case_id, lineage.last_row < IN_ORDER)
