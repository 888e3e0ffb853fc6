"""Linux cameras through Video4Linux (V4L2): devices, modes, controls; the images come through OpenCV.

`devices` has records and interfaces, `kernel` the system calls, `structs` their structures and constants.

Python libraries for V4L2 are GPL, so this is our own. Formats, granted mode and controls are read on a second
descriptor of the device, behind interfaces that tests replace. macOS has none of this.
"""

from server.capture.v4l2.devices import (
    ControlReading,
    DeviceDescription,
    VideoDevice,
    VideoDevices,
)
from server.capture.v4l2.kernel import KernelDevices, NoDevices, system_devices

__all__ = [
    "ControlReading",
    "DeviceDescription",
    "KernelDevices",
    "NoDevices",
    "VideoDevice",
    "VideoDevices",
    "system_devices",
]
