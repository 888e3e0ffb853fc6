"""An industrial camera as a source."""

import threading
import time
from collections.abc import Callable

import numpy as np
import structlog

from server.capture.address import SourceAddress
from server.capture.controls import ControlLock
from server.capture.device_clock import DeviceClock
from server.capture.driver_clock import DriverClock
from server.capture.industrial.camera_controls import EXPOSURE_UNIT_MS, IndustrialControls
from server.capture.industrial.camera_setup import (
    choose_industrial_mode,
    read_capabilities,
    set_mode,
    set_trigger,
)
from server.capture.industrial.clock_latch import LatchedClock
from server.capture.industrial.device import GrabbedImage, IndustrialCamera, IndustrialCameras
from server.capture.industrial.pixel_formats import bgr_from_pixels
from server.capture.local_camera import CalibratedCamera
from server.capture.mode_check import ModeCheck
from server.capture.modes import WantedMode
from server.capture.shot import Shot
from server.errors import CaptureError
from server.live import CameraMode, CameraStatus, ImageClock
from tracker.camera import CameraControl

# Interval of the checks for stop and a removed camera.
GRAB_TIMEOUT_S = 0.2
# A free-running camera without an image for this long is reopened.
MAX_SILENCE_S = 2.0
MAX_TORN = 30

log = structlog.get_logger(__name__)


class IndustrialCameraSource:
    """Images of an industrial camera, newest only, with times of its own clock where it has one.

    Args:
        address: "basler:" or "genicam:" with a serial number; without one, the only connected camera.
        cameras: cameras of the library.
        stop: ends all waits.
        wanted: mode of the settings.
        calibration: calibration in use at the start; None without one.
        trigger: trigger input of each image; None for free run.
        lock_controls: switch automatic exposure, gain and white balance off once they have settled, and set
            the sensor region of the calibration.
        first_number: number of its first image.
        clock: monotonic.
    """

    def __init__(
        self,
        address: SourceAddress,
        *,
        cameras: IndustrialCameras,
        stop: threading.Event,
        wanted: WantedMode | None = None,
        calibration: CalibratedCamera | None = None,
        trigger: str | None = None,
        lock_controls: bool = True,
        first_number: int = 0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.name = address.name
        self.waits_for_consumer = False
        self.stalls = True
        self._serial = address.text.partition(":")[2]
        self._cameras = cameras
        self._stop = stop
        self._wanted = wanted or WantedMode()
        self._calibration = calibration
        self._adopted: CalibratedCamera | None = None
        self._trigger = trigger
        self._triggered_by = ""
        self._lock_controls = lock_controls
        self._number = first_number
        self._clock = clock
        self._device_clock = DeviceClock()
        self._timestamps = DriverClock()
        self._has_own_clock = False
        self._camera: IndustrialCamera | None = None
        self._opened_serial = ""
        self._latch: LatchedClock | None = None
        self._requested: CameraMode | None = None
        self._check: ModeCheck | None = None
        self._control_lock: ControlLock | None = None

    @property
    def defect(self) -> CaptureError | None:
        """Difference between its images and the requested mode; None without one."""
        return None if self._check is None else self._check.problem

    @property
    def camera(self) -> CameraStatus:
        """Status of the camera."""
        is_used = self._has_own_clock and self._timestamps.clock is ImageClock.DRIVER
        return CameraStatus(
            clock=ImageClock.DEVICE if is_used else ImageClock.ARRIVAL,
            requested=self._requested,
            granted=None if self._check is None else self._check.granted,
            controls={} if self._control_lock is None else self._control_lock.values,
            trigger=self._triggered_by,
            exposure_unit_ms=EXPOSURE_UNIT_MS,
            device=self._opened_serial,
        )

    def adopt(self, calibration: CalibratedCamera | None) -> None:
        """Use the camera settings of this calibration from the next image on. From any thread."""
        self._adopted = calibration

    def open(self) -> None:
        """Open the camera, request format, size, rate and trigger, and start it."""
        self.close()
        try:
            camera = self._opened()
            self._camera = camera
            self._set_up(camera)
            camera.start()
        except ImportError as error:
            raise self._without_library() from error
        except OSError as error:
            raise self._not_opened(str(error)) from error

    def read(self) -> Shot | None:
        """Return the newest image; None when stopped."""
        self._use_adopted()
        image, captured_at_s = None, 0.0
        began_s, torn = self._clock(), 0
        while image is None:
            if self._stop.is_set():
                return None
            grabbed = self._grabbed()
            now_s = self._clock()
            if self._control_lock is not None:
                self._control_lock.poll(now_s)
            if grabbed is None:
                if not self._triggered_by and now_s - began_s > MAX_SILENCE_S:
                    raise self._stopped("no complete image arrived")
                continue
            self._number += grabbed.skipped
            captured_at_s = self._captured_at_s(grabbed, now_s)
            if grabbed.pixels is not None:
                image = bgr_from_pixels(grabbed.pixels, grabbed.pixel_format)
            if image is None:
                self._number, torn = self._number + 1, torn + 1
                if torn > MAX_TORN:
                    raise self._torn(torn, grabbed)
        if self._check is not None:
            height, width = image.shape[:2]
            self._check.take((width, height), captured_at_s)
        shot = Shot.live(np.asarray(image, dtype=np.uint8), number=self._number, captured_at_s=captured_at_s)
        self._number += 1
        return shot

    def close(self) -> None:
        """Release the camera."""
        if self._camera is not None:
            self._camera.close()
            self._camera = None
        self._control_lock = None
        self._latch = None

    def _opened(self) -> IndustrialCamera:
        if self._serial:
            self._opened_serial = self._serial
            return self._cameras.open(self._serial)
        found = self._cameras.descriptions()
        if len(found) != 1:
            raise OSError(
                f"{len(found)} cameras are connected: {', '.join(one.address for one in found)}; select one"
                if found
                else "no camera is connected"
            )
        self._opened_serial = found[0].serial
        return self._cameras.open(self._opened_serial)

    def _set_up(self, camera: IndustrialCamera) -> None:
        controls = IndustrialControls(camera)
        calibrated = {} if self._calibration is None else self._calibration.controls
        if self._lock_controls and CameraControl.ZOOM in calibrated:
            # Binning first, because it limits the size.
            controls.set_control(CameraControl.ZOOM, calibrated[CameraControl.ZOOM])
        self._triggered_by = set_trigger(camera, self.name, self._trigger)
        requested = self._chosen(camera)
        if requested is None:
            raise OSError(f"it offers no supported pixel format, only {camera.options('PixelFormat')}")
        granted = set_mode(camera, requested)
        self._requested = requested
        wanted = WantedMode(size_wh_px=self._wanted.size_wh_px) if self._triggered_by else self._wanted
        self._check = ModeCheck(self.name, wanted=wanted, requested=requested, granted=granted)
        log.info("camera mode requested", camera=self.name, requested=str(requested), granted=str(granted))
        self._device_clock.restart()
        self._timestamps.restart()
        self._latch = LatchedClock(camera, self._device_clock, clock=self._clock)
        self._control_lock = ControlLock(
            controls,
            name=self.name,
            lock_focus=self._lock_controls,
            lock_light=self._lock_controls,
            calibrated=calibrated,
            at_s=self._clock(),
        )

    def _chosen(self, camera: IndustrialCamera) -> CameraMode | None:
        return choose_industrial_mode(
            read_capabilities(camera),
            self._wanted,
            calibrated_size_wh_px=None if self._calibration is None else self._calibration.size_wh_px,
            is_triggered=bool(self._triggered_by),
        )

    def _use_adopted(self) -> None:
        """Apply the calibration that was adopted last, if it differs."""
        adopted, self._adopted = self._adopted, None
        if adopted is None or adopted == self._calibration:
            return
        self._calibration = adopted
        if self._camera is not None:
            # Size and binning cannot be changed while grabbing.
            self.open()

    def _grabbed(self) -> GrabbedImage | None:
        if self._camera is None:
            raise self._stopped("it is not open")
        try:
            if self._latch is not None:
                self._latch.renew()
            return self._camera.grab(GRAB_TIMEOUT_S)
        except OSError as error:
            raise self._stopped(str(error)) from error

    def _captured_at_s(self, grabbed: GrabbedImage, arrived_s: float) -> float:
        self._has_own_clock = grabbed.device_s is not None
        if grabbed.device_s is None:
            return arrived_s
        had_given_up = self._timestamps.gave_up
        at_s = self._device_clock.monotonic_s(grabbed.device_s, arrived_s=arrived_s)
        captured_at_s = self._timestamps.captured_at_s(at_s, arrived_s=arrived_s)
        if self._timestamps.gave_up and not had_given_up:
            log.warning(
                "the time stamps of the camera are implausible; arrival times are used instead",
                code="CAMERA_CLOCK_IMPLAUSIBLE",
                camera=self.name,
                remedy="Ages now lack exposure and transfer. Restart the camera, and update its firmware.",
            )
        return captured_at_s

    def _without_library(self) -> CaptureError:
        extra = self._cameras.extra
        return CaptureError(
            "CAMERA_LIBRARY_MISSING",
            f"{self.name} needs a library that is not installed here",
            f"Install it with pip install 'coaxial[{extra}]', and start again.",
            {"camera": self.name, "extra": extra},
        )

    def _not_opened(self, reason: str) -> CaptureError:
        return CaptureError(
            "CAMERA_NOT_OPENED",
            f"{self.name} cannot be opened: {reason}",
            "Run 'coaxial cameras'; check its cable and power, and that no other program uses it. "
            "It is retried automatically.",
            {"camera": self.name, "reason": reason},
        )

    def _stopped(self, reason: str) -> CaptureError:
        return CaptureError(
            "CAMERA_STOPPED",
            f"{self.name} sent no image: {reason}",
            "Check its cable and power; it is retried automatically.",
            {"camera": self.name, "reason": reason},
        )

    def _torn(self, images: int, grabbed: GrabbedImage) -> CaptureError:
        return CaptureError(
            "CAMERA_TORN",
            f"{self.name} sent {images} images in a row that are incomplete or cannot be decoded",
            "Use a separate USB 3 port or network card (jumbo frames) for it, or a lower camera.rate_hz.",
            {"camera": self.name, "images": images, "pixel_format": grabbed.pixel_format},
        )
