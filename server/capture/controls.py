"""A camera's focus, exposure, gain and white balance: locked at the start, and read once a second."""

from collections.abc import Iterable, Mapping

import structlog

from server.capture.v4l2 import VideoDevice
from server.capture.v4l2.structs import EXPOSURE_MANUAL
from tracker.camera import GEOMETRIC, CameraControl

READ_EVERY_S = 1.0
# Automatic exposure and white balance need this long to find what suits the room.
LIGHT_SETTLES_S = 3.0
# What automatic control sets, and the value that switches it off.
LIGHT_LOCKS = (
    (CameraControl.AUTO_EXPOSURE, EXPOSURE_MANUAL, CameraControl.EXPOSURE),
    (CameraControl.AUTO_WHITE_BALANCE, 0, CameraControl.WHITE_BALANCE),
)

log = structlog.get_logger(__name__)


class ControlKeeper:
    """Sets a camera's controls once, and reads them from then on. Without a clock: times are passed in.

    What somebody changes later is read and told, and not set back: a focus that moves twice helps nobody.

    Args:
        device: the camera.
        name: of the camera.
        lock_focus: switch automatic focus off, and set what the calibration has.
        lock_light: switch automatic exposure and white balance off once they have settled.
        calibrated: the values at the calibration in use; empty where none is known.
        at_s: the time now.
    """

    def __init__(
        self,
        device: VideoDevice,
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
        self._light_locked = not lock_light
        self._began_s = at_s
        self._read_at_s = at_s
        self._values: Mapping[CameraControl, int] = {}
        self._values = self._read(CameraControl)
        self.restore(calibrated)

    @property
    def values(self) -> Mapping[CameraControl, int]:
        """As they were last read; never changed in place, so it may be taken from any thread."""
        return self._values

    def restore(self, calibrated: Mapping[CameraControl, int]) -> None:
        """Lock the focus where the calibration has it, else where it is; likewise zoom, pan and tilt."""
        if not self._lock_focus:
            return
        if self._values.get(CameraControl.AUTOFOCUS):
            self._set(CameraControl.AUTOFOCUS, 0)
        for control in GEOMETRIC:
            if control is CameraControl.AUTOFOCUS or control not in self._values:
                continue
            # The focus is set even to what it is: while it was automatic the lens may have stood elsewhere
            # than the value says, and what is kept with a calibration must be where the lens stands.
            is_focus = control is CameraControl.FOCUS
            value = calibrated.get(control, self._values[control] if is_focus else None)
            if value is not None and (is_focus or value != self._values[control]):
                self._set(control, value)
        self._values = self._read(self._values)

    def poll(self, at_s: float) -> None:
        """Read the values, if it is time to; and lock exposure and white balance, once, when it is."""
        if not self._light_locked and at_s - self._began_s >= LIGHT_SETTLES_S:
            self._light_locked = True
            self._lock_light()
        if at_s - self._read_at_s >= READ_EVERY_S:
            self._read_at_s = at_s
            self._values = self._read(self._values)

    def _lock_light(self) -> None:
        values = self._read(self._values)
        for switch, off, setting in LIGHT_LOCKS:
            if values.get(switch, off) != off:
                self._set(switch, off)
                if setting in values:
                    self._set(setting, values[setting])
        self._values = self._read(self._values)

    def _read(self, controls: Iterable[CameraControl]) -> dict[CameraControl, int]:
        """The values of those that the camera has; of a camera that is gone, those that were known."""
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
                code="CAMERA_CONTROL_REFUSED",
                camera=self._name,
                control=control.value,
                value=value,
                reason=(error.strerror or str(error)).lower(),
                remedy="Set it by hand, as with v4l2-ctl, and calibrate as it then is.",
            )
