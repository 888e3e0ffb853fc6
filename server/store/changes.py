"""What was changed in the store, for those who write down who did it."""

from dataclasses import dataclass

from server.store.records import Case, Document


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One change, as it was committed.

    Attributes:
        case_id: of which case.
        kind: of the document, or "case".
        name: of the document; empty for a case, whose name may say more than a log shall.
        before: version or state before it; None where there was none.
        after: version or state after it; None where there is none.
        by: who said that they did it.
    """

    case_id: str
    kind: str
    name: str = ""
    before: int | str | None
    after: int | str | None
    by: str = ""

    @classmethod
    def opened(cls, case_id: str, *, before: Case | None) -> "Change":
        """That another case is open now."""
        return cls(case_id=case_id, kind="open case", before=before.id if before else None, after=case_id)

    @classmethod
    def added(cls, document: Document) -> "Change":
        """That a document has a new version."""
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
        """That a document no longer holds."""
        return cls(
            case_id=document.case_id,
            kind=document.kind.value,
            name=document.name,
            before=document.version,
            after="withdrawn",
            by=by,
        )

    def told(self) -> dict[str, object]:
        """As JSON takes it."""
        line: dict[str, object] = {"what": self.kind, "case_id": self.case_id}
        if self.name and self.kind != "patient":
            line["name"] = self.name
        if self.by:
            line["by"] = self.by
        return {**line, "from": self.before, "to": self.after}
