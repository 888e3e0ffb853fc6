"""Industrial cameras as GenICam describes them: what both libraries and a test's fake have in common.

Every such camera describes itself by a tree of named features ("Width", "ExposureTime"), whose names are
those of GenICam's Standard Features Naming Convention (SFNC). What is done with them is in the files beside
this one, once for all libraries.
"""

from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

FeatureValue: TypeAlias = int | float | str | bool


@dataclass(frozen=True, slots=True, kw_only=True)
class IndustrialDescription:
    """Which camera it is.

    Attributes:
        address: by which it is given as a source: "basler:40021234".
        name: vendor and model.
        serial: its serial number.
        bus: how it is connected, as its library names it.
    """

    address: str
    name: str
    serial: str
    bus: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Bounds:
    """The values that a numeric feature takes now.

    Attributes:
        min_value, max_value: both are allowed.
        step: from one allowed value to the next; 0 where any value between the two is allowed.
    """

    min_value: float
    max_value: float
    step: float = 0.0

    def nearest(self, value: float) -> float:
        """The allowed value that is nearest."""
        inside = min(max(value, self.min_value), self.max_value)
        if self.step <= 0.0:
            return inside
        max_steps = (self.max_value - self.min_value) // self.step
        return self.min_value + self.step * min(round((inside - self.min_value) / self.step), max_steps)


@dataclass(frozen=True, slots=True, kw_only=True)
class GrabbedImage:
    """One image as the camera sent it.

    Attributes:
        pixels: (h, w) or (h, w, channels), of its own memory; None when a part of the image was lost on its
            way.
        pixel_format: as the camera names it.
        device_s: when it was taken, by the camera's own clock; None where the camera does not say.
        skipped: images before this one that the library threw away, because a newer one was there.
    """

    pixels: npt.NDArray[np.uint8] | None
    pixel_format: str
    device_s: float | None = None
    skipped: int = 0


class Features(Protocol):
    """A camera's features by their names. A feature that the camera does not have is no error to read."""

    def value(self, name: str) -> FeatureValue | None:
        """Its value; None where the camera does not have it, or does not let it be read now."""

    def bounds(self, name: str) -> Bounds | None:
        """What may be set now; None where there is no such number."""

    def options(self, name: str) -> tuple[str, ...]:
        """The values of an enumeration; empty where there is none."""

    def set_value(self, name: str, value: FeatureValue) -> None:
        """Set it. Raises OSError when the camera refuses, or has no such feature."""

    def execute(self, name: str) -> None:
        """Run a command. Raises OSError when the camera refuses, or has no such command."""


class IndustrialCamera(Features, Protocol):
    """One camera, open."""

    def start(self) -> None:
        """Begin to take images. Raises OSError."""

    def grab(self, timeout_s: float) -> GrabbedImage | None:
        """The newest image that was not given yet; None when none came in time.

        Raises:
            OSError: the camera is gone.
        """

    def close(self) -> None:
        """Stop, and let go of the camera; never raises."""


class IndustrialCameras(Protocol):
    """The cameras that one library finds at this machine and its network.

    Attributes:
        extra: what of `pip install coaxial[...]` brings the library.
    """

    extra: str

    def descriptions(self) -> tuple[IndustrialDescription, ...]:
        """Those that are there now. Raises OSError; ImportError without the library."""

    def open(self, serial: str) -> IndustrialCamera:
        """Open the one with this serial number. Raises OSError; ImportError without the library."""
