"""The surgical plan: the drill channel and the bone around it."""

from tracker.plan.channel import Channel
from tracker.plan.document import (
    PedicleRecord,
    PlanDocument,
    PlannedChannel,
    VertebraPlan,
    corrected_measure,
    plan_from_mapping,
    plan_to_mapping,
)
from tracker.plan.landmark import Landmark
from tracker.plan.pedicle import PedicleMeasure, PedicleSpread, measure_pedicle
from tracker.plan.reference_slice import (
    ReferenceSlice,
    SliceLine,
    draw_reference,
    propose_middle,
    propose_slice,
)
from tracker.plan.screw import (
    ScrewCatalogue,
    ScrewPlan,
    channel_from_measure,
    channel_from_points,
    plan_screw,
    propose_screw,
)
from tracker.plan.surface import Surface
from tracker.plan.volume import Volume

__all__ = [
    "Channel",
    "Landmark",
    "PedicleMeasure",
    "PedicleRecord",
    "PedicleSpread",
    "PlanDocument",
    "PlannedChannel",
    "ReferenceSlice",
    "ScrewCatalogue",
    "ScrewPlan",
    "SliceLine",
    "Surface",
    "VertebraPlan",
    "Volume",
    "channel_from_measure",
    "channel_from_points",
    "corrected_measure",
    "draw_reference",
    "measure_pedicle",
    "plan_from_mapping",
    "plan_screw",
    "plan_to_mapping",
    "propose_middle",
    "propose_screw",
    "propose_slice",
]
