"""Whether a camera gives what it was asked for: size, format and rate, as granted and as they really come."""

from collections import deque

from server.capture.modes import WantedMode, is_same_rate
from server.errors import CaptureError
from server.live import CameraMode

# The rate is measured over this time, again and again, and not before the camera has settled.
SETTLE_S = 2.0
MEASURED_OVER_S = 4.0
# Of the rate; a rate that differs is told until it is nearer than the second one.
RATE_TOLERANCE_RATIO = 0.15
CLEARS_AT_RATIO = 0.10

CHOOSE = "Choose a mode that coaxial cameras lists, with camera.width, camera.height and camera.rate_hz."
FASTER = (
    "Give it more light or a fixed, shorter exposure (automatic exposure slows a camera down in the dark), a "
    "USB port of its own, or ask for smaller images with camera.width and camera.height."
)


class ModeCheck:
    """Compares asked, granted and measured. Without a clock: the times are those of the images.

    Args:
        name: of the camera.
        wanted: by the settings.
        asked: of what is offered, what the camera was asked for; None where it is not known what is offered.
        granted: by the driver.
    """

    def __init__(
        self, name: str, *, wanted: WantedMode, asked: CameraMode | None, granted: CameraMode
    ) -> None:
        self._name = name
        self._wanted = wanted
        self._asked = asked
        self._granted = granted
        self._size_wh_px = granted.size_wh_px
        self._began_s: float | None = None
        self._times: deque[float] = deque()
        self._measured_hz: float | None = None
        self._is_off_rate = False
        self._problem = self._judged()

    @property
    def granted(self) -> CameraMode:
        """What the driver granted."""
        return self._granted

    @property
    def problem(self) -> CaptureError | None:
        """What differs, with all numbers; None where nothing does."""
        return self._problem

    def take(self, size_wh_px: tuple[int, int], at_s: float) -> None:
        """One more image, of this size and captured at this time."""
        if self._began_s is None:
            self._began_s = at_s
        if size_wh_px != self._size_wh_px:
            self._size_wh_px = size_wh_px
            self._problem = self._judged()
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
        # The sentence that stands is not told anew for every tenth of a hertz.
        told_hz = self._measured_hz
        if was_off and self._is_off_rate and told_hz and abs(rate_hz - told_hz) <= limit * told_hz:
            return
        self._measured_hz = rate_hz
        self._problem = self._judged()

    def _expected_hz(self) -> float:
        """What the settings or the choice ask for, not what was granted: a granted 5 Hz is told, too."""
        asked_hz = 0.0 if self._asked is None else self._asked.rate_hz
        return self._wanted.rate_hz or asked_hz or self._granted.rate_hz

    def _judged(self) -> CaptureError | None:
        if self._is_other_than_wanted():
            return self._error("CAMERA_MODE_NOT_OFFERED", CHOOSE)
        if self._is_other_than_granted():
            return self._error("CAMERA_MODE_NOT_GRANTED", CHOOSE)
        return self._error("CAMERA_RATE_DIFFERS", FASTER) if self._is_off_rate else None

    def _is_other_than_wanted(self) -> bool:
        """Whether the settings ask for what the camera does not offer."""
        asked, wanted = self._asked, self._wanted
        if asked is None:
            return False
        is_other_size = wanted.size_wh_px is not None and wanted.size_wh_px != asked.size_wh_px
        is_other_rate = (
            wanted.rate_hz is not None
            and asked.rate_hz > 0.0
            and not is_same_rate(wanted.rate_hz, asked.rate_hz)
        )
        return is_other_size or is_other_rate

    def _is_other_than_granted(self) -> bool:
        """Whether the driver granted something else than it was asked for, or gives another size."""
        granted, wanted, asked = self._granted, self._wanted, self._asked
        size_wh_px = wanted.size_wh_px if asked is None else asked.size_wh_px
        sizes = {self._size_wh_px} | ({granted.size_wh_px} if granted.size_wh_px != (0, 0) else set())
        if size_wh_px is not None and sizes != {size_wh_px}:
            return True
        if asked is not None and granted.fourcc and granted.fourcc != asked.fourcc:
            return True
        asked_hz = wanted.rate_hz if asked is None else asked.rate_hz
        return bool(asked_hz and granted.rate_hz) and not is_same_rate(asked_hz or 0.0, granted.rate_hz)

    def _error(self, code: str, remedy: str) -> CaptureError:
        wanted, asked, granted = self._wanted, self._asked, self._granted
        told = []
        if wanted.size_wh_px is not None or wanted.rate_hz is not None:
            told.append(f"the settings ask for {_wanted_text(wanted)}")
        if asked is not None:
            told.append(f"{asked} was asked of the camera")
        if granted.size_wh_px != (0, 0):
            told.append(f"{granted} was granted")
        width, height = self._size_wh_px
        if self._measured_hz is not None:
            told.append(f"images come as {width}x{height} at {self._measured_hz:.1f} Hz")
        elif self._size_wh_px != granted.size_wh_px:
            told.append(f"images come as {width}x{height}")
        context: dict[str, object] = {
            "camera": self._name,
            "asked": None if asked is None else str(asked),
            "granted": str(granted),
            "measured_hz": self._measured_hz,
        }
        return CaptureError(
            code, f"{self._name} gives other images than asked: {', '.join(told)}", remedy, context
        )


def _wanted_text(wanted: WantedMode) -> str:
    size = "" if wanted.size_wh_px is None else f"{wanted.size_wh_px[0]}x{wanted.size_wh_px[1]}"
    rate = "" if wanted.rate_hz is None else f"{wanted.rate_hz:.4g} Hz"
    return " at ".join(part for part in (size, rate) if part)
