"""The image rate of a capture: how it is worded in a refusal, and what makes it higher."""

from collections.abc import Sequence
from dataclasses import dataclass

from tracker.pose.image_rate import image_period_s

# Below this rate a refusal says how the camera, or the machine, becomes faster.
SLOW_HZ = 15.0
# The camera gave so many times the images that were tracked: the machine is slow, not the camera.
BUSY_RATIO = 1.5


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureRate:
    """How often images came during a capture.

    Attributes:
        period_s: median time between two images that were tracked.
        camera_hz: images/s that the camera gave, tracked or not; None if unknown.
    """

    period_s: float
    camera_hz: float | None

    @classmethod
    def of(cls, times_s: Sequence[float], image_numbers: Sequence[int | None]) -> "CaptureRate | None":
        """The rate of these images; None before the second one.

        `image_numbers`: as the camera counts its images; None where that is unknown.
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
        """Images/s that were tracked."""
        return 1.0 / self.period_s

    @property
    def machine_is_slow(self) -> bool:
        """Whether the camera gave far more images than were tracked."""
        return self.camera_hz is not None and self.camera_hz > BUSY_RATIO * self.tracked_hz

    @property
    def text(self) -> str:
        """The rate for a sentence, such as `5.0 images/s`."""
        given = f" (the camera gives {self.camera_hz:.1f})" if self.machine_is_slow else ""
        return f"{self.tracked_hz:.1f} images/s{given}"

    @property
    def remedy(self) -> str:
        """How the images come faster, as a sentence with a space before it; empty where they are fast."""
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
