"""Pedicle measurement from one click: 3-D isthmus search and sub-voxel wall fit."""

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
