"""Industrial cameras (GenICam): Basler's by pypylon, any by harvesters and its vendor's GenTL producer.

`device` is what both libraries have in common, `basler` and `gentl` are thin layers over them; `source`
gives the images, with `camera_setup` (format, size, rate, trigger), `camera_controls` (exposure, gain,
white balance), `clock_latch` (the camera's clock) and `pixel_formats`.

Both libraries name GenICam's features alike, so mode, trigger, controls and clock are written once. pypylon's
wheel is under the 3-clause BSD licence with Basler's runtime in it, and emulates cameras for the tests; the
GenICam package below harvesters may be passed on only unchanged, so it is in no lock. A smaller image is a
region of the sensor: its place counts as pan and tilt, binning as zoom. Formats of more than 8 bits and YUV
are not read.
"""

from server.capture.industrial.basler import BaslerCameras
from server.capture.industrial.camera_controls import IndustrialControls
from server.capture.industrial.camera_setup import Offer, chosen_mode, offer_of
from server.capture.industrial.device import Bounds, IndustrialCameras, IndustrialDescription
from server.capture.industrial.gentl import GenTLCameras, producers
from server.capture.industrial.source import IndustrialCameraSource

__all__ = [
    "BaslerCameras",
    "Bounds",
    "GenTLCameras",
    "IndustrialCameraSource",
    "IndustrialCameras",
    "IndustrialControls",
    "IndustrialDescription",
    "Offer",
    "chosen_mode",
    "offer_of",
    "producers",
]
