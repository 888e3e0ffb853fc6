"""Landmarks that are being touched for one registration: points so far, and what they give."""

import threading
from collections.abc import Mapping
from dataclasses import dataclass

from server.live import LiveHub, Problem
from server.procedure.registration.ground import Ground
from server.procedure.registration.touching import Touch, TouchState, TouchStatus
from tracker.errors import RegistrationError
from tracker.geometry import Array
from tracker.registration.capture import CapturedLandmark, CaptureSettings
from tracker.registration.points import PointRegistration, register_points
from tracker.registration.tip import pairs_of_touches


@dataclass(frozen=True, slots=True, kw_only=True)
class TouchedLandmark:
    """A landmark of the plan, and the tip on it.

    Attributes:
        name: of the landmark.
        point_lps_mm: (3,) on the CT.
        touched: the tip on it; None while it was not touched.
        used: whether it has a say in the fit.
    """

    name: str
    point_lps_mm: Array
    touched: CapturedLandmark | None
    used: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class PointsStatus:
    """How far registration by points has come.

    Attributes:
        ground: what it stands on.
        landmarks: in the plan's order.
        capture: the one that runs, or was last refused or taken; None before the first.
        fit: of the points that are used.
        trouble: why they give no fit yet.
        from_s: when the first of the points was touched, by the clock of the images; None before.
    """

    ground: Ground
    landmarks: tuple[TouchedLandmark, ...]
    capture: TouchStatus | None
    fit: PointRegistration | None
    problem: Problem | None
    from_s: float | None

    @property
    def used(self) -> tuple[TouchedLandmark, ...]:
        """The landmarks that have a say."""
        return tuple(one for one in self.landmarks if one.touched is not None and one.used)


class PointsSession:
    """Holds what was touched until it is concluded or thrown away; may be asked from any thread."""

    def __init__(self, hub: LiveHub, ground: Ground, gate: CaptureSettings) -> None:
        self.ground = ground
        self._hub = hub
        self._gate = gate
        self._lock = threading.Lock()
        self._touched: dict[str, CapturedLandmark] = {}
        self._from_s: dict[str, float] = {}
        self._left_out: set[str] = set()
        self._touch: Touch | None = None

    def capture(self, landmark: str) -> None:
        """Look for the tip at rest on this landmark; a point that was there stays until another is taken.

        Raises:
            PlanError: LANDMARK_UNKNOWN.
        """
        self.ground.landmark(landmark)
        with self._lock:
            self._take_over()
            if self._touch is not None:
                self._touch.stop()
            self._touch = Touch(
                self._hub,
                landmark=landmark,
                tool=self.ground.tool,
                reference=self.ground.reference,
                gate=self._gate,
            )

    def use(self, landmark: str, *, used: bool) -> None:
        """Let a landmark have a say in the fit, or not.

        Raises:
            PlanError: LANDMARK_UNKNOWN.
            RegistrationError: LANDMARK_NOT_TOUCHED.
        """
        self.ground.landmark(landmark)
        with self._lock:
            self._take_over()
            self._reject_untouched(landmark)
            (self._left_out.discard if used else self._left_out.add)(landmark)

    def forget(self, landmark: str) -> None:
        """Throw the point of a landmark away.

        Raises:
            PlanError: LANDMARK_UNKNOWN.
            RegistrationError: LANDMARK_NOT_TOUCHED.
        """
        self.ground.landmark(landmark)
        with self._lock:
            self._take_over()
            self._reject_untouched(landmark)
            del self._touched[landmark]
            self._from_s.pop(landmark, None)
            self._left_out.discard(landmark)
            if self._touch is not None and self._touch.landmark == landmark:
                self._touch.stop()
                self._touch = None

    @property
    def status(self) -> PointsStatus:
        """How far it has come."""
        with self._lock:
            self._take_over()
            touched, left_out = dict(self._touched), set(self._left_out)
            capture = None if self._touch is None else self._touch.status
            from_s = min(self._from_s.values(), default=None)
        landmarks = tuple(
            TouchedLandmark(
                name=one.name,
                point_lps_mm=one.point_lps_mm,
                touched=touched.get(one.name),
                used=one.name not in left_out,
            )
            for one in self.ground.vertebra.landmarks
        )
        fit, problem = None, None
        try:
            fit = fit_of(landmarks, self.ground.tool)
        except RegistrationError as error:
            problem = Problem.from_error(error)
        return PointsStatus(
            ground=self.ground,
            landmarks=landmarks,
            capture=capture,
            fit=fit,
            problem=problem,
            from_s=from_s,
        )

    def stop(self) -> None:
        """Look no more."""
        with self._lock:
            if self._touch is not None:
                self._touch.stop()

    def _take_over(self) -> None:
        """Keep what the capture has taken; a capture that is over looks no more."""
        if self._touch is None:
            return
        status = self._touch.status
        if status.state is not TouchState.LOOKING:
            self._touch.stop()
        if status.touched is not None and self._touched.get(status.landmark) is not status.touched:
            self._touched[status.landmark] = status.touched
            if status.from_s is not None:
                self._from_s[status.landmark] = status.from_s

    def _reject_untouched(self, landmark: str) -> None:
        if landmark not in self._touched:
            raise RegistrationError(
                "LANDMARK_NOT_TOUCHED",
                f"the landmark '{landmark}' has not been touched",
                "Capture it first.",
                {"landmark": landmark},
            )


def fit_of(landmarks: tuple[TouchedLandmark, ...], tool: str) -> PointRegistration:
    """The fit of those that are used, touched by this tool; those that are not have residuals all the same.

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
    )


def residuals_mm(status: PointsStatus) -> Mapping[str, float]:
    """By landmark that was touched: how far the tip on it comes to lie from it."""
    if status.fit is None:
        return {}
    return dict(zip(status.fit.pairs.labels, status.fit.distances_mm.tolist(), strict=True))
