"""The paper's registration: three needles in the bone, seen in the calibrated camera's image."""

from tracker.registration.needles.fit import NeedleFit, NeedleResidual, register_needles
from tracker.registration.needles.limits import NeedleLimits
from tracker.registration.needles.places import NeedlePlace, places_at_landmarks, places_on_lines
from tracker.registration.needles.seen import NeedleSeen, clicked_needle
from tracker.registration.needles.sureness import Sureness
from tracker.registration.needles.view import MeasuredView, Standing, TouchedPoint, View, view_from_ruler

__all__ = [
    "MeasuredView",
    "NeedleFit",
    "NeedleLimits",
    "NeedlePlace",
    "NeedleResidual",
    "NeedleSeen",
    "Standing",
    "Sureness",
    "TouchedPoint",
    "View",
    "clicked_needle",
    "places_at_landmarks",
    "places_on_lines",
    "register_needles",
    "view_from_ruler",
]
