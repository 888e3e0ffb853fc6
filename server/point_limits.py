"""Limits of a registration by landmarks, from the configuration; the same for server and command line."""

from server.config import RegistrationConfig
from tracker.registration.points import PointGate, PointSettings


def point_settings(limits: RegistrationConfig) -> PointSettings:
    """Return the settings of the fit."""
    return PointSettings(max_left_out_mm=limits.max_left_out_mm)


def point_gate(limits: RegistrationConfig) -> PointGate:
    """Return the limits that the fit must meet before its use."""
    return PointGate(max_fre_mm=limits.max_fre_mm, max_tre_mm=limits.max_tre_mm)
