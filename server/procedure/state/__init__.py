"""The state of the procedure: its steps in their order, what each says, and what may follow."""

from server.procedure.state.judged import ProcedureState, judged, no_case
from server.procedure.state.reading import Brought, Procedure
from server.procedure.state.records import Finding, Lack, StepName, StepState, StepStatus

__all__ = [
    "Brought",
    "Finding",
    "Lack",
    "Procedure",
    "ProcedureState",
    "StepName",
    "StepState",
    "StepStatus",
    "judged",
    "no_case",
]
