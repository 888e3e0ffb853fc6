"""Interface of V4L2 devices, for the kernel and a test's fake."""

from dataclasses import dataclass
from typing import Protocol

from server.live import CameraMode
from tracker.camera import CameraControl


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceDescription:
    """Identity of a camera.

    Attributes:
        path: its device file.
        name: name by the driver.
        driver: name of the kernel driver.
        bus: location on the bus.
        captures: whether it captures images; a camera has further devices, for metadata, that do not.
    """

    path: str
    name: str
    driver: str
    bus: str
    captures: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlReading:
    """Value of a control.

    Attributes:
        value: in the driver's unit.
        min_value, max_value: its range.
        is_inactive: whether another control sets it: focus under autofocus.
    """

    value: int
    min_value: int
    max_value: int
    is_inactive: bool = False


class VideoDevice(Protocol):
    """One device, opened beside the process that captures its images."""

    def description(self) -> DeviceDescription:
        """Return its identity. Raises OSError if it is no V4L2 device, or was removed."""

    def modes(self) -> tuple[CameraMode, ...]:
        """Return every offered format, size and rate, in its order; empty without a list."""

    def mode(self) -> CameraMode:
        """Return the present mode. Raises OSError if it was removed."""

    def control(self, control: CameraControl) -> ControlReading | None:
        """Return a control's value; None if the device lacks it."""

    def set_control(self, control: CameraControl, value: int) -> None:
        """Set a control. Raises OSError if the device rejects it."""

    def close(self) -> None:
        """Close it."""


class VideoDevices(Protocol):
    """Devices of this machine."""

    def paths(self) -> tuple[str, ...]:
        """Return the device files, by number."""

    def open(self, path: str) -> VideoDevice:
        """Open a device. Raises OSError."""
