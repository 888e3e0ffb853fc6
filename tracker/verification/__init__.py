"""End-to-end verification: registration and navigation in simulated theatres with known ground truth."""

from tracker.verification.figures import Figures, VariantFigures, drill_figures, name_of
from tracker.verification.rows import ImageRow, RegistrationMethod, RegistrationRow, TheatreRows, Variant
from tracker.verification.settings import VerificationSettings
from tracker.verification.theatre import theatre_seeds, verify_theatre

__all__ = [
    "Figures",
    "ImageRow",
    "RegistrationMethod",
    "RegistrationRow",
    "TheatreRows",
    "Variant",
    "VariantFigures",
    "VerificationSettings",
    "drill_figures",
    "name_of",
    "theatre_seeds",
    "verify_theatre",
]
