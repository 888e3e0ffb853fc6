"""Computation of the navigation snapshot of one image by tracker and navigation, each timed."""

import dataclasses
import time
from collections.abc import Callable, Mapping

import structlog

from server.capture.local_camera import CalibratedCamera
from server.capture.shot import Shot
from server.live import Problem
from server.setup import CaseSetup, Preparation
from tracker.camera import CameraControl, ControlChange, control_changes
from tracker.errors import CalibrationError
from tracker.navigation import (
    Absent,
    DrillReference,
    LagEstimator,
    MotionMonitor,
    NavigationSnapshot,
    Setup,
    ToolSmoothing,
    min_errors_95_mm,
    navigate,
)
from tracker.pipeline import Tracker
from tracker.plan import Channel
from tracker.pose import Sighting
from tracker.registration import Registration

log = structlog.get_logger(__name__)


class Tracking:
    """Tracker for the present image size; rebuilt when the size changes."""

    def __init__(self, preparation: Preparation) -> None:
        self._base_preparation = preparation
        self._preparation = preparation
        self._setup: Setup | None = None
        self._tracker: Tracker | None = None
        self._steadying = ToolSmoothing(preparation.smoothing)
        self._watching = MotionMonitor()
        self._lagging = LagEstimator()
        self._watched_registration: tuple[bytes, float | None] | None = None
        self._guide: DrillReference | None = None
        self._device = ""
        self._camera_problem: Problem | None = None
        self._changes: tuple[ControlChange, ...] = ()

    @property
    def problem(self) -> Problem | None:
        """Why there are no measurements although images arrive; None otherwise."""
        return self._camera_problem or (_changed_problem(self._changes[0]) if self._changes else None)

    @property
    def device(self) -> str:
        """The camera for which it is prepared; empty if unknown."""
        return self._device

    @property
    def preparation(self) -> Preparation:
        """The setup in use."""
        return self._preparation

    @property
    def setup(self) -> Setup | None:
        """The setup of navigation; None before the first image of a case."""
        return self._setup

    @property
    def calibrated_camera(self) -> CalibratedCamera | None:
        """Camera settings for which the calibration in use is valid; None without a calibration."""
        return self._preparation.calibrated_camera

    def adopt(self, case: CaseSetup) -> None:
        """Use the data of this case from the next image on; all previous state is discarded."""
        self._preparation = self._base_preparation.with_case(case)
        self._setup = None

    def process(
        self,
        shot: Shot,
        *,
        skipped_images: int,
        controls: Mapping[CameraControl, int] | None = None,
        device: str = "",
        clock: Callable[[], float] = time.monotonic,
    ) -> NavigationSnapshot:
        """Return the navigation snapshot of an image.

        `controls` and `device` are those of the camera's status. A calibration of another size or camera is
        reported as `problem`; the marker is then tracked without calibration and without measurements.

        Raises:
            NavigationError: The tracker cannot process this image.
        """
        height, width = shot.image.shape[:2]
        started_s = clock()
        device = device or self._device
        is_prepared = self._setup is not None and self._setup.camera.size_wh_px == (width, height)
        if not is_prepared or device != self._device:
            self.prepare((width, height), shot.captured_at_s, device=device)
        setup, tracker = self._setup, self._tracker
        if setup is None or tracker is None:
            raise RuntimeError("there is no setup")
        sightings = self._sightings(tracker, shot)
        tracked_s = clock()
        motion = self._watching.take(setup, shot.image, sightings, at_s=shot.captured_at_s)
        self._note_controls(setup, controls or {})
        motion = dataclasses.replace(
            motion,
            camera_changes=self._changes,
            focal_length_error=tracker.focal_length.error if setup.camera_calibrated else None,
        )
        watched_s = clock()
        snapshot = navigate(
            setup=setup,
            sightings=sightings,
            image_number=shot.number,
            captured_at_s=shot.captured_at_s,
            size_wh_px=(width, height),
            stage_ms={},
            skipped_images=skipped_images,
            steadied=self._steadying.steadied(setup, sightings, captured_at_s=shot.captured_at_s),
            drill_reference=self._guide,
            motion=motion,
        )
        snapshot = self._lagging.take(snapshot, latency=self._preparation.latency)
        stage_ms = {
            "waiting": (started_s - shot.captured_at_s) * 1000.0,
            **tracker.stage_ms,
            "watch": (watched_s - tracked_s) * 1000.0,
            "navigation": (clock() - watched_s) * 1000.0,
        }
        return dataclasses.replace(snapshot, stage_ms=stage_ms)

    def _sightings(self, tracker: Tracker, shot: Shot) -> dict[str, Sighting]:
        """Return the sightings of the markers in an image, or of the bodies of an external tracker."""
        external = self._preparation.external
        if external is not None:
            return external.sightings(shot.poses or {})
        return tracker.step(shot.image, captured_at_s=shot.captured_at_s, is_predicted=shot.is_predicted)

    def prepare(self, size_wh_px: tuple[int, int], at_s: float, *, device: str = "") -> None:
        """Set up for images of this size and camera, the first of which is captured at `at_s`."""
        self._device = device
        self._camera_problem = None
        try:
            setup = self._preparation.setup_for(size_wh_px, device=device)
        except CalibrationError as error:
            # Logged here and shown on the page; the video continues without measurements.
            log.warning(error.message, code=error.code, remedy=error.remedy)
            self._camera_problem = Problem.from_error(error)
            setup = self._preparation.uncalibrated_setup_for(size_wh_px)
        previous, self._tracker = self._tracker, self._preparation.tracker_for(setup)
        if previous is not None:
            self._tracker.focal_length.adopt(previous.focal_length)
        self._steadying, self._lagging = ToolSmoothing(self._preparation.smoothing), LagEstimator()
        channel = setup.channel
        self._guide = self._preparation.drill_reference_for(channel) if isinstance(channel, Channel) else None
        if self._guide is not None:
            setup = dataclasses.replace(setup, min_errors_95_mm=min_errors_95_mm(setup, self._guide))
        self._monitor_registration(setup, at_s)
        self._setup = setup

    def _note_controls(self, setup: Setup, controls: Mapping[CameraControl, int]) -> None:
        """Compare the camera's controls with those of the calibration in use, and log changes once."""
        calibrated = self._preparation.camera_controls if setup.camera_calibrated else {}
        changes = control_changes(calibrated, controls)
        if changes != self._changes:
            self._changes = changes
            for change in changes:
                problem = _changed_problem(change)
                log.warning(problem.message, code=problem.code, remedy=problem.remedy)

    def _monitor_registration(self, setup: Setup, at_s: float) -> None:
        """Restart the motion monitor for a new registration; an unchanged or checked one continues."""
        now = (_identity(setup.registration), self._preparation.registered_from_s)
        if now != self._watched_registration:
            self._watched_registration = now
            self._watching.begin(from_s=self._preparation.registered_from_s, now_s=at_s)


def _changed_problem(change: ControlChange) -> Problem:
    control, calibrated, now = change.control.value, change.calibrated, change.now
    return Problem(
        code="CAMERA_CHANGED",
        message=f"{control} of the camera changed from {calibrated} to {now} since the calibration, "
        "which is therefore invalid",
        remedy=f"Set {control} back to {calibrated} (a restart does this, unless camera.lock_controls is "
        "false), or calibrate the camera again.",
        context={"control": control, "calibrated": calibrated, "now": now},
    )


def _identity(registration: Registration | Absent) -> bytes:
    """Return equal bytes for equal registrations: each order of the server has its own copy."""
    if isinstance(registration, Absent):
        return b""
    return registration.anchored_to.encode() + registration.anchor_from_vertebra.matrix.tobytes()
