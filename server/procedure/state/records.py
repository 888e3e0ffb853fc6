"""What is said of one step of the procedure."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

Number: TypeAlias = float | int | bool | str | None


class StepName(StrEnum):
    """The steps, in the order in which they follow each other."""

    CAMERA = "camera"
    TOOL = "tool"
    PLAN = "plan"
    REGISTER = "register"
    CHECK = "check"
    NAVIGATE = "navigate"


class StepState(StrEnum):
    """How a step stands."""

    MISSING = "missing"
    OUT_OF_DATE = "out_of_date"  # what it stands on was changed or withdrawn
    FAILED = "failed"  # it was done, and its gate says no
    DUE = "due"  # it holds, and shall be done again
    DONE = "done"


HOLDS = frozenset({StepState.DONE, StepState.DUE})


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """What the open case says of one step, whatever the others say.

    Attributes:
        state: how it stands.
        said: why, in a sentence without its full stop.
        remedy: what to do next, one full sentence; empty where there is nothing to do.
        numbers: of its gate, by name.
        document_id: of what was made in it; empty where nothing was.
    """

    state: StepState
    said: str
    remedy: str = ""
    numbers: Mapping[str, Number] = field(default_factory=dict)
    document_id: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lack:
    """What a step that is done still lacks before anybody may navigate by it.

    Attributes:
        said: what, in a sentence without its full stop.
        remedy: what to do, one full sentence.
    """

    said: str
    remedy: str


@dataclass(frozen=True, slots=True, kw_only=True)
class StepStatus:
    """One step among the others.

    Attributes:
        step: which one.
        finding: what is said of it.
        allowed: whether all that it stands on holds, so that it may be done now.
        lacks: the co-signature that is required of it and not there; None where nothing is lacking.
    """

    step: StepName
    finding: Finding
    allowed: bool
    lacks: Lack | None = None
