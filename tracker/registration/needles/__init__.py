"""The paper's registration: three needles in the bone, seen in the calibrated camera's image."""

from tracker.registration.needles.detection import DetectedNeedle, detect_needles, expected_width_px
from tracker.registration.needles.fit import NeedleFit, NeedleResidual, register_needles
from tracker.registration.needles.limits import NeedleLimits
from tracker.registration.needles.observability import PoseObservability
from tracker.registration.needles.observation import NeedleObservation, needle_from_clicks
from tracker.registration.needles.overlay import (
    OverlayResidual,
    SliceOverlay,
    first_overlay,
    image_from_slice,
    needles_from_overlay,
    overlay_lines_px,
    overlay_of_pose,
    overlay_residuals,
    pose_of_overlay,
)
from tracker.registration.needles.planned import PlannedNeedle, planned_at_landmarks, planned_on_lines
from tracker.registration.needles.proposal import NeedleProposal, propose_needles, refine_marked
from tracker.registration.needles.view_prior import (
    PatientEnd,
    RulerMeasurement,
    TouchedPoint,
    ViewPrior,
    view_prior_from_ruler,
)

__all__ = [
    "DetectedNeedle",
    "NeedleFit",
    "NeedleLimits",
    "NeedleObservation",
    "NeedleProposal",
    "NeedleResidual",
    "OverlayResidual",
    "PatientEnd",
    "PlannedNeedle",
    "PoseObservability",
    "RulerMeasurement",
    "SliceOverlay",
    "TouchedPoint",
    "ViewPrior",
    "detect_needles",
    "expected_width_px",
    "first_overlay",
    "image_from_slice",
    "needle_from_clicks",
    "needles_from_overlay",
    "overlay_lines_px",
    "overlay_of_pose",
    "overlay_residuals",
    "planned_at_landmarks",
    "planned_on_lines",
    "pose_of_overlay",
    "propose_needles",
    "refine_marked",
    "register_needles",
    "view_prior_from_ruler",
]
