"""The limits of the config as the tracker's rooms take them."""

from server.config import RegistrationConfig
from tracker.registration.capture import CaptureSettings

# How much longer than needed is waited for a tip at rest.
PATIENCE = 5.0


def capture_settings(gate: RegistrationConfig) -> CaptureSettings:
    """When the tip counts as held still on a landmark."""
    return CaptureSettings(
        least_images=gate.capture_images,
        least_s=gate.capture_s,
        most_s=PATIENCE * gate.capture_s,
        most_gap_s=gate.most_capture_gap_s,
        most_sd_mm=gate.most_capture_sd_mm,
    )
