"""Comparison of the requested camera mode with granted and measured size, format and rate."""

from collections import deque

from server.capture.modes import WantedMode, is_same_rate
from server.errors import CaptureError
from server.live import CameraMode

# Window of the repeated rate measurement, which starts after the camera has settled.
SETTLE_S = 2.0
MEASURED_OVER_S = 4.0
# Relative tolerance; a deviation is cleared below the second one (hysteresis).
RATE_TOLERANCE_RATIO = 0.15
CLEARS_AT_RATIO = 0.10

CHOOSE = "Choose a mode that coaxial cameras lists, with camera.width, camera.height and camera.rate_hz."
FASTER = (
    "Use more light or a fixed, shorter exposure (automatic exposure slows a camera down in the dark), a "
    "separate USB port, or smaller images with camera.width and camera.height."
)


class ModeCheck:
    """Compares requested, granted and measured mode. The times are those of the images.

    Args:
        name: Name of the camera.
        wanted: Mode of the settings.
        requested: The offered mode that was requested; None if the modes are unknown.
        granted: Mode granted by the driver.
    """

    def __init__(
        self, name: str, *, wanted: WantedMode, requested: CameraMode | None, granted: CameraMode
    ) -> None:
        self._name = name
        self._wanted = wanted
        self._requested = requested
        self._granted = granted
        self._size_wh_px = granted.size_wh_px
        self._began_s: float | None = None
        self._times: deque[float] = deque()
        self._measured_hz: float | None = None
        self._is_off_rate = False
        self._problem = self._find_problem()

    @property
    def granted(self) -> CameraMode:
        """Mode granted by the driver."""
        return self._granted

    @property
    def problem(self) -> CaptureError | None:
        """The difference between the modes, with all numbers; None without one."""
        return self._problem

    def take(self, size_wh_px: tuple[int, int], at_s: float) -> None:
        """Add one image of this size and capture time."""
        if self._began_s is None:
            self._began_s = at_s
        if size_wh_px != self._size_wh_px:
            self._size_wh_px = size_wh_px
            self._problem = self._find_problem()
        if at_s - self._began_s < SETTLE_S:
            return
        self._times.append(at_s)
        if at_s - self._times[0] >= MEASURED_OVER_S:
            self._measure((len(self._times) - 1) / (at_s - self._times[0]))
            self._times.clear()
            self._times.append(at_s)

    def _measure(self, rate_hz: float) -> None:
        expected_hz = self._expected_hz()
        limit = CLEARS_AT_RATIO if self._is_off_rate else RATE_TOLERANCE_RATIO
        was_off, self._is_off_rate = self._is_off_rate, False
        if expected_hz > 0.0:
            self._is_off_rate = abs(rate_hz - expected_hz) > limit * expected_hz
        # A reported problem is not reported again for every change by a tenth of a hertz.
        reported_hz = self._measured_hz
        if (
            was_off
            and self._is_off_rate
            and reported_hz
            and abs(rate_hz - reported_hz) <= limit * reported_hz
        ):
            return
        self._measured_hz = rate_hz
        self._problem = self._find_problem()

    def _expected_hz(self) -> float:
        """Return the requested rate, because a granted rate of 5 Hz is a problem as well."""
        requested_hz = 0.0 if self._requested is None else self._requested.rate_hz
        return self._wanted.rate_hz or requested_hz or self._granted.rate_hz

    def _find_problem(self) -> CaptureError | None:
        if self._is_other_than_wanted():
            return self._error("CAMERA_MODE_NOT_OFFERED", CHOOSE)
        if self._is_other_than_granted():
            return self._error("CAMERA_MODE_NOT_GRANTED", CHOOSE)
        return self._error("CAMERA_RATE_DIFFERS", FASTER) if self._is_off_rate else None

    def _is_other_than_wanted(self) -> bool:
        """Return whether the camera does not offer the settings' mode."""
        requested, wanted = self._requested, self._wanted
        if requested is None:
            return False
        is_other_size = wanted.size_wh_px is not None and wanted.size_wh_px != requested.size_wh_px
        is_other_rate = (
            wanted.rate_hz is not None
            and requested.rate_hz > 0.0
            and not is_same_rate(wanted.rate_hz, requested.rate_hz)
        )
        return is_other_size or is_other_rate

    def _is_other_than_granted(self) -> bool:
        """Return whether the driver granted another mode than requested, or delivers another size."""
        granted, wanted, requested = self._granted, self._wanted, self._requested
        size_wh_px = wanted.size_wh_px if requested is None else requested.size_wh_px
        sizes = {self._size_wh_px} | ({granted.size_wh_px} if granted.size_wh_px != (0, 0) else set())
        if size_wh_px is not None and sizes != {size_wh_px}:
            return True
        if requested is not None and granted.fourcc and granted.fourcc != requested.fourcc:
            return True
        requested_hz = wanted.rate_hz if requested is None else requested.rate_hz
        return bool(requested_hz and granted.rate_hz) and not is_same_rate(
            requested_hz or 0.0, granted.rate_hz
        )

    def _error(self, code: str, remedy: str) -> CaptureError:
        wanted, requested, granted = self._wanted, self._requested, self._granted
        parts = []
        if wanted.size_wh_px is not None or wanted.rate_hz is not None:
            parts.append(f"the settings request {wanted}")
        if requested is not None:
            parts.append(f"{requested} was requested")
        if granted.size_wh_px != (0, 0):
            parts.append(f"{granted} was granted")
        width, height = self._size_wh_px
        if self._measured_hz is not None:
            parts.append(f"images arrive as {width}x{height} at {self._measured_hz:.1f} Hz")
        elif self._size_wh_px != granted.size_wh_px:
            parts.append(f"images arrive as {width}x{height}")
        context: dict[str, object] = {
            "camera": self._name,
            "requested": None if requested is None else str(requested),
            "granted": str(granted),
            "measured_hz": self._measured_hz,
        }
        return CaptureError(
            code, f"{self._name} sends other images than requested: {', '.join(parts)}", remedy, context
        )
