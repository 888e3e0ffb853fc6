"""What may follow what: from what is found of each step to the state of the procedure."""

from collections.abc import Mapping
from dataclasses import dataclass

from server.errors import SetupOrderError
from server.procedure.confirmed import ConfirmationNeeded
from server.procedure.state.records import HOLDS, Finding, Lack, StepName, StepState, StepStatus

NOTHING_LACKS: Mapping[StepName, Lack] = {}
NO_CASE = Finding(
    state=StepState.MISSING,
    said="no case is open",
    remedy="Make a case and open it, or open one that is there.",
)
# A step that is asked for too early is told by the one that it waits for.
WORDS = {
    StepName.CAMERA: "the camera",
    StepName.TOOL: "the tool",
    StepName.PLAN: "the plan",
    StepName.REGISTER: "the registration",
    StepName.CHECK: "the check on anatomy",
    StepName.NAVIGATE: "navigation",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcedureState:
    """All steps of the procedure.

    Attributes:
        case_id: the open case; empty where none is open.
        case_name: as people call it; empty likewise.
        steps: in their order.
        check_required: whether nothing is navigated by a registration that was never checked.
        confirmation: what a person is asked before navigation goes on; None while nothing is to be asked.
    """

    case_id: str
    steps: tuple[StepStatus, ...]
    check_required: bool
    confirmation: ConfirmationNeeded | None = None
    case_name: str = ""

    def status(self, step: StepName) -> StepStatus:
        """One of them."""
        return next(one for one in self.steps if one.step is step)

    @property
    def next_step(self) -> StepName:
        """What is to be done now."""
        return next((one.step for one in self.steps if one.finding.state not in HOLDS), StepName.NAVIGATE)

    @property
    def waits_for_check(self) -> bool:
        """Whether numbers are withheld until the registration was checked."""
        return not _lets_pass(StepName.CHECK, self.status(StepName.CHECK).finding, self.check_required)

    @property
    def unsigned(self) -> StepName | None:
        """The first step that lacks a co-signature, for which numbers are withheld."""
        return next((one.step for one in self.steps if one.lacks is not None), None)

    def reject_before(self, step: StepName) -> None:
        """Refuse a step while one that it stands on is missing, failed, out of date, or not co-signed.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or as CAMERA_MISSING, TOOL_OUT_OF_DATE, CHECK_FAILED,
                PLAN_NOT_COSIGNED.
        """
        if not self.case_id:
            raise SetupOrderError("NO_CASE_OPEN", NO_CASE.said, NO_CASE.remedy)
        blocking = _blocking(step, {one.step: one.finding for one in self.steps}, self.check_required)
        if blocking is None:
            if step is StepName.NAVIGATE and self.unsigned is not None:
                self._reject_unsigned(self.unsigned)
            return
        finding = self.status(blocking).finding
        raise SetupOrderError(
            f"{blocking.name}_{finding.state.name}",
            f"{WORDS[step]} waits for {WORDS[blocking]}: {finding.said}",
            finding.remedy,
            {"step": step.value, "waits_for": blocking.value, "state": finding.state.value},
        )

    def _reject_unsigned(self, step: StepName) -> None:
        lacks = self.status(step).lacks
        if lacks is None:
            return
        raise SetupOrderError(
            f"{step.name}_NOT_COSIGNED",
            f"navigation waits for a co-signature: {lacks.said}",
            lacks.remedy,
            {"step": StepName.NAVIGATE.value, "waits_for": step.value},
        )


def judged(
    case_id: str,
    findings: Mapping[StepName, Finding],
    *,
    check_required: bool = True,
    confirmation: ConfirmationNeeded | None = None,
    lacks: Mapping[StepName, Lack] = NOTHING_LACKS,
) -> ProcedureState:
    """The state that follows from what is found of each step but the last.

    Args:
        case_id: the open case.
        findings: of every step from the camera to the check.
        check_required: whether a registration must be checked before it is navigated by. One whose check
            failed is never navigated by.
        confirmation: what a person has to confirm of the registration; asked only where its check lets pass,
            because a check is more than a word.
        lacks: by step, the co-signature that it lacks. It keeps nobody from any step but navigation: while
            one person looks at the plan, others may register.
    """
    blocking = _blocking(StepName.NAVIGATE, findings, check_required)
    unsigned = next(iter(lacks.values()), None)
    if not _lets_pass(StepName.CHECK, findings[StepName.CHECK], check_required):
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
                lacks=lacks.get(step),
            )
            for step in StepName
        ),
    )


def no_case(*, check_required: bool = True) -> ProcedureState:
    """The state while no case is open: nothing may be done."""
    return ProcedureState(
        case_id="",
        check_required=check_required,
        steps=tuple(StepStatus(step=step, finding=NO_CASE, allowed=False) for step in StepName),
    )


def _blocking(step: StepName, findings: Mapping[StepName, Finding], check_required: bool) -> StepName | None:
    """The first earlier step that does not hold."""
    order = list(StepName)
    for earlier in order[: order.index(step)]:
        if _stands_on(step, earlier) and not _lets_pass(earlier, findings[earlier], check_required):
            return earlier
    return None


def _stands_on(step: StepName, earlier: StepName) -> bool:
    """A plan is made on a CT, whether or not there is a camera; everything else follows in line."""
    return step is not StepName.PLAN or earlier not in (StepName.CAMERA, StepName.TOOL)


def _lets_pass(step: StepName, finding: Finding, check_required: bool) -> bool:
    if finding.state in HOLDS:
        return True
    return step is StepName.CHECK and not check_required and finding.state is StepState.MISSING


def _navigation(
    findings: Mapping[StepName, Finding],
    blocking: StepName | None,
    *,
    unsigned: Lack | None,
    confirmation: ConfirmationNeeded | None,
) -> Finding:
    if blocking is None and unsigned is not None:
        return Finding(
            state=StepState.MISSING,
            said=f"navigation waits for a co-signature: {unsigned.said}",
            remedy=unsigned.remedy,
        )
    if blocking is None and confirmation is not None:
        return Finding(
            state=StepState.MISSING,
            said=f"navigation waits for a person: {confirmation.said}",
            remedy=confirmation.remedy,
            document_id=confirmation.registration.id,
        )
    if blocking is None:
        return Finding(state=StepState.DONE, said="the tool is shown against the channel")
    first = findings[blocking]
    return Finding(
        state=StepState.MISSING,
        said=f"navigation waits for {WORDS[blocking]}: {first.said}",
        remedy=first.remedy,
    )
