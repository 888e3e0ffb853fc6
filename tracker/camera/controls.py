"""Camera controls, and which of them invalidate a calibration when they change.

An autofocus changes the focal length and therefore every depth by a percent, which is not visible in the
image. After a change of a geometric control no values in millimetres are displayed. With a driver that
reports a fluctuating focus, no numbers are displayed at all.
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
# matrix. Exposure, gain and white balance change only the brightness, which is fitted in each image.
GEOMETRIC = (
    CameraControl.FOCUS,
    CameraControl.ZOOM,
    CameraControl.PAN,
    CameraControl.TILT,
    CameraControl.AUTOFOCUS,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlChange:
    """A control whose value differs from that at the calibration.

    Attributes:
        control: the control.
        calibrated: its value at the calibration, in the driver's own unit.
        now: its value now.
    """

    control: CameraControl
    calibrated: int
    now: int


def control_changes(
    calibrated: Mapping[CameraControl, int], now: Mapping[CameraControl, int]
) -> tuple[ControlChange, ...]:
    """Return the geometric controls whose values differ; unknown values do not count."""
    return tuple(
        ControlChange(control=control, calibrated=calibrated[control], now=now[control])
        for control in GEOMETRIC
        if control in calibrated and control in now and calibrated[control] != now[control]
    )
