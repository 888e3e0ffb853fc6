"""The case store: cases with their documents and files. Acknowledged changes are on the disk.

with Home(home_folder()) as home, CaseStore(home) as store:
    case = store.create("L3, rehearsal")
    with store.new_file(case.id, ".npy") as new:
        numpy.save(new.path, volume)
    ct = store.put(case.id, DocumentKind.CT, "main", {...}, made_by="M. Ito", files=[new.stored.id])
    plan = store.put(case.id, DocumentKind.PLAN, "L3", {...}, made_by="M. Ito", depends_on=[ct.id])
    store.validity(plan)        # Current(), until the CT is replaced or withdrawn
"""

from server.store.archive import Archive
from server.store.case_store import CaseStore
from server.store.changes import Change
from server.store.documents import NewDocument
from server.store.errors import NotFound, OutOfDateError, StoreConflict, StoreError, translate_errors
from server.store.files import NewFile
from server.store.home import Home
from server.store.records import (
    Case,
    Current,
    Damage,
    Document,
    DocumentKind,
    DocumentVersion,
    Entry,
    Heading,
    ImportRecord,
    OutOfDate,
    StoredFile,
    Validity,
    Withdrawal,
    says_archive,
)

__all__ = [
    "Archive",
    "Case",
    "CaseStore",
    "Change",
    "Current",
    "Damage",
    "Document",
    "DocumentKind",
    "DocumentVersion",
    "Entry",
    "Heading",
    "Home",
    "ImportRecord",
    "NewDocument",
    "NewFile",
    "NotFound",
    "OutOfDate",
    "OutOfDateError",
    "StoreConflict",
    "StoreError",
    "StoredFile",
    "Validity",
    "Withdrawal",
    "says_archive",
    "translate_errors",
]
