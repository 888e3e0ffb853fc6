"""Cases themselves: made, found, opened, renamed, taken away."""

import secrets

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from server.store.checks import checked_name
from server.store.errors import NotStored, StoreConflict
from server.store.records import Case
from server.store.tables import HERE, LEAVING, CaseRow, OpenCaseRow
from tracker.errors import InvalidInput


def new_id() -> str:
    """16 hexadecimal digits that nobody can guess, and that say nothing."""
    return secrets.token_hex(8)


def case_of(row: CaseRow) -> Case:
    """The record of a row."""
    return Case(
        id=row.id,
        name=row.name,
        created_at=row.created_at,
        changed_at=row.changed_at,
        copied_from=row.copied_from,
    )


def case_row(session: Session, case_id: str) -> CaseRow:
    """The row of a case that is there.

    Raises:
        NotStored: CASE_UNKNOWN.
    """
    row = session.get(CaseRow, case_id)
    if row is None or row.state != HERE:
        raise NotStored(
            "CASE_UNKNOWN",
            f"there is no case {case_id[:40]}",
            "Look at the list of cases; it may have been deleted.",
            {"case_id": case_id[:40]},
        )
    return row


def all_cases(session: Session) -> tuple[Case, ...]:
    """The newest first."""
    rows = session.scalars(
        select(CaseRow).where(CaseRow.state == HERE).order_by(CaseRow.created_at.desc(), CaseRow.id)
    )
    return tuple(case_of(row) for row in rows)


def add_case(
    session: Session, *, name: str, now: str, state: str = HERE, copied_from: str | None = None
) -> Case:
    """A new case without anything in it."""
    row = CaseRow(
        id=new_id(),
        name=checked_name(name, of="name of the case"),
        state=state,
        created_at=now,
        changed_at=now,
        copied_from=copied_from,
    )
    session.add(row)
    session.flush()
    return case_of(row)


def opened_case(session: Session) -> Case | None:
    """The case that is open."""
    row = session.get(OpenCaseRow, 1)
    return None if row is None else case_of(case_row(session, row.case_id))


def open_case(session: Session, case_id: str) -> Case:
    """Open a case; the one that was open is closed by it."""
    case = case_of(case_row(session, case_id))
    session.merge(OpenCaseRow(only=1, case_id=case_id))
    return case


def close_case(session: Session) -> None:
    """Have no case open."""
    session.execute(delete(OpenCaseRow))


def reject_removal(session: Session, case_id: str, confirm: str) -> None:
    """A case is taken away only by who knows its name, and not while people work in it.

    Raises:
        NotStored: CASE_UNKNOWN.
        StoreConflict: CASE_OPEN.
        InvalidInput: CONFIRMATION_WRONG.
    """
    row = case_row(session, case_id)
    opened = session.get(OpenCaseRow, 1)
    if opened is not None and opened.case_id == case_id:
        raise StoreConflict(
            "CASE_OPEN",
            f"the case {case_id} is open, and an open case is not deleted",
            "Close it first.",
            {"case_id": case_id},
        )
    if confirm.strip() != row.name and checked_name(confirm or "-", of="word of confirmation") != row.name:
        raise InvalidInput(
            "CONFIRMATION_WRONG",
            f"the word of confirmation is not the name of the case {case_id}",
            "Write the name of the case exactly as the list shows it; nothing was deleted.",
            {"case_id": case_id},
        )


def mark_leaving(session: Session, case_id: str) -> None:
    """From here on the case is gone for everybody, and the next start takes away what is left of it.

    A small change on purpose: on a full disk it is the one that makes room.
    """
    row = case_row(session, case_id)
    row.state, row.name = LEAVING, ""
