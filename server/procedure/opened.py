"""The case that a step of the set-up works in."""

from server.errors import SetupOrderError
from server.store import Case, CaseStore


def opened_case(store: CaseStore) -> Case:
    """The case that is open.

    Raises:
        SetupOrderError: NO_CASE_OPEN.
    """
    case = store.opened()
    if case is None:
        raise SetupOrderError(
            "NO_CASE_OPEN",
            "no case is open, so nothing that is made could be kept",
            "Make a case and open it, or open one that is there.",
        )
    return case
