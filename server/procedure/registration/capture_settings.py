"""Settings of a landmark capture, from the configuration."""

from server.config import RegistrationConfig
from tracker.pose.image_rate import GapLimit
from tracker.registration.capture import CaptureSettings

# Timeout of a capture, as a multiple of the minimum duration.
TIMEOUT_RATIO = 5.0
# The lowest supported image rate: 12 images then take 8 s, about as long as a hand can rest.
MIN_RATE_HZ = 1.5


def capture_settings(gate: RegistrationConfig) -> CaptureSettings:
    """Return the criteria for a tip at rest on a landmark."""
    return CaptureSettings(
        min_images=gate.capture_images,
        min_s=gate.capture_s,
        max_s=max(TIMEOUT_RATIO * gate.capture_s, gate.capture_images / MIN_RATE_HZ),
        gap=GapLimit(max_s=gate.max_capture_gap_s),
        max_sd_mm=gate.max_capture_sd_mm,
    )
