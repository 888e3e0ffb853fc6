"""A camera at this machine as a source."""

import contextlib
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import cv2
import numpy as np
import structlog

from server.capture.address import SourceAddress
from server.capture.codecs import open_device
from server.capture.controls import ControlKeeper
from server.capture.driver_clock import DriverClock
from server.capture.mode_check import ModeCheck
from server.capture.modes import WantedMode, choose_mode
from server.capture.shot import Shot
from server.capture.v4l2 import VideoDevice, VideoDevices, devices_here
from server.capture.v4l2.structs import fourcc_text
from server.errors import CaptureError
from server.live import CameraMode, CameraStatus, ImageClock
from tracker.camera import CameraControl, FlickerMonitor

log = structlog.get_logger(__name__)


class Video(Protocol):
    """What is used of `cv2.VideoCapture`."""

    def isOpened(self) -> bool: ...  # noqa: D102, N802  OpenCV's name

    def set(self, key: int, value: float) -> bool: ...  # noqa: D102

    def get(self, key: int) -> float: ...  # noqa: D102

    def grab(self) -> bool: ...  # noqa: D102

    def retrieve(self) -> tuple[bool, np.ndarray | None]: ...  # noqa: D102

    def release(self) -> None: ...  # noqa: D102


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibratedCamera:
    """What a calibration in use says of the camera beside its model.

    Attributes:
        size_wh_px: of the images that it was made with.
        controls: their values then; empty where they were not kept.
    """

    size_wh_px: tuple[int, int]
    controls: Mapping[CameraControl, int] = field(default_factory=dict)


class LocalCameraSource:
    """Images of a local camera, the moment they arrive, stamped by its driver where that can be believed.

    Args:
        address: number or path of the device.
        wanted: what the settings ask for.
        calibration: that is in use at the start; None while there is none.
        lock_controls: switch automatic focus off, and set what the calibration has.
        lock_light: switch automatic exposure and white balance off once they have settled.
        first_number: number of its first image.
        devices: asked for what the camera offers.
        open_video: opens it in OpenCV.
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
        self.waits_for_taker = False
        self.stalls = True
        self._text = address.text
        self._wanted = wanted or WantedMode()
        self._calibration = calibration
        self._adopted: CalibratedCamera | None = None
        self._lock_controls = lock_controls
        self._lock_light = lock_light
        self._number = first_number
        self._devices = devices or devices_here()
        self._open_video = open_video
        self._clock = clock
        self._stamps = DriverClock()
        self._camera: Video | None = None
        self._device: VideoDevice | None = None
        self._asked: CameraMode | None = None
        self._check: ModeCheck | None = None
        self._keeper: ControlKeeper | None = None
        self._lamps = FlickerMonitor()

    @property
    def defect(self) -> CaptureError | None:
        """In what its images are others than was asked for; None where they are not."""
        return None if self._check is None else self._check.problem

    @property
    def camera(self) -> CameraStatus:
        """What is known of the camera."""
        return CameraStatus(
            clock=self._stamps.clock if self._device is not None else ImageClock.ARRIVAL,
            asked=self._asked,
            granted=None if self._check is None else self._check.granted,
            controls={} if self._keeper is None else self._keeper.values,
            flicker=self._lamps.flicker,
        )

    def adopt(self, calibration: CalibratedCamera | None) -> None:
        """From the next image on give what this calibration was made with. From any thread.

        Where the settings name no size, the camera is opened again in the calibration's.
        """
        self._adopted = calibration

    def open(self) -> None:
        """Open the device, and ask it for format, size and rate."""
        self.close()
        camera = self._open_video(self._text)
        if not camera.isOpened():
            camera.release()
            raise CaptureError(
                "CAMERA_NOT_OPENED",
                f"{self.name} cannot be opened",
                "Check its cable, that no other program holds it, and the right to read it (group 'video'); "
                "it is tried again by itself.",
                {"camera": self.name},
            )
        self._camera = camera
        self._device = self._opened_device()
        self._stamps.restart()
        self._lamps = FlickerMonitor()
        self._ask(camera)
        self._keep_controls()

    def read(self) -> Shot | None:
        """The next image."""
        self._use_adopted()
        camera, image = self._camera, None
        captured_at_s = 0.0
        if camera is not None and camera.grab():
            captured_at_s = self._captured_at_s(camera)
            image = camera.retrieve()[1]
        if image is None:
            raise CaptureError(
                "CAMERA_STOPPED",
                f"{self.name} gave no image",
                "Check its cable and power; it is tried again by itself.",
                {"camera": self.name},
            )
        if self._check is not None:
            height, width = image.shape[:2]
            self._check.take((width, height), captured_at_s)
        if self._keeper is not None:
            self._keeper.poll(self._clock())
        self._look_at_light(image, captured_at_s)
        shot = Shot(
            image=np.asarray(image, dtype=np.uint8),
            number=self._number,
            captured_at_s=captured_at_s,
            source_time_s=captured_at_s,
        )
        self._number += 1
        return shot

    def close(self) -> None:
        """Let go of the device."""
        if self._camera is not None:
            self._camera.release()
            self._camera = None
        if self._device is not None:
            self._device.close()
            self._device = None
        self._keeper = None

    def _look_at_light(self, image: np.ndarray, at_s: float) -> None:
        """Look for lamps that flicker, and log when they begin to or end."""
        before = self._lamps.flicker
        self._lamps.take(np.asarray(image, dtype=np.uint8), at_s)
        flicker = self._lamps.flicker
        if flicker is not None and before is None:
            log.warning(
                "lamps flicker in the images",
                code="LAMP_FLICKER",
                camera=self.name,
                mains_hz=flicker.mains_hz,
                depth_percent=round(100.0 * flicker.depth_ratio, 1),
                remedy="The page says which exposures even it out.",
            )
        elif flicker is None and before is not None:
            log.info("lamps do not flicker any more", camera=self.name)

    def _use_adopted(self) -> None:
        """Take up the calibration that was adopted last, if it is another one."""
        adopted, self._adopted = self._adopted, None
        if adopted is None or adopted == self._calibration:
            return
        before, self._calibration = self._asked, adopted
        if self._camera is None:
            return
        if before is not None and self._wanted.size_wh_px is None and before != self._chosen():
            self.open()
        elif self._keeper is not None:
            self._keeper.restore(adopted.controls)

    def _keep_controls(self) -> None:
        if self._device is not None:
            self._keeper = ControlKeeper(
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
        had_given_up = self._stamps.gave_up
        # OpenCV's V4L2 backend has the buffer's own time there, which drivers take from the monotonic clock.
        driver_s = camera.get(cv2.CAP_PROP_POS_MSEC) / 1000.0
        captured_at_s = self._stamps.captured_at_s(driver_s, arrived_s=arrived_s)
        if self._stamps.gave_up and not had_given_up:
            log.warning(
                "the times of the camera's driver are implausible; images count from their arrival",
                code="CAMERA_CLOCK_IMPLAUSIBLE",
                camera=self.name,
                driver_s=round(driver_s, 3),
                arrived_s=round(arrived_s, 3),
                remedy="Ages lack exposure and transfer now, some 10 to 100 ms. Try another port or kernel.",
            )
        return captured_at_s

    def _opened_device(self) -> VideoDevice | None:
        """The device beside OpenCV; None where this system or this device does not answer."""
        path = f"/dev/video{int(self._text)}" if self._text.isdecimal() else self._text
        with contextlib.suppress(OSError):
            device = self._devices.open(path)
            try:
                device.description()
            except OSError:
                device.close()
                raise
            return device
        return None

    def _ask(self, camera: Video) -> None:
        """Ask for a mode, and keep what was granted."""
        calibrated = None if self._calibration is None else self._calibration.size_wh_px
        asked = self._chosen()
        # Where it is not known what is offered, what the settings want is asked for as it stands.
        size = self._wanted.size_wh_px or calibrated if asked is None else asked.size_wh_px
        rate_hz = self._wanted.rate_hz if asked is None else asked.rate_hz
        if asked is not None:
            camera.set(cv2.CAP_PROP_FOURCC, cv2.VideoWriter.fourcc(*asked.fourcc.ljust(4)))
        if size is not None:
            camera.set(cv2.CAP_PROP_FRAME_WIDTH, size[0])
            camera.set(cv2.CAP_PROP_FRAME_HEIGHT, size[1])
        if rate_hz:
            camera.set(cv2.CAP_PROP_FPS, rate_hz)
        self._asked = asked
        granted = self._granted(camera)
        self._check = ModeCheck(self.name, wanted=self._wanted, asked=asked, granted=granted)
        log.info("camera asked", camera=self.name, asked=str(asked or "its own mode"), granted=str(granted))

    def _chosen(self) -> CameraMode | None:
        """Of what the device offers; None where that is not known."""
        calibrated = None if self._calibration is None else self._calibration.size_wh_px
        offered: tuple[CameraMode, ...] = ()
        if self._device is not None:
            with contextlib.suppress(OSError):
                offered = self._device.modes()
        return choose_mode(offered, self._wanted, calibrated_size_wh_px=calibrated)

    def _granted(self, camera: Video) -> CameraMode:
        """The mode that is set now: as the device says, else as OpenCV does."""
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
