"""Camera controls, and which of them invalidate a calibration when they change.

An autofocus changes the focal length by a percent, and with it every depth, without a sign in the image. So
after a change of a geometric control no millimetres are shown. A camera whose driver reports a fluctuating
focus shows no numbers at all.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum


class CameraControl(StrEnum):
    """Controls of a camera beside its mode; those that affect the geometry come first."""

    FOCUS = "focus"
    ZOOM = "zoom"
    PAN = "pan"
    TILT = "tilt"
    AUTOFOCUS = "autofocus"
    AUTO_EXPOSURE = "auto_exposure"
    EXPOSURE = "exposure"
    GAIN = "gain"
    AUTO_WHITE_BALANCE = "auto_white_balance"
    WHITE_BALANCE = "white_balance"


# Focus moves the lens and with it the focal length; zoom, pan and tilt, mechanical or digital, the camera
# matrix. Exposure, gain and white balance change brightness alone, which each pose fits for itself.
GEOMETRIC = (
    CameraControl.FOCUS,
    CameraControl.ZOOM,
    CameraControl.PAN,
    CameraControl.TILT,
    CameraControl.AUTOFOCUS,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlChange:
    """A control that is not what it was at the calibration.

    Attributes:
        control: which one.
        calibrated: its value at the calibration, in the driver's own unit.
        now: its value now.
    """

    control: CameraControl
    calibrated: int
    now: int


def control_changes(
    calibrated: Mapping[CameraControl, int], now: Mapping[CameraControl, int]
) -> tuple[ControlChange, ...]:
    """The geometric controls whose values differ; one that is not known on either side does not count."""
    return tuple(
        ControlChange(control=control, calibrated=calibrated[control], now=now[control])
        for control in GEOMETRIC
        if control in calibrated and control in now and calibrated[control] != now[control]
    )
