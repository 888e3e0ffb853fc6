"""Rows of cases: creation, lookup, opening and deletion."""

import secrets

import structlog
from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from server.store.checksums import case_checksum
from server.store.errors import NotFound, StoreConflict, StoreError
from server.store.records import Case
from server.store.tables import DELETING, PRESENT, CaseRow, OpenCaseRow
from server.store.validation import validate_name
from tracker.errors import InvalidInput

log = structlog.get_logger(__name__)


def new_id() -> str:
    """Return a random id of 16 hexadecimal digits."""
    return secrets.token_hex(8)


def case_of(row: CaseRow) -> Case:
    """Convert a row to a record."""
    # A damaged row can have values of other types.
    return Case(
        id=f"{row.id}",
        name=f"{row.name}",
        created_at=f"{row.created_at}",
        changed_at=f"{row.changed_at}",
        copied_from=None if row.copied_from is None else f"{row.copied_from}",
        is_damaged=not is_intact(row),
    )


def is_intact(row: CaseRow) -> bool:
    """Return whether a row matches its checksum."""
    return row.checksum == case_checksum(row)


def case_row(session: Session, case_id: str, *, accept_damaged: bool = False) -> CaseRow:
    """Return the row of an existing case.

    Raises:
        NotFound: CASE_UNKNOWN.
        StoreError: CASE_DAMAGED, unless that is accepted.
    """
    row = session.get(CaseRow, case_id)
    if row is not None and not is_intact(row):
        if accept_damaged:
            return row
        raise StoreError(
            "CASE_DAMAGED",
            f"the name or the times of the case {case_id} are damaged on the disk",
            "Check which case it is, and give it its name again. Then check the disk.",
            {"case_id": case_id},
        )
    if row is None or row.state != PRESENT:
        raise NotFound(
            "CASE_UNKNOWN",
            f"there is no case {case_id[:40]}",
            "GET /api/cases lists the cases; this one may have been deleted.",
            {"case_id": case_id[:40]},
        )
    return row


def all_cases(session: Session) -> tuple[Case, ...]:
    """Return all cases, newest first, also those whose rows are damaged."""
    rows = [row for row in session.scalars(select(CaseRow)) if row is not None]
    cases = [case_of(row) for row in rows if row.state == PRESENT or not is_intact(row)]
    return tuple(sorted(sorted(cases, key=lambda one: one.id), key=lambda one: one.created_at, reverse=True))


def add_case(
    session: Session, *, name: str, now: str, state: str = PRESENT, copied_from: str | None = None
) -> Case:
    """Create an empty case."""
    row = CaseRow(
        id=new_id(),
        name=validate_name(name, of="name of the case"),
        state=state,
        created_at=now,
        changed_at=now,
        copied_from=copied_from,
    )
    session.add(row)
    session.flush()
    return case_of(row)


def find_open_case(session: Session) -> Case | None:
    """Return the open case; None if there is none, or if its row is damaged."""
    row = session.get(OpenCaseRow, 1)
    try:
        return None if row is None else case_of(case_row(session, row.case_id))
    except (StoreError, NotFound) as error:
        log.warning("the case that was open is closed", code=error.code, why=error.message)
        return None


def open_case(session: Session, case_id: str) -> Case:
    """Open a case, which closes the one that was open."""
    case = case_of(case_row(session, case_id))
    session.merge(OpenCaseRow(only=1, case_id=case_id))
    return case


def close_case(session: Session) -> None:
    """Close the open case."""
    session.execute(delete(OpenCaseRow))


def reject_removal(session: Session, case_id: str, confirm: str) -> None:
    """Reject the deletion of an open case, or with a wrong confirmation.

    Raises:
        NotFound: CASE_UNKNOWN.
        StoreConflict: CASE_OPEN.
        InvalidInput: CONFIRMATION_WRONG.
    """
    row = case_row(session, case_id, accept_damaged=True)
    opened = session.get(OpenCaseRow, 1)
    if opened is not None and opened.case_id == case_id:
        raise StoreConflict(
            "CASE_OPEN",
            f"the case {case_id} is open, and an open case cannot be deleted",
            "Close it first.",
            {"case_id": case_id},
        )
    if confirm.strip() != row.name and validate_name(confirm or "-", of="word of confirmation") != row.name:
        raise InvalidInput(
            "CONFIRMATION_WRONG",
            f"the confirmation is not the name of the case {case_id}",
            "Enter the name of the case exactly as in the list; nothing was deleted.",
            {"case_id": case_id},
        )


def mark_deleting(session: Session, case_id: str) -> None:
    """Mark a case as deleted; it is invisible from here on, and its remains are removed at the next start.

    The change is small, because it must succeed on a full disk.
    """
    row = case_row(session, case_id, accept_damaged=True)
    row.state, row.name = DELETING, ""
