"""Industrial cameras (GenICam): Basler's by pypylon, any by harvesters and its vendor's GenTL producer.

`device` is what both libraries have in common, `basler` and `gentl` are thin layers over them; `source`
gives the images, with `camera_setup` (format, size, rate, trigger), `camera_controls` (exposure, gain,
white balance), `clock_latch` (the camera's clock) and `pixel_formats`.
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
