"""What Linux says of its cameras (Video4Linux, V4L2): devices, modes, controls; images come through OpenCV.

`devices` has the records and the interfaces, `kernel` asks the kernel, `structs` are its records and numbers.

Python libraries for V4L2 are GPL, so this is our own. Formats, granted mode and controls are asked for on a
second descriptor of the device, behind interfaces that tests play. macOS has none of this.
"""

from server.capture.v4l2.devices import (
    ControlReading,
    DeviceDescription,
    VideoDevice,
    VideoDevices,
)
from server.capture.v4l2.kernel import KernelDevices, NoDevices, devices_here

__all__ = [
    "ControlReading",
    "DeviceDescription",
    "KernelDevices",
    "NoDevices",
    "VideoDevice",
    "VideoDevices",
    "devices_here",
]
