"""State of the procedure: its steps in order, their findings, and which of them are allowed."""

from server.procedure.state.procedure import Procedure, SetupDefaults
from server.procedure.state.procedure_state import ProcedureState, derive_state, no_case
from server.procedure.state.records import Finding, MissingCosignature, StepName, StepState, StepStatus

__all__ = [
    "Finding",
    "MissingCosignature",
    "Procedure",
    "ProcedureState",
    "SetupDefaults",
    "StepName",
    "StepState",
    "StepStatus",
    "derive_state",
    "no_case",
]
