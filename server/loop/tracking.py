"""From one image to the snapshot of its instant: the tracker, then the navigation, each timed."""

import dataclasses
import time
from collections.abc import Callable

import structlog

from server.capture.shot import Shot
from server.live import Trouble
from server.setup import CaseSetup, Preparation
from tracker.errors import CalibrationError
from tracker.navigation import NavigationSnapshot, Setup, Steadying, navigate
from tracker.pipeline import Tracker

log = structlog.get_logger(__name__)


class Tracking:
    """The tracker for the size of image that comes, made anew when the size changes."""

    def __init__(self, preparation: Preparation) -> None:
        self._settled = preparation
        self._preparation = preparation
        self._setup: Setup | None = None
        self._tracker: Tracker | None = None
        self._steadying = Steadying(preparation.smoothing)
        self.trouble: Trouble | None = None

    def adopt(self, case: CaseSetup) -> None:
        """From the next image on work with what this case knows; nothing of the one before is kept."""
        self._preparation = self._settled.with_case(case)
        self._setup = None

    def conclude(
        self, shot: Shot, *, skipped_images: int, clock: Callable[[], float] = time.monotonic
    ) -> NavigationSnapshot:
        """What this image says.

        A camera file for another size is told as `trouble`; the marker is then found without it, and no
        millimetre is claimed.

        Raises:
            NavigationError: the tracker cannot work on this image.
        """
        height, width = shot.image.shape[:2]
        started_s = clock()
        if self._setup is None or self._setup.camera.size_wh_px != (width, height):
            self._prepare((width, height))
        setup, tracker = self._setup, self._tracker
        if setup is None or tracker is None:
            raise RuntimeError("no setup was made")
        sightings = tracker.step(shot.image, captured_at_s=shot.captured_at_s)
        tracked_s = clock()
        snapshot = navigate(
            setup=setup,
            sightings=sightings,
            image_number=shot.number,
            captured_at_s=shot.captured_at_s,
            size_wh_px=(width, height),
            stage_ms={},
            skipped_images=skipped_images,
            steadied=self._steadying.steadied(setup, sightings, captured_at_s=shot.captured_at_s),
        )
        stage_ms = {
            "waiting": (started_s - shot.captured_at_s) * 1000.0,
            **tracker.stage_ms,
            "navigation": (clock() - tracked_s) * 1000.0,
        }
        return dataclasses.replace(snapshot, stage_ms=stage_ms)

    def _prepare(self, size_wh_px: tuple[int, int]) -> None:
        self.trouble = None
        try:
            setup = self._preparation.setup_for(size_wh_px)
        except CalibrationError as error:
            # Told here and shown on the page; the picture goes on without millimetres.
            log.warning(error.message, code=error.code, remedy=error.remedy)
            self.trouble = Trouble.from_error(error)
            setup = self._preparation.uncalibrated_setup_for(size_wh_px)
        self._tracker = self._preparation.tracker_for(setup)
        self._steadying = Steadying(self._preparation.smoothing)
        self._setup = setup
