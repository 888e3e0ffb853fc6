"""Records of changes in the store, for the audit log."""

from dataclasses import dataclass

from server.store.records import Case, Document


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One committed change.

    Attributes:
        case_id: the case.
        kind: kind of the document, or "case", "open case", "rotation" (a recording was deleted by it).
        name: name of the document; empty for a case, whose name could identify the patient.
        before: version or state before the change; None if there was none.
        after: version or state after the change; None if there is none.
        by: stated author.
    """

    case_id: str
    kind: str
    name: str = ""
    before: int | str | None
    after: int | str | None
    by: str = ""

    @classmethod
    def opened(cls, case_id: str, *, before: Case | None) -> "Change":
        """Return the change for an opened case."""
        return cls(case_id=case_id, kind="open case", before=before.id if before else None, after=case_id)

    @classmethod
    def added(cls, document: Document) -> "Change":
        """Return the change for a new version of a document."""
        return cls(
            case_id=document.case_id,
            kind=document.kind.value,
            name=document.name,
            before=document.version - 1 or None,
            after=document.version,
            by=document.made_by,
        )

    @classmethod
    def withdrawn(cls, document: Document, *, by: str) -> "Change":
        """Return the change for a withdrawn document."""
        return cls(
            case_id=document.case_id,
            kind=document.kind.value,
            name=document.name,
            before=document.version,
            after="withdrawn",
            by=by,
        )

    def to_json(self) -> dict[str, object]:
        """Return the change as JSON-serialisable values."""
        line: dict[str, object] = {"what": self.kind, "case_id": self.case_id}
        if self.name and self.kind != "patient":
            line["name"] = self.name
        if self.by:
            line["by"] = self.by
        return {**line, "from": self.before, "to": self.after}
