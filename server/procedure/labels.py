"""Labels step: takes in a segmentation of the vertebrae in the CT, and provides its labels."""

import shutil
import threading
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from server.errors import SetupOrderError
from server.imaging.labels.names import names_from_text
from server.jobs import Job, Jobs
from server.planning.labels import LABELS, UPLOAD, read_labels
from server.procedure.ct import CtProvider
from server.procedure.open_case import require_open_case
from server.store import CaseStore, Document, DocumentKind, StoredFile, translate_errors
from tracker.geometry import Array
from tracker.plan.labels import (
    LabelOutline,
    LabelVolume,
    StartPoint,
    label_outlines,
    pedicle_start_points,
)

# A case has the labels of one segmentation; its document has this name.
MAIN_LABELS = "main"


@dataclass(frozen=True, slots=True, kw_only=True)
class CaseLabels:
    """The labels of the open case.

    Attributes:
        document: the stored document.
        volume: the labels in the voxels of the CT.
    """

    document: Document
    volume: LabelVolume


class LabelProvider:
    """Provides the valid labels of the open case, and caches them. Thread-safe."""

    def __init__(self, store: CaseStore) -> None:
        self._store = store
        self._lock = threading.Lock()
        self._in_use: CaseLabels | None = None

    def current(self) -> CaseLabels | None:
        """Return the labels of the open case; None if it has none, or they are of another CT.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
            StoreError: FILE_DAMAGED.
            InvalidInput: LABELS_DAMAGED.
        """
        case = require_open_case(self._store)
        document = self._store.find_current(case.id, DocumentKind.LABELS, MAIN_LABELS)
        if document is None:
            return None
        with self._lock:
            if self._in_use is None or self._in_use.document.id != document.id:
                self._in_use = self._loaded(document)
            return self._in_use

    def _loaded(self, document: Document) -> CaseLabels:
        from server.imaging.labels.label_file import (  # noqa: PLC0415  slow to import
            labels_damaged,
            load_label_file,
        )

        voxel_mm = document.content.get("voxel_mm")
        if len(document.files) != 1 or not isinstance(voxel_mm, float | int):
            raise labels_damaged()
        file = self._store.file(document.case_id, document.files[0])
        return CaseLabels(document=document, volume=load_label_file(file.path, voxel_mm=float(voxel_mm)))


class LabelStep:
    """Takes in segmentations. Thread-safe.

    Args:
        store: where the labels are stored.
        jobs: runs the reading.
        ct_provider: the CT that they must be of.
        provider: the labels, which other steps use too.
    """

    def __init__(
        self, *, store: CaseStore, jobs: Jobs, ct_provider: CtProvider, provider: LabelProvider
    ) -> None:
        self._store = store
        self._jobs = jobs
        self._ct_provider = ct_provider
        self._provider = provider

    def reject_without_ct(self) -> None:
        """Raise if the open case has no CT, before a large upload.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CT_MISSING.
        """
        self._ct_provider.current()

    def receive(self, path: Path, *, names: str, made_by: str) -> Job:
        """Start a job that reads the segmentation at `path` (which is moved) for the CT of the open case.

        Args:
            path: the upload: NIfTI, DICOM SEG, or a zip of them.
            names: levels of its labels as `29:L3,28:L4`; empty for those that the file names.
            made_by: who sent it.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CT_MISSING.
            InvalidInput: LABEL_NAMES_INVALID.
            StoreError: STORE_FULL, STORE_READ_ONLY or STORE_FAILED.
        """
        ct = self._ct_provider.current()
        names_from_text(names)
        case_id = ct.document.case_id
        folder = self._store.home.new_temporary(".labels")
        with translate_errors(self._store.home.folder):
            folder.mkdir()
            path.replace(folder / UPLOAD)

        def keep(values: object) -> object:
            if not isinstance(values, Mapping):
                raise TypeError(f"reading labels returned {type(values).__name__}")
            with self._store.new_file(case_id, ".gz") as new:
                shutil.move(folder / LABELS, new.path)
            content = {**values, "sha256": new.stored.sha256}
            document = self._store.put(
                case_id,
                DocumentKind.LABELS,
                MAIN_LABELS,
                content,
                made_by=made_by,
                depends_on=[ct.document.id],
                files=[new.stored.id],
            )
            return {"document_id": document.id, "version": document.version, **content}

        return self._jobs.start(
            "reading the segmentation",
            read_labels,
            {
                "folder": str(folder),
                "ct_path": str(ct.file.path),
                "lps_from_ijk": ct.document.content["lps_from_ijk"],
                "names": names,
            },
            folder=folder,
            conclude=keep,
        )

    def latest(self) -> tuple[Document, StoredFile]:
        """Return the newest labels of the open case, with their file.

        Raises:
            SetupOrderError: NO_CASE_OPEN, LABELS_NOT_STORED.
            StoreError: FILE_DAMAGED.
        """
        case = require_open_case(self._store)
        document = self._store.latest(case.id, DocumentKind.LABELS, MAIN_LABELS)
        if document is None or not document.files:
            raise labels_not_stored(case.id)
        return document, self._store.file(case.id, document.files[0])

    def start_points(self, level: str) -> tuple[StartPoint, ...]:
        """Return where the measurement of both pedicles of a level starts.

        Raises:
            SetupOrderError: NO_CASE_OPEN, LABELS_NOT_STORED.
            PlanError: LEVEL_WITHOUT_LABEL, LABEL_WITHOUT_PEDICLES.
        """
        return pedicle_start_points(self._current().volume, level)

    def outlines(self, lps_from_px: Array, size_wh_px: tuple[int, int]) -> tuple[LabelOutline, ...]:
        """Return the outlines of the labels in a slice of the CT.

        Raises:
            SetupOrderError: NO_CASE_OPEN, LABELS_NOT_STORED.
        """
        return label_outlines(self._current().volume, lps_from_px, size_wh_px)

    def _current(self) -> CaseLabels:
        labels = self._provider.current()
        if labels is None:
            raise labels_not_stored(require_open_case(self._store).id)
        return labels


def labels_not_stored(case_id: str) -> SetupOrderError:
    """Return the error for a case without labels of its CT."""
    return SetupOrderError(
        "LABELS_NOT_STORED",
        "the open case has no labels of vertebrae for its CT",
        "Send a segmentation of this CT.",
        {"case_id": case_id},
    )
