"""A camera of this machine as a source."""

import contextlib
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import cv2
import numpy as np
import numpy.typing as npt
import structlog

from server.capture.address import SourceAddress
from server.capture.codecs import open_device
from server.capture.controls import ControlLock
from server.capture.damaged_images import DamagedImages
from server.capture.driver_clock import DriverClock
from server.capture.mode_check import ModeCheck
from server.capture.modes import JPEG_FORMATS, UNCOMPRESSED, WantedMode, choose_mode
from server.capture.shot import Shot
from server.capture.v4l2 import VideoDevice, VideoDevices, system_devices
from server.capture.v4l2.structs import fourcc_text
from server.errors import CaptureError
from server.image_file import DamagedJpeg, decode_jpeg
from server.live import CameraMode, CameraStatus, ImageClock
from tracker.camera import CameraControl

log = structlog.get_logger(__name__)


class Video(Protocol):
    """The used part of `cv2.VideoCapture`."""

    def isOpened(self) -> bool: ...  # noqa: D102, N802  OpenCV's name

    def set(self, key: int, value: float, /) -> bool: ...  # noqa: D102

    def get(self, key: int, /) -> float: ...  # noqa: D102

    def grab(self) -> bool: ...  # noqa: D102

    def retrieve(self) -> tuple[bool, np.ndarray | None]: ...  # noqa: D102

    def release(self) -> None: ...  # noqa: D102


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibratedCamera:
    """Camera settings of a calibration in use.

    Attributes:
        size_wh_px: image size of the calibration.
        controls: control values of the calibration; empty where not stored.
    """

    size_wh_px: tuple[int, int]
    controls: Mapping[CameraControl, int] = field(default_factory=dict)


class LocalCameraSource:
    """Images of a local camera at their arrival, with the driver's capture times where plausible.

    Args:
        address: number or path of the device.
        wanted: mode of the settings.
        calibration: calibration in use at the start; None without one.
        lock_controls: switch autofocus off, and set the controls of the calibration.
        lock_light: switch automatic exposure and white balance off once they have settled.
        first_number: number of its first image.
        devices: provides the camera's modes and controls.
        open_video: opens the camera in OpenCV.
        clock: monotonic.
    """

    def __init__(
        self,
        address: SourceAddress,
        *,
        wanted: WantedMode | None = None,
        calibration: CalibratedCamera | None = None,
        lock_controls: bool = True,
        lock_light: bool = False,
        first_number: int = 0,
        devices: VideoDevices | None = None,
        open_video: Callable[[str], Video] = open_device,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.name = address.name
        self.waits_for_consumer = False
        self.stalls = True
        self._text = address.text
        self._wanted = wanted or WantedMode()
        self._calibration = calibration
        self._adopted: CalibratedCamera | None = None
        self._lock_controls = lock_controls
        self._lock_light = lock_light
        self._number = first_number
        self._devices = devices or system_devices()
        self._open_video = open_video
        self._clock = clock
        self._timestamps = DriverClock()
        self._camera: Video | None = None
        self._device: VideoDevice | None = None
        self._device_name = ""
        self._requested: CameraMode | None = None
        self._check: ModeCheck | None = None
        self._control_lock: ControlLock | None = None
        self._is_jpeg = False
        self._damaged = DamagedImages(address.name)

    @property
    def defect(self) -> CaptureError | None:
        """Damaged images, or a difference between its images and the requested mode; None without one."""
        return self._damaged.problem or (None if self._check is None else self._check.problem)

    @property
    def camera(self) -> CameraStatus:
        """Status of the camera."""
        return CameraStatus(
            clock=self._timestamps.clock if self._device is not None else ImageClock.ARRIVAL,
            requested=self._requested,
            granted=None if self._check is None else self._check.granted,
            controls={} if self._control_lock is None else self._control_lock.values,
            device=self._device_name,
        )

    def adopt(self, calibration: CalibratedCamera | None) -> None:
        """Use the camera settings of this calibration from the next image on. From any thread.

        If the settings state no size, the camera is reopened in that of the calibration.
        """
        self._adopted = calibration

    def open(self) -> None:
        """Open the device, and request format, size and rate."""
        self.close()
        camera = self._open_video(self._text)
        if not camera.isOpened():
            camera.release()
            raise CaptureError(
                "CAMERA_NOT_OPENED",
                f"{self.name} cannot be opened",
                "Check its cable, that no other program uses it, and the read permission (group 'video'); "
                "it is retried automatically.",
                {"camera": self.name},
            )
        self._camera = camera
        self._device, self._device_name = self._opened_device()
        self._timestamps.restart()
        self._damaged.restart()
        self._ask(camera)
        self._lock_controls_now()

    def read(self) -> Shot | None:
        """Return the next intact image; damaged ones are skipped and counted."""
        self._use_adopted()
        image, captured_at_s = self._grabbed()
        while isinstance(image, DamagedJpeg):
            self._number += 1
            self._damaged.add_damaged(image.reason, self._clock())
            image, captured_at_s = self._grabbed()
        self._damaged.add_intact(self._clock())
        if self._check is not None:
            height, width = image.shape[:2]
            self._check.take((width, height), captured_at_s)
        if self._control_lock is not None:
            self._control_lock.poll(self._clock())
        shot = Shot.live(image, number=self._number, captured_at_s=captured_at_s)
        self._number += 1
        return shot

    def close(self) -> None:
        """Release the device."""
        if self._camera is not None:
            self._camera.release()
            self._camera = None
        if self._device is not None:
            self._device.close()
            self._device = None
        self._control_lock = None

    def _grabbed(self) -> tuple[npt.NDArray[np.uint8] | DamagedJpeg, float]:
        """Return the next image with its capture time."""
        camera = self._camera
        if camera is None or not camera.grab():
            raise self._stopped()
        captured_at_s = self._captured_at_s(camera)
        content = camera.retrieve()[1]
        if self._is_jpeg:
            # OpenCV returns None for an empty packet.
            return decode_jpeg(b"" if content is None else np.asarray(content)), captured_at_s
        if content is None:
            raise self._stopped()
        return np.asarray(content), captured_at_s

    def _stopped(self) -> CaptureError:
        return CaptureError(
            "CAMERA_STOPPED",
            f"{self.name} sent no image",
            "Check its cable and power; it is retried automatically.",
            {"camera": self.name},
        )

    def _use_adopted(self) -> None:
        """Apply the calibration that was adopted last, if it differs."""
        adopted, self._adopted = self._adopted, None
        if adopted is None or adopted == self._calibration:
            return
        before, self._calibration = self._requested, adopted
        if self._camera is None:
            return
        if before is not None and self._wanted.size_wh_px is None and before != self._chosen():
            self.open()
        elif self._control_lock is not None:
            self._control_lock.restore(adopted.controls)

    def _lock_controls_now(self) -> None:
        if self._device is not None:
            self._control_lock = ControlLock(
                self._device,
                name=self.name,
                lock_focus=self._lock_controls,
                lock_light=self._lock_light,
                calibrated={} if self._calibration is None else self._calibration.controls,
                at_s=self._clock(),
            )

    def _captured_at_s(self, camera: Video) -> float:
        arrived_s = self._clock()
        if self._device is None:
            return arrived_s
        had_given_up = self._timestamps.gave_up
        # OpenCV's V4L2 backend returns the time stamp of the buffer, for most drivers on the monotonic clock.
        driver_s = camera.get(cv2.CAP_PROP_POS_MSEC) / 1000.0
        captured_at_s = self._timestamps.captured_at_s(driver_s, arrived_s=arrived_s)
        if self._timestamps.gave_up and not had_given_up:
            log.warning(
                "the time stamps of the camera driver are implausible; arrival times are used instead",
                code="CAMERA_CLOCK_IMPLAUSIBLE",
                camera=self.name,
                driver_s=round(driver_s, 3),
                arrived_s=round(arrived_s, 3),
                remedy="Ages now lack exposure and transfer, some 10 to 100 ms. Try another port or kernel.",
            )
        return captured_at_s

    def _opened_device(self) -> tuple[VideoDevice | None, str]:
        """Open the device beside OpenCV, with its name; None where system or device do not support it."""
        path = f"/dev/video{self._text.lstrip('0') or '0'}" if self._text.isdecimal() else self._text
        with contextlib.suppress(OSError):
            device = self._devices.open(path)
            try:
                name = device.description().name
            except OSError:
                device.close()
                raise
            return device, name
        return None, ""

    def _ask(self, camera: Video) -> None:
        """Request a mode, and store the granted one."""
        calibrated = None if self._calibration is None else self._calibration.size_wh_px
        requested = self._chosen()
        # Without a list of modes the wanted values are requested directly.
        size = self._wanted.size_wh_px or calibrated if requested is None else requested.size_wh_px
        rate_hz = self._wanted.rate_hz if requested is None else requested.rate_hz
        if requested is not None:
            camera.set(cv2.CAP_PROP_FOURCC, cv2.VideoWriter.fourcc(*requested.fourcc.ljust(4)))
        if size is not None:
            camera.set(cv2.CAP_PROP_FRAME_WIDTH, size[0])
            camera.set(cv2.CAP_PROP_FRAME_HEIGHT, size[1])
        if rate_hz:
            camera.set(cv2.CAP_PROP_FPS, rate_hz)
        self._requested = requested
        granted = self._granted_mode(camera)
        # OpenCV decodes damaged JPEGs without a word, so packets are decoded here. A backend without them
        # returns False.
        self._is_jpeg = granted.fourcc in JPEG_FORMATS and camera.set(cv2.CAP_PROP_CONVERT_RGB, 0)
        self._check = ModeCheck(self.name, wanted=self._wanted, requested=requested, granted=granted)
        log.info(
            "camera mode requested",
            camera=self.name,
            requested=str(requested or "default mode"),
            granted=str(granted),
        )

    def _chosen(self) -> CameraMode | None:
        """Return the best offered mode; None where the modes are unknown."""
        calibrated = None if self._calibration is None else self._calibration.size_wh_px
        offered: tuple[CameraMode, ...] = ()
        if self._device is not None:
            with contextlib.suppress(OSError):
                offered = self._device.modes()
        # A mode that was never intact is replaced; a lower rate is better than no image.
        if self._damaged.were_all and self._requested is not None:
            size_wh_px = self._requested.size_wh_px
            raw = [one for one in offered if one.fourcc in UNCOMPRESSED and one.size_wh_px == size_wh_px]
            offered = tuple(raw) or offered
        return choose_mode(offered, self._wanted, calibrated_size_wh_px=calibrated)

    def _granted_mode(self, camera: Video) -> CameraMode:
        """Return the present mode as reported by the device, otherwise by OpenCV."""
        if self._device is not None:
            with contextlib.suppress(OSError):
                return self._device.mode()
        size = tuple(
            max(0, int(camera.get(key))) for key in (cv2.CAP_PROP_FRAME_WIDTH, cv2.CAP_PROP_FRAME_HEIGHT)
        )
        fourcc = max(0, int(camera.get(cv2.CAP_PROP_FOURCC)))
        rate_hz = float(camera.get(cv2.CAP_PROP_FPS))
        return CameraMode(
            fourcc=fourcc_text(fourcc) if fourcc else "",
            size_wh_px=(size[0], size[1]),
            rate_hz=rate_hz if 0.0 < rate_hz < 10_000.0 else 0.0,
        )
