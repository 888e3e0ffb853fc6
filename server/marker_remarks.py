"""Rejection of markers that are their own mirror image, and warnings about nearly symmetric ones."""

from collections.abc import Sequence

import structlog

from tracker.marker import MarkerModel, reject_mirror_symmetric

log = structlog.get_logger(__name__)

# Correlation of a marker with its own rotation or mirror image; designed markers reach about 0.8.
MAX_SELF_CORRELATION = 0.9
DESIGNED = "print a marker made with 'coaxial marker design'"


def reject_ambiguous_markers(models: Sequence[MarkerModel]) -> None:
    """Reject markers that equal their mirror image; warn of those that resemble it or their own rotation.

    Raises:
        InvalidInput: MARKER_MIRROR_SYMMETRIC.
    """
    reject_mirror_symmetric(models)
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
