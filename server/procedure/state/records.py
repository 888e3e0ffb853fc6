"""Records of the state of one step of the procedure."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

from server.texts import Reason

Number: TypeAlias = float | int | bool | str | None


class StepName(StrEnum):
    """The steps, in the order of the procedure."""

    CAMERA = "camera"
    TOOL = "tool"
    PLAN = "plan"
    REGISTER = "register"
    CHECK = "check"
    NAVIGATE = "navigate"


class StepState(StrEnum):
    """State of a step."""

    MISSING = "missing"
    OUT_OF_DATE = "out_of_date"  # something that it depends on was changed or withdrawn
    FAILED = "failed"  # it was done, and did not meet its limits
    DUE = "due"  # it is valid, and should be repeated
    DONE = "done"


VALID_STATES = frozenset({StepState.DONE, StepState.DUE})


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """State of one step in the open case, without regard to the other steps.

    Attributes:
        state: the state.
        reason: the reason with its code and values, and what to do next.
        numbers: results and their limits, by name.
        document_id: document that the step made; empty if there is none.
    """

    state: StepState
    reason: Reason
    numbers: Mapping[str, Number] = field(default_factory=dict)
    document_id: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class MissingCosignature:
    """A co-signature that a completed step needs before navigation is allowed.

    Attributes:
        reason: what is missing, and what to do.
    """

    reason: Reason


@dataclass(frozen=True, slots=True, kw_only=True)
class StepStatus:
    """One step among the others.

    Attributes:
        step: the step.
        finding: its own state.
        allowed: whether everything that it depends on is valid, so that it may be done now.
        missing_cosignature: the required co-signature that does not exist yet; None if nothing is missing.
    """

    step: StepName
    finding: Finding
    allowed: bool
    missing_cosignature: MissingCosignature | None = None
