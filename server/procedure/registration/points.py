"""Point registration step: paired points from the tool tip on landmarks of the plan."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from server.config import RegistrationConfig
from server.live import LiveHub
from server.point_limits import point_gate, point_settings
from server.procedure.collecting_step import CollectingStep
from server.procedure.registration.capture_settings import capture_settings
from server.procedure.registration.context import RegistrationContext, RegistrationContextFinder
from server.procedure.registration.points_session import PointsSession, PointsStatus, residuals_mm
from server.procedure.registration.repository import RegistrationRepository
from server.procedure.registration_record import ExpectedCovariance, RegistrationEvidence, Value
from server.store import Document
from tracker.errors import RegistrationError
from tracker.geometry import inverse_covariance
from tracker.plan.document import plain
from tracker.registration.needles import TouchedPoint
from tracker.registration.points import PointRegistration

# Fiducial localisation error of a landmark on CT and bone together, per axis.
LANDMARK_SD_MM = 0.7
# Numbers of additional landmarks that a person can still touch.
MORE_LANDMARKS = (2, 4, 8)
# From the entry point to the end of a channel.
ALONG = (0.0, 0.25, 0.5, 0.75, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetError:
    """Target registration error (TRE) at one point of a channel.

    Attributes:
        side: side of the patient.
        depth_mm: distance from the entry point along the channel; 0 is the entry point.
        expected_mm: 3-D RMS by Fitzpatrick's formula, from the residuals only.
        stated_mm: 3-D RMS as displayed and compared with the limit; larger for few points, and includes the
            depth error of the tip and a gross error of a landmark that the others do not exclude.
    """

    side: str
    depth_mm: float
    expected_mm: float
    stated_mm: float


class PointsStep(CollectingStep[PointsSession]):
    """Registers by points; one session at a time. Thread-safe.

    Args:
        hub: the live images.
        contexts: finds the context of the registration.
        repository: where it is stored.
        gate: acceptance limits.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        contexts: RegistrationContextFinder,
        repository: RegistrationRepository,
        gate: RegistrationConfig,
    ) -> None:
        super().__init__(
            "registration by landmarks is",
            remedy="Start a registration by landmarks with a tool.",
        )
        self._hub = hub
        self._contexts = contexts
        self._repository = repository
        self.gate = gate
        self._captures = capture_settings(gate)
        self._settings = point_settings(gate)

    def begin(self, *, tool: str, vertebra: str | None = None) -> PointsSession:
        """Start to capture a vertebra's landmarks with this tool; a previous session is discarded.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or the code of a missing earlier step.
            PlanError: VERTEBRA_UNKNOWN.
            InvalidInput: TOOL_UNKNOWN.
            RegistrationError: LANDMARKS_TOO_FEW.
        """
        context = self._contexts.find(vertebra=vertebra, tool=tool)
        there, needed = len(context.vertebra.landmarks), self.gate.min_points
        if there < needed:
            raise RegistrationError(
                "LANDMARKS_TOO_FEW",
                f"the plan has {there} landmarks on {context.vertebra.name}, the minimum is {needed}",
                "Mark more landmarks on the CT in the plan, including one for the check.",
                {"landmarks": there, "needed": needed, "vertebra": context.vertebra.name},
            )
        return self._start(lambda: PointsSession(self._hub, context, self._captures, self._settings))

    def failures(self, status: PointsStatus) -> tuple[RegistrationError, ...]:
        """Return the errors that prevent the registration; empty if it is accepted."""
        if len(status.used) < self.gate.min_points:
            return (
                RegistrationError(
                    "POINTS_TOO_FEW",
                    f"{len(status.used)} landmarks are captured and used, minimum {self.gate.min_points}",
                    "Capture another landmark, or include one that was excluded.",
                    {"points": len(status.used), "needed": self.gate.min_points},
                ),
            )
        if status.fit is None:
            problem = status.problem
            if problem is None:
                raise RuntimeError("there is neither a fit nor a problem")
            return (RegistrationError(problem.code, problem.message, problem.remedy, problem.context),)
        return status.fit.failures(point_gate(self.gate), list(status.context.entries_mm))

    def conclude(self, *, made_by: str) -> Document:
        """Store the registration in the open case if it is accepted, and end the session.

        Raises:
            SetupOrderError: NO_CASE_OPEN, COLLECTION_MISSING, or the code of a missing earlier step.
            OutOfDateError: REGISTRATION_CONTEXT_CHANGED.
            RegistrationError: The points are insufficient, or a limit is exceeded.
        """
        session = self.collection
        self._contexts.reject_changed(session.context)
        status = session.status
        failures = self.failures(status)
        if failures or status.fit is None:
            raise failures[0]
        document = self._repository.put(
            session.context,
            status.fit.registration(session.context.anchored_to),
            RegistrationEvidence(
                numbers=self.numbers(status, status.fit),
                made_from=made_from(status),
                from_s=status.from_s,
                with_more_landmarks=with_more_landmarks(status.fit),
            ),
            made_by=made_by,
        )
        self.end()
        return document

    def numbers(self, status: PointsStatus, fit: PointRegistration) -> dict[str, Value]:
        """Return the results and their limits, by name."""
        entries = [error for error in target_errors(status.context, fit) if error.depth_mm == 0.0]
        return {
            "points": int(fit.used.sum()),
            "fre_rms_mm": fit.fre_rms_mm,
            "max_fre_mm": self.gate.max_fre_mm,
            "leave_one_out_mm": max(fit.leave_one_out_mm.values(), default=None),
            "max_left_out_mm": self.gate.max_left_out_mm,
            "tre_at_entry_mm": max((error.stated_mm for error in entries), default=None),
            "max_tre_mm": self.gate.max_tre_mm,
        }


def touched_points(step: PointsStep) -> tuple[TouchedPoint, ...]:
    """Return the captured points in the camera frame, which constrain the depth of needles.

    Raises:
        SetupOrderError: COLLECTION_MISSING.
        RegistrationError: TOUCHED_BESIDE_REFERENCE, the points are not in the camera's frame.
    """
    status = step.collection.status
    if status.context.reference:
        raise RegistrationError(
            "TOUCHED_BESIDE_REFERENCE",
            f"the landmarks were captured relative to the marker '{status.context.reference}', not to the "
            "camera",
            "Register by these points only, or by the needles only.",
            {"reference": status.context.reference},
        )
    return tuple(
        TouchedPoint(
            name=one.name,
            point_lps_mm=one.point_lps_mm,
            point_in_camera_mm=one.touched.tip_in_anchor_mm,
            covariance_mm2=one.touched.covariance_mm2 + LANDMARK_SD_MM**2 * np.eye(3),
        )
        for one in status.used
        if one.touched is not None
    )


def target_errors(context: RegistrationContext, fit: PointRegistration) -> tuple[TargetError, ...]:
    """Return the TRE along every channel of the vertebra."""
    found = []
    for planned in context.vertebra.channels:
        entry, target = planned.channel.entry_in_vertebra_mm, planned.channel.target_in_vertebra_mm
        length_mm = float(np.linalg.norm(target - entry))
        for share in ALONG:
            point = entry + share * (target - entry)
            found.append(
                TargetError(
                    side=str(planned.side),
                    depth_mm=share * length_mm,
                    expected_mm=fit.tre_expected_mm(point),
                    stated_mm=fit.tre_stated_mm(point),
                )
            )
    return tuple(found)


def with_more_landmarks(fit: PointRegistration) -> list[ExpectedCovariance]:
    """Return the covariances of the registration that are expected with more landmarks."""
    count = int(fit.used.sum())
    return [
        ExpectedCovariance(
            landmarks=count + more,
            covariance=inverse_covariance(fit.fixed_from_moving, fit.covariance_with_more(more)).tolist(),
        )
        for more in MORE_LANDMARKS
    ]


def made_from(status: PointsStatus) -> dict[str, object]:
    """Return the points and their results for the document."""
    off = residuals_mm(status)
    fit = status.fit
    points: list[Mapping[str, object]] = [
        {
            "landmark": one.name,
            "point_lps_mm": one.point_lps_mm.tolist(),
            "tip_in_anchor_mm": one.touched.tip_in_anchor_mm.tolist(),
            "tip_covariance_mm2": one.touched.covariance_mm2.tolist(),
            "spread_mm": one.touched.spread_mm.tolist(),
            "images": one.touched.images,
            "used": one.used,
            "residual_mm": off.get(one.name),
        }
        for one in status.landmarks
        if one.touched is not None
    ]
    return {
        "tool": status.context.tool,
        "points": points,
        "targets": []
        if fit is None
        else [
            {
                "side": error.side,
                "depth_mm": error.depth_mm,
                "expected_mm": error.expected_mm,
                "stated_mm": error.stated_mm,
            }
            for error in target_errors(status.context, fit)
        ],
        "remarks": [] if fit is None else [plain(remark) for remark in fit.remarks],
    }
