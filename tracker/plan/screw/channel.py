"""Channel from a measured pedicle, or from two manual points."""

import numpy as np
import numpy.typing as npt

from tracker.plan.channel import Channel
from tracker.plan.pedicle import PedicleMeasure

FRONT_MARGIN_MM = 5.0


def channel_from_measure(
    name: str, measure: PedicleMeasure, *, front_margin_mm: float = FRONT_MARGIN_MM
) -> Channel:
    """Return the cylinder along the pedicle's axis with its minimum width as diameter (paper, 2.1).

    It ends `front_margin_mm` before the front wall of the body.

    Raises:
        PlanError: CHANNEL_INVALID, nothing is left of the length.
    """
    return Channel(
        name=name,
        entry_in_vertebra_mm=measure.entry_lps_mm,
        target_in_vertebra_mm=measure.front_lps_mm - front_margin_mm * measure.axis_lps,
        radius_mm=0.5 * min(measure.width_mm, measure.height_mm),
    )


def channel_from_points(
    name: str, *, entry_lps_mm: npt.ArrayLike, target_lps_mm: npt.ArrayLike, diameter_mm: float
) -> Channel:
    """Return the cylinder between two manual points.

    Raises:
        PlanError: CHANNEL_INVALID.
    """
    return Channel(
        name=name,
        entry_in_vertebra_mm=np.asarray(entry_lps_mm, dtype=np.float64),
        target_in_vertebra_mm=np.asarray(target_lps_mm, dtype=np.float64),
        radius_mm=0.5 * diameter_mm,
    )
