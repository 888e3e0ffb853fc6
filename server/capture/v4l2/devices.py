"""Cameras as V4L2 describes them, and the interfaces that the kernel and a test's fake have in common."""

from dataclasses import dataclass
from typing import Protocol

from server.live import CameraMode
from tracker.camera import CameraControl


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceDescription:
    """Which camera it is.

    Attributes:
        path: its device file.
        name: as the driver has it.
        driver: name of the kernel driver.
        bus: where it is plugged in.
        captures: whether it gives images; a camera has further devices, of metadata, that do not.
    """

    path: str
    name: str
    driver: str
    bus: str
    captures: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlReading:
    """A control at one moment.

    Attributes:
        value: in the driver's own unit.
        min_value, max_value: its range.
        is_inactive: another control sets it: focus while automatic focus is on.
    """

    value: int
    min_value: int
    max_value: int
    is_inactive: bool = False


class VideoDevice(Protocol):
    """One device, open beside whoever takes its images."""

    def description(self) -> DeviceDescription:
        """Which camera it is. Raises OSError when it is no V4L2 device, or is gone."""

    def modes(self) -> tuple[CameraMode, ...]:
        """Every format, size and rate that it offers, as it lists them; empty when it lists none."""

    def mode(self) -> CameraMode:
        """The mode that is set now. Raises OSError when it is gone."""

    def control(self, control: CameraControl) -> ControlReading | None:
        """A control's value; None when the device does not have it."""

    def set_control(self, control: CameraControl, value: int) -> None:
        """Set a control. Raises OSError when the device refuses."""

    def close(self) -> None:
        """Close it."""


class VideoDevices(Protocol):
    """The devices of this machine."""

    def paths(self) -> tuple[str, ...]:
        """The device files, in the order of their numbers."""

    def open(self, path: str) -> VideoDevice:
        """Open one. Raises OSError."""
