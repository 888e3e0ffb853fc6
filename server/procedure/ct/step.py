"""The step in which a CT is uploaded, read and stored in the open case.

A job reads the CT into its own folder, and the voxels are moved into the case when they are complete. Both
folders are on one file system, so nothing is copied, and a cancelled, killed or failed job leaves nothing
behind. An upload that waits for the choice of a series is lost at a restart.
"""

import secrets
import shutil
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from server.imaging.dicom_network.inbox import Inbox, ReceivedUnknown
from server.jobs import Job, Jobs
from server.planning.ct import PREVIEW, VOXELS, read_upload
from server.procedure.open_case import require_open_case
from server.store import CaseStore, DocumentKind, translate_errors
from tracker.errors import NavigationError

# A case has one CT; its document has this name.
MAIN_CT = "main"
# Limits for uploads that wait for the choice of a series.
MAX_PENDING_S = 3600.0
MAX_PENDING = 2
UPLOAD = "upload"


class UploadUnknown(NavigationError):
    """The upload does not exist, or was discarded."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CtUpload:
    """An upload that is being read.

    Attributes:
        upload_id: identifier for the preview and for the choice of a series.
        job: the job that reads it.
    """

    upload_id: str
    job: Job


@dataclass(slots=True, kw_only=True)
class _Upload:
    """An upload, until it is stored as the CT of the case, or discarded."""

    id: str
    case_id: str
    made_by: str
    folder: Path
    working: Path
    is_pending: bool
    began_s: float
    on_stored: Callable[[], None] | None = None
    job_id: str = ""


class CtStep:
    """Imports a CT. Thread-safe.

    Args:
        store: where it is stored.
        jobs: runs the reading.
    """

    def __init__(self, *, store: CaseStore, jobs: Jobs) -> None:
        self._store = store
        self._jobs = jobs
        self._lock = threading.Lock()
        self._uploads: dict[str, _Upload] = {}

    def reject_without_case(self) -> None:
        """Raise if no case is open; called before a large upload.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
        """
        require_open_case(self._store)

    def receive(self, path: Path, *, made_by: str) -> CtUpload:
        """Start a job that reads the upload at `path` (which is moved) as the CT of the open case.

        If the upload contains several CT series, the result of the job is the list of them, and the upload
        is kept for up to `MAX_PENDING_S`, so that one can be chosen.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
            StoreError: STORE_FULL, STORE_READ_ONLY or STORE_FAILED.
        """
        return self._take(path.replace, made_by=made_by)

    def take(self, inbox: Inbox, series_id: str, *, made_by: str) -> CtUpload:
        """Start a job that reads a received series as the CT of the open case; it waits until that is stored.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
            ReceivedUnknown: RECEIVED_UNKNOWN.
            InvalidInput: RECEIVED_NOT_COMPLETE.
            StoreError: STORE_FULL, STORE_READ_ONLY or STORE_FAILED.
        """

        def discard() -> None:
            with suppress(ReceivedUnknown):
                inbox.discard(series_id)

        return self._take(
            lambda upload: inbox.link_into(series_id, upload), made_by=made_by, on_stored=discard
        )

    def _take(
        self,
        fill: Callable[[Path], object],
        *,
        made_by: str,
        on_stored: Callable[[], None] | None = None,
    ) -> CtUpload:
        """Start to read what `fill` puts at a path."""
        case = require_open_case(self._store)
        self._forget_old()
        upload_id = secrets.token_hex(8)
        folder = self._store.home.new_temporary(".ct")
        with translate_errors(self._store.home.folder):
            folder.mkdir()
            fill(folder / UPLOAD)
        upload = _Upload(
            id=upload_id,
            case_id=case.id,
            made_by=made_by,
            folder=folder,
            working=folder,
            is_pending=False,
            began_s=time.monotonic(),
            on_stored=on_stored,
        )
        return self._read(upload, series=None)

    def choose(self, upload_id: str, series: str) -> CtUpload:
        """Start to read one series of an upload that contains several.

        Raises:
            UploadUnknown: UPLOAD_UNKNOWN.
            StoreError: STORE_FULL, STORE_READ_ONLY or STORE_FAILED.
        """
        upload = self._find(upload_id)
        if not upload.is_pending:
            raise _unknown(upload_id)
        upload.working = self._store.home.new_temporary(".ct")
        with translate_errors(self._store.home.folder):
            upload.working.mkdir()
        upload.began_s = time.monotonic()
        return self._read(upload, series=series)

    def preview(self, upload_id: str) -> Path:
        """Return the path of the preview image, which exists from the first slice until all are read.

        Raises:
            UploadUnknown: UPLOAD_UNKNOWN.
        """
        return self._find(upload_id).working / PREVIEW

    def _read(self, upload: _Upload, *, series: str | None) -> CtUpload:
        def keep(values: object) -> object:
            if not isinstance(values, Mapping):
                raise TypeError(f"reading a CT returned {type(values).__name__}")
            if "series" in values:
                return self._keep_upload(upload, values["series"])
            return self._keep_ct(upload, values["ct"])

        with self._lock:
            self._uploads[upload.id] = upload
        job = self._jobs.start(
            "reading the CT",
            read_upload,
            {"path": str(upload.folder / UPLOAD), "folder": str(upload.working), "series": series},
            folder=upload.working,
            conclude=keep,
        )
        upload.job_id = job.id
        return CtUpload(upload_id=upload.id, job=job)

    def _keep_upload(self, upload: _Upload, series: object) -> object:
        """Move the upload out of the job's folder, which is deleted with the job."""
        folder = self._store.home.new_temporary(".ct")
        with translate_errors(self._store.home.folder):
            upload.folder.replace(folder)
        upload.folder, upload.is_pending = folder, True
        return {"upload_id": upload.id, "series": series}

    def _keep_ct(self, upload: _Upload, content: Mapping[str, object]) -> object:
        with self._store.new_file(upload.case_id, ".npy") as new:
            # Both are on one file system, so that nothing is copied.
            shutil.move(upload.working / VOXELS, new.path)
        document = self._store.put(
            upload.case_id,
            DocumentKind.CT,
            MAIN_CT,
            content,
            made_by=upload.made_by,
            files=[new.stored.id],
        )
        if upload.on_stored is not None:
            upload.on_stored()
        self._forget(upload)
        return {"document_id": document.id, "version": document.version, **content}

    def _find(self, upload_id: str) -> _Upload:
        with self._lock:
            upload = self._uploads.get(upload_id)
        if upload is None or not (upload.is_pending or upload.folder.exists()):
            raise _unknown(upload_id)
        return upload

    def _forget(self, upload: _Upload) -> None:
        with self._lock:
            self._uploads.pop(upload.id, None)
        if upload.is_pending:
            shutil.rmtree(upload.folder, ignore_errors=True)

    def _forget_old(self) -> None:
        """Discard uploads that are too old, lost, or more than `MAX_PENDING`."""
        with self._lock:
            idle = [one for one in self._uploads.values() if not self._is_read(one)]
        waiting = sorted((one for one in idle if one.is_pending), key=lambda one: -one.began_s)
        now_s = time.monotonic()
        for upload in idle:
            if upload not in waiting[: MAX_PENDING - 1] or now_s - upload.began_s > MAX_PENDING_S:
                self._forget(upload)

    def _is_read(self, upload: _Upload) -> bool:
        """Return whether a job is reading it."""
        return not upload.job_id or any(
            job.id == upload.job_id and not job.state.is_finished for job in self._jobs.list()
        )


def _unknown(upload_id: str) -> UploadUnknown:
    return UploadUnknown(
        "UPLOAD_UNKNOWN",
        f"no upload {upload_id[:40]} is being read or waits for the choice of a series",
        "Check the job that read it; the CT may already be stored in the case.",
        {"upload_id": upload_id[:40]},
    )
