"""The whole way from registration to navigation in theatres whose truth is known, and none of it used."""

from tracker.verification.rows import ImageRow, RegistrationRow, TheatreRows, Variant, Way
from tracker.verification.settings import VerificationSettings
from tracker.verification.theatre import verify_theatre

__all__ = [
    "ImageRow",
    "RegistrationRow",
    "TheatreRows",
    "Variant",
    "VerificationSettings",
    "Way",
    "verify_theatre",
]
