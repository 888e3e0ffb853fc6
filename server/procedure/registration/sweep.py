"""Surface registration step: a sweep of the tip over the bone refines a registration."""

import threading
from dataclasses import dataclass, replace

import numpy as np

from server.config import RegistrationConfig
from server.imaging.meshes import read_mesh
from server.live import Instant, LiveHub, Problem
from server.procedure.collecting_step import CollectingStep
from server.procedure.live_listener import LiveListener
from server.procedure.registration.context import RegistrationContext, RegistrationContextFinder
from server.procedure.registration.landmark_capture import tip_of
from server.procedure.registration.repository import RegistrationRepository, StoredRegistration
from server.procedure.registration_record import RegistrationEvidence, RegistrationRecord, Value
from server.procedure.state import Procedure, StepName
from server.procedure.surface import SurfaceStep
from server.store import Document
from tracker.errors import RegistrationError
from tracker.geometry import Array
from tracker.plan.document import plain
from tracker.registration import AnchoredTo
from tracker.registration.capture import TipSample
from tracker.registration.points import PointPairs
from tracker.registration.surface import (
    ClosestPointQuery,
    SurfaceGate,
    SurfaceRegistration,
    principal_extents_mm,
    register_surface,
)

# Two minutes at 30 images/s; more points do not improve the fit.
MAX_POINTS = 3600


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepStatus:
    """Progress of a sweep.

    Attributes:
        context: context of the registration.
        start: the registration that it refines.
        taking: whether tip positions are recorded.
        points: number of recorded points.
        unseen: number of images without a tip position.
        reach_mm: extent of the points along their principal axes, the longest first.
        from_s: time of the first point, on the image clock; None before it.
        problem: why the sweep ended.
    """

    context: RegistrationContext
    start: StoredRegistration
    taking: bool
    points: int
    unseen: int
    reach_mm: tuple[float, float, float]
    from_s: float | None
    problem: Problem | None


class SweepSession:
    """Records tip positions during a sweep over exposed bone. Thread-safe."""

    def __init__(self, hub: LiveHub, context: RegistrationContext, start: StoredRegistration) -> None:
        self._context = context
        self._start = start
        self._lock = threading.Lock()
        self._taking = True
        self._points: list[Array] = []
        self._unseen = 0
        self._from_s: float | None = None
        self._image_number = -1
        self._listener = LiveListener(hub, self._process, name=f"sweeping {context.vertebra.name}")

    def take(self, *, taking: bool) -> None:
        """Resume or pause the recording; pause it while the tip is off the bone."""
        with self._lock:
            self._taking = taking

    @property
    def points_mm(self) -> Array:
        """Recorded points (n, 3) in the anchor frame."""
        with self._lock:
            return np.array(self._points, dtype=np.float64).reshape(-1, 3)

    @property
    def status(self) -> SweepStatus:
        """Progress of the sweep."""
        points = self.points_mm
        with self._lock:
            return SweepStatus(
                context=self._context,
                start=self._start,
                taking=self._taking and self._listener.running,
                points=len(points),
                unseen=self._unseen,
                reach_mm=principal_extents_mm(points),
                from_s=self._from_s,
                problem=self._listener.problem,
            )

    def stop(self) -> None:
        """Stop recording."""
        self._listener.stop()

    def _process(self, instant: Instant) -> None:
        snapshot = instant.snapshot
        if snapshot is None or snapshot.image_number == self._image_number:
            return
        self._image_number = snapshot.image_number
        tip = tip_of(snapshot, self._context.tool, self._context.reference)
        with self._lock:
            if not self._taking or len(self._points) >= MAX_POINTS:
                return
            if not isinstance(tip, TipSample):
                self._unseen += 1
                return
            self._from_s = tip.at_s if self._from_s is None else self._from_s
            self._points.append(tip.tip_in_anchor_mm)


class SweepStep(CollectingStep[SweepSession]):
    """Refines registrations on the bone surface; one sweep at a time. Thread-safe.

    Args:
        hub: the live images.
        contexts: finds the context of the registration.
        repository: where it is stored.
        procedure: provides the run of the server.
        surfaces: provides the bone surface.
        gate: acceptance limits.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        contexts: RegistrationContextFinder,
        repository: RegistrationRepository,
        procedure: Procedure,
        surfaces: SurfaceStep,
        gate: RegistrationConfig,
    ) -> None:
        super().__init__("sweep is", remedy="Start a sweep with a tool.")
        self._hub = hub
        self._contexts = contexts
        self._repository = repository
        self._procedure = procedure
        self._surfaces = surfaces
        self._gate = SurfaceGate(max_rms_mm=gate.max_surface_rms_mm, max_tre_mm=gate.max_tre_mm)
        self._lock = threading.Lock()
        self._nearest: tuple[str, ClosestPointQuery] | None = None

    def begin(self, *, tool: str) -> SweepSession:
        """Start a sweep of the active vertebra, which must be registered.

        Raises:
            SetupOrderError: NO_CASE_OPEN, SURFACE_MISSING, or the code of a missing earlier step.
            InvalidInput: TOOL_UNKNOWN.
            RegistrationError: SWEEP_ANCHOR_DIFFERS.
        """
        context = self._contexts.find(vertebra=None, tool=tool, step=StepName.CHECK)
        start = self._repository.current(context.vertebra.name)
        self._surfaces.latest()
        if start.record.anchored_to is not context.anchored_to:
            raise RegistrationError(
                "SWEEP_ANCHOR_DIFFERS",
                f"{start.document.title} is anchored to the {start.record.anchored_to}, but a sweep would be "
                f"anchored to the {context.anchored_to}",
                "Register by points again, then sweep.",
                {
                    "title": start.document.title,
                    "start_anchor": str(start.record.anchored_to),
                    "sweep_anchor": str(context.anchored_to),
                },
            )
        return self._start(lambda: SweepSession(self._hub, context, start))

    def fit(self) -> tuple[SurfaceRegistration, tuple[RegistrationError, ...], str]:
        """Fit the sweep to the surface; return the fit, the reasons to reject it, and the surface's id.

        Raises:
            SetupOrderError: COLLECTION_MISSING, SURFACE_MISSING.
            RegistrationError: as `register_surface`, for example if the sweep can slide on the surface.
        """
        session = self.collection
        status, points = session.status, session.points_mm
        surface_id, nearest = self._bone()
        record = status.start.record
        targets = list(status.context.entries_mm)
        found = register_surface(
            nearest,
            points,
            record.registration.anchor_from_vertebra.inverse,
            targets_mm=targets,
            landmarks=self._landmarks(record),
        )
        return found, found.failures(self._gate, targets), surface_id

    def conclude(self, *, made_by: str) -> Document:
        """Store the refined registration as the next version if it is accepted, and end the sweep.

        Raises:
            SetupOrderError, OutOfDateError: A dependency is missing or has changed.
            RegistrationError: As `fit`, or a limit is exceeded.
            StoreConflict: VERSION_CONFLICT, the registration was changed since the sweep started.
        """
        status = self.collection.status
        self._contexts.reject_changed(status.context)
        found, failures, surface_id = self.fit()
        if failures:
            raise failures[0]
        document = self._repository.put(
            status.context,
            replace(
                found.registration(status.context.anchored_to),
                tracking_covariance_mm2=status.start.record.registration.tracking_covariance_mm2,
            ),
            RegistrationEvidence(
                numbers=self.numbers(status, found),
                made_from={
                    "tool": status.context.tool,
                    "start_version": status.start.document.version,
                    "points": status.start.record.made_from.get("points", []),
                    "weakest": found.weakest_mode.description,
                    "remarks": [plain(remark) for remark in found.remarks],
                    "sweep_in_anchor_mm": np.round(self.collection.points_mm, 3).tolist(),
                },
                from_s=self._from_s(status),
            ),
            made_by=made_by,
            also_on=[surface_id],
            expected_version=status.start.document.version,
        )
        self.end()
        return document

    def numbers(self, status: SweepStatus, found: SurfaceRegistration) -> dict[str, Value]:
        """Return the results and their limits, by name."""
        return {
            "points": len(found.used),
            "used_ratio": found.used_ratio,
            "rms_mm": found.rms_mm,
            "max_rms_mm": self._gate.max_rms_mm,
            "tre_at_entry_mm": max(
                (found.tre_stated_mm(entry) for entry in status.context.entries_mm), default=None
            ),
            "max_tre_mm": self._gate.max_tre_mm,
            "moved_mm": found.moved_mm,
            "moved_deg": found.moved_deg,
            "weakest_sd_mm": found.weakest_mode.sd_mm if np.isfinite(found.weakest_mode.sd_mm) else None,
        }

    def _bone(self) -> tuple[str, ClosestPointQuery]:
        document, file = self._surfaces.latest()
        with self._lock:
            if self._nearest is None or self._nearest[0] != document.id:
                self._nearest = document.id, ClosestPointQuery(read_mesh(file.path, unit="mm").surface)
            return self._nearest

    def _is_loose(self, record: RegistrationRecord) -> bool:
        """Return whether the registration is anchored to the camera and from an earlier run of the server.

        The camera may have been moved since.
        """
        return record.anchored_to is AnchoredTo.CAMERA and record.run != self._procedure.run

    def _from_s(self, status: SweepStatus) -> float | None:
        record = status.start.record
        return status.from_s if record.run != self._procedure.run else record.from_s

    def _landmarks(self, record: RegistrationRecord) -> PointPairs | None:
        """Return the captured landmarks of the registration, which take part in the fit."""
        points = record.made_from.get("points")
        used = [
            one
            for one in (points if isinstance(points, list) else [])
            if isinstance(one, dict) and one.get("used") is True and "tip_in_anchor_mm" in one
        ]
        if not used or self._is_loose(record):
            return None
        return PointPairs(
            fixed_mm=np.array([one["point_lps_mm"] for one in used]),
            moving_mm=np.array([one["tip_in_anchor_mm"] for one in used]),
            moving_covariances_mm2=np.array([one["tip_covariance_mm2"] for one in used]),
            labels=tuple(str(one["landmark"]) for one in used),
        )
