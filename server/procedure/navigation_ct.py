"""The CT around the navigated vertebra, for viewers that resample it in the planes of the drill.

A viewer receives the part around the channels once and resamples it, because slices that follow the drill
would cost the server one image per viewer and pose.
"""

import hashlib
import threading
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from server.errors import SetupOrderError
from server.jobs import Jobs
from server.planning.volume import scan_rehearsal
from server.procedure.ct import CtProvider
from server.procedure.open_case import require_open_case
from server.procedure.plan import active_channel_document, active_channel_from_document, planned_ct_id
from server.setup import REHEARSAL_CT_ID
from server.store import CaseStore, Document
from server.texts import Text, error_reason
from tracker.geometry import Array
from tracker.plan import Volume, plan_from_mapping
from tracker.plan.crop import cropped_around
from tracker.plan.document.changes import vertebra_named

GZIP_FORMAT = 31  # zlib's window bits for a gzip header and trailer
FASTEST = 1
CANCELLED: Text = {"en": "it was cancelled", "de": "es wurde abgebrochen"}


@dataclass(frozen=True)
class NavigationCt:
    """Part of a CT around the channels of one vertebra.

    Attributes:
        ct_id: Id of the CT, as in the channel of the live message.
        volume: Part of the CT, in LPS, which is the vertebra frame.
    """

    ct_id: str
    volume: Volume

    @cached_property
    def digest(self) -> str:
        """Return a hash of voxels, affine and id."""
        known_by = hashlib.sha256(self.volume.hu.data)
        known_by.update(self.volume.lps_from_ijk.tobytes())
        known_by.update(f"{self.ct_id} {self.volume.shape_ijk}".encode())
        return known_by.hexdigest()[:32]

    @cached_property
    def gzipped(self) -> bytes:
        """Return the voxels as int16, little-endian, i fastest, gzipped to about half (0.1 s for 4 MB)."""
        packing = zlib.compressobj(FASTEST, zlib.DEFLATED, GZIP_FORMAT)
        return packing.compress(self.volume.hu.astype("<i2", copy=False).data) + packing.flush()


@dataclass(frozen=True, slots=True, kw_only=True)
class BeingScanned:
    """The simulated CT of the rehearsal is not ready yet."""


class NavigationCtProvider:
    """Provides the CT around the vertebra of the active channel. Thread-safe.

    Without an active channel of a case, a rehearsal that provides its own setup has the simulated CT of its
    vertebra. A job at the lowest priority scans it once, at the first request.

    Args:
        store: source of plan and active channel.
        ct_provider: the CT of the open case.
        jobs: runs the simulated scan.
        is_rehearsal: whether the source is a rehearsal that provides its own setup.
    """

    def __init__(self, *, store: CaseStore, ct_provider: CtProvider, jobs: Jobs, is_rehearsal: bool) -> None:
        self._store = store
        self._ct_provider = ct_provider
        self._jobs = jobs
        self._is_rehearsal = is_rehearsal
        self._lock = threading.Lock()
        self._cropped: tuple[tuple[str, ...], NavigationCt] | None = None
        self._rehearsal: NavigationCt | None = None
        self._scan_job_id = ""

    def current(self) -> NavigationCt | BeingScanned:
        """Return the part of the CT around the active channel.

        Raises:
            SetupOrderError: NO_CASE_OPEN, NO_ACTIVE_CHANNEL, CT_MISSING, CT_REPLACED or SCAN_FAILED.
            PlanError: CROP_OUTSIDE_CT.
            StoreError: FILE_DAMAGED.
            InvalidInput: CT_DOCUMENT_INVALID.
        """
        active = self._active()
        if active is not None:
            with self._lock:
                return self._of_case(active)
        if self._is_rehearsal:
            with self._lock:
                return self._of_rehearsal()
        raise SetupOrderError(
            "NO_ACTIVE_CHANNEL",
            "the open case has no active channel",
            "Select the active channel in the plan.",
            {"case_id": require_open_case(self._store).id},
        )

    def _active(self) -> Document | None:
        case = self._store.get_open_case()
        return None if case is None else active_channel_document(self._store, case.id)

    def _of_case(self, active: Document) -> NavigationCt:
        key = (active.id, *active.depends_on)
        if self._cropped is not None and self._cropped[0] == key:
            return self._cropped[1]
        ct = self._ct_provider.current()
        if ct.document.id != planned_ct_id(self._store, active):
            raise SetupOrderError(
                "CT_REPLACED",
                "the channel was not planned on the newest CT of this case",
                "Plan it on the newest CT, and select it again.",
                {"ct_id": ct.document.id},
            )
        cropped = NavigationCt(ct.document.id, cropped_around(ct.volume, self._channel_ends(active)))
        self._cropped = (key, cropped)
        return cropped

    def _channel_ends(self, active: Document) -> Sequence[Array]:
        """Return the ends of all channels of the vertebra, so that a change of side needs no other part."""
        chosen = active_channel_from_document(active)
        plan = plan_from_mapping(self._store.document(active.case_id, active.depends_on[0]).content)
        channels = [chosen.channel, *(one.channel for one in vertebra_named(plan, chosen.vertebra).channels)]
        return [end for one in channels for end in (one.entry_in_vertebra_mm, one.target_in_vertebra_mm)]

    def _of_rehearsal(self) -> NavigationCt | BeingScanned:
        if self._rehearsal is not None:
            return self._rehearsal
        if self._scan_job_id == "":
            self._scan_job_id = self._jobs.start(
                "scanning the rehearsal's vertebra", scan_rehearsal, conclude=self._keep_scan
            ).id
            return BeingScanned()
        job = self._jobs.get(self._scan_job_id)
        if not job.state.is_finished:
            return BeingScanned()
        self._scan_job_id = ""
        problem = job.problem
        reason = (
            CANCELLED
            if problem is None
            else error_reason(problem.code, problem.message, problem.remedy, problem.context).message
        )
        raise SetupOrderError(
            "SCAN_FAILED",
            f"the CT of the rehearsal's vertebra could not be simulated: {reason['en']}",
            "The next request starts another attempt.",
            {"job_id": job.id, "scan_problem": reason},
        )

    def _keep_scan(self, scanned: object) -> object:
        if not isinstance(scanned, Volume):
            raise TypeError(f"the scan returned {type(scanned).__name__}")
        with self._lock:
            self._rehearsal = NavigationCt(REHEARSAL_CT_ID, scanned)
        return {"size_ijk": list(scanned.shape_ijk)}
