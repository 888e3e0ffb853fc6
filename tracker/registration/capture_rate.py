"""Image rate of a capture, its text in error messages, and how to raise it."""

from collections.abc import Sequence
from dataclasses import dataclass

from tracker.pose.image_rate import image_period_s

# Below this rate an error message includes a remedy for the slow camera or machine.
SLOW_HZ = 15.0
# Above this ratio of camera rate to tracked rate, the machine is slow and not the camera.
BUSY_RATIO = 1.5


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureRate:
    """Image rate during a capture.

    Attributes:
        period_s: median time between two tracked images.
        camera_hz: images/s of the camera, tracked or not; None if unknown.
    """

    period_s: float
    camera_hz: float | None

    @classmethod
    def of(cls, times_s: Sequence[float], image_numbers: Sequence[int | None]) -> "CaptureRate | None":
        """Return the rate of these images; None before the second one.

        `image_numbers`: as counted by the camera; None if unknown.
        """
        period_s = image_period_s(times_s)
        if period_s is None:
            return None
        first, last, lasted_s = image_numbers[0], image_numbers[-1], times_s[-1] - times_s[0]
        if first is None or last is None or lasted_s <= 0.0:
            return cls(period_s=period_s, camera_hz=None)
        return cls(period_s=period_s, camera_hz=(last - first) / lasted_s)

    @property
    def tracked_hz(self) -> float:
        """Return the rate of tracked images [images/s]."""
        return 1.0 / self.period_s

    @property
    def machine_is_slow(self) -> bool:
        """Return whether the camera delivers far more images than are tracked."""
        return self.camera_hz is not None and self.camera_hz > BUSY_RATIO * self.tracked_hz

    @property
    def text(self) -> str:
        """Return the rate as text, such as `5.0 images/s`."""
        given = f" (the camera gives {self.camera_hz:.1f})" if self.machine_is_slow else ""
        return f"{self.tracked_hz:.1f} images/s{given}"

    @property
    def remedy(self) -> str:
        """Return a remedy for a low rate, as a sentence with a leading space; empty at a high rate."""
        if self.tracked_hz >= SLOW_HZ:
            return ""
        if self.machine_is_slow:
            return (
                " The machine skips images: end other programs, or ask the camera for smaller images "
                "(camera.width, camera.height)."
            )
        return (
            " The camera is slow: give it more light, or ask it for smaller images or more of them "
            "(camera.width, camera.height, camera.rate_hz)."
        )
