"""The session of a point registration: captured landmarks and their current fit."""

import threading
from collections.abc import Mapping
from dataclasses import dataclass

from server.live import LiveHub, Problem
from server.procedure.registration.context import RegistrationContext
from server.procedure.registration.landmark_capture import CaptureState, CaptureStatus, LandmarkCapture
from tracker.errors import RegistrationError
from tracker.geometry import Array
from tracker.registration.capture import CapturedLandmark, CaptureSettings
from tracker.registration.points import PointRegistration, PointSettings, register_points
from tracker.registration.tip import pairs_of_touches


@dataclass(frozen=True, slots=True, kw_only=True)
class LandmarkMeasurement:
    """A landmark of the plan with its captured point.

    Attributes:
        name: name of the landmark.
        point_lps_mm: (3,) position on the CT.
        touched: captured tip position; None if it was not captured.
        used: whether it is used in the fit.
    """

    name: str
    point_lps_mm: Array
    touched: CapturedLandmark | None
    used: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class PointsStatus:
    """Progress of a point registration.

    Attributes:
        context: context of the registration.
        landmarks: in the order of the plan.
        capture: the active or last capture; None before the first.
        fit: fit of the used points.
        problem: why there is no fit yet.
        from_s: time of the first captured point, on the image clock; None before it.
    """

    context: RegistrationContext
    landmarks: tuple[LandmarkMeasurement, ...]
    capture: CaptureStatus | None
    fit: PointRegistration | None
    problem: Problem | None
    from_s: float | None

    @property
    def used(self) -> tuple[LandmarkMeasurement, ...]:
        """The captured landmarks that are used in the fit."""
        return tuple(one for one in self.landmarks if one.touched is not None and one.used)


class PointsSession:
    """Captured points of one registration, until it is stored or discarded. Thread-safe."""

    def __init__(
        self, hub: LiveHub, context: RegistrationContext, gate: CaptureSettings, settings: PointSettings
    ) -> None:
        self.context = context
        self._settings = settings
        self._hub = hub
        self._gate = gate
        self._lock = threading.Lock()
        self._last_fit: tuple[
            tuple[LandmarkMeasurement, ...] | None, PointRegistration | None, Problem | None
        ] = (None, None, None)
        self._touched: dict[str, CapturedLandmark] = {}
        self._from_s: dict[str, float] = {}
        self._left_out: set[str] = set()
        self._capture: LandmarkCapture | None = None

    def capture(self, landmark: str) -> None:
        """Start to capture this landmark; its previous point stays until the capture is complete.

        Raises:
            PlanError: LANDMARK_UNKNOWN.
        """
        self.context.landmark(landmark)
        with self._lock:
            self._take_over()
            if self._capture is not None:
                self._capture.stop()
            self._capture = LandmarkCapture(
                self._hub,
                landmark=landmark,
                tool=self.context.tool,
                reference=self.context.reference,
                gate=self._gate,
            )

    def use(self, landmark: str, *, used: bool) -> None:
        """Include a landmark in the fit, or exclude it.

        Raises:
            PlanError: LANDMARK_UNKNOWN.
            RegistrationError: LANDMARK_NOT_TOUCHED.
        """
        self.context.landmark(landmark)
        with self._lock:
            self._take_over()
            self._reject_untouched(landmark)
            (self._left_out.discard if used else self._left_out.add)(landmark)

    def forget(self, landmark: str) -> None:
        """Discard the point of a landmark.

        Raises:
            PlanError: LANDMARK_UNKNOWN.
            RegistrationError: LANDMARK_NOT_TOUCHED.
        """
        self.context.landmark(landmark)
        with self._lock:
            self._take_over()
            self._reject_untouched(landmark)
            del self._touched[landmark]
            self._from_s.pop(landmark, None)
            self._left_out.discard(landmark)
            if self._capture is not None and self._capture.landmark == landmark:
                self._capture.stop()
                self._capture = None

    @property
    def status(self) -> PointsStatus:
        """Progress of the session."""
        with self._lock:
            capture = self._take_over()
            touched, left_out = dict(self._touched), set(self._left_out)
            from_s = min(self._from_s.values(), default=None)
        landmarks = tuple(
            LandmarkMeasurement(
                name=one.name,
                point_lps_mm=one.point_lps_mm,
                touched=touched.get(one.name),
                used=one.name not in left_out,
            )
            for one in self.context.vertebra.landmarks
        )
        fit, problem = self._fitted(landmarks)
        return PointsStatus(
            context=self.context,
            landmarks=landmarks,
            capture=capture,
            fit=fit,
            problem=problem,
            from_s=from_s,
        )

    def stop(self) -> None:
        """Stop the active capture."""
        with self._lock:
            if self._capture is not None:
                self._capture.stop()

    def _fitted(
        self, landmarks: tuple[LandmarkMeasurement, ...]
    ) -> tuple[PointRegistration | None, Problem | None]:
        """Return the fit of these landmarks or why there is none; computed when one or its use changed."""
        before, fit, problem = self._last_fit
        # Identity, because a new capture of a landmark is a new object.
        if before is not None and all(
            one.touched is other.touched and one.used == other.used
            for one, other in zip(landmarks, before, strict=True)
        ):
            return fit, problem
        fit, problem = None, None
        try:
            fit = fit_of(landmarks, self.context.tool, self._settings)
        except RegistrationError as error:
            problem = Problem.from_error(error)
        # One assignment: requests poll from several threads.
        self._last_fit = landmarks, fit, problem
        return fit, problem

    def _take_over(self) -> CaptureStatus | None:
        """Store the point of a completed capture, stop a capture that has ended, and return its status.

        It is read once: a capture that completes between two reads would be reported without its point.
        """
        if self._capture is None:
            return None
        status = self._capture.status
        if status.state is not CaptureState.LOOKING:
            self._capture.stop()
        if status.touched is not None and self._touched.get(status.landmark) is not status.touched:
            self._touched[status.landmark] = status.touched
            if status.from_s is not None:
                self._from_s[status.landmark] = status.from_s
        return status

    def _reject_untouched(self, landmark: str) -> None:
        if landmark not in self._touched:
            raise RegistrationError(
                "LANDMARK_NOT_TOUCHED",
                f"the landmark '{landmark}' has not been captured",
                "Capture it first.",
                {"landmark": landmark},
            )


def fit_of(
    landmarks: tuple[LandmarkMeasurement, ...], tool: str, settings: PointSettings
) -> PointRegistration:
    """Fit the used points. Excluded points are not fitted, but have residuals.

    Raises:
        RegistrationError: as `register_points`.
    """
    pairs = [(one, one.touched) for one in landmarks if one.touched is not None]
    return register_points(
        pairs_of_touches(
            [one.point_lps_mm for one, _ in pairs],
            [touched for _, touched in pairs],
            labels=[one.name for one, _ in pairs],
            tool=tool,
        ),
        excluded=[index for index, (one, _) in enumerate(pairs) if not one.used],
        settings=settings,
    )


def residuals_mm(status: PointsStatus) -> Mapping[str, float]:
    """Return the residual of each captured landmark, by name."""
    if status.fit is None:
        return {}
    return dict(zip(status.fit.pairs.labels, status.fit.distances_mm.tolist(), strict=True))
