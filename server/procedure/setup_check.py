"""Check whether the planned screw can be navigated with the registration, and measures that would help.

The check is computed when plan, registration, tool or surface changes. Navigation uses the same check
(`tracker.navigation.check_setup`) to distinguish an insufficient set-up from an uncertain image. Without a
registration the check assumes the planned landmarks, localised to `LANDMARK_SD_MM`, and an exact tool.
"""

import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
import structlog

from server.procedure.drill_reference import PlannedPedicle, planned_pedicle
from server.procedure.plan import active_channel_document
from server.procedure.registration.points import LANDMARK_SD_MM, MORE_LANDMARKS
from server.procedure.registration_record import (
    RegistrationRecord,
    with_tip_in_common,
)
from server.procedure.state import SetupDefaults
from server.procedure.surface import MAIN_SURFACE
from server.procedure.tool import tool_from_document
from server.store import CaseStore, Document, DocumentKind
from tracker.errors import NavigationError
from tracker.geometry import Anchor, Array, Rigid, Vertebra
from tracker.navigation import RegistrationCheck, check_registration, check_setup
from tracker.navigation.uncertainty import PedicleTolerance, UncertainPose
from tracker.plan import ScrewPlan, plan_from_mapping
from tracker.plan.document.changes import vertebra_named
from tracker.plan.pedicle import Side
from tracker.plan.screw import ScrewCatalogue, tolerance_of
from tracker.pose import ToolModel
from tracker.registration import Method, Registration
from tracker.registration.points import expected_covariance

# Fewer landmarks cannot exclude a gross error of one of them, whatever their noise.
MIN_EXPECTED_LANDMARKS = 4
# Minimum reduction of the error for which an exact tool is listed as a remedy.
MIN_TOOL_GAIN_MM = 0.05

log = structlog.get_logger(__name__)


class Basis(StrEnum):
    """Basis of a check."""

    REGISTRATION = (
        "registration"  # a valid registration, with the calibrated tool and the tracking at its captures
    )
    LANDMARKS = "landmarks"  # the planned landmarks, without a registration


class RemedyKind(StrEnum):
    """Measures that reduce the error or increase the tolerance."""

    MORE_LANDMARKS = "more_landmarks"  # of the same spread and precision, without a gross error
    EXACT_TOOL = "exact_tool"  # a tool whose tip and axis have no error
    THINNER_SCREW = "thinner_screw"  # a screw of the catalogue on the same axis
    SURFACE_SWEEP = "surface_sweep"  # its effect depends on where the bone can be swept


@dataclass(frozen=True, slots=True, kw_only=True)
class Remedy:
    """One remedy with its expected result.

    Attributes:
        kind: Kind of the remedy.
        check: Expected check with this remedy; None if it cannot be predicted.
        landmarks: Number of landmarks; None for other remedies.
        diameter_mm: Diameter of the screw; None for other remedies.
    """

    kind: RemedyKind
    check: RegistrationCheck | None
    landmarks: int | None = None
    diameter_mm: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SetupCheck:
    """The check of the active channel.

    Attributes:
        basis: Basis of the computation.
        method: Method of the registration; None without one.
        vertebra, side: Vertebra and side of the channel.
        diameter_mm: Diameter of the planned screw.
        tool: Tool with the smallest error; empty if no tool is included.
        check: Smallest possible error, and the tolerance of the screw.
        remedies: Empty if the error is within the tolerance.
    """

    basis: Basis
    method: Method | None
    vertebra: str
    side: Side
    diameter_mm: float
    tool: str
    check: RegistrationCheck
    remedies: tuple[Remedy, ...]


class SetupChecker:
    """Checks the active channel of the open case. Thread-safe.

    Args:
        store: Source of plan, registration, tools and surface.
        defaults: Provides the reference marker of the settings.
        tools: Tools of the settings by name; a tool of the case replaces one of the same name.
        catalogue: The available screws.
    """

    def __init__(
        self,
        *,
        store: CaseStore,
        defaults: SetupDefaults,
        tools: Mapping[str, ToolModel],
        catalogue: ScrewCatalogue,
    ) -> None:
        self._store = store
        self._defaults = defaults
        self._tools = tools
        self._catalogue = catalogue
        self._lock = threading.Lock()
        self._made: tuple[tuple[str, ...], SetupCheck | None] = ((), None)

    def check(self) -> SetupCheck | None:
        """Return the check; None without a planned screw, or with neither registration nor four landmarks.

        It is recomputed only if a document that it depends on has changed.
        """
        case = self._store.get_open_case()
        active = None if case is None else active_channel_document(self._store, case.id)
        if active is None:
            return None
        vertebra = str(active.content.get("vertebra"))
        registered = self._store.find_current(active.case_id, DocumentKind.REGISTRATION, vertebra)
        surface = self._store.find_current(active.case_id, DocumentKind.SURFACE, MAIN_SURFACE)
        tools = self._store.all_current(active.case_id, DocumentKind.TOOL)
        key = tuple("" if one is None else one.id for one in (active, registered, surface, *tools))
        with self._lock:
            if self._made[0] == key:
                return self._made[1]
        made = self._compute(active, registered, tools, has_surface=surface is not None)
        with self._lock:
            self._made = (key, made)
        return made

    def _compute(
        self,
        active: Document,
        registered: Document | None,
        tools: Sequence[Document],
        *,
        has_surface: bool,
    ) -> SetupCheck | None:
        try:
            planned = planned_pedicle(self._store, active)
            if registered is None:
                landmarks_mm = self._landmarks_mm(active, planned)
                return check_of_landmarks(planned, landmarks_mm, self._catalogue, has_surface=has_surface)
            record = self._defaults.registration_from(registered)
            record = with_tip_in_common(record, registered, tools)
            return check_of_registration(
                planned, record, self._known(tools), self._catalogue, has_surface=has_surface
            )
        except NavigationError as error:
            log.warning(error.message, code=error.code, remedy=error.remedy, document=active.title)
            return None

    def _known(self, documents: Sequence[Document]) -> dict[str, ToolModel]:
        """Return the tools of settings and case, without those that cannot be read."""
        known = dict(self._tools)
        for document in documents:
            try:
                tool = tool_from_document(document).model(document.name)
            except NavigationError as error:
                log.warning(error.message, code=error.code, remedy=error.remedy, document=document.title)
                continue
            if tool is not None:
                known[document.name] = tool
        return known

    def _landmarks_mm(self, active: Document, planned: PlannedPedicle) -> Array:
        """Return the landmarks (n, 3) of the vertebra, as planned."""
        plan = self._store.document(active.case_id, active.depends_on[0])
        vertebra = vertebra_named(plan_from_mapping(plan.content), planned.active.vertebra)
        return np.array([one.point_lps_mm for one in vertebra.landmarks]).reshape(-1, 3)


def check_of_registration(
    planned: PlannedPedicle,
    record: RegistrationRecord,
    tools: Mapping[str, ToolModel],
    catalogue: ScrewCatalogue,
    *,
    has_surface: bool,
) -> SetupCheck | None:
    """Return the check of a registration with the tool of the smallest error; None without a screw."""
    registration, channel, screw = record.registration, planned.active.channel, planned.screw
    if screw is None:
        return None

    def check(
        tolerance: PedicleTolerance, registration: Registration = registration
    ) -> tuple[str, RegistrationCheck]:
        if not tools:
            pose = UncertainPose(
                pose=registration.anchor_from_vertebra, covariance=registration.covariance
            ).inverse
            return "", check_registration(pose, channel, tolerance)
        checks = {name: check_setup(registration, tool, channel, tolerance) for name, tool in tools.items()}
        return min(checks.items(), key=lambda one: one[1].error_95_mm)

    tolerance = PedicleTolerance.of_tolerance(screw.tolerance)
    tool, now = check(tolerance)

    def remedies() -> Iterator[Remedy]:
        for one in record.with_more_landmarks:
            _, then = check(tolerance, replace(registration, covariance=np.array(one.covariance)))
            yield Remedy(kind=RemedyKind.MORE_LANDMARKS, check=then, landmarks=one.landmarks)
            if then.suffices:
                break
        if registration.method is Method.POINTS and has_surface:
            yield Remedy(kind=RemedyKind.SURFACE_SWEEP, check=None)
        if tool:
            exact = check_setup(*_with_exact_tool(registration, tools[tool]), channel, tolerance)
            if exact.error_95_mm <= now.error_95_mm - MIN_TOOL_GAIN_MM:
                yield Remedy(kind=RemedyKind.EXACT_TOOL, check=exact)
        yield from _thinner(planned, screw, catalogue, lambda thin: check(thin)[1])

    return SetupCheck(
        basis=Basis.REGISTRATION,
        method=record.method,
        vertebra=planned.active.vertebra,
        side=planned.active.side,
        diameter_mm=screw.diameter_mm,
        tool=tool,
        check=now,
        remedies=() if now.suffices else tuple(remedies()),
    )


def check_of_landmarks(
    planned: PlannedPedicle, landmarks_mm: Array, catalogue: ScrewCatalogue, *, has_surface: bool
) -> SetupCheck | None:
    """Return the expected check of landmarks (n, 3) as planned; None without a screw or four landmarks."""
    channel, screw = planned.active.channel, planned.screw
    if screw is None or len(landmarks_mm) < MIN_EXPECTED_LANDMARKS:
        return None

    def check(tolerance: PedicleTolerance, more: int = 0) -> RegistrationCheck:
        covariance = expected_covariance(landmarks_mm, LANDMARK_SD_MM, more=more)
        vertebra_from_anchor: UncertainPose[Vertebra, Anchor] = UncertainPose(
            pose=Rigid(rotation=np.eye(3), translation_mm=np.zeros(3)), covariance=covariance
        )
        return check_registration(vertebra_from_anchor, channel, tolerance)

    tolerance = PedicleTolerance.of_tolerance(screw.tolerance)
    now = check(tolerance)

    def remedies() -> Iterator[Remedy]:
        for more in MORE_LANDMARKS:
            then = check(tolerance, more)
            yield Remedy(kind=RemedyKind.MORE_LANDMARKS, check=then, landmarks=len(landmarks_mm) + more)
            if then.suffices:
                break
        if has_surface:
            yield Remedy(kind=RemedyKind.SURFACE_SWEEP, check=None)
        yield from _thinner(planned, screw, catalogue, check)

    return SetupCheck(
        basis=Basis.LANDMARKS,
        method=None,
        vertebra=planned.active.vertebra,
        side=planned.active.side,
        diameter_mm=screw.diameter_mm,
        tool="",
        check=now,
        remedies=() if now.suffices else tuple(remedies()),
    )


def _thinner(
    planned: PlannedPedicle,
    screw: ScrewPlan,
    catalogue: ScrewCatalogue,
    check: Callable[[PedicleTolerance], RegistrationCheck],
) -> Iterator[Remedy]:
    """Yield the thickest screw that suffices, otherwise the thinnest; none without a measured pedicle."""
    measure, found = planned.measure, None
    for diameter_mm in sorted(catalogue.diameters_mm, reverse=True):
        if measure is None or diameter_mm >= screw.diameter_mm:
            continue
        tolerance = tolerance_of(planned.active.channel, measure, diameter_mm=diameter_mm)
        then = check(PedicleTolerance.of_tolerance(tolerance))
        found = Remedy(kind=RemedyKind.THINNER_SCREW, check=then, diameter_mm=diameter_mm)
        if then.suffices:
            break
    if found is not None:
        yield found


def _with_exact_tool(registration: Registration, tool: ToolModel) -> tuple[Registration, ToolModel]:
    """Return both without the error of the tool calibration, also where it is part of the registration."""
    exact = replace(tool, tip_covariance_mm2=np.zeros((3, 3)), axis_sd_deg=0.0)
    if registration.tool != tool.name:
        return registration, exact
    return registration.without_tip_error(tool.tip_covariance_mm2), exact
