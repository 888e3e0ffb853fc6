"""The limits of the config as the tracker's rooms take them."""

from server.config import RegistrationConfig
from tracker.pose.image_rate import GapLimit
from tracker.registration.capture import CaptureSettings

# How much longer than needed is waited for a tip at rest.
PATIENCE = 5.0
# The lowest image rate at which a capture is worth a hand's patience: 12 images take 8 s.
MIN_RATE_HZ = 1.5


def capture_settings(gate: RegistrationConfig) -> CaptureSettings:
    """When the tip counts as held still on a landmark."""
    return CaptureSettings(
        min_images=gate.capture_images,
        min_s=gate.capture_s,
        max_s=max(PATIENCE * gate.capture_s, gate.capture_images / MIN_RATE_HZ),
        gap=GapLimit(max_s=gate.max_capture_gap_s),
        max_sd_mm=gate.max_capture_sd_mm,
    )
