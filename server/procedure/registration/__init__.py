"""Registration of the planned vertebra to the patient, and the check of a registration."""

from server.procedure.registration.check import CheckSession, CheckStatus, CheckStep
from server.procedure.registration.context import RegistrationContext, RegistrationContextFinder
from server.procedure.registration.landmark_capture import CaptureState, CaptureStatus
from server.procedure.registration.nudges import NudgeStatus, NudgeStep
from server.procedure.registration.points import PointsStep, TargetError, target_errors, touched_points
from server.procedure.registration.points_session import PointsSession, PointsStatus, residuals_mm
from server.procedure.registration.repository import RegistrationRepository, StoredRegistration
from server.procedure.registration.steps import RegistrationSteps
from server.procedure.registration.sweep import SweepStep

__all__ = [
    "CaptureState",
    "CaptureStatus",
    "CheckSession",
    "CheckStatus",
    "CheckStep",
    "NudgeStatus",
    "NudgeStep",
    "PointsSession",
    "PointsStatus",
    "PointsStep",
    "RegistrationContext",
    "RegistrationContextFinder",
    "RegistrationRepository",
    "RegistrationSteps",
    "StoredRegistration",
    "SweepStep",
    "TargetError",
    "residuals_mm",
    "target_errors",
    "touched_points",
]
