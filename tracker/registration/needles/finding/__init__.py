"""Needles found in the image by software: thin straight bars of one width, with a head."""

from tracker.registration.needles.finding.find import FoundNeedle, WidthRange, expected_width_px, find_needles

__all__ = ["FoundNeedle", "WidthRange", "expected_width_px", "find_needles"]
