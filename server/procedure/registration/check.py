"""The check on anatomy: the tip on a landmark that was not used for the registration verifies it."""

from dataclasses import dataclass

from server.config import RegistrationConfig
from server.live import LiveHub
from server.procedure.collecting_step import CollectingStep
from server.procedure.registration.capture_settings import capture_settings
from server.procedure.registration.context import RegistrationContext, RegistrationContextFinder
from server.procedure.registration.landmark_capture import CaptureStatus, LandmarkCapture
from server.procedure.registration.repository import RegistrationRepository, StoredRegistration
from server.procedure.registration_record import CheckRecord, check_name
from server.procedure.state import Procedure, StepName
from server.store import CaseStore, Document, DocumentKind, OutOfDateError
from tracker.errors import RegistrationError
from tracker.plan import Landmark
from tracker.registration.capture import CapturedLandmark
from tracker.registration.check import LandmarkCheck, check_landmark


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckStatus:
    """Progress of a check.

    Attributes:
        vertebra: the checked vertebra.
        tool: tool whose tip is on the landmark.
        capture: capture of the tip on the landmark.
        max_mm: maximum distance between the tip and the planned landmark.
        max_spread_mm: maximum standard deviation of the tip during the capture.
        outcome: the record to store; None until the tip is captured.
    """

    vertebra: str
    tool: str
    capture: CaptureStatus
    max_mm: float
    max_spread_mm: float
    outcome: CheckRecord | None


class CheckSession:
    """Check of one registration on one landmark. Thread-safe."""

    def __init__(
        self,
        hub: LiveHub,
        *,
        context: RegistrationContext,
        landmark: str,
        stored: StoredRegistration,
        gate: RegistrationConfig,
        run: str,
    ) -> None:
        self.context = context
        self.stored = stored
        self._landmark = context.landmark(landmark)
        self._gate = gate
        self._run = run
        self._capture = LandmarkCapture(
            hub,
            landmark=landmark,
            tool=context.tool,
            reference=stored.record.reference,
            gate=capture_settings(gate),
        )

    @property
    def status(self) -> CheckStatus:
        """Progress of the check."""
        capture = self._capture.status
        return CheckStatus(
            vertebra=self.context.vertebra.name,
            tool=self.context.tool,
            capture=capture,
            max_mm=self._gate.max_check_mm,
            max_spread_mm=self._gate.max_capture_sd_mm,
            outcome=None if capture.touched is None else self._outcome(capture, capture.touched),
        )

    def stop(self) -> None:
        """Stop the capture."""
        self._capture.stop()

    def _outcome(self, capture: CaptureStatus, touched: CapturedLandmark) -> CheckRecord:
        result = self._measure(touched)
        return CheckRecord(
            vertebra=self.context.vertebra.name,
            landmark=capture.landmark,
            tool=self.context.tool,
            distance_mm=result.distance_mm,
            max_mm=result.max_mm,
            passed=result.passed,
            run=self._run,
            from_s=capture.from_s or 0.0,
            off_lps_mm=result.off_mm.tolist(),
            sd_mm=result.sd_mm,
            images=touched.images,
        )

    def _measure(self, touched: CapturedLandmark) -> LandmarkCheck:
        return check_landmark(
            self.stored.record.registration,
            self._landmark.name,
            self._landmark.point_lps_mm,
            touched.tip_in_anchor_mm,
            used_mm=used_mm(self.stored),
            tip_covariance_mm2=touched.covariance_mm2,
            max_mm=self._gate.max_check_mm,
        )


class CheckStep(CollectingStep[CheckSession]):
    """Checks registrations on anatomy; one check at a time. Thread-safe.

    Args:
        hub: the live images.
        store: where checks are stored.
        contexts: finds the context of a registration.
        repository: where registrations are stored.
        procedure: state of the procedure.
        gate: acceptance limits.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        store: CaseStore,
        contexts: RegistrationContextFinder,
        repository: RegistrationRepository,
        procedure: Procedure,
        gate: RegistrationConfig,
    ) -> None:
        super().__init__("check is", remedy="Start a check on a landmark.")
        self._hub = hub
        self._store = store
        self._contexts = contexts
        self._repository = repository
        self._procedure = procedure
        self._gate = gate

    def begin(self, landmark: str, *, tool: str) -> CheckSession:
        """Start to capture the tip on this landmark of the active vertebra.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or the code of a missing earlier step.
            PlanError: LANDMARK_UNKNOWN.
            InvalidInput: TOOL_UNKNOWN.
            RegistrationError: LANDMARK_WAS_USED.
        """
        context = self._contexts.find(vertebra=None, tool=tool, step=StepName.CHECK)
        stored = self._repository.current(context.vertebra.name)
        _reject_used(stored, context.landmark(landmark))
        return self._start(
            lambda: CheckSession(
                self._hub,
                context=context,
                landmark=landmark,
                stored=stored,
                gate=self._gate,
                run=self._procedure.run,
            )
        )

    def conclude(self, *, made_by: str) -> Document:
        """Store the check, passed or failed, and end the session.

        Raises:
            SetupOrderError: NO_CASE_OPEN, COLLECTION_MISSING.
            OutOfDateError: REGISTRATION_CHANGED, the checked registration is no longer the newest.
            RegistrationError: CHECK_NOT_CAPTURED, or why the capture was rejected.
        """
        session = self.collection
        status = session.status
        if status.outcome is None:
            problem = status.capture.problem
            if problem is not None:
                raise RegistrationError(problem.code, problem.message, problem.remedy, problem.context)
            raise _not_captured(status.capture)
        document = self._repository.current(status.vertebra).document
        if document.id != session.stored.document.id:
            raise OutOfDateError(
                "REGISTRATION_CHANGED",
                f"{session.stored.document.title} was checked, but the newest version is {document.version}",
                "Check the newest registration.",
                {
                    "checked_version": session.stored.document.version,
                    "version": document.version,
                    "title": session.stored.document.title_text,
                },
            )
        record = self._store.put(
            document.case_id,
            DocumentKind.CHECK,
            check_name(status.vertebra),
            status.outcome.model_dump(mode="json"),
            made_by=made_by,
            depends_on=[document.id],
        )
        self.end()
        return record


def _not_captured(capture: CaptureStatus) -> RegistrationError:
    at_rate, how_long = "", ""
    if capture.rate_hz is not None and capture.left_s is not None:
        at_rate = f" at {capture.rate_hz:.1f} images/s"
        how_long = f" for another {capture.left_s:.1f} s,"
    return RegistrationError(
        "CHECK_NOT_CAPTURED",
        f"the tip was seen in {capture.images} images{at_rate}, needed {capture.wanted}",
        f"Hold the tip still on the landmark{how_long} until it is captured.",
        {
            "images": capture.images,
            "needed": capture.wanted,
            "rate_hz": capture.rate_hz,
            "left_s": capture.left_s,
            "at_rate": at_rate,
            "left_hint": how_long,
        },
    )


def used_mm(stored: StoredRegistration) -> dict[str, list[float]]:
    """Return the landmarks (LPS mm, by name) that were used for a registration."""
    points = stored.record.made_from.get("points")
    return {
        str(one["landmark"]): [float(mm) for mm in one["point_lps_mm"]]
        for one in (points if isinstance(points, list) else [])
        if isinstance(one, dict) and one.get("used") is True
    }


def _reject_used(stored: StoredRegistration, landmark: Landmark) -> None:
    """Reject a landmark that was used, before its capture: tested as if the tip were exactly on it."""
    registration = stored.record.registration
    check_landmark(
        registration,
        landmark.name,
        landmark.point_lps_mm,
        registration.anchor_from_vertebra.move_points(landmark.point_lps_mm),
        used_mm=used_mm(stored),
    )
