"""Detection of needles in the image: thin straight bars of one width, with a head."""

from tracker.registration.needles.detection.detector import (
    DetectedNeedle,
    WidthRange,
    detect_needles,
    expected_width_px,
)

__all__ = ["DetectedNeedle", "WidthRange", "detect_needles", "expected_width_px"]
