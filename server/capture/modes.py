"""Selection of a camera's format, size and rate from its offered modes."""

from collections.abc import Sequence
from dataclasses import dataclass

from server.live import CameraMode

# Rate for the tracker: a higher rate costs time for little gain; at a lower rate markers move far per image.
WANTED_RATE_HZ = 30.0
MIN_RATE_HZ = 25.0
MAX_SIZE_WH_PX = (1920, 1080)
# Lossless, so at equal size and rate better than MJPG, which has block artefacts at marker edges.
UNCOMPRESSED = ("YUYV", "UYVY", "NV12", "NV21", "YU12", "YV12", "BGR3", "RGB3", "GREY")
JPEG_FORMATS = ("MJPG", "JPEG")
# Uncompressed ones are converted to BGR by OpenCV's V4L2 backend, JPEGs decoded from their packets.
DECODED = (*UNCOMPRESSED, *JPEG_FORMATS)
# 29.97 and 30, 59.94 and 60 are the same rate.
SAME_RATE_RATIO = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class WantedMode:
    """Camera mode of the settings.

    Attributes:
        size_wh_px: width and height; None for the default choice.
        rate_hz: images per second; None for the default choice.
    """

    size_wh_px: tuple[int, int] | None = None
    rate_hz: float | None = None

    def __str__(self) -> str:
        """Return a text such as "1920x1080 at 30 Hz"; empty if nothing is given."""
        size = "" if self.size_wh_px is None else f"{self.size_wh_px[0]}x{self.size_wh_px[1]}"
        rate = "" if self.rate_hz is None else f"{self.rate_hz:.4g} Hz"
        return " at ".join(part for part in (size, rate) if part)


def choose_mode(
    offered: Sequence[CameraMode], wanted: WantedMode, *, calibrated_size_wh_px: tuple[int, int] | None = None
) -> CameraMode | None:
    """Return the mode to request; None where the camera offers none that can be decoded.

    The wanted mode is taken where offered, else the nearest one. By default: the calibration's size, else the
    largest one up to full HD with at least 25 images per second.

    Args:
        offered: modes of the camera.
        wanted: mode of the settings.
        calibrated_size_wh_px: size of the calibration in use; None without one.
    """
    usable = [mode for mode in offered if mode.fourcc in DECODED]
    if not usable:
        return None
    size_wh_px = wanted.size_wh_px or _size_offered(usable, calibrated_size_wh_px)
    if size_wh_px is None:
        size_wh_px = _best_size(usable, wanted.rate_hz)
    nearest = min((mode.size_wh_px for mode in usable), key=lambda size: _difference(size, size_wh_px))
    of_size = [mode for mode in usable if mode.size_wh_px == nearest]
    return min(
        of_size, key=lambda mode: (_rate_rank(mode.rate_hz, wanted.rate_hz), DECODED.index(mode.fourcc))
    )


def is_same_rate(rate_hz: float, other_hz: float) -> bool:
    """Return whether two rates are equal up to rounding."""
    return abs(rate_hz - other_hz) <= SAME_RATE_RATIO * max(rate_hz, other_hz)


def _size_offered(usable: Sequence[CameraMode], size: tuple[int, int] | None) -> tuple[int, int] | None:
    return size if any(mode.size_wh_px == size for mode in usable) else None


def _best_size(usable: Sequence[CameraMode], rate_hz: float | None) -> tuple[int, int]:
    """Return the largest size up to full HD that is fast enough; else the largest of the fastest."""
    max_width, max_height = MAX_SIZE_WH_PX
    small = [
        mode for mode in usable if mode.size_wh_px[0] <= max_width and mode.size_wh_px[1] <= max_height
    ] or usable
    min_rate_hz = MIN_RATE_HZ if rate_hz is None else rate_hz * (1.0 - SAME_RATE_RATIO)
    fast = [mode for mode in small if mode.rate_hz >= min_rate_hz]
    if not fast:
        max_rate_hz = max(mode.rate_hz for mode in small)
        fast = [mode for mode in small if mode.rate_hz == max_rate_hz]
    return max((mode.size_wh_px for mode in fast), key=lambda size: size[0] * size[1])


def _difference(size: tuple[int, int], wanted: tuple[int, int]) -> tuple[int, int]:
    """Return the distance of a size from the wanted one; of two equal ones the smaller comes first."""
    return (abs(size[0] - wanted[0]) + abs(size[1] - wanted[1]), size[0] * size[1])


def _rate_rank(rate_hz: float, wanted_hz: float | None) -> tuple[int, float]:
    """Rank: the wanted rate, else the nearest; by default 30 Hz, then higher, then lower ones."""
    if is_same_rate(rate_hz, wanted_hz or WANTED_RATE_HZ):
        return (0, 0.0)
    if wanted_hz is not None:
        return (1, abs(rate_hz - wanted_hz))
    return (1, rate_hz) if rate_hz > WANTED_RATE_HZ else (2, -rate_hz)
