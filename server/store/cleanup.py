"""Removal of the remains of a crash at the start; files unknown to the database are not removed."""

import shutil

import structlog
from sqlalchemy import select

from server.disk import sync_path
from server.store import cases
from server.store.case_database import CaseDatabase
from server.store.errors import StoreError, translate_errors
from server.store.files import UNFINISHED, discard, is_intact
from server.store.home import RECORDINGS
from server.store.tables import PRESENT, WRITING, CaseRow, FileRow

log = structlog.get_logger(__name__)


def clean_up(database: CaseDatabase) -> None:
    """Finish deletions, and remove cases and files that were never complete."""
    with database.read_session() as session:
        # A state that the disk changed must not delete anything.
        leftovers = session.scalars(select(CaseRow).where(CaseRow.state != PRESENT))
        gone = [row.id for row in leftovers if row is not None and cases.is_intact(row)]
        partial = session.scalars(select(FileRow).where(FileRow.state == WRITING))
        unfinished = [(row.case_id, row.id) for row in partial if row is not None and is_intact(row)]
    for case_id in gone:
        remove_case(database, case_id)
    for case_id, file_id in unfinished:
        if case_id not in gone:
            discard(database, case_id, file_id)
    if gone or unfinished:
        log.info("removed the remains of a crash", cases=len(gone), files=len(unfinished))
    _log_strays(database)


def remove_case(database: CaseDatabase, case_id: str) -> None:
    """Remove a case that is being deleted or was not imported completely.

    What cannot be removed now is removed at the next start.
    """
    folder = database.home.cases / case_id
    try:
        with translate_errors(database.home.folder):
            if folder.exists():
                shutil.rmtree(folder)
                # Before the row: after a power cut nobody would know whose files these are.
                sync_path(folder.parent)
        with database.write_session() as session:
            row = session.get(CaseRow, case_id)
            if row is not None:
                session.delete(row)
        database.truncate_journal()
    except StoreError as error:
        log.warning(
            "a deleted case could not be removed from the disk yet",
            code="CASE_LEFT",
            case_id=case_id,
            why=error.message,
            remedy="It is removed at the next start; check the disk and the permissions of its folder.",
        )


def _log_strays(database: CaseDatabase) -> None:
    """Log files that the database does not know. They are kept, because the database may be an older copy."""
    with database.read_session() as session:
        known = {(row.case_id, row.id) for row in session.execute(select(FileRow.case_id, FileRow.id))}
        known_cases = set(session.scalars(select(CaseRow.id)))
    strays = []
    with translate_errors(database.home.folder):
        for folder in database.home.cases.iterdir():
            if folder.name not in known_cases:
                strays.append(folder.name)
                continue
            strays += [
                f"{folder.name}/{file.name}"
                for file in folder.iterdir()
                if file.name != RECORDINGS and (folder.name, file.name.removeprefix(UNFINISHED)) not in known
            ]
    if strays:
        log.warning(
            "the folder of cases contains files that the database does not know; they are not removed",
            code="STORE_STRAYS",
            strays=sorted(strays)[:20],
            count=len(strays),
            remedy="If the database was replaced by an older one, restore the newer one; otherwise remove "
            "them.",
        )
