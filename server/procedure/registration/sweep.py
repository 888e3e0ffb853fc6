"""The step in which a sweep of the tip over the bone refines a registration by points."""

import threading
from dataclasses import dataclass

import numpy as np

from server.config import RegistrationConfig
from server.imaging.meshes import read_mesh
from server.live import Instant, LiveHub, Problem
from server.procedure.following import Follower
from server.procedure.held import Held
from server.procedure.registered import KeptRegistration, Value
from server.procedure.registration.ground import Ground, GroundFinder
from server.procedure.registration.repository import RegistrationRepository, ShelvedRegistration
from server.procedure.registration.touching import tip_of
from server.procedure.state import Procedure, StepName
from server.procedure.surface import SurfaceStep
from server.store import Document
from tracker.errors import RegistrationError
from tracker.geometry import Array
from tracker.registration import AnchoredTo
from tracker.registration.capture import TipSample
from tracker.registration.points import PairedPoints
from tracker.registration.surface import (
    NearestOnSurface,
    SurfaceGate,
    SurfaceRegistration,
    register_surface,
)

# Two minutes at 30 images a second; more says nothing new.
MAX_POINTS = 3600


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepStatus:
    """How far a sweep has come.

    Attributes:
        ground: what it stands on.
        start: the registration that it refines.
        taking: whether the tip's places are taken.
        points: taken so far.
        unseen: images in which the tip was not known.
        reach_mm: from end to end of what was swept, along each of its three axes, the longest first.
        from_s: when the first was taken, by the clock of the images; None before.
        trouble: why nothing is taken any more.
    """

    ground: Ground
    start: ShelvedRegistration
    taking: bool
    points: int
    unseen: int
    reach_mm: tuple[float, float, float]
    from_s: float | None
    problem: Problem | None


class SweepSession:
    """Takes the tip's places while it is swept over bare bone; may be asked from any thread."""

    def __init__(self, hub: LiveHub, ground: Ground, start: ShelvedRegistration) -> None:
        self._ground = ground
        self._start = start
        self._lock = threading.Lock()
        self._taking = True
        self._points: list[Array] = []
        self._unseen = 0
        self._from_s: float | None = None
        self._image_number = -1
        self._follower = Follower(hub, self._look, name=f"sweeping {ground.vertebra.name}")

    def take(self, *, taking: bool) -> None:
        """Take the tip's places, or leave it out while the tip is off the bone."""
        with self._lock:
            self._taking = taking

    @property
    def points_mm(self) -> Array:
        """What was taken (n, 3), in the anchor's frame."""
        with self._lock:
            return np.array(self._points, dtype=np.float64).reshape(-1, 3)

    @property
    def status(self) -> SweepStatus:
        """How far it has come."""
        points = self.points_mm
        with self._lock:
            return SweepStatus(
                ground=self._ground,
                start=self._start,
                taking=self._taking and self._follower.running,
                points=len(points),
                unseen=self._unseen,
                reach_mm=_reach_mm(points),
                from_s=self._from_s,
                problem=self._follower.problem,
            )

    def stop(self) -> None:
        """Take no more."""
        self._follower.stop()

    def _look(self, instant: Instant) -> None:
        snapshot = instant.snapshot
        if snapshot is None or snapshot.image_number == self._image_number:
            return
        self._image_number = snapshot.image_number
        tip = tip_of(snapshot, self._ground.tool, self._ground.reference)
        with self._lock:
            if not self._taking or len(self._points) >= MAX_POINTS:
                return
            if not isinstance(tip, TipSample):
                self._unseen += 1
                return
            self._from_s = tip.at_s if self._from_s is None else self._from_s
            self._points.append(tip.tip_in_anchor_mm)


class SweepStep:
    """Refines registrations on the bone's surface; one sweep at a time. Safe to use from any thread.

    Args:
        hub: the live images.
        grounds: what a registration is made on.
        shelf: where it is kept.
        procedure: knows which run of the server this is.
        surfaces: the bone.
        gate: what it must reach.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        grounds: GroundFinder,
        repository: RegistrationRepository,
        procedure: Procedure,
        surfaces: SurfaceStep,
        gate: RegistrationConfig,
    ) -> None:
        self._hub = hub
        self._grounds = grounds
        self._repository = repository
        self._procedure = procedure
        self._surfaces = surfaces
        self._gate = SurfaceGate(max_rms_mm=gate.max_surface_rms_mm, max_tre_mm=gate.max_tre_mm)
        self._lock = threading.Lock()
        self._nearest: tuple[str, NearestOnSurface] | None = None
        self._held: Held[SweepSession] = Held("sweep is", remedy="Begin a sweep, and say with which tool.")

    def begin(self, *, tool: str) -> SweepSession:
        """Begin to sweep the vertebra that is to be drilled, which is registered already.

        Raises:
            SetupOrderError: NO_CASE_OPEN, SURFACE_MISSING, or what it waits for.
            InvalidInput: TOOL_UNKNOWN.
            RegistrationError: SWEEP_ANCHOR_DIFFERS.
        """
        ground = self._grounds.find(vertebra=None, tool=tool, step=StepName.CHECK)
        start = self._repository.current(ground.vertebra.name)
        self._surfaces.latest()
        if start.kept.anchored_to is not ground.anchored_to:
            raise RegistrationError(
                "SWEEP_ANCHOR_DIFFERS",
                f"{start.document.title} is fixed to the {start.kept.anchored_to}, a sweep would be to the "
                f"{ground.anchored_to}",
                "Register by points again, then sweep.",
            )
        return self._held.begin(lambda: SweepSession(self._hub, ground, start))

    @property
    def session(self) -> SweepSession:
        """The sweep so far.

        Raises:
            SetupOrderError: COLLECTION_MISSING.
        """
        return self._held.get()

    @property
    def running(self) -> bool:
        """Whether a sweep was begun."""
        return self._held.is_there

    def end(self) -> None:
        """Take no more, and throw away what was taken."""
        self._held.end()

    def fit(self) -> tuple[SurfaceRegistration, tuple[RegistrationError, ...], str]:
        """What the sweep gives, what keeps it from being used, and the surface that it was laid on.

        Raises:
            SetupOrderError: COLLECTION_MISSING, SURFACE_MISSING.
            RegistrationError: as `register_surface`, for one where the sweep slides.
        """
        session = self.session
        status, points = session.status, session.points_mm
        surface_id, nearest = self._bone()
        kept = status.start.kept
        targets = list(status.ground.entries_mm)
        found = register_surface(
            nearest,
            points,
            kept.registration.anchor_from_vertebra.inverse,
            targets_mm=targets,
            landmarks=self._landmarks(kept),
        )
        return found, found.failures(self._gate, targets), surface_id

    def conclude(self, *, made_by: str) -> Document:
        """Keep the refined registration as the next version, if it passes its gate; the sweep ends.

        Raises:
            SetupOrderError, OutOfDateError: what it stands on is missing, or was changed.
            RegistrationError: as `fit`, or the gate that is not passed.
            StoreConflict: VERSION_CONFLICT, the registration was changed since the sweep began.
        """
        status = self.session.status
        self._grounds.reject_changed(status.ground)
        found, failures, surface_id = self.fit()
        if failures:
            raise failures[0]
        document = self._repository.put(
            status.ground,
            found.registration(status.ground.anchored_to),
            numbers=self.numbers(status, found),
            made_from={
                "tool": status.ground.tool,
                "start_version": status.start.document.version,
                "points": status.start.kept.made_from.get("points", []),
                "weakest": found.weakest.in_words,
                "remarks": [remark.message for remark in found.remarks],
                "sweep_in_anchor_mm": np.round(self.session.points_mm, 3).tolist(),
            },
            made_by=made_by,
            from_s=self._from_s(status),
            also_on=[surface_id],
            expected_version=status.start.document.version,
        )
        self.end()
        return document

    def numbers(self, status: SweepStatus, found: SurfaceRegistration) -> dict[str, Value]:
        """The numbers of the gate."""
        return {
            "points": len(found.used),
            "used_ratio": found.used_ratio,
            "rms_mm": found.rms_mm,
            "max_rms_mm": self._gate.max_rms_mm,
            "tre_at_entry_mm": max(
                (found.tre_stated_mm(entry) for entry in status.ground.entries_mm), default=None
            ),
            "max_tre_mm": self._gate.max_tre_mm,
            "moved_mm": found.moved_mm,
            "moved_deg": found.moved_deg,
            "weakest_sd_mm": found.weakest.sd_mm if np.isfinite(found.weakest.sd_mm) else None,
        }

    def _bone(self) -> tuple[str, NearestOnSurface]:
        document, file = self._surfaces.latest()
        with self._lock:
            if self._nearest is None or self._nearest[0] != document.id:
                self._nearest = document.id, NearestOnSurface(read_mesh(file.path, unit="mm").surface)
            return self._nearest

    def _is_loose(self, kept: KeptRegistration) -> bool:
        """Whether it was made in a run in which the camera may have stood elsewhere."""
        return kept.anchored_to is AnchoredTo.CAMERA and kept.run != self._procedure.run

    def _from_s(self, status: SweepStatus) -> float | None:
        kept = status.start.kept
        return status.from_s if kept.run != self._procedure.run else kept.from_s

    def _landmarks(self, kept: KeptRegistration) -> PairedPoints | None:
        """The landmarks that were touched for the registration: they pull, too."""
        points = kept.made_from.get("points")
        used = [
            one
            for one in (points if isinstance(points, list) else [])
            if isinstance(one, dict) and one.get("used") is True and "tip_in_anchor_mm" in one
        ]
        if not used or self._is_loose(kept):
            return None
        return PairedPoints(
            fixed_mm=np.array([one["point_lps_mm"] for one in used]),
            moving_mm=np.array([one["tip_in_anchor_mm"] for one in used]),
            moving_covariances_mm2=np.array([one["tip_covariance_mm2"] for one in used]),
            labels=tuple(str(one["landmark"]) for one in used),
        )


def _reach_mm(points: Array) -> tuple[float, float, float]:
    if len(points) < 2:
        return 0.0, 0.0, 0.0
    off = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(off, full_matrices=False)
    spans = [float(np.ptp(off @ axis)) for axis in axes]
    longest, middle, shortest = (*spans, 0.0, 0.0)[:3]
    return longest, middle, shortest
