"""Screw planning: selection from the catalogue, clearance, bone density and navigation tolerance."""

from tracker.plan.screw.catalogue import USUAL_CATALOGUE, ScrewCatalogue
from tracker.plan.screw.channel import channel_from_measure, channel_from_points
from tracker.plan.screw.clearance import Clearance, GertzbeinRobbins, clearance_of, grade_of_breach
from tracker.plan.screw.clearance_along import ClearanceAlong, clearance_along
from tracker.plan.screw.density import BoneAlong, bone_along
from tracker.plan.screw.proposal import ScrewPlan, plan_screw, propose_screw
from tracker.plan.screw.tolerance import Tolerance, tolerance_of

__all__ = [
    "USUAL_CATALOGUE",
    "BoneAlong",
    "Clearance",
    "ClearanceAlong",
    "GertzbeinRobbins",
    "ScrewCatalogue",
    "ScrewPlan",
    "Tolerance",
    "bone_along",
    "channel_from_measure",
    "channel_from_points",
    "clearance_along",
    "clearance_of",
    "grade_of_breach",
    "plan_screw",
    "propose_screw",
    "tolerance_of",
]
