"""A fake local camera: its V4L2 driver and its OpenCV capture."""

import errno
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import cv2
import numpy as np

from server.capture.v4l2 import ControlReading, DeviceDescription, VideoDevice
from server.capture.v4l2.structs import fourcc_code, fourcc_text
from server.live import CameraMode
from tracker.camera import CameraControl

FULL_HD, HD, VGA = (1920, 1080), (1280, 720), (640, 480)


def modes(fourcc: str, size_wh_px: tuple[int, int], *rates_hz: float) -> list[CameraMode]:
    return [CameraMode(fourcc=fourcc, size_wh_px=size_wh_px, rate_hz=rate_hz) for rate_hz in rates_hz]


# Like webcams on USB 2: full HD without compression at 5 Hz.
WEBCAM_MODES = (
    *modes("YUYV", VGA, 30, 15),
    *modes("YUYV", HD, 10, 5),
    *modes("YUYV", FULL_HD, 5),
    *modes("MJPG", VGA, 60, 30),
    *modes("MJPG", HD, 60, 30),
    *modes("MJPG", FULL_HD, 30, 15),
    *modes("MJPG", (2560, 1440), 30),
    *modes("H264", FULL_HD, 60),
)
WEBCAM_CONTROLS = {
    CameraControl.FOCUS: 30,
    CameraControl.AUTOFOCUS: 1,
    CameraControl.AUTO_EXPOSURE: 3,
    CameraControl.EXPOSURE: 250,
    CameraControl.GAIN: 20,
    CameraControl.AUTO_WHITE_BALANCE: 1,
    CameraControl.WHITE_BALANCE: 4000,
}


@dataclass
class FakeCamera:
    """State of the camera, changed by the test in place of a user or a driver."""

    path: str = "/dev/video0"
    name: str = "Webcam"
    captures: bool = True
    offered: tuple[CameraMode, ...] = WEBCAM_MODES
    controls: dict[CameraControl, int] = field(default_factory=lambda: dict(WEBCAM_CONTROLS))
    granted: CameraMode = field(
        default_factory=lambda: CameraMode(fourcc="YUYV", size_wh_px=VGA, rate_hz=30.0)
    )
    fault: OSError | None = None
    was_set: list[tuple[CameraControl, int]] = field(default_factory=list)

    def description(self) -> DeviceDescription:
        if self.fault is not None:
            raise self.fault
        return DeviceDescription(
            path=self.path, name=self.name, driver="uvcvideo", bus="usb-1", captures=self.captures
        )

    def modes(self) -> tuple[CameraMode, ...]:
        return self.offered

    def mode(self) -> CameraMode:
        return self.granted

    def control(self, control: CameraControl) -> ControlReading | None:
        if control not in self.controls:
            return None
        return ControlReading(value=self.controls[control], min_value=0, max_value=10_000)

    def set_control(self, control: CameraControl, value: int) -> None:
        if control not in self.controls:
            raise OSError(errno.EINVAL, "Invalid argument")
        self.controls[control] = value
        self.was_set.append((control, value))

    def close(self) -> None:
        pass


class FakeDevices:
    """The devices of a machine that has these cameras."""

    def __init__(self, *cameras: FakeCamera) -> None:
        self.cameras = {camera.path: camera for camera in cameras}

    def paths(self) -> tuple[str, ...]:
        return tuple(self.cameras)

    def open(self, path: str) -> VideoDevice:
        if path not in self.cameras:
            raise OSError(errno.ENOENT, "No such file or directory", path)
        return self.cameras[path]


class FakeVideo:
    """OpenCV's view of a camera: it grants what is offered, and stamps images with the driver's clock.

    The test sets `now_s`, the only clock of this machine, and the transfer time of an image. With `packets`
    it returns these instead of images, `period_s` apart.
    """

    def __init__(self, camera: FakeCamera, *, latency_s: float = 0.04) -> None:
        self.camera = camera
        self.latency_s = latency_s
        self.now_s = 100.0
        self.requested = CameraMode(fourcc="YUYV", size_wh_px=VGA, rate_hz=30.0)
        self.calls: list[str] = []
        self.grants: CameraMode | None = None
        self.stamp: Callable[[float], float] = lambda taken_s: taken_s
        self.size_wh_px: tuple[int, int] | None = None
        self.packets: Iterator[bytes] | None = None
        self.period_s = 0.0
        self.is_open = True
        self._stamp_s = 0.0
        self._taken = 0

    def __call__(self, text: str) -> "FakeVideo":
        self.calls.append(f"open {text}")
        return self

    def clock(self) -> float:
        return self.now_s

    def isOpened(self) -> bool:  # noqa: N802  OpenCV's name
        return self.is_open

    def set(self, key: int, value: float) -> bool:
        width, height = self.requested.size_wh_px
        if key == cv2.CAP_PROP_CONVERT_RGB:
            return self.packets is not None
        if key == cv2.CAP_PROP_FOURCC:
            self.requested = replace(self.requested, fourcc=fourcc_text(int(value)))
        elif key == cv2.CAP_PROP_FRAME_WIDTH:
            self.requested = replace(self.requested, size_wh_px=(int(value), height))
        elif key == cv2.CAP_PROP_FRAME_HEIGHT:
            self.requested = replace(self.requested, size_wh_px=(width, int(value)))
        elif key == cv2.CAP_PROP_FPS:
            self.requested = replace(self.requested, rate_hz=value)
        self.camera.granted = self.grants or self.requested
        return True

    def get(self, key: int) -> float:
        granted = self.camera.granted
        return {
            cv2.CAP_PROP_POS_MSEC: self._stamp_s * 1000.0,
            cv2.CAP_PROP_FRAME_WIDTH: float(granted.size_wh_px[0]),
            cv2.CAP_PROP_FRAME_HEIGHT: float(granted.size_wh_px[1]),
            cv2.CAP_PROP_FOURCC: float(fourcc_code(granted.fourcc)),
            cv2.CAP_PROP_FPS: granted.rate_hz,
        }[key]

    def grab(self) -> bool:
        self.now_s += self.period_s
        self._stamp_s = self.stamp(self.now_s - self.latency_s)
        return True

    def retrieve(self) -> tuple[bool, np.ndarray | None]:
        if self.packets is not None:
            packet = next(self.packets)
            return True, np.frombuffer(packet, np.uint8).reshape(1, -1) if packet else None
        width, height = self.size_wh_px or self.camera.granted.size_wh_px
        self._taken += 1
        # Another grey level each time, since no two sensor images are equal; one byte in memory.
        image = np.broadcast_to(np.uint8(self._taken % 251), (height, width, 3))
        return True, image

    def release(self) -> None:
        self.calls.append("release")
