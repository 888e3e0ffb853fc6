"""The CT of the open case, memory-mapped from its file."""

import threading
from dataclasses import dataclass

from server.errors import SetupOrderError
from server.planning.volume import load_volume
from server.procedure.ct.step import MAIN_CT
from server.procedure.open_case import require_open_case
from server.store import CaseStore, Document, DocumentKind, StoredFile
from tracker.errors import InvalidInput
from tracker.plan import Volume


@dataclass(frozen=True, slots=True, kw_only=True)
class MappedCt:
    """A CT with its mapped voxels.

    Attributes:
        document: the stored document.
        file: file of the voxels.
        volume: the mapped voxels; axes in the order left-right, front-back, feet-head.
    """

    document: Document
    file: StoredFile
    volume: Volume


class CtProvider:
    """Provides the CT of the open case, and caches its mapping. Thread-safe."""

    def __init__(self, store: CaseStore) -> None:
        self._store = store
        self._lock = threading.Lock()
        self._in_use: MappedCt | None = None
        store.add_commit_listener(self._release)

    def current(self) -> MappedCt:
        """Return the newest CT of the open case.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CT_MISSING.
            StoreError: FILE_DAMAGED.
            InvalidInput: CT_DOCUMENT_INVALID.
        """
        case = require_open_case(self._store)
        document = self._store.latest(case.id, DocumentKind.CT, MAIN_CT)
        if document is None:
            raise SetupOrderError(
                "CT_MISSING",
                "the open case has no CT",
                "Upload a CT.",
                {"case_id": case.id},
            )
        with self._lock:
            if self._in_use is None or self._in_use.document.id != document.id:
                self._in_use = self._mapped(document)
            return self._in_use

    def _release(self) -> None:
        """Unmap the CT of a case that is closed: its file must be removable when the case is deleted."""
        with self._lock:
            if self._in_use is None:
                return
            case = self._store.get_open_case()
            if case is None or case.id != self._in_use.document.case_id:
                self._in_use = None

    def _mapped(self, document: Document) -> MappedCt:
        if len(document.files) != 1:
            raise _invalid(document, f"it has {len(document.files)} files, expected 1")
        file = self._store.file(document.case_id, document.files[0])
        return MappedCt(
            document=document,
            file=file,
            volume=load_volume(
                str(file.path), document.content.get("lps_from_ijk"), title=document.title_text
            ),
        )


def _invalid(document: Document, why: str) -> InvalidInput:
    return InvalidInput(
        "CT_DOCUMENT_INVALID",
        f"{document.title} cannot be used: {why}",
        "Upload the CT again.",
        {"document_id": document.id, "title": document.title_text, "document_problem": why},
    )
