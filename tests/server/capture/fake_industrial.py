"""A fake industrial camera: features, clock and images."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from server.capture.industrial.device import (
    Bounds,
    FeatureValue,
    GrabbedImage,
    IndustrialCamera,
    IndustrialDescription,
)

SERIAL = "4711"
SENSOR_WH_PX = (1936, 1216)
SWITCH = ("Off", "Once", "Continuous")


def sensor_features() -> dict[str, FeatureValue]:
    """# Features of a colour camera with 2.3 megapixels after power-on."""
    return {
        "WidthMax": SENSOR_WH_PX[0],
        "HeightMax": SENSOR_WH_PX[1],
        "Width": SENSOR_WH_PX[0],
        "Height": SENSOR_WH_PX[1],
        "OffsetX": 0,
        "OffsetY": 0,
        "BinningHorizontal": 1,
        "PixelFormat": "Mono8",
        "AcquisitionFrameRateEnable": False,
        "AcquisitionFrameRate": 10.0,
        "ResultingFrameRate": 10.0,
        "TriggerSelector": "FrameStart",
        "TriggerMode": "Off",
        "TriggerSource": "Line1",
        "ExposureAuto": "Continuous",
        "GainAuto": "Continuous",
        "BalanceWhiteAuto": "Continuous",
        "ExposureTime": 8000.4,
        "Gain": 3.25,
    }


@dataclass
class FakeIndustrialCamera:
    """State of the camera, changed by the test in place of a user, a cable or firmware.

    Attributes:
        now_s: the only clock of this machine, advanced by the test; `clock` reads it.
        device_zero_s: reading of the camera's clock when this machine's read 0.
        latency_s: from exposure to arrival of the next image.
        latch_takes_s: round trip of reading the camera's clock; None if it cannot be read.
        max_rate_hz: limit of its connection.
        arriving: what comes next: an image, None for a timeout, or an error.

    """

    features: dict[str, FeatureValue] = field(default_factory=sensor_features)
    pixel_formats: tuple[str, ...] = ("Mono8", "BayerRG8", "BayerRG12")
    triggers: tuple[str, ...] = ("Line1", "Line3", "Software")
    rejected: set[str] = field(default_factory=set)
    max_rate_hz: float = 160.0
    now_s: float = 1000.0
    device_zero_s: float | None = 50_000.0
    latency_s: float = 0.02
    latch_takes_s: float | None = None
    arriving: deque[GrabbedImage | OSError | None] = field(default_factory=deque)
    calls: list[str] = field(default_factory=list)
    taken: int = 0

    def clock(self) -> float:
        return self.now_s

    def device_s(self) -> float | None:
        return None if self.device_zero_s is None else self.device_zero_s + self.now_s

    def value(self, name: str) -> FeatureValue | None:
        return self.features.get(name)

    def bounds(self, name: str) -> Bounds | None:
        if name in ("Width", "Height"):
            axis = ("Width", "Height").index(name)
            free = SENSOR_WH_PX[axis] - int(self.features[f"Offset{'XY'[axis]}"])
            return Bounds(min_value=16, max_value=free, step=8)
        if name in ("OffsetX", "OffsetY"):
            axis = ("OffsetX", "OffsetY").index(name)
            free = SENSOR_WH_PX[axis] - int(self.features[("Width", "Height")[axis]])
            return Bounds(min_value=0, max_value=free, step=8)
        if name == "AcquisitionFrameRate":
            return Bounds(min_value=1.0, max_value=160.0)
        value = self.features.get(name)
        return Bounds(min_value=0, max_value=1e6) if isinstance(value, int | float) else None

    def options(self, name: str) -> tuple[str, ...]:
        return {
            "PixelFormat": self.pixel_formats,
            "TriggerSource": self.triggers,
            "TriggerSelector": ("FrameStart", "FrameBurstStart"),
        }.get(name, ())

    def set_value(self, name: str, value: FeatureValue) -> None:
        if name not in self.features or name in self.rejected:
            raise OSError(f"{name} is not writable")
        self.features[name] = value
        self.calls.append(f"{name}={value}")
        if name == "AcquisitionFrameRate":
            self.features["ResultingFrameRate"] = min(float(value), self.max_rate_hz)

    def execute(self, name: str) -> None:
        device_s = self.device_s()
        if name != "TimestampLatch" or self.latch_takes_s is None or device_s is None:
            raise OSError(f"{name} is not executable")
        # Read halfway between request and answer.
        self.features["TimestampLatchValue"] = round((device_s + self.latch_takes_s / 2.0) * 1e9)
        self.now_s += self.latch_takes_s

    def start(self) -> None:
        self.calls.append("start")

    def grab(self, timeout_s: float) -> GrabbedImage | None:
        if not self.arriving:
            return self.image()
        thing = self.arriving.popleft()
        if isinstance(thing, OSError):
            raise thing
        if thing is None:
            self.now_s += timeout_s
        return thing

    def image(self, *, device_s: Callable[[float], float] | None = None) -> GrabbedImage:
        """An image that arrives now, taken `latency_s` before, with this camera time."""
        taken_s = self.device_s()
        if taken_s is not None:
            taken_s -= self.latency_s
            taken_s = taken_s if device_s is None else device_s(taken_s)
        self.taken += 1
        height, width = int(self.features["Height"]), int(self.features["Width"])
        # Another grey level each time, since no two sensor images are equal; one byte in memory.
        pixels = np.broadcast_to(np.uint8(self.taken % 251), (height, width))
        return GrabbedImage(
            pixels=pixels, pixel_format=str(self.features["PixelFormat"]), device_s=taken_s, skipped=0
        )

    def close(self) -> None:
        self.calls.append("close")


class FakeIndustrialCameras:
    """A library that finds these cameras, by their serial numbers."""

    extra = "basler"

    def __init__(self, **cameras: FakeIndustrialCamera) -> None:
        self.cameras = {name.removeprefix("sn"): camera for name, camera in cameras.items()}
        self.is_installed = True

    def descriptions(self) -> tuple[IndustrialDescription, ...]:
        if not self.is_installed:
            raise ImportError("No module named 'pypylon'")
        return tuple(
            IndustrialDescription(
                address=f"basler:{serial}", name="Basler a2A1920-160uc", serial=serial, bus="BaslerUsb"
            )
            for serial in self.cameras
        )

    def open(self, serial: str) -> IndustrialCamera:
        if not self.is_installed:
            raise ImportError("No module named 'pypylon'")
        if serial not in self.cameras:
            raise OSError("it is not there")
        return self.cameras[serial]
