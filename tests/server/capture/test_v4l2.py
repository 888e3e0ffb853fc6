"""V4L2 structures and requests, with a fake kernel that reads and fills the same memory."""

import errno
from collections.abc import Sequence
from contextlib import closing
from ctypes import Structure, sizeof
from pathlib import Path
from typing import Any, TypeVar

import pytest

from server.capture.v4l2 import KernelDevices, NoDevices, structs
from server.capture.v4l2.structs import fourcc_code, fourcc_text
from server.live import CameraMode
from tracker.camera import CameraControl

Value = TypeVar("Value")
MJPG, YUYV = fourcc_code("MJPG"), fourcc_code("YUYV")


class PlayedKernel:
    """Answers each ioctl as uvcvideo does."""

    def __init__(self) -> None:
        self.controls = {structs.CONTROL_IDS[CameraControl.FOCUS]: 30}
        self.capabilities = (0x84A0_0001, 0x0420_0001)
        self.stepwise = False

    def __call__(self, descriptor: int, request: int, record: Structure) -> None:
        assert descriptor >= 0
        answers: dict[int, Any] = {
            structs.QUERYCAP: self.capability,
            structs.ENUM_FMT: self.pixel_format,
            structs.ENUM_FRAMESIZES: self.size,
            structs.ENUM_FRAMEINTERVALS: self.interval,
            structs.G_FMT: self.format,
            structs.G_PARM: self.parameters,
            structs.QUERYCTRL: self.query,
            structs.G_CTRL: self.get,
            structs.S_CTRL: self.set,
        }
        answers[request](record)

    def capability(self, record: structs.Capability) -> None:
        record.driver, record.card, record.bus_info = b"uvcvideo", b"HD Webcam", b"usb-0000:00:14.0-1"
        record.capabilities, record.device_caps = self.capabilities

    def pixel_format(self, record: structs.FormatDescription) -> None:
        assert record.type == 1
        record.pixelformat = listed([MJPG, YUYV], record.index)

    def size(self, record: structs.FrameSize) -> None:
        if self.stepwise:
            record.type = 3
            record.values[:] = listed([(16, 1920, 2, 16, 1200, 2)], record.index)
            return
        record.type = 1
        sizes = {MJPG: [(1920, 1080), (640, 480)], YUYV: [(640, 480)]}[record.pixel_format]
        record.values[:2] = listed(sizes, record.index)

    def interval(self, record: structs.FrameInterval) -> None:
        assert record.width > 0 < record.height
        record.type = 1
        fractions = [(1, 30), (2, 15)] if record.pixel_format == MJPG else [(333333, 10_000_000)]
        record.values[:2] = listed(fractions, record.index)

    def format(self, record: structs.Format) -> None:
        assert record.type == 1
        record.width, record.height, record.pixelformat = 1920, 1080, MJPG

    def parameters(self, record: structs.StreamParameters) -> None:
        record.numerator, record.denominator = 1, 30

    def query(self, record: structs.QueryControl) -> None:
        if record.id not in self.controls:
            raise OSError(errno.EINVAL, "Invalid argument")
        record.minimum, record.maximum, record.flags = 0, 250, structs.FLAG_INACTIVE

    def get(self, record: structs.Control) -> None:
        record.value = self.controls[record.id]

    def set(self, record: structs.Control) -> None:
        self.controls[record.id] = record.value


def listed(values: Sequence[Value], index: int) -> Value:
    if index >= len(values):
        raise OSError(errno.EINVAL, "Invalid argument")
    return values[index]


@pytest.fixture
def kernel() -> PlayedKernel:
    return PlayedKernel()


@pytest.fixture
def devices(kernel: PlayedKernel, tmp_path: Path) -> KernelDevices:
    for name in ("video10", "video2", "video0", "video-codec", "vhost"):
        (tmp_path / name).touch()
    return KernelDevices(tmp_path, ioctl=kernel)


@pytest.mark.parametrize(
    ("record", "size", "request_number", "expected"),
    [
        (structs.Capability, 104, structs.QUERYCAP, 0x8068_5600),
        (structs.FormatDescription, 64, structs.ENUM_FMT, 0xC040_5602),
        (structs.FrameSize, 44, structs.ENUM_FRAMESIZES, 0xC02C_564A),
        (structs.FrameInterval, 52, structs.ENUM_FRAMEINTERVALS, 0xC034_564B),
        (structs.Format, 208, structs.G_FMT, 0xC0D0_5604),
        (structs.StreamParameters, 204, structs.G_PARM, 0xC0CC_5615),
        (structs.QueryControl, 68, structs.QUERYCTRL, 0xC044_5624),
        (structs.Control, 8, structs.S_CTRL, 0xC008_561C),
    ],
)
def test_records_and_requests_are_those_of_the_kernel(
    record: type[Structure], size: int, request_number: int, expected: int
) -> None:
    # As printed by a C program that includes linux/videodev2.h, on 64 bits.
    assert sizeof(record) == size
    assert request_number == expected


def test_control_ids_are_those_of_the_kernel() -> None:
    assert structs.CONTROL_IDS[CameraControl.FOCUS] == 0x9A090A
    assert structs.CONTROL_IDS[CameraControl.AUTOFOCUS] == 0x9A090C
    assert structs.CONTROL_IDS[CameraControl.AUTO_EXPOSURE] == 0x9A0901
    assert structs.CONTROL_IDS[CameraControl.EXPOSURE] == 0x9A0902
    assert structs.CONTROL_IDS[CameraControl.GAIN] == 0x980913
    assert structs.CONTROL_IDS[CameraControl.AUTO_WHITE_BALANCE] == 0x98090C
    assert structs.CONTROL_IDS[CameraControl.WHITE_BALANCE] == 0x98091A
    assert set(structs.CONTROL_IDS) == set(CameraControl)


def test_devices_are_listed_by_their_numbers(devices: KernelDevices) -> None:
    assert [Path(path).name for path in devices.paths()] == ["video0", "video2", "video10"]
    assert KernelDevices(Path("/nowhere")).paths() == ()


def test_a_camera_reports_its_identity_and_modes(devices: KernelDevices) -> None:
    with closing(devices.open(devices.paths()[0])) as camera:
        found = camera.description()
        assert (found.name, found.driver, found.bus) == ("HD Webcam", "uvcvideo", "usb-0000:00:14.0-1")
        assert found.captures
        assert camera.modes() == (
            CameraMode(fourcc="MJPG", size_wh_px=(1920, 1080), rate_hz=30.0),
            CameraMode(fourcc="MJPG", size_wh_px=(1920, 1080), rate_hz=7.5),
            CameraMode(fourcc="MJPG", size_wh_px=(640, 480), rate_hz=30.0),
            CameraMode(fourcc="MJPG", size_wh_px=(640, 480), rate_hz=7.5),
            CameraMode(fourcc="YUYV", size_wh_px=(640, 480), rate_hz=30.0),
        )
        assert camera.mode() == CameraMode(fourcc="MJPG", size_wh_px=(1920, 1080), rate_hz=30.0)


def test_the_metadata_device_of_a_camera_gives_no_images(
    devices: KernelDevices, kernel: PlayedKernel
) -> None:
    # The hardware captures images, but not through this device file.
    kernel.capabilities = (0x84A0_0001, 0x04A0_0000)
    with closing(devices.open(devices.paths()[0])) as camera:
        assert not camera.description().captures
    # An old driver does not distinguish them.
    kernel.capabilities = (0x0400_0001, 0)
    with closing(devices.open(devices.paths()[0])) as camera:
        assert camera.description().captures


def test_a_range_of_sizes_gives_the_usual_ones_and_the_largest(
    devices: KernelDevices, kernel: PlayedKernel
) -> None:
    kernel.stepwise = True
    with closing(devices.open(devices.paths()[0])) as camera:
        sizes = [mode.size_wh_px for mode in camera.modes() if mode.fourcc == "YUYV"]
    assert sizes == [(640, 480), (800, 600), (1280, 720), (1280, 960), (1920, 1080), (1920, 1200)]


def test_a_control_is_read_set_and_missed(devices: KernelDevices) -> None:
    with closing(devices.open(devices.paths()[0])) as camera:
        focus = camera.control(CameraControl.FOCUS)
        assert focus is not None
        assert (focus.value, focus.min_value, focus.max_value, focus.is_inactive) == (30, 0, 250, True)
        camera.set_control(CameraControl.FOCUS, 45)
        changed = camera.control(CameraControl.FOCUS)
        assert changed is not None
        assert changed.value == 45
        assert camera.control(CameraControl.ZOOM) is None


def test_the_letters_of_a_format_are_its_number() -> None:
    assert fourcc_text(fourcc_code("MJPG")) == "MJPG"
    assert fourcc_text(fourcc_code("Y16")) == "Y16"
    assert fourcc_code("MJPG") == 0x4750_4A4D


def test_a_system_without_v4l2_knows_no_camera() -> None:
    assert NoDevices().paths() == ()
    with pytest.raises(OSError, match="no V4L2"):
        NoDevices().open("/dev/video0")
