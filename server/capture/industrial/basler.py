"""Basler cameras, by Basler's own library (pypylon)."""

import contextlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from server.capture.industrial.device import Bounds, FeatureValue, GrabbedImage, IndustrialDescription

NANOSECONDS_PER_S = 1e9


class BaslerCameras:
    """Cameras found by pylon. With PYLON_CAMEMU=2 in the environment it also emulates two cameras."""

    extra = "basler"

    def descriptions(self) -> tuple[IndustrialDescription, ...]:
        """Return the connected cameras."""
        from pypylon import pylon  # noqa: PLC0415  an extra, loaded when needed

        with _as_os_error():
            return tuple(
                IndustrialDescription(
                    address=f"basler:{device.GetSerialNumber()}",
                    name=_name(device.GetVendorName(), device.GetModelName()),
                    serial=device.GetSerialNumber(),
                    bus=device.GetDeviceClass(),
                )
                for device in pylon.TlFactory.GetInstance().EnumerateDevices()
            )

    def open(self, serial: str) -> "BaslerCamera":
        """Open the camera with this serial number."""
        from pypylon import pylon  # noqa: PLC0415  an extra, loaded when needed

        with _as_os_error():
            wanted = pylon.DeviceInfo()
            wanted.SetSerialNumber(serial)
            camera = pylon.InstantCamera(pylon.TlFactory.GetInstance().CreateDevice(wanted))
            camera.Open()
        return BaslerCamera(camera, pylon)


class BaslerCamera:
    """One open Basler camera."""

    def __init__(self, camera: Any, pylon: Any) -> None:  # noqa: ANN401  the library has no types
        self._camera = camera
        self._pylon = pylon
        self._nodes = camera.GetNodeMap()
        frequency_hz = self.value("GevTimestampTickFrequency")
        self._ticks_per_s = float(frequency_hz) if frequency_hz else NANOSECONDS_PER_S

    def value(self, name: str) -> FeatureValue | None:
        """Return the value of a feature."""
        with contextlib.suppress(OSError), _as_os_error():
            node = self._nodes.GetNode(name)
            if node.IsReadable():
                value: FeatureValue = node.GetValue()
                return value
        return None

    def bounds(self, name: str) -> Bounds | None:
        """Return the present range of a feature."""
        with contextlib.suppress(OSError), _as_os_error():
            node = self._nodes.GetNode(name)
            if node.IsReadable():
                min_value, max_value = float(node.GetMin()), float(node.GetMax())
                step = float(node.GetInc()) if isinstance(node.GetValue(), int) else 0.0
                return Bounds(min_value=min_value, max_value=max_value, step=step)
        return None

    def options(self, name: str) -> tuple[str, ...]:
        """Return the values of an enumeration."""
        with contextlib.suppress(OSError), _as_os_error():
            node = self._nodes.GetNode(name)
            if node.IsReadable():
                return tuple(node.Symbolics)
        return ()

    def set_value(self, name: str, value: FeatureValue) -> None:
        """Set a feature."""
        with _as_os_error():
            self._nodes.GetNode(name).SetValue(value)

    def execute(self, name: str) -> None:
        """Run a command."""
        with _as_os_error():
            self._nodes.GetNode(name).Execute()

    def start(self) -> None:
        """Start grabbing; the library buffers the newest image only."""
        with _as_os_error():
            self._camera.StartGrabbing(self._pylon.GrabStrategy_LatestImageOnly)

    def grab(self, timeout_s: float) -> GrabbedImage | None:
        """Return the newest image not returned yet.

        Pylon ends its wait with a timer that sends SIGALRM to this process; pylon handles the signal.
        """
        with _as_os_error():
            if not self._camera.IsGrabbing() or self._camera.IsCameraDeviceRemoved():
                raise OSError("the camera was removed")
            result = self._camera.RetrieveResult(int(timeout_s * 1000), self._pylon.TimeoutHandling_Return)
            if not result.IsValid():
                return None
            try:
                return self._grabbed(result)
            finally:
                result.Release()

    def _grabbed(self, result: Any) -> GrabbedImage:  # noqa: ANN401  the library has no types
        ticks = int(result.GetTimeStamp())
        is_whole = result.GrabSucceeded()
        return GrabbedImage(
            # A copy: the library reuses the result's memory.
            pixels=np.array(result.Array, dtype=np.uint8) if is_whole else None,
            pixel_format=str(self.value("PixelFormat") or ""),
            device_s=ticks / self._ticks_per_s if ticks else None,
            skipped=int(result.GetNumberOfSkippedImages()),
        )

    def close(self) -> None:
        """Stop, and release the camera."""
        with contextlib.suppress(OSError), _as_os_error():
            self._camera.StopGrabbing()
        with contextlib.suppress(OSError), _as_os_error():
            self._camera.Close()
        with contextlib.suppress(OSError), _as_os_error():
            self._camera.DestroyDevice()


@contextlib.contextmanager
def _as_os_error() -> Iterator[None]:
    """Convert pylon's many exceptions to OSError."""
    from pypylon import genicam  # noqa: PLC0415  an extra, loaded when needed

    try:
        yield
    except genicam.GenericException as error:
        raise OSError(_first_sentence(str(error))) from error


def _first_sentence(text: str) -> str:
    """Return the message without its location in the library's source."""
    return text.split(" : ", 1)[0].split("\n", 1)[0].rstrip(". ")


def _name(vendor: str, model: str) -> str:
    return model if model.startswith(vendor) else f"{vendor} {model}"
