"""A camera that exists in a test alone: its driver (V4L2), and what OpenCV makes of it."""

import errno
from dataclasses import dataclass, field

from server.capture.v4l2 import ControlReading, DeviceDescription, VideoDevice
from server.live import CameraMode
from tracker.camera import CameraControl

FULL_HD, HD, VGA = (1920, 1080), (1280, 720), (640, 480)


def modes(fourcc: str, size_wh_px: tuple[int, int], *rates_hz: float) -> list[CameraMode]:
    return [CameraMode(fourcc=fourcc, size_wh_px=size_wh_px, rate_hz=rate_hz) for rate_hz in rates_hz]


# As webcams on USB 2 are: full HD without compression at 5 Hz.
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
    """State of the camera, changed by the test as a person or a driver would."""

    path: str = "/dev/video0"
    name: str = "Webcam"
    captures: bool = True
    offered: tuple[CameraMode, ...] = WEBCAM_MODES
    controls: dict[CameraControl, int] = field(default_factory=lambda: dict(WEBCAM_CONTROLS))
    granted: CameraMode = field(
        default_factory=lambda: CameraMode(fourcc="YUYV", size_wh_px=VGA, rate_hz=30.0)
    )
    fault: OSError | None = None

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
