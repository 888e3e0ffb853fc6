"""The step in which a CT is sent, read and kept in the open case.

A job reads the CT into its own folder, and the voxels are moved into the case when all are there. Both lie
in one home, so nothing is copied, and a cancelled, killed or failed job leaves nothing behind. An upload
that waits for a choice among several series does not outlast a restart.
"""

import secrets
import shutil
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from server.jobs import Job, Jobs
from server.planning.ct import PREVIEW, VOXELS, read_upload
from server.procedure.opened import opened_case
from server.store import CaseStore, DocumentKind, told
from tracker.errors import NavigationError

# A case has one CT; its document has this name.
MAIN_CT = "main"
# An upload that waits for somebody to choose a series.
KEPT_S = 3600.0
MAX_KEPT = 2
UPLOAD = "upload"


class UploadUnknown(NavigationError):
    """There is no such upload, or not any more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadingBegun:
    """An upload that is being read.

    Attributes:
        upload_id: by which its first slice is asked for, and a series is chosen.
        job: that reads it.
    """

    upload_id: str
    job: Job


@dataclass(slots=True, kw_only=True)
class _Upload:
    """What was sent, until it is a CT of the case, or nobody wants it any more."""

    id: str
    case_id: str
    made_by: str
    folder: Path
    working: Path
    is_kept: bool
    began_s: float
    job_id: str = ""


class CtStep:
    """Takes a CT in; safe to use from any thread.

    Args:
        store: where it is kept.
        jobs: where it is read.
    """

    def __init__(self, *, store: CaseStore, jobs: Jobs) -> None:
        self._store = store
        self._jobs = jobs
        self._lock = threading.Lock()
        self._uploads: dict[str, _Upload] = {}

    def reject_without_case(self) -> None:
        """To be asked before much is sent.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
        """
        opened_case(self._store)

    def receive(self, path: Path, *, made_by: str) -> ReadingBegun:
        """Read what was sent, which is moved away from `path`, and keep it as the CT of the open case.

        Where there are several CT series, the job ends with the list of them, and the upload is kept for a
        while, so that one can be chosen.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
            StoreError: STORE_FULL, STORE_READ_ONLY or STORE_FAILED.
        """
        case = opened_case(self._store)
        self._forget_old()
        upload_id = secrets.token_hex(8)
        folder = self._store.home.new_temporary(".ct")
        with told(self._store.home.folder):
            folder.mkdir()
            path.replace(folder / UPLOAD)
        upload = _Upload(
            id=upload_id,
            case_id=case.id,
            made_by=made_by,
            folder=folder,
            working=folder,
            is_kept=False,
            began_s=time.monotonic(),
        )
        return self._read(upload, series=None)

    def choose(self, upload_id: str, series: str) -> ReadingBegun:
        """Read this series of an upload that was kept because it holds several.

        Raises:
            UploadUnknown: UPLOAD_UNKNOWN.
            StoreError: STORE_FULL, STORE_READ_ONLY or STORE_FAILED.
        """
        upload = self._find(upload_id)
        if not upload.is_kept:
            raise _unknown(upload_id)
        upload.working = self._store.home.new_temporary(".ct")
        with told(self._store.home.folder):
            upload.working.mkdir()
        upload.began_s = time.monotonic()
        return self._read(upload, series=series)

    def preview(self, upload_id: str) -> Path:
        """Where the first slice is, as a picture, as soon as it is read and until all are.

        Raises:
            UploadUnknown: UPLOAD_UNKNOWN.
        """
        return self._find(upload_id).working / PREVIEW

    def _read(self, upload: _Upload, *, series: str | None) -> ReadingBegun:
        def keep(values: object) -> object:
            if not isinstance(values, Mapping):
                raise TypeError(f"reading a CT gave {type(values).__name__}")
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
        return ReadingBegun(upload_id=upload.id, job=job)

    def _keep_upload(self, upload: _Upload, series: object) -> object:
        """Out of the way of the job, which takes its folder with it."""
        kept = self._store.home.new_temporary(".ct")
        with told(self._store.home.folder):
            upload.folder.replace(kept)
        upload.folder, upload.is_kept = kept, True
        return {"upload_id": upload.id, "series": series}

    def _keep_ct(self, upload: _Upload, content: Mapping[str, object]) -> object:
        with self._store.new_file(upload.case_id, ".npy") as new:
            # Both lie in one folder, so that nothing is copied.
            shutil.move(upload.working / VOXELS, new.path)
        document = self._store.put(
            upload.case_id,
            DocumentKind.CT,
            MAIN_CT,
            content,
            made_by=upload.made_by,
            files=[new.stored.id],
        )
        self._forget(upload)
        return {"document_id": document.id, "version": document.version, **content}

    def _find(self, upload_id: str) -> _Upload:
        with self._lock:
            upload = self._uploads.get(upload_id)
        if upload is None or not (upload.is_kept or upload.folder.exists()):
            raise _unknown(upload_id)
        return upload

    def _forget(self, upload: _Upload) -> None:
        with self._lock:
            self._uploads.pop(upload.id, None)
        if upload.is_kept:
            shutil.rmtree(upload.folder, ignore_errors=True)

    def _forget_old(self) -> None:
        """Uploads whose time is over, those that are gone, and more than a few that wait."""
        with self._lock:
            idle = [one for one in self._uploads.values() if not self._is_read(one)]
        waiting = sorted((one for one in idle if one.is_kept), key=lambda one: -one.began_s)
        now_s = time.monotonic()
        for upload in idle:
            if upload not in waiting[: MAX_KEPT - 1] or now_s - upload.began_s > KEPT_S:
                self._forget(upload)

    def _is_read(self, upload: _Upload) -> bool:
        """Whether a job works on it just now."""
        return not upload.job_id or any(
            job.id == upload.job_id and not job.state.is_over for job in self._jobs.list()
        )


def _unknown(upload_id: str) -> UploadUnknown:
    return UploadUnknown(
        "UPLOAD_UNKNOWN",
        f"there is no upload {upload_id[:40]} that is being read or waits for a choice",
        "Look at the job that read it; the CT may be in the case already.",
        {"upload_id": upload_id[:40]},
    )
