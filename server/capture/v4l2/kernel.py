"""V4L2 devices of the kernel, through ioctl on a device file."""

import contextlib
import errno
import os
import re
import sys
from collections.abc import Callable, Iterator
from ctypes import Structure
from pathlib import Path
from typing import TypeAlias, TypeVar

from server.capture.v4l2.devices import (
    ControlReading,
    DeviceDescription,
    VideoDevice,
    VideoDevices,
)
from server.capture.v4l2.structs import (
    CAN_CAPTURE,
    CONTROL_IDS,
    DISCRETE,
    ENUM_FMT,
    ENUM_FRAMEINTERVALS,
    ENUM_FRAMESIZES,
    FLAG_DISABLED,
    FLAG_INACTIVE,
    G_CTRL,
    G_FMT,
    G_PARM,
    HAS_DEVICE_CAPS,
    QUERYCAP,
    QUERYCTRL,
    S_CTRL,
    VIDEO_CAPTURE,
    Capability,
    Control,
    Format,
    FormatDescription,
    FrameInterval,
    FrameSize,
    QueryControl,
    StreamParameters,
    fourcc_text,
)
from server.live import CameraMode
from tracker.camera import CameraControl

Ioctl: TypeAlias = Callable[[int, int, Structure], object]
Record = TypeVar("Record", FormatDescription, FrameSize, FrameInterval)
# Limit for a driver with an endless list.
MAX_LISTED = 256
# Candidates where a device offers a range of sizes.
COMMON_SIZES_WH_PX = ((640, 480), (800, 600), (1280, 720), (1280, 960), (1920, 1080))


def kernel_ioctl(descriptor: int, request: int, record: Structure) -> object:
    """Run the system call, which fills the record. Raises OSError."""
    # Imported here, because it exists on Unix only.
    import fcntl  # noqa: PLC0415

    return fcntl.ioctl(descriptor, request, record, True)


class KernelDevices:
    """Cameras of a Linux machine.

    Args:
        folder: folder of the device files.
        ioctl: the system call.
    """

    def __init__(self, folder: Path = Path("/dev"), *, ioctl: Ioctl = kernel_ioctl) -> None:
        self._folder = folder
        self._ioctl = ioctl

    def paths(self) -> tuple[str, ...]:
        """Return the device files, by number."""
        numbered = {
            int(found.group(1)): str(path)
            for path in self._folder.glob("video*")
            if (found := re.fullmatch(r"video(\d+)", path.name))
        }
        return tuple(path for _, path in sorted(numbered.items()))

    def open(self, path: str) -> VideoDevice:
        """Open a device, beside the process that captures its images."""
        return KernelDevice(path, os.open(path, os.O_RDWR | os.O_NONBLOCK), ioctl=self._ioctl)


class NoDevices:
    """For systems without V4L2."""

    def paths(self) -> tuple[str, ...]:
        """Return no device."""
        return ()

    def open(self, path: str) -> VideoDevice:
        """Raise OSError."""
        raise OSError(errno.ENOSYS, "this system has no V4L2", path)


def system_devices() -> VideoDevices:
    """Return the devices of this machine: the kernel's on Linux, none elsewhere."""
    return KernelDevices() if sys.platform == "linux" else NoDevices()


class KernelDevice:
    """One device file; see `VideoDevice`."""

    def __init__(self, path: str, descriptor: int, *, ioctl: Ioctl) -> None:
        self._path = path
        self._descriptor = descriptor
        self._ioctl = ioctl

    def description(self) -> DeviceDescription:
        """Return its identity."""
        found = Capability()
        self._ioctl(self._descriptor, QUERYCAP, found)
        # Capabilities of the whole hardware, where the driver does not give those of this device file.
        able = found.device_caps if found.capabilities & HAS_DEVICE_CAPS else found.capabilities
        return DeviceDescription(
            path=self._path,
            name=_text(found.card),
            driver=_text(found.driver),
            bus=_text(found.bus_info),
            captures=bool(able & CAN_CAPTURE),
        )

    def modes(self) -> tuple[CameraMode, ...]:
        """Return every offered format, size and rate."""
        return tuple(
            CameraMode(fourcc=fourcc_text(pixel_format), size_wh_px=size, rate_hz=rate_hz)
            for pixel_format in self._formats()
            for size in self._sizes(pixel_format)
            for rate_hz in self._rates(pixel_format, size)
        )

    def mode(self) -> CameraMode:
        """Return the present mode."""
        form, parameters = Format(type=VIDEO_CAPTURE), StreamParameters(type=VIDEO_CAPTURE)
        self._ioctl(self._descriptor, G_FMT, form)
        rate_hz = 0.0
        # Some devices have no rate.
        with contextlib.suppress(OSError):
            self._ioctl(self._descriptor, G_PARM, parameters)
            rate_hz = _rate_hz(parameters.numerator, parameters.denominator)
        return CameraMode(
            fourcc=fourcc_text(form.pixelformat), size_wh_px=(form.width, form.height), rate_hz=rate_hz
        )

    def control(self, control: CameraControl) -> ControlReading | None:
        """Return a control's value."""
        about, value = QueryControl(id=CONTROL_IDS[control]), Control(id=CONTROL_IDS[control])
        try:
            self._ioctl(self._descriptor, QUERYCTRL, about)
            if about.flags & FLAG_DISABLED:
                return None
            self._ioctl(self._descriptor, G_CTRL, value)
        except OSError as error:
            if error.errno in (errno.ENODEV, errno.EBADF):
                raise
            return None
        return ControlReading(
            value=value.value,
            min_value=about.minimum,
            max_value=about.maximum,
            is_inactive=bool(about.flags & FLAG_INACTIVE),
        )

    def set_control(self, control: CameraControl, value: int) -> None:
        """Set a control."""
        self._ioctl(self._descriptor, S_CTRL, Control(id=CONTROL_IDS[control], value=value))

    def close(self) -> None:
        """Close the device; does nothing if it is closed."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1

    def _formats(self) -> list[int]:
        records = self._listed(ENUM_FMT, lambda index: FormatDescription(index=index, type=VIDEO_CAPTURE))
        return [int(record.pixelformat) for record in records]

    def _sizes(self, pixel_format: int) -> list[tuple[int, int]]:
        sizes: list[tuple[int, int]] = []
        for record in self._listed(
            ENUM_FRAMESIZES, lambda index: FrameSize(index=index, pixel_format=pixel_format)
        ):
            if record.type == DISCRETE:
                sizes.append((record.values[0], record.values[1]))
                continue
            sizes += _sizes_in_range(*record.values)
            break
        return sizes

    def _rates(self, pixel_format: int, size_wh_px: tuple[int, int]) -> list[float]:
        width, height = size_wh_px
        rates: list[float] = []
        for record in self._listed(
            ENUM_FRAMEINTERVALS,
            lambda index: FrameInterval(index=index, pixel_format=pixel_format, width=width, height=height),
        ):
            rates.append(_rate_hz(record.values[0], record.values[1]))
            if record.type != DISCRETE:
                # A range starts with its shortest interval.
                break
        return rates or [0.0]

    def _listed(self, request: int, blank: Callable[[int], Record]) -> Iterator[Record]:
        for index in range(MAX_LISTED):
            record = blank(index)
            try:
                self._ioctl(self._descriptor, request, record)
            except OSError as error:
                # EINVAL ends the list, ENOTTY means that there is none.
                if error.errno in (errno.EINVAL, errno.ENOTTY):
                    return
                raise
            yield record


def _sizes_in_range(
    min_width: int, max_width: int, step_width: int, min_height: int, max_height: int, step_height: int
) -> list[tuple[int, int]]:
    """Return the common sizes in a range, and its largest one."""
    found = [
        (width, height)
        for width, height in COMMON_SIZES_WH_PX
        if min_width <= width <= max_width
        and min_height <= height <= max_height
        and (width - min_width) % max(step_width, 1) == 0
        and (height - min_height) % max(step_height, 1) == 0
    ]
    largest = (max_width, max_height)
    return found if largest in found else [*found, largest]


def _rate_hz(numerator: int, denominator: int) -> float:
    """Return images per second; 0 without an interval."""
    return round(denominator / numerator, 3) if numerator > 0 else 0.0


def _text(raw: bytes) -> str:
    return raw.decode("utf-8", "replace").strip()
