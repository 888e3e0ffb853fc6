"""What is said of a marker that may be used, and had better not be."""

from collections.abc import Iterable

import structlog

from tracker.marker import MarkerModel

log = structlog.get_logger(__name__)

# Two markers that are this much alike are nearly refused; of a designed one it is 0.8.
MAX_LIKE_ITSELF = 0.9
DESIGNED = "print one that 'coaxial marker design' proposes"


def warn_of_markers(models: Iterable[MarkerModel]) -> None:
    """Say in the log which of these markers could be taken for itself, turned or mirrored."""
    for model in models:
        turned, mirrored = model.own_correlation
        if turned > MAX_LIKE_ITSELF:
            how, where = "when it is turned", "where it is small or blurred, its pose may be told turned"
            remedy = f"Measure it with 'coaxial marker check', or {DESIGNED}."
            log.warning(_like(model, how, turned, where), code="MARKER_NEARLY_SYMMETRIC", remedy=remedy)
        if mirrored > MAX_LIKE_ITSELF:
            how, where = "in a mirror", "in a mirrored picture, or on shining steel, that is taken for it"
            remedy = f"Do not mirror the camera's picture, or {DESIGNED}."
            log.warning(_like(model, how, mirrored, where), code="MARKER_NEARLY_MIRRORED", remedy=remedy)


def _like(model: MarkerModel, how: str, correlation: float, where: str) -> str:
    return (
        f"marker '{model.name}' looks much the same {how} (correlation {correlation:.2f}, "
        f"better under {MAX_LIKE_ITSELF:g}): {where}"
    )
