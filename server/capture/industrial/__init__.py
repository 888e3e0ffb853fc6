"""Industrial cameras (GenICam): Basler's by pypylon, others by harvesters and the vendor's GenTL producer.

`device` has the common interface, `basler` and `gentl` are thin adapters; `source` provides the images, with
`camera_setup` (format, size, rate, trigger), `camera_controls` (exposure, gain, white balance), `clock_latch`
(the camera's clock) and `pixel_formats`.

Both libraries use GenICam's feature names, so mode, trigger, controls and clock are implemented once.
pypylon's wheel is under the 3-clause BSD licence with Basler's runtime in it, and emulates cameras for the
tests; the GenICam package below harvesters may be redistributed only unchanged, so it is in no lock file. A
smaller image is a region of the sensor: its offset counts as pan and tilt, binning as zoom. Formats of more
than 8 bits and YUV are not supported.
"""

from server.capture.industrial.basler import BaslerCameras
from server.capture.industrial.camera_controls import IndustrialControls
from server.capture.industrial.camera_setup import (
    CameraCapabilities,
    choose_industrial_mode,
    read_capabilities,
)
from server.capture.industrial.device import Bounds, IndustrialCameras, IndustrialDescription
from server.capture.industrial.gentl import GenTLCameras, producers
from server.capture.industrial.source import IndustrialCameraSource

__all__ = [
    "BaslerCameras",
    "Bounds",
    "CameraCapabilities",
    "GenTLCameras",
    "IndustrialCameraSource",
    "IndustrialCameras",
    "IndustrialControls",
    "IndustrialDescription",
    "choose_industrial_mode",
    "producers",
    "read_capabilities",
]
