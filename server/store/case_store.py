"""Everything that is kept, behind one object."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from types import TracebackType

from server.clock import Clock, utc_now
from server.disk import FULL
from server.store import cases, documents, files
from server.store.archive import Archive, pack, unpack
from server.store.changes import Change
from server.store.checks import checked_name
from server.store.documents import NewDocument
from server.store.errors import OutOfDateError, StoreError
from server.store.home import Home
from server.store.ledger import Ledger
from server.store.records import (
    Case,
    Damage,
    Document,
    DocumentKind,
    Entry,
    Heading,
    OutOfDate,
    Standing,
    StoredFile,
)
from server.store.standing import lineage_of
from server.store.sweep import remove_case, sweep


class CaseStore:
    """Cases with their documents and files. Whatever a method answers is on the disk.

    Safe to use from any thread; methods wait for the disk, so never call them in an event loop.

    Raises (every method):
        StoreError: STORE_FULL, STORE_READ_ONLY, STORE_BUSY, STORE_DAMAGED, STORE_FAILED; at the start also
            STORE_NEWER.
        NotStored: CASE_UNKNOWN, DOCUMENT_UNKNOWN, FILE_UNKNOWN.
    """

    def __init__(self, home: Home, *, clock: Clock = utc_now) -> None:
        self.home = home
        self._ledger = Ledger(home, clock=clock)
        self._told: Callable[[Change], None] = lambda _: None
        try:
            sweep(self._ledger)
        except BaseException:
            self._ledger.close()
            raise

    # ------------------------------------------------------------ cases

    def create(self, name: str) -> Case:
        """A new case; InvalidInput NAME_INVALID."""
        with self._ledger.writing() as session:
            made = cases.add_case(session, name=name, now=self._ledger.now)
        self._told(Change(case_id=made.id, kind="case", before=None, after="here"))
        return made

    def list(self) -> tuple[Case, ...]:
        """All cases, the newest first."""
        with self._ledger.reading() as session:
            return cases.all_cases(session)

    def get(self, case_id: str) -> Case:
        """One case."""
        with self._ledger.reading() as session:
            return cases.case_of(cases.case_row(session, case_id))

    def open(self, case_id: str) -> Case:
        """Make this the case that is worked in; it stays so over a restart."""
        before = self.opened()
        with self._ledger.writing() as session:
            opened = cases.open_case(session, case_id)
        self._told(Change.opened(case_id, before=before))
        return opened

    def close(self) -> None:
        """Have no case open."""
        before = self.opened()
        with self._ledger.writing() as session:
            cases.close_case(session)
        if before is not None:
            self._told(Change(case_id=before.id, kind="open case", before=before.id, after=None))

    def opened(self) -> Case | None:
        """The case that is open."""
        with self._ledger.reading() as session:
            return cases.opened_case(session)

    def rename(self, case_id: str, name: str) -> Case:
        """Give a case another name; InvalidInput NAME_INVALID."""
        with self._ledger.writing() as session:
            row = cases.case_row(session, case_id)
            row.name, row.changed_at = checked_name(name, of="name of the case"), self._ledger.now
            renamed = cases.case_of(row)
        self._told(Change(case_id=case_id, kind="case", before="here", after="here, with another name"))
        return renamed

    def delete(self, case_id: str, *, confirm: str) -> None:
        """Take a case away for ever; `confirm` is its name.

        Raises:
            InvalidInput: CONFIRMATION_WRONG.
            StoreConflict: CASE_OPEN, CASE_IN_USE.
        """
        try:
            self._mark_leaving(case_id, confirm)
        except StoreError as error:
            if error.code != FULL:
                raise
            self.home.spend_reserve()
            self._mark_leaving(case_id, confirm)
        remove_case(self._ledger, case_id)
        self.home.keep_reserve()
        self._told(Change(case_id=case_id, kind="case", before="here", after=None))

    def _mark_leaving(self, case_id: str, confirm: str) -> None:
        with self._ledger.writing() as session:
            cases.reject_removal(session, case_id, confirm)
            self._ledger.reject_held(case_id)
            cases.mark_leaving(session, case_id)

    # ------------------------------------------------------------ documents

    def put(
        self,
        case_id: str,
        kind: DocumentKind,
        name: str,
        content: Mapping[str, object],
        *,
        made_by: str,
        stands_on: Sequence[str] = (),
        files: Sequence[str] = (),
        expected_version: int | None = None,
        with_it: Callable[[Document], Sequence[NewDocument]] = lambda _: (),
    ) -> Document:
        """Store the next version of a document, and whatever belongs to it, in one transaction.

        Args:
            case_id: the case.
            kind: what it is about; who the patient is goes into PATIENT and nowhere else.
            name: tells it from others of its kind.
            content: JSON: texts, finite numbers, true, false, None, lists and mappings of them.
            made_by: who made it.
            stands_on: ids of the documents that it was made from.
            files: ids of the files that belong to it.
            expected_version: the version that the change was made on, 0 for none; checked if given.
            with_it: returns further documents, given the stored one. No reader sees it without them, and a
                crash leaves all of them or none.

        Raises:
            InvalidInput: NAME_INVALID, CONTENT_NOT_JSON, CONTENT_TOO_LARGE, STANDS_ON_IDENTITY.
            StoreConflict: VERSION_CONFLICT.
        """
        new = NewDocument.checked(
            kind,
            name,
            content,
            made_by=made_by,
            stands_on=stands_on,
            files=files,
            expected_version=expected_version,
        )
        with self._ledger.writing() as session:
            row, now = cases.case_row(session, case_id), self._ledger.now
            row.changed_at = now
            document = documents.add_document(session, case_id, new, now=now)
            others = [documents.add_document(session, case_id, one, now=now) for one in with_it(document)]
        for one in (document, *others):
            self._told(Change.added(one))
        return document

    def document(self, case_id: str, document_id: str) -> Document:
        """One document."""
        with self._ledger.reading() as session:
            cases.case_row(session, case_id)
            return documents.find_document(session, case_id, document_id)

    def latest(self, case_id: str, kind: DocumentKind, name: str) -> Document | None:
        """The newest version; None if there is none, or if it was withdrawn: no older one holds again."""
        with self._ledger.reading() as session:
            cases.case_row(session, case_id)
            return next(iter(documents.newest(session, case_id, kind, name)), None)

    def history(self, case_id: str, kind: DocumentKind, name: str) -> tuple[Document, ...]:
        """All versions, the first first, withdrawn ones too."""
        with self._ledger.reading() as session:
            cases.case_row(session, case_id)
            return documents.versions(session, case_id, kind, name)

    def all(self, case_id: str, kind: DocumentKind) -> tuple[Document, ...]:
        """The newest version of each name, without those that were withdrawn, ordered by name."""
        with self._ledger.reading() as session:
            cases.case_row(session, case_id)
            return documents.newest(session, case_id, kind, None)

    def outline(self, case_id: str) -> tuple[Entry, ...]:
        """Every version of every document without its content, with its standing, in the order of making."""
        with self._ledger.reading() as session:
            cases.case_row(session, case_id)
            lineage = lineage_of(session, case_id)
        return tuple(
            Entry(heading=heading, standing=lineage.standing(heading.id))
            for heading in lineage.headings.values()
        )

    def standing(self, document: Heading) -> Standing:
        """Whether a document holds: it and all that it stands on are the newest, and none was withdrawn."""
        with self._ledger.reading() as session:
            cases.case_row(session, document.case_id)
            documents.document_row(session, document.case_id, document.id)
            return lineage_of(session, document.case_id, document.id).standing(document.id)

    def current(self, case_id: str, kind: DocumentKind, name: str) -> Document:
        """The newest version, if it holds.

        Raises:
            OutOfDateError: DOCUMENT_MISSING, DOCUMENT_OUT_OF_DATE.
        """
        document = self.latest(case_id, kind, name)
        standing = (
            OutOfDate(reason=f"there is no {kind.value} '{name}'")
            if document is None
            else self.standing(document)
        )
        if document is not None and not isinstance(standing, OutOfDate):
            return document
        reason = standing.reason if isinstance(standing, OutOfDate) else ""
        missing = document is None
        raise OutOfDateError(
            "DOCUMENT_MISSING" if missing else "DOCUMENT_OUT_OF_DATE",
            reason if missing else f"{kind.value} '{name}' is out of date: {reason}",
            f"Make the {kind.value} first." if missing else f"Make the {kind.value} again.",
            {"kind": kind.value, "name": name},
        )

    def withdraw(self, document: Heading, *, by: str, reason: str) -> Document:
        """Say that a document no longer holds; a second time changes nothing."""
        by, reason = checked_name(by, of="name of who withdraws it"), checked_name(reason, of="reason")
        with self._ledger.writing() as session:
            case = cases.case_row(session, document.case_id)
            row = documents.document_row(session, document.case_id, document.id)
            is_news = row.withdrawn_at is None
            if is_news:
                row.withdrawn_at, row.withdrawn_by, row.withdrawn_reason = self._ledger.now, by, reason
                case.changed_at = row.withdrawn_at
                session.flush()
            found = documents.find_document(session, document.case_id, document.id)
        if is_news:
            self._told(Change.withdrawn(found, by=by))
        return found

    # ------------------------------------------------------------ files

    def new_file(self, case_id: str, suffix: str) -> AbstractContextManager[files.NewFile]:
        """A file that is whole in the case when the block ends, or nowhere.

            with store.new_file(case.id, ".npy") as new:
                numpy.save(new.path, volume)
            store.put(..., files=[new.stored.id])

        Raises:
            InvalidInput: SUFFIX_INVALID.
        """
        return files.new_file(self._ledger, case_id, suffix)

    def file(self, case_id: str, file_id: str) -> StoredFile:
        """One file; StoreError FILE_DAMAGED if it is missing on the disk."""
        with self._ledger.reading() as session:
            return files.find_file(self._ledger, session, case_id, file_id)

    def files(self, case_id: str) -> tuple[StoredFile, ...]:
        """All files of a case, the oldest first."""
        with self._ledger.reading() as session:
            cases.case_row(session, case_id)
            return files.all_files(self._ledger, session, case_id)

    def verify(self, case_id: str) -> tuple[Damage, ...]:
        """Read every file of a case, and tell those that are missing or not as they were stored."""
        return files.damages(self._ledger, case_id)

    # ------------------------------------------------------------ archives

    def copy_out(self, case_id: str, *, with_identity: bool = False) -> Archive:
        """A case as one file, without its name and without who the patient is unless asked for.

        Raises:
            StoreError: FILE_DAMAGED.
        """
        return pack(self._ledger, case_id, with_identity=with_identity)

    def copy_in(self, archive: Path, *, by: str) -> Case:
        """Take an archive in as a new case, whole or not at all; `by` is who does, and stands for it.

        Raises:
            InvalidInput: NAME_INVALID, ARCHIVE_INVALID, ARCHIVE_NEWER.
        """
        by = checked_name(by, of="name of who takes it in")
        case = unpack(self._ledger, archive, by=by)
        self._told(Change(case_id=case.id, kind="case", before=None, after="copied in", by=by))
        return case

    # ------------------------------------------------------------ end

    def call_after_writing(self, listener: Callable[[], None]) -> None:
        """Have this called after each change, by the thread that made it; it may read the store."""
        self._ledger.call_after_writing(listener)

    def tell_changes(self, listener: Callable[[Change], None]) -> None:
        """Have this one told what was changed, once it is on the disk, by the thread that changed it."""
        self._told = listener

    def shut(self) -> None:
        """Close the database. The home is closed by who opened it."""
        self._ledger.close()

    def __enter__(self) -> "CaseStore":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.shut()
