"""From one image to the snapshot of its instant: the tracker, then the navigation, each timed."""

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
    Guide,
    Lagging,
    NavigationSnapshot,
    Setup,
    Steadying,
    Watching,
    navigate,
)
from tracker.pipeline import Tracker
from tracker.plan import Channel
from tracker.registration import Registration

log = structlog.get_logger(__name__)


class Tracking:
    """The tracker for the size of image that comes, made anew when the size changes."""

    def __init__(self, preparation: Preparation) -> None:
        self._settled = preparation
        self._preparation = preparation
        self._setup: Setup | None = None
        self._tracker: Tracker | None = None
        self._steadying = Steadying(preparation.smoothing)
        self._watching = Watching()
        self._lagging = Lagging()
        self._watched_registration: tuple[bytes, float | None] | None = None
        self._guide: Guide | None = None
        self._size_problem: Problem | None = None
        self._changes: tuple[ControlChange, ...] = ()

    @property
    def problem(self) -> Problem | None:
        """Why no millimetre is claimed although images come; None while nothing is in the way."""
        return self._size_problem or (_changed_problem(self._changes[0]) if self._changes else None)

    @property
    def calibrated_camera(self) -> CalibratedCamera | None:
        """What the camera is set to so that the calibration in use holds of it; None where there is none."""
        return self._preparation.calibrated_camera

    def adopt(self, case: CaseSetup) -> None:
        """From the next image on work with what this case knows; nothing of the one before is kept."""
        self._preparation = self._settled.with_case(case)
        self._setup = None

    def conclude(
        self,
        shot: Shot,
        *,
        skipped_images: int,
        controls: Mapping[CameraControl, int] | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> NavigationSnapshot:
        """What this image says, of a camera whose controls have these values; None where none is known.

        A camera file for another size is told as `trouble`; the marker is then found without it, and no
        millimetre is claimed.

        Raises:
            NavigationError: the tracker cannot work on this image.
        """
        height, width = shot.image.shape[:2]
        started_s = clock()
        if self._setup is None or self._setup.camera.size_wh_px != (width, height):
            self._prepare((width, height), shot.captured_at_s)
        setup, tracker = self._setup, self._tracker
        if setup is None or tracker is None:
            raise RuntimeError("no setup was made")
        sightings = tracker.step(shot.image, captured_at_s=shot.captured_at_s)
        tracked_s = clock()
        watched = self._watching.take(setup, shot.image, sightings, at_s=shot.captured_at_s)
        self._note_controls(setup, controls or {})
        watched = dataclasses.replace(watched, camera_changes=self._changes)
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
            guide=self._guide,
            watched=watched,
        )
        snapshot = self._lagging.take(snapshot, latency_ms=self._preparation.latency_ms)
        stage_ms = {
            "waiting": (started_s - shot.captured_at_s) * 1000.0,
            **tracker.stage_ms,
            "watch": (watched_s - tracked_s) * 1000.0,
            "navigation": (clock() - watched_s) * 1000.0,
        }
        return dataclasses.replace(snapshot, stage_ms=stage_ms)

    def _prepare(self, size_wh_px: tuple[int, int], at_s: float) -> None:
        self._size_problem = None
        try:
            setup = self._preparation.setup_for(size_wh_px)
        except CalibrationError as error:
            # Told here and shown on the page; the picture goes on without millimetres.
            log.warning(error.message, code=error.code, remedy=error.remedy)
            self._size_problem = Problem.from_error(error)
            setup = self._preparation.uncalibrated_setup_for(size_wh_px)
        self._tracker = self._preparation.tracker_for(setup)
        self._steadying, self._lagging = Steadying(self._preparation.smoothing), Lagging()
        channel = setup.channel
        self._guide = self._preparation.guide_along(channel) if isinstance(channel, Channel) else None
        self._watch_registration(setup, at_s)
        self._setup = setup

    def _note_controls(self, setup: Setup, controls: Mapping[CameraControl, int]) -> None:
        """Compare the camera's controls with those at the calibration in use, and log what changed, once."""
        calibrated = self._preparation.camera_controls if setup.camera_calibrated else {}
        changes = control_changes(calibrated, controls)
        if changes != self._changes:
            self._changes = changes
            for change in changes:
                problem = _changed_problem(change)
                log.warning(problem.message, code=problem.code, remedy=problem.remedy)

    def _watch_registration(self, setup: Setup, at_s: float) -> None:
        """Begin to watch another registration; one that stays, or was checked, is watched on."""
        now = (_identity(setup.registration), self._preparation.registered_from_s)
        if now != self._watched_registration:
            self._watched_registration = now
            self._watching.begin(from_s=self._preparation.registered_from_s, now_s=at_s)


def _changed_problem(change: ControlChange) -> Problem:
    control, calibrated, now = change.control.value, change.calibrated, change.now
    return Problem(
        code="CAMERA_CHANGED",
        message=f"{control} of the camera changed from {calibrated} to {now} since the calibration in use, "
        "which does not hold any more",
        remedy=f"Set {control} back to {calibrated} (a new start does, unless camera.lock_controls is false) "
        "or calibrate the camera again.",
        context={"control": control, "calibrated": calibrated, "now": now},
    )


def _identity(registration: Registration | Absent) -> bytes:
    """Equal for registrations that are the same: each order of the server brings a copy of its own."""
    if isinstance(registration, Absent):
        return b""
    return registration.anchored_to.encode() + registration.anchor_from_vertebra.matrix.tobytes()
