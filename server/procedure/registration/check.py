"""The check on anatomy: the tip on a landmark that was not used decides whether anybody may navigate."""

from dataclasses import dataclass

from server.config import RegistrationConfig
from server.live import LiveHub
from server.procedure.held import Held
from server.procedure.registered import KeptCheck, check_name
from server.procedure.registration.gates import capture_settings
from server.procedure.registration.ground import Ground, GroundFinder
from server.procedure.registration.repository import RegistrationRepository, ShelvedRegistration
from server.procedure.registration.touching import Touch, TouchStatus
from server.procedure.state import Procedure, StepName
from server.store import CaseStore, Document, DocumentKind, OutOfDateError
from tracker.errors import RegistrationError
from tracker.plan import Landmark
from tracker.registration.capture import CapturedLandmark
from tracker.registration.check import LandmarkCheck, check_landmark


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckStatus:
    """How far a check has come.

    Attributes:
        vertebra: that is checked.
        tool: that touches.
        capture: of the tip on the landmark.
        max_mm: how far the tip may be from where the plan has the landmark.
        max_spread_mm: standard deviation that the tip may have while it is held there.
        outcome: what the case would keep; None until the tip was captured.
    """

    vertebra: str
    tool: str
    capture: TouchStatus
    max_mm: float
    max_spread_mm: float
    outcome: KeptCheck | None


class CheckSession:
    """One landmark touched to check one registration; may be asked from any thread."""

    def __init__(
        self,
        hub: LiveHub,
        *,
        ground: Ground,
        landmark: str,
        shelved: ShelvedRegistration,
        gate: RegistrationConfig,
        run: str,
    ) -> None:
        self.ground = ground
        self.shelved = shelved
        self._landmark = ground.landmark(landmark)
        self._gate = gate
        self._run = run
        self._touch = Touch(
            hub,
            landmark=landmark,
            tool=ground.tool,
            reference=shelved.kept.reference,
            gate=capture_settings(gate),
        )

    @property
    def status(self) -> CheckStatus:
        """How far it has come."""
        capture = self._touch.status
        return CheckStatus(
            vertebra=self.ground.vertebra.name,
            tool=self.ground.tool,
            capture=capture,
            max_mm=self._gate.max_check_mm,
            max_spread_mm=self._gate.max_capture_sd_mm,
            outcome=None if capture.touched is None else self._outcome(capture, capture.touched),
        )

    def stop(self) -> None:
        """Look no more."""
        self._touch.stop()

    def _outcome(self, capture: TouchStatus, touched: CapturedLandmark) -> KeptCheck:
        held = self._held_against(touched)
        return KeptCheck(
            vertebra=self.ground.vertebra.name,
            landmark=capture.landmark,
            tool=self.ground.tool,
            distance_mm=held.distance_mm,
            max_mm=held.max_mm,
            passed=held.passed,
            run=self._run,
            from_s=capture.from_s or 0.0,
            off_lps_mm=held.off_mm.tolist(),
            sd_mm=held.sd_mm,
            images=touched.images,
        )

    def _held_against(self, touched: CapturedLandmark) -> LandmarkCheck:
        return check_landmark(
            self.shelved.kept.registration,
            self._landmark.name,
            self._landmark.point_lps_mm,
            touched.tip_in_anchor_mm,
            used_mm=used_mm(self.shelved),
            tip_covariance_mm2=touched.covariance_mm2,
            max_mm=self._gate.max_check_mm,
        )


class CheckStep:
    """Checks registrations on anatomy; one check at a time. Safe to use from any thread.

    Args:
        hub: the live images.
        store: where checks are kept.
        grounds: what a registration is made on.
        shelf: where registrations are kept.
        procedure: what may follow what.
        gate: what a check must reach.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        store: CaseStore,
        grounds: GroundFinder,
        repository: RegistrationRepository,
        procedure: Procedure,
        gate: RegistrationConfig,
    ) -> None:
        self._hub = hub
        self._store = store
        self._grounds = grounds
        self._repository = repository
        self._procedure = procedure
        self._gate = gate
        self._held: Held[CheckSession] = Held(
            "check is", remedy="Begin the check, and say on which landmark."
        )

    def begin(self, landmark: str, *, tool: str) -> CheckSession:
        """Look for the tip at rest on this landmark of the vertebra that is to be drilled.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or what it waits for.
            PlanError: LANDMARK_UNKNOWN.
            InvalidInput: TOOL_UNKNOWN.
            RegistrationError: LANDMARK_WAS_USED.
        """
        ground = self._grounds.find(vertebra=None, tool=tool, step=StepName.CHECK)
        shelved = self._repository.current(ground.vertebra.name)
        _reject_used(shelved, ground.landmark(landmark))
        return self._held.begin(
            lambda: CheckSession(
                self._hub,
                ground=ground,
                landmark=landmark,
                shelved=shelved,
                gate=self._gate,
                run=self._procedure.run,
            )
        )

    @property
    def session(self) -> CheckSession:
        """The check that runs.

        Raises:
            SetupOrderError: COLLECTION_MISSING.
        """
        return self._held.get()

    @property
    def running(self) -> bool:
        """Whether a check was begun."""
        return self._held.is_there

    def end(self) -> None:
        """Look no more."""
        self._held.end()

    def conclude(self, *, made_by: str) -> Document:
        """Keep the check, passed or failed; the session ends.

        Raises:
            SetupOrderError: NO_CASE_OPEN, COLLECTION_MISSING.
            OutOfDateError: REGISTRATION_CHANGED, it is not the registration any more that was checked.
            RegistrationError: CHECK_NOT_CAPTURED, or why its capture was refused.
        """
        session = self.session
        status = session.status
        if status.outcome is None:
            problem = status.capture.problem
            if problem is not None:
                raise RegistrationError(problem.code, problem.message, problem.remedy, problem.context)
            raise _not_captured(status.capture)
        document = self._repository.current(status.vertebra).document
        if document.id != session.shelved.document.id:
            raise OutOfDateError(
                "REGISTRATION_CHANGED",
                f"{session.shelved.document.title} was checked, and now there is version {document.version}",
                "Check the registration that holds now.",
                {"checked_version": session.shelved.document.version, "version": document.version},
            )
        kept = self._store.put(
            document.case_id,
            DocumentKind.CHECK,
            check_name(status.vertebra),
            status.outcome.model_dump(mode="json"),
            made_by=made_by,
            stands_on=[document.id],
        )
        self.end()
        return kept


def _not_captured(capture: TouchStatus) -> RegistrationError:
    at_rate, how_long = "", ""
    if capture.rate_hz is not None and capture.left_s is not None:
        at_rate = f" at {capture.rate_hz:.1f} images/s"
        how_long = f" for another {capture.left_s:.1f} s,"
    return RegistrationError(
        "CHECK_NOT_CAPTURED",
        f"the tip was seen in {capture.images} images{at_rate}, needed {capture.wanted}",
        f"Hold the tip still on the landmark{how_long} until it is taken.",
        {"images": capture.images, "needed": capture.wanted, "rate_hz": capture.rate_hz},
    )


def used_mm(shelved: ShelvedRegistration) -> dict[str, list[float]]:
    """The landmarks on the CT that a registration was fitted to, by name."""
    points = shelved.kept.made_from.get("points")
    return {
        str(one["landmark"]): [float(mm) for mm in one["point_lps_mm"]]
        for one in (points if isinstance(points, list) else [])
        if isinstance(one, dict) and one.get("used") is True
    }


def _reject_used(shelved: ShelvedRegistration, landmark: Landmark) -> None:
    """Before the tip is held on it: as if it were found exactly where it belongs."""
    registration = shelved.kept.registration
    check_landmark(
        registration,
        landmark.name,
        landmark.point_lps_mm,
        registration.anchor_from_vertebra.move_points(landmark.point_lps_mm),
        used_mm=used_mm(shelved),
    )
