"""The CT of the open case: its voxels mapped from the disk, not read into memory."""

import threading
from dataclasses import dataclass

from server.errors import SetupOrderError
from server.planning.volume import volume_of
from server.procedure.ct.step import MAIN_CT
from server.procedure.opened import opened_case
from server.store import CaseStore, Document, DocumentKind, StoredFile
from tracker.errors import InvalidInput
from tracker.plan import Volume


@dataclass(frozen=True, slots=True, kw_only=True)
class CtInUse:
    """The CT that is looked at and planned on.

    Attributes:
        document: as it is stored.
        file: its voxels.
        volume: the same, mapped; its axes in the order left-right, front-back, feet-head.
    """

    document: Document
    file: StoredFile
    volume: Volume


class OpenedCt:
    """Gives the CT of the open case; the last one is kept mapped. Safe to use from any thread."""

    def __init__(self, store: CaseStore) -> None:
        self._store = store
        self._lock = threading.Lock()
        self._in_use: CtInUse | None = None
        store.call_after_writing(self._let_go)

    def current(self) -> CtInUse:
        """The newest CT of the open case.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CT_MISSING.
            StoreError: FILE_DAMAGED.
            InvalidInput: CT_DOCUMENT_INVALID.
        """
        case = opened_case(self._store)
        document = self._store.latest(case.id, DocumentKind.CT, MAIN_CT)
        if document is None:
            raise SetupOrderError(
                "CT_MISSING",
                "the open case has no CT",
                "Send one.",
                {"case_id": case.id},
            )
        with self._lock:
            if self._in_use is None or self._in_use.document.id != document.id:
                self._in_use = self._mapped(document)
            return self._in_use

    def _let_go(self) -> None:
        """Of a CT whose case is closed: a deleted one must be gone from the disk."""
        with self._lock:
            if self._in_use is None:
                return
            case = self._store.opened()
            if case is None or case.id != self._in_use.document.case_id:
                self._in_use = None

    def _mapped(self, document: Document) -> CtInUse:
        if len(document.files) != 1:
            raise _invalid(document, f"it has {len(document.files)} files, needed 1")
        file = self._store.file(document.case_id, document.files[0])
        return CtInUse(
            document=document,
            file=file,
            volume=volume_of(str(file.path), document.content.get("lps_from_ijk"), title=document.title),
        )


def _invalid(document: Document, why: str) -> InvalidInput:
    return InvalidInput(
        "CT_DOCUMENT_INVALID",
        f"{document.title} cannot be used: {why}",
        "Send the CT again.",
        {"document_id": document.id},
    )
