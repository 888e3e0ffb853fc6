"""The order of the steps: derives the state of the procedure from the findings of its steps."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from server.errors import SetupOrderError
from server.procedure.confirmation import ConfirmationPrompt
from server.procedure.state.records import (
    VALID_STATES,
    Finding,
    MissingCosignature,
    StepName,
    StepState,
    StepStatus,
)
from server.texts import STEPS, Reason, Value, reason, reason_error

NONE_MISSING: Mapping[StepName, MissingCosignature] = {}
NO_CASE = Finding(state=StepState.MISSING, reason=reason("NO_CASE_OPEN"))


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcedureState:
    """All steps of the procedure.

    Attributes:
        case_id: the open case; empty if none is open.
        case_name: its display name; empty if none is open.
        steps: in the order of the procedure.
        check_required: whether a registration must be checked before navigation.
        confirmation: the confirmation that is needed before navigation resumes; None if none is needed.
    """

    case_id: str
    steps: tuple[StepStatus, ...]
    check_required: bool
    confirmation: ConfirmationPrompt | None = None
    case_name: str = ""

    def status(self, step: StepName) -> StepStatus:
        """Return the status of one step."""
        return next(one for one in self.steps if one.step is step)

    @property
    def next_step(self) -> StepName:
        """The first step that is not valid."""
        return next(
            (one.step for one in self.steps if one.finding.state not in VALID_STATES), StepName.NAVIGATE
        )

    @property
    def waits_for_check(self) -> bool:
        """Whether numbers are withheld until the registration is checked."""
        return not _is_satisfied(StepName.CHECK, self.status(StepName.CHECK).finding, self.check_required)

    @property
    def unsigned(self) -> StepName | None:
        """The first step with a missing co-signature, for which numbers are withheld."""
        return next((one.step for one in self.steps if one.missing_cosignature is not None), None)

    def require_earlier_steps(self, step: StepName) -> None:
        """Raise if a step that this one depends on is missing, failed, out of date, or not co-signed.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or as CAMERA_MISSING, TOOL_OUT_OF_DATE, CHECK_FAILED,
                PLAN_NOT_COSIGNED.
        """
        if not self.case_id:
            raise reason_error(SetupOrderError, NO_CASE.reason)
        blocking = _blocking(step, {one.step: one.finding for one in self.steps}, self.check_required)
        if blocking is None:
            if step is StepName.NAVIGATE and self.unsigned is not None:
                self._reject_unsigned(self.unsigned)
            return
        finding = self.status(blocking).finding
        raise reason_error(
            SetupOrderError,
            _waits_for(step, blocking, finding.reason),
            code=f"{blocking.name}_{finding.state.name}",
            context={"step": step.value, "waits_for": blocking.value, "state": finding.state.value},
        )

    def _reject_unsigned(self, step: StepName) -> None:
        missing_cosignature = self.status(step).missing_cosignature
        if missing_cosignature is None:
            return
        raise reason_error(
            SetupOrderError,
            _waits(missing_cosignature.reason, "WAITS_FOR_COSIGNATURE"),
            code=f"{step.name}_NOT_COSIGNED",
            context={"step": StepName.NAVIGATE.value, "waits_for": step.value},
        )


def derive_state(
    case_id: str,
    findings: Mapping[StepName, Finding],
    *,
    check_required: bool = True,
    confirmation: ConfirmationPrompt | None = None,
    missing_cosignature: Mapping[StepName, MissingCosignature] = NONE_MISSING,
) -> ProcedureState:
    """Derive the state of the procedure from the findings of all steps before navigation.

    Args:
        case_id: the open case.
        findings: of every step from the camera to the check.
        check_required: whether a registration must be checked before navigation. A failed check always
            prevents navigation.
        confirmation: the confirmation that the registration needs. It is requested only if the check is
            satisfied, because a check replaces a confirmation.
        missing_cosignature: by step, its missing co-signature. It blocks navigation only: others may
            register while a second person reviews the plan.
    """
    blocking = _blocking(StepName.NAVIGATE, findings, check_required)
    unsigned = next(iter(missing_cosignature.values()), None)
    if not _is_satisfied(StepName.CHECK, findings[StepName.CHECK], check_required):
        confirmation = None
    navigation = _navigation(findings, blocking, unsigned=unsigned, confirmation=confirmation)
    whole = {**findings, StepName.NAVIGATE: navigation}
    return ProcedureState(
        case_id=case_id,
        check_required=check_required,
        confirmation=confirmation,
        steps=tuple(
            StepStatus(
                step=step,
                finding=whole[step],
                allowed=_blocking(step, whole, check_required) is None
                and not (step is StepName.NAVIGATE and unsigned is not None),
                missing_cosignature=missing_cosignature.get(step),
            )
            for step in StepName
        ),
    )


def no_case(*, check_required: bool = True) -> ProcedureState:
    """Return the state without an open case: no step is allowed."""
    return ProcedureState(
        case_id="",
        check_required=check_required,
        steps=tuple(StepStatus(step=step, finding=NO_CASE, allowed=False) for step in StepName),
    )


def _blocking(step: StepName, findings: Mapping[StepName, Finding], check_required: bool) -> StepName | None:
    """Return the first earlier step that is not satisfied."""
    order = list(StepName)
    for earlier in order[: order.index(step)]:
        if _depends_on(step, earlier) and not _is_satisfied(earlier, findings[earlier], check_required):
            return earlier
    return None


def _depends_on(step: StepName, earlier: StepName) -> bool:
    """Return whether a step depends on an earlier one. The plan needs a CT only, not camera or tool."""
    return step is not StepName.PLAN or earlier not in (StepName.CAMERA, StepName.TOOL)


def _is_satisfied(step: StepName, finding: Finding, check_required: bool) -> bool:
    if finding.state in VALID_STATES:
        return True
    return step is StepName.CHECK and not check_required and finding.state is StepState.MISSING


def _navigation(
    findings: Mapping[StepName, Finding],
    blocking: StepName | None,
    *,
    unsigned: MissingCosignature | None,
    confirmation: ConfirmationPrompt | None,
) -> Finding:
    if blocking is None and unsigned is not None:
        return Finding(state=StepState.MISSING, reason=_waits(unsigned.reason, "WAITS_FOR_COSIGNATURE"))
    if blocking is None and confirmation is not None:
        return Finding(
            state=StepState.MISSING,
            reason=_waits(confirmation.reason, "WAITS_FOR_CONFIRMATION"),
            document_id=confirmation.registration.id,
        )
    if blocking is None:
        return Finding(state=StepState.DONE, reason=reason("NAVIGATION_ALLOWED"))
    first = findings[blocking]
    return Finding(state=StepState.MISSING, reason=_waits_for(StepName.NAVIGATE, blocking, first.reason))


def _waits_for(step: StepName, blocking: StepName, why: Reason) -> Reason:
    steps = {"step": STEPS[step.value], "waits_for": STEPS[blocking.value]}
    return _waits(why, "WAITS_FOR_STEP", steps)


def _waits(why: Reason, code: str, steps: Mapping[str, Value] | None = None) -> Reason:
    """Return the reason of a step that waits for what another reason states."""
    waits = reason(code, {"reason": why.message, **(steps or {})}, remedy=why.remedy)
    return replace(waits, is_translated=why.is_translated)
