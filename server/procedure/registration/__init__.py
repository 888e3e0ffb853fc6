"""The steps in the theatre that find the plan's vertebra on the patient, and check that it was found."""

from server.procedure.registration.check import CheckSession, CheckStatus, CheckStep
from server.procedure.registration.ground import Ground, GroundFinder
from server.procedure.registration.nudging import NudgesStatus, NudgeStep
from server.procedure.registration.points import PointsStep, TargetError, target_errors, touched_points
from server.procedure.registration.repository import RegistrationRepository, ShelvedRegistration
from server.procedure.registration.session import PointsSession, PointsStatus, residuals_mm
from server.procedure.registration.steps import RegistrationSteps
from server.procedure.registration.sweep import SweepStep
from server.procedure.registration.touching import TouchState, TouchStatus

__all__ = [
    "CheckSession",
    "CheckStatus",
    "CheckStep",
    "Ground",
    "GroundFinder",
    "NudgeStep",
    "NudgesStatus",
    "PointsSession",
    "PointsStatus",
    "PointsStep",
    "RegistrationRepository",
    "RegistrationSteps",
    "ShelvedRegistration",
    "SweepStep",
    "TargetError",
    "TouchState",
    "TouchStatus",
    "residuals_mm",
    "target_errors",
    "touched_points",
]
