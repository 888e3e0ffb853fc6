"""The paper's registration: three needles in the bone, seen in the calibrated camera's image."""

from tracker.registration.needles.finding import FoundNeedle, expected_width_px, find_needles
from tracker.registration.needles.fit import NeedleFit, NeedleResidual, register_needles
from tracker.registration.needles.limits import NeedleLimits
from tracker.registration.needles.overlay import (
    OverlayResidual,
    SliceOverlay,
    first_overlay,
    image_from_slice,
    needles_under,
    overlay_lines_px,
    overlay_of_pose,
    overlay_residuals,
    pose_of_overlay,
)
from tracker.registration.needles.places import NeedlePlace, places_at_landmarks, places_on_lines
from tracker.registration.needles.proposal import NeedleProposal, propose_needles, refine_marked
from tracker.registration.needles.seen import NeedleSeen, clicked_needle
from tracker.registration.needles.sureness import Sureness
from tracker.registration.needles.view import MeasuredView, Standing, TouchedPoint, View, view_from_ruler

__all__ = [
    "FoundNeedle",
    "MeasuredView",
    "NeedleFit",
    "NeedleLimits",
    "NeedlePlace",
    "NeedleProposal",
    "NeedleResidual",
    "NeedleSeen",
    "OverlayResidual",
    "SliceOverlay",
    "Standing",
    "Sureness",
    "TouchedPoint",
    "View",
    "clicked_needle",
    "expected_width_px",
    "find_needles",
    "first_overlay",
    "image_from_slice",
    "needles_under",
    "overlay_lines_px",
    "overlay_of_pose",
    "overlay_residuals",
    "places_at_landmarks",
    "places_on_lines",
    "pose_of_overlay",
    "propose_needles",
    "refine_marked",
    "register_needles",
    "view_from_ruler",
]
