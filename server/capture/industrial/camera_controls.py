"""Exposure, gain, white balance and sensor region of an industrial camera, as controls to lock and read."""

import contextlib

from server.capture.industrial.device import Features
from server.capture.v4l2 import ControlReading
from server.capture.v4l2.structs import EXPOSURE_MANUAL
from tracker.camera import CameraControl

# Unit of the control EXPOSURE: a microsecond.
EXPOSURE_UNIT_MS = 0.001
# Value of V4L2 for automatic exposure.
EXPOSURE_AUTO = 0
OFF = "Off"
# Automatic exposure includes automatic gain.
AUTOMATICS = {
    CameraControl.AUTO_EXPOSURE: (("ExposureAuto", "GainAuto"), EXPOSURE_MANUAL, EXPOSURE_AUTO),
    CameraControl.AUTO_WHITE_BALANCE: (("BalanceWhiteAuto",), 0, 1),
}
# SFNC name, then the name of older cameras; a control's value is a whole number of such parts of the
# feature's unit. Includes what changes the camera matrix: binning is zoom, the region's offset on the sensor
# pan and tilt.
NUMBERS = {
    CameraControl.ZOOM: (("BinningHorizontal",), 1),
    CameraControl.PAN: (("OffsetX",), 1),
    CameraControl.TILT: (("OffsetY",), 1),
    CameraControl.EXPOSURE: (("ExposureTime", "ExposureTimeAbs"), 1),
    CameraControl.GAIN: (("Gain", "GainRaw"), 100),
}


class IndustrialControls:
    """Controls of one camera: exposure in microseconds, gain in hundredths of its unit (mostly dB)."""

    def __init__(self, features: Features) -> None:
        self._features = features

    def control(self, control: CameraControl) -> ControlReading | None:
        """Return a control's value; None if the camera lacks it."""
        if control in AUTOMATICS:
            names, off, on = AUTOMATICS[control]
            states = [state for name in names if (state := self._features.value(name)) is not None]
            if not states:
                return None
            value = off if all(state == OFF for state in states) else on
            return ControlReading(value=value, min_value=min(off, on), max_value=max(off, on))
        names, parts = NUMBERS.get(control, ((), 1))
        for name in names:
            value_now, bounds = self._features.value(name), self._features.bounds(name)
            if isinstance(value_now, int | float) and bounds is not None:
                return ControlReading(
                    value=round(value_now * parts),
                    min_value=round(bounds.min_value * parts),
                    max_value=round(bounds.max_value * parts),
                )
        return None

    def set_control(self, control: CameraControl, value: int) -> None:
        """Set a control, if it differs. Raises OSError if the camera rejects it."""
        reading = self.control(control)
        if reading is None:
            raise OSError(f"the camera has no {control.value}")
        if reading.value == value:
            return
        if control in AUTOMATICS:
            for name in AUTOMATICS[control][0]:
                if self._features.value(name) is not None:
                    self._features.set_value(name, OFF)
            return
        names, parts = NUMBERS[control]
        name = next(name for name in names if self._features.value(name) is not None)
        is_whole = isinstance(self._features.value(name), int)
        self._features.set_value(name, value // parts if is_whole else value / parts)
        if control is CameraControl.ZOOM:
            with contextlib.suppress(OSError):
                self._features.set_value("BinningVertical", value)
