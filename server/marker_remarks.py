"""Warnings about markers that are usable but nearly symmetric."""

from collections.abc import Iterable

import structlog

from tracker.marker import MarkerModel

log = structlog.get_logger(__name__)

# Correlation of a marker with its own rotation or mirror image; designed markers reach about 0.8.
MAX_SELF_CORRELATION = 0.9
DESIGNED = "print a marker made with 'coaxial marker design'"


def warn_of_ambiguous_markers(models: Iterable[MarkerModel]) -> None:
    """Log a warning for markers that resemble their own rotation or mirror image."""
    for model in models:
        turned, mirrored = model.own_correlation
        if turned > MAX_SELF_CORRELATION:
            how, where = (
                "after rotation",
                "if it is small or blurred, its pose may be rotated by a quarter or half turn",
            )
            remedy = f"Check it with 'coaxial marker check', or {DESIGNED}."
            log.warning(_like(model, how, turned, where), code="MARKER_NEARLY_SYMMETRIC", remedy=remedy)
        if mirrored > MAX_SELF_CORRELATION:
            how, where = "mirrored", "a mirrored video or a reflection in steel may be detected as the marker"
            remedy = f"Do not mirror the video, or {DESIGNED}."
            log.warning(_like(model, how, mirrored, where), code="MARKER_NEARLY_MIRRORED", remedy=remedy)


def _like(model: MarkerModel, how: str, correlation: float, where: str) -> str:
    return (
        f"marker '{model.name}' looks similar {how} (correlation {correlation:.2f}, "
        f"recommended below {MAX_SELF_CORRELATION:g}): {where}"
    )
