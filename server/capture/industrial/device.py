"""Common interface of industrial cameras, for both libraries and a test's fake, as GenICam describes them.

Every such camera has a tree of named features ("Width", "ExposureTime"), with the names of GenICam's Standard
Features Naming Convention (SFNC). The other files of this folder use them for all libraries.
"""

from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

FeatureValue: TypeAlias = int | float | str | bool


@dataclass(frozen=True, slots=True, kw_only=True)
class IndustrialDescription:
    """Identity of a camera.

    Attributes:
        address: source address: "basler:40021234".
        name: vendor and model.
        serial: its serial number.
        bus: connection type, as its library names it.
    """

    address: str
    name: str
    serial: str
    bus: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Bounds:
    """Present range of a numeric feature.

    Attributes:
        min_value, max_value: inclusive.
        step: increment; 0 for a continuous range.
    """

    min_value: float
    max_value: float
    step: float = 0.0

    def nearest(self, value: float) -> float:
        """Return the nearest allowed value."""
        inside = min(max(value, self.min_value), self.max_value)
        if self.step <= 0.0:
            return inside
        max_steps = (self.max_value - self.min_value) // self.step
        return self.min_value + self.step * min(round((inside - self.min_value) / self.step), max_steps)


@dataclass(frozen=True, slots=True, kw_only=True)
class GrabbedImage:
    """One image as sent by the camera.

    Attributes:
        pixels: (h, w) or (h, w, channels), an own copy; None when a part of the image was lost in transfer.
        pixel_format: as the camera names it.
        device_s: capture time by the camera's clock; None without one.
        skipped: number of older images that the library discarded.
    """

    pixels: npt.NDArray[np.uint8] | None
    pixel_format: str
    device_s: float | None = None
    skipped: int = 0


class Features(Protocol):
    """A camera's features by name. Reading a missing feature is no error."""

    def value(self, name: str) -> FeatureValue | None:
        """Return the value; None if it is missing, or not readable now."""

    def bounds(self, name: str) -> Bounds | None:
        """Return the present range; None without one."""

    def options(self, name: str) -> tuple[str, ...]:
        """Return the values of an enumeration; empty without one."""

    def set_value(self, name: str, value: FeatureValue) -> None:
        """Set a feature. Raises OSError if the camera rejects or lacks it."""

    def execute(self, name: str) -> None:
        """Run a command. Raises OSError if the camera rejects or lacks it."""


class IndustrialCamera(Features, Protocol):
    """One open camera."""

    def start(self) -> None:
        """Start grabbing. Raises OSError."""

    def grab(self, timeout_s: float) -> GrabbedImage | None:
        """Return the newest image not returned yet; None after the timeout.

        Raises:
            OSError: the camera is gone.
        """

    def close(self) -> None:
        """Stop, and release the camera; never raises."""


class IndustrialCameras(Protocol):
    """Cameras that one library finds.

    Attributes:
        extra: extra of `pip install coaxial[...]` with the library.
    """

    extra: str

    def descriptions(self) -> tuple[IndustrialDescription, ...]:
        """Return the connected cameras. Raises OSError; ImportError without the library."""

    def open(self, serial: str) -> IndustrialCamera:
        """Open the camera with this serial number. Raises OSError; ImportError without the library."""
