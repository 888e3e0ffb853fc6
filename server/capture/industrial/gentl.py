"""Any GenICam camera whose vendor provides a GenTL producer (a .cti file), through harvesters.

Producers are found in the folders of GENICAM_GENTL64_PATH, as GenTL defines it; the vendors' installers set
it.
"""

import contextlib
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from server.capture.industrial.device import Bounds, FeatureValue, GrabbedImage, IndustrialDescription

PATH_VARIABLE = "GENICAM_GENTL64_PATH"
# One is being filled, one is ready, one is being copied.
BUFFERS = 3
MIN_TIMEOUT_S = 0.001
NANOSECONDS_PER_S = 1e9


def producers() -> tuple[Path, ...]:
    """Return the GenTL producers of this machine."""
    folders = [Path(text) for text in os.environ.get(PATH_VARIABLE, "").split(os.pathsep) if text]
    return tuple(file for folder in folders for file in sorted(folder.glob("*.cti")))


class GenTLCameras:
    """Cameras found by the producers."""

    extra = "genicam"

    def descriptions(self) -> tuple[IndustrialDescription, ...]:
        """Return the connected cameras."""
        with contextlib.closing(_opened()) as library:
            return tuple(
                IndustrialDescription(
                    address=f"genicam:{_serial(device)}",
                    name=f"{device.vendor} {device.model}",
                    serial=_serial(device),
                    bus=str(device.tl_type),
                )
                for device in library.harvester.device_info_list
            )

    def open(self, serial: str) -> "GenTLCamera":
        """Open the camera with this serial number."""
        library = _opened()
        try:
            devices = library.harvester.device_info_list
            with _as_os_error():
                return GenTLCamera(library.harvester.create(_index(devices, serial)), library)
        except BaseException:
            library.close()
            raise


class _Library:
    """The producers, loaded."""

    def __init__(self, harvester: Any) -> None:  # noqa: ANN401  the library has no types
        self.harvester = harvester

    def close(self) -> None:
        with contextlib.suppress(OSError), _as_os_error():
            self.harvester.reset()


def _opened() -> _Library:
    from harvesters.core import Harvester  # noqa: PLC0415  an extra, loaded when needed

    library = _Library(Harvester())
    try:
        with _as_os_error():
            for file in producers():
                library.harvester.add_file(str(file))
            library.harvester.update()
    except BaseException:
        library.close()
        raise
    return library


def _index(devices: Sequence[Any], serial: str) -> int:
    index = next((n for n, device in enumerate(devices) if _serial(device) == serial), None)
    if index is None:
        raise OSError("it is not connected")
    return index


def _serial(device: Any) -> str:  # noqa: ANN401  the library has no types
    """Return the serial number, or the producer's id of a camera without one."""
    return str(device.serial_number or device.id_)


class GenTLCamera:
    """One open camera of a GenTL producer."""

    def __init__(self, acquirer: Any, library: _Library) -> None:  # noqa: ANN401  the library has no types
        self._acquirer = acquirer
        self._library = library
        self._nodes = acquirer.remote_device.node_map

    def value(self, name: str) -> FeatureValue | None:
        """Return the value of a feature."""
        with contextlib.suppress(OSError, AttributeError), _as_os_error():
            value: FeatureValue = self._node(name).value
            return value
        return None

    def bounds(self, name: str) -> Bounds | None:
        """Return the present range of a feature."""
        with contextlib.suppress(OSError, AttributeError), _as_os_error():
            node = self._node(name)
            step = float(node.inc) if isinstance(node.value, int) else 0.0
            return Bounds(min_value=float(node.min), max_value=float(node.max), step=step)
        return None

    def options(self, name: str) -> tuple[str, ...]:
        """Return the values of an enumeration."""
        with contextlib.suppress(OSError, AttributeError), _as_os_error():
            return tuple(self._node(name).symbolics)
        return ()

    def set_value(self, name: str, value: FeatureValue) -> None:
        """Set a feature."""
        with _as_os_error():
            self._node(name).value = value

    def execute(self, name: str) -> None:
        """Run a command."""
        with _as_os_error():
            self._node(name).execute()

    def _node(self, name: str) -> Any:  # noqa: ANN401  the library has no types
        if not self._nodes.has_node(name):
            raise OSError(f"the camera has no {name}")
        return getattr(self._nodes, name)

    def start(self) -> None:
        """Start grabbing."""
        with _as_os_error():
            self._acquirer.num_buffers = max(BUFFERS, self._acquirer.min_num_buffers)
            self._acquirer.start()

    def grab(self, timeout_s: float) -> GrabbedImage | None:
        """Return the newest image not returned yet; older buffered ones are released unread."""
        with _as_os_error():
            buffer = self._acquirer.try_fetch(timeout=timeout_s)
            if buffer is None:
                return None
            skipped = 0
            while (newer := self._acquirer.try_fetch(timeout=MIN_TIMEOUT_S)) is not None:
                buffer.queue()
                buffer = newer
                skipped += 1
            try:
                return _grabbed(buffer, skipped)
            finally:
                buffer.queue()

    def close(self) -> None:
        """Stop, and release the camera."""
        with contextlib.suppress(OSError), _as_os_error():
            self._acquirer.stop()
        with contextlib.suppress(OSError), _as_os_error():
            self._acquirer.destroy()
        self._library.close()


def _grabbed(buffer: Any, skipped: int) -> GrabbedImage:  # noqa: ANN401  the library has no types
    components = buffer.payload.components
    device_s = _device_s(buffer)
    if not components or components[0].data is None:
        return GrabbedImage(pixels=None, pixel_format="", device_s=device_s, skipped=skipped)
    component = components[0]
    shape = (int(component.height), int(component.width), int(component.num_components_per_pixel))
    # A copy: the producer reuses the buffer.
    pixels = np.array(component.data, dtype=np.uint8).reshape(shape)
    return GrabbedImage(
        pixels=pixels[:, :, 0] if shape[2] == 1 else pixels,
        pixel_format=str(component.data_format),
        device_s=device_s,
        skipped=skipped,
    )


def _device_s(buffer: Any) -> float | None:  # noqa: ANN401  the library has no types
    with contextlib.suppress(OSError, AttributeError), _as_os_error():
        return float(buffer.timestamp_ns) / NANOSECONDS_PER_S or None
    with contextlib.suppress(OSError, AttributeError, ZeroDivisionError), _as_os_error():
        return float(buffer.timestamp) / float(buffer.timestamp_frequency) or None
    return None


@contextlib.contextmanager
def _as_os_error() -> Iterator[None]:
    """Convert exceptions of GenApi and GenTL to OSError."""
    from genicam.genapi import GenericException as FeatureError  # noqa: PLC0415  an extra, loaded when needed
    from genicam.gentl import GenericException as TransportError  # noqa: PLC0415

    try:
        yield
    except (FeatureError, TransportError) as error:
        raise OSError(str(error).split("\n", 1)[0] or type(error).__name__) from error
