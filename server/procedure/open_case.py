"""The open case, in which the steps of the procedure store their results."""

from server.errors import SetupOrderError
from server.store import Case, CaseStore


def require_open_case(store: CaseStore) -> Case:
    """Return the open case.

    Raises:
        SetupOrderError: NO_CASE_OPEN.
    """
    case = store.get_open_case()
    if case is None:
        raise SetupOrderError(
            "NO_CASE_OPEN",
            "no case is open, so no result can be stored",
            "Create a case and open it, or open an existing one.",
        )
    return case
