"""The whole way from registration to navigation in theatres whose truth is known, and none of it used."""

from tracker.verification.figures import Figures, VariantFigures, figures_of, name_of
from tracker.verification.rows import ImageRow, RegistrationRow, TheatreRows, Variant, Way
from tracker.verification.settings import VerificationSettings
from tracker.verification.theatre import theatre_seeds, verify_theatre

__all__ = [
    "Figures",
    "ImageRow",
    "RegistrationRow",
    "TheatreRows",
    "Variant",
    "VariantFigures",
    "VerificationSettings",
    "Way",
    "figures_of",
    "name_of",
    "theatre_seeds",
    "verify_theatre",
]
