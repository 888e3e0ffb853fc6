"""Focus, exposure, gain and white balance of a camera: locked at the start, and read once a second.

Values are stored with the calibration, and set when the camera is opened or a calibration is adopted. The
tracking process compares them, so that image, numbers and alarm agree. A change of exposure, gain or white
balance invalidates nothing, because each pose estimates the brightness.
"""

from collections.abc import Iterable, Mapping
from typing import Protocol

import structlog

from server.capture.v4l2 import ControlReading
from server.capture.v4l2.structs import EXPOSURE_MANUAL
from tracker.camera import GEOMETRIC, CameraControl

READ_EVERY_S = 1.0
# Settling time of automatic focus, exposure and white balance.
SETTLES_S = 3.0
# Automatic control, the value that switches it off, and the control that it sets.
LIGHT_LOCKS = (
    (CameraControl.AUTO_EXPOSURE, EXPOSURE_MANUAL, CameraControl.EXPOSURE),
    (CameraControl.AUTO_WHITE_BALANCE, 0, CameraControl.WHITE_BALANCE),
)

log = structlog.get_logger(__name__)


class Controls(Protocol):
    """Controls of one camera."""

    def control(self, control: CameraControl) -> ControlReading | None:
        """Return a control's value; None if the camera lacks it. Raises OSError for a removed camera."""

    def set_control(self, control: CameraControl, value: int) -> None:
        """Set a control. Raises OSError if the camera rejects it."""


class ControlLock:
    """Sets a camera's controls once, and monitors them from then on. Times are passed in.

    A later change by a person is reported but not reverted, because a second focus move would not restore the
    calibrated state.

    Args:
        device: The camera.
        name: Name of the camera.
        lock_focus: Switch autofocus off: at once if the calibration has a focus, which is then set with its
            zoom, pan and tilt; otherwise once it has settled.
        lock_light: Switch automatic exposure and white balance off once they have settled.
        calibrated: Values at the calibration in use; empty if unknown.
        at_s: Present time.
    """

    def __init__(
        self,
        device: Controls,
        *,
        name: str,
        lock_focus: bool,
        lock_light: bool,
        calibrated: Mapping[CameraControl, int],
        at_s: float,
    ) -> None:
        self._device = device
        self._name = name
        self._lock_focus = lock_focus
        self._focus_locked = not lock_focus
        self._light_locked = not lock_light
        self._began_s = at_s
        self._read_at_s = at_s
        self._values: Mapping[CameraControl, int] = {}
        self._values = self._read(CameraControl)
        self.restore(calibrated)

    @property
    def values(self) -> Mapping[CameraControl, int]:
        """Last read values; immutable, so readable from any thread."""
        return self._values

    def restore(self, calibrated: Mapping[CameraControl, int]) -> None:
        """Set focus, zoom, pan and tilt to their values at a calibration, where known."""
        if not self._lock_focus:
            return
        for control in GEOMETRIC:
            if control is CameraControl.FOCUS and control in calibrated:
                self._fix_focus(calibrated[control])
            elif control is not CameraControl.AUTOFOCUS and control in calibrated and control in self._values:
                self._set(control, calibrated[control])
        self._values = self._read(self._values)

    def _fix_focus(self, value: int) -> None:
        """Switch autofocus off, and set the focus."""
        self._focus_locked = True
        if self._values.get(CameraControl.AUTOFOCUS):
            self._set(CameraControl.AUTOFOCUS, 0)
        if CameraControl.FOCUS in self._values:
            self._set(CameraControl.FOCUS, value)

    def poll(self, at_s: float) -> None:
        """Read the values when due; lock the controls once they have settled."""
        if at_s - self._began_s >= SETTLES_S:
            self._lock_settled()
        if at_s - self._read_at_s >= READ_EVERY_S:
            self._read_at_s = at_s
            self._values = self._read(self._values)

    def _lock_settled(self) -> None:
        if self._focus_locked and self._light_locked:
            return
        self._values = self._read(self._values)
        if not self._focus_locked:
            # Set even to its present value: the lens position may differ from the value, but the value stored
            # with a calibration must be that of the lens.
            self._fix_focus(self._values.get(CameraControl.FOCUS, 0))
        if not self._light_locked:
            self._light_locked = True
            self._lock_light(self._values)
        self._values = self._read(self._values)

    def _lock_light(self, values: Mapping[CameraControl, int]) -> None:
        for switch, off, setting in LIGHT_LOCKS:
            if values.get(switch, off) != off:
                self._set(switch, off)
                if setting in values:
                    self._set(setting, values[setting])

    def _read(self, controls: Iterable[CameraControl]) -> dict[CameraControl, int]:
        """Return the values of the camera's controls; for a removed camera, the last known ones."""
        values: dict[CameraControl, int] = {}
        for control in controls:
            try:
                reading = self._device.control(control)
            except OSError:
                return dict(self._values)
            if reading is not None:
                values[control] = reading.value
        return values

    def _set(self, control: CameraControl, value: int) -> None:
        try:
            self._device.set_control(control, value)
        except OSError as error:
            log.warning(
                "a control of the camera cannot be set",
                code="CAMERA_CONTROL_REJECTED",
                camera=self._name,
                control=control.value,
                value=value,
                reason=(error.strerror or str(error)).lower(),
                remedy="Set it manually, for example with v4l2-ctl, and then calibrate.",
            )
