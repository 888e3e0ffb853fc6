"""A pedicle measured from one click: the isthmus found in 3-D, its walls placed below a voxel."""

from tracker.plan.pedicle.measure import measure_pedicle
from tracker.plan.pedicle.record import (
    SIDES,
    PedicleMeasure,
    PedicleSpread,
    Side,
    axis_from_angles,
    checked_side,
    sagittal_deg_of,
    transverse_deg_of,
)

__all__ = [
    "SIDES",
    "PedicleMeasure",
    "PedicleSpread",
    "Side",
    "axis_from_angles",
    "checked_side",
    "measure_pedicle",
    "sagittal_deg_of",
    "transverse_deg_of",
]
