"""Capabilities of an industrial camera, and the requested and granted mode.

A smaller image of such a camera is a centred region of its sensor, not a scaled image: it has the same pixels
per degree, but another camera matrix.
"""

import contextlib
from dataclasses import dataclass

from server.capture.industrial.device import Bounds, Features, FeatureValue
from server.capture.industrial.pixel_formats import best_format
from server.capture.modes import WANTED_RATE_HZ, WantedMode
from server.errors import CaptureError
from server.live import CameraMode

# SFNC name, and names of older and Basler's cameras.
RATE_NAMES = ("AcquisitionFrameRate", "AcquisitionFrameRateAbs")
GRANTED_RATE_NAMES = (
    "ResultingFrameRate",
    "BslResultingAcquisitionFrameRate",
    "ResultingFrameRateAbs",
    "AcquisitionResultingFrameRate",
    *RATE_NAMES,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraCapabilities:
    """Capabilities of a camera.

    Attributes:
        pixel_formats: PFNC names.
        width_px, height_px: size of its images; the largest is of the whole sensor.
        rate_hz: images per second; None where it cannot be set.
        triggers: trigger inputs.
    """

    pixel_formats: tuple[str, ...]
    width_px: Bounds
    height_px: Bounds
    rate_hz: Bounds | None
    triggers: tuple[str, ...]


def read_capabilities(features: Features) -> CameraCapabilities:
    """Return a camera's present capabilities. Raises OSError if it does not state its image size."""
    width, height = _full_range(features, "Width"), _full_range(features, "Height")
    if width is None or height is None:
        raise OSError("it does not state the size of its images")
    rates = (features.bounds(name) for name in RATE_NAMES)
    return CameraCapabilities(
        pixel_formats=features.options("PixelFormat"),
        width_px=width,
        height_px=height,
        rate_hz=next((rate for rate in rates if rate is not None), None),
        triggers=features.options("TriggerSource"),
    )


def choose_industrial_mode(
    offer: CameraCapabilities,
    wanted: WantedMode,
    *,
    calibrated_size_wh_px: tuple[int, int] | None,
    is_triggered: bool,
) -> CameraMode | None:
    """Return the mode to request; None where no format can be decoded.

    The wanted mode, or the nearest one; by default the calibration's size, else the whole sensor, at 30 Hz or
    the nearest rate. A triggered camera has no rate of its own: 0.
    """
    fourcc = best_format(offer.pixel_formats)
    if fourcc is None:
        return None
    width, height = (
        wanted.size_wh_px or calibrated_size_wh_px or (offer.width_px.max_value, offer.height_px.max_value)
    )
    rate_hz = 0.0
    if offer.rate_hz is not None and not is_triggered:
        rate_hz = offer.rate_hz.nearest(wanted.rate_hz or WANTED_RATE_HZ)
    size = (int(offer.width_px.nearest(width)), int(offer.height_px.nearest(height)))
    return CameraMode(fourcc=fourcc, size_wh_px=size, rate_hz=rate_hz)


def set_mode(features: Features, mode: CameraMode) -> CameraMode:
    """Request a mode, and return the granted one, which shows what the camera rejected."""
    _try(features, "PixelFormat", mode.fourcc)
    for name, offset, size_px in zip(
        ("Width", "Height"), ("OffsetX", "OffsetY"), mode.size_wh_px, strict=True
    ):
        _try(features, offset, 0)
        _try(features, name, size_px)
        free = features.bounds(offset)
        if free is not None:
            _try(features, offset, int(free.nearest(free.max_value / 2.0)))
    if mode.rate_hz > 0.0:
        _try(features, "AcquisitionFrameRateEnable", True)
        for name in RATE_NAMES:
            _try(features, name, mode.rate_hz)
    return granted_mode(features, has_rate=mode.rate_hz > 0.0)


def granted_mode(features: Features, *, has_rate: bool) -> CameraMode:
    """Return the present mode."""
    rates = (features.value(name) for name in GRANTED_RATE_NAMES) if has_rate else iter(())
    return CameraMode(
        fourcc=str(features.value("PixelFormat") or ""),
        size_wh_px=(int(features.value("Width") or 0), int(features.value("Height") or 0)),
        rate_hz=next((float(rate) for rate in rates if rate), 0.0),
    )


def set_trigger(features: Features, name: str, trigger: str | None) -> str:
    """Set or clear the trigger input of each image; return the camera's name of it.

    Args:
        features: features of the camera.
        name: display name of the camera.
        trigger: the input, case-insensitive ("line1"); None for free run.

    Raises:
        CaptureError: CAMERA_TRIGGER_NOT_OFFERED.
        OSError: the camera rejects the setting.
    """
    # Triggers may be left on by another program.
    for selected in features.options("TriggerSelector"):
        with contextlib.suppress(OSError):
            features.set_value("TriggerSelector", selected)
            features.set_value("TriggerMode", "Off")
    if trigger is None:
        return ""
    sources = features.options("TriggerSource")
    source = next((one for one in sources if one.lower() == trigger.lower()), None)
    if source is None:
        triggers = ", ".join(sources) or "none"
        raise CaptureError(
            "CAMERA_TRIGGER_NOT_OFFERED",
            f"{name} has no trigger '{trigger}'",
            f"Set camera.trigger to an available trigger ({triggers}), or to null.",
            {"camera": name, "trigger": trigger, "offered": list(sources), "triggers": triggers},
        )
    _try(features, "TriggerSelector", "FrameStart")
    features.set_value("TriggerSource", source)
    features.set_value("TriggerMode", "On")
    return source


def _full_range(features: Features, name: str) -> Bounds | None:
    """Return the range of width or height with the region at the sensor's edge."""
    now, largest = features.bounds(name), features.value(f"{name}Max")
    if now is None or not isinstance(largest, int | float):
        return now
    return Bounds(min_value=now.min_value, max_value=max(now.max_value, float(largest)), step=now.step)


def _try(features: Features, name: str, value: FeatureValue) -> None:
    """Set an optional feature; the granted value is read back afterwards."""
    with contextlib.suppress(OSError):
        features.set_value(name, value)
