"""What a crash left behind is taken away at the start, and nothing that the database does not know."""

import shutil

import structlog
from sqlalchemy import select

from server.store.errors import StoreError, told
from server.store.files import UNFINISHED, discard
from server.store.ledger import Ledger
from server.store.tables import COMING, HERE, CaseRow, FileRow

log = structlog.get_logger(__name__)


def sweep(ledger: Ledger) -> None:
    """Finish deletions, and take away cases and files that were never whole."""
    with ledger.reading() as session:
        gone = list(session.scalars(select(CaseRow.id).where(CaseRow.state != HERE)))
        unfinished = [
            (row.case_id, row.id) for row in session.scalars(select(FileRow).where(FileRow.state == COMING))
        ]
    for case_id in gone:
        remove_case(ledger, case_id)
    for case_id, file_id in unfinished:
        if case_id not in gone:
            discard(ledger, case_id, file_id)
    if gone or unfinished:
        log.info("swept what a crash left behind", cases=len(gone), files=len(unfinished))
    _tell_strays(ledger)


def remove_case(ledger: Ledger, case_id: str) -> None:
    """Take away a case that is leaving or never arrived; what cannot be removed now is at the next start."""
    folder = ledger.home.cases / case_id
    try:
        with told(ledger.home.folder):
            if folder.exists():
                shutil.rmtree(folder)
        with ledger.writing() as session:
            row = session.get(CaseRow, case_id)
            if row is not None:
                session.delete(row)
        ledger.empty_journal()
    except StoreError as error:
        log.warning(
            "a deleted case could not be removed from the disk yet",
            code="CASE_LEFT",
            case_id=case_id,
            why=error.message,
            remedy="It is removed at the next start; look at the disk and at the rights of its folder.",
        )


def _tell_strays(ledger: Ledger) -> None:
    """Name what lies in the folder and not in the database; a restored database must not cost files."""
    with ledger.reading() as session:
        known = {(row.case_id, row.id) for row in session.scalars(select(FileRow))}
        cases = set(session.scalars(select(CaseRow.id)))
    strays = []
    with told(ledger.home.folder):
        for folder in ledger.home.cases.iterdir():
            if folder.name not in cases:
                strays.append(folder.name)
                continue
            strays += [
                f"{folder.name}/{file.name}"
                for file in folder.iterdir()
                if (folder.name, file.name.removeprefix(UNFINISHED)) not in known
            ]
    if strays:
        log.warning(
            "files lie in the folder of cases that the database does not know; they are left alone",
            code="STORE_STRAYS",
            strays=sorted(strays)[:20],
            count=len(strays),
            remedy="If the database was replaced by an older one, put the newer one back; else remove them.",
        )
