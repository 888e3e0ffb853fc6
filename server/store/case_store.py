"""The public interface of the store."""

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from types import TracebackType

from sqlalchemy import event
from sqlalchemy.orm import Session

from server.clock import Clock, utc_now
from server.disk import FULL
from server.store import cases, documents, files
from server.store.archive import Archive, pack, unpack
from server.store.case_database import CaseDatabase
from server.store.case_index import CaseIndex
from server.store.changes import Change
from server.store.cleanup import clean_up, remove_case
from server.store.documents import NewDocument
from server.store.errors import OutOfDateError, StoreConflict, StoreError
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
    OutOfDate,
    StoredFile,
    Validity,
    Withdrawal,
)
from server.store.tables import PRESENT
from server.store.validation import validate_name
from server.texts import WITHDRAWALS


class CaseStore:
    """Cases with their documents and files. When a method returns, its change is on the disk.

    Thread-safe. Methods block on the disk: do not call them in an event loop.

    Raises (every method):
        StoreError: STORE_FULL, STORE_READ_ONLY, STORE_BUSY, STORE_DAMAGED, STORE_FAILED; at the start also
            STORE_SCHEMA_UNKNOWN.
        StoreError: CASE_DAMAGED, DOCUMENT_DAMAGED, FILE_DAMAGED, what the disk changed is not returned.
        NotFound: CASE_UNKNOWN, DOCUMENT_UNKNOWN, FILE_UNKNOWN.
    """

    def __init__(self, home: Home, *, clock: Clock = utc_now) -> None:
        self.home = home
        self._database = CaseDatabase(home, clock=clock)
        # Before all other listeners of a commit, which may read what was committed.
        self._index = CaseIndex(self._database)
        self._on_change: Callable[[Change], None] = lambda _: None
        self._intact_files: set[tuple[str, str]] = set()
        try:
            clean_up(self._database)
        except BaseException:
            self._database.close()
            raise

    # ------------------------------------------------------------ cases

    def create(self, name: str) -> Case:
        """Create a case; InvalidInput NAME_INVALID."""
        with self._database.write_session() as session:
            made = cases.add_case(session, name=name, now=self._database.now)
        self._on_change(Change(case_id=made.id, kind="case", before=None, after="here"))
        return made

    def list(self) -> tuple[Case, ...]:
        """Return all cases, newest first."""
        with self._database.read_session() as session:
            return cases.all_cases(session)

    def get(self, case_id: str) -> Case:
        """Return a case."""
        with self._database.read_session() as session:
            return cases.case_of(cases.case_row(session, case_id))

    def open(self, case_id: str) -> Case:
        """Make this the open case; it stays open over a restart."""
        before = self.get_open_case()
        with self._database.write_session() as session:
            opened = cases.open_case(session, case_id)
        self._on_change(Change.opened(case_id, before=before))
        return opened

    def close(self) -> None:
        """Close the open case."""
        before = self.get_open_case()
        with self._database.write_session() as session:
            cases.close_case(session)
        if before is not None:
            self._on_change(Change(case_id=before.id, kind="open case", before=before.id, after=None))

    def get_open_case(self) -> Case | None:
        """Return the open case; None if none is open."""
        return self._index.open_case()

    def rename(self, case_id: str, name: str) -> Case:
        """Rename a case, which also makes one usable whose row was damaged; InvalidInput NAME_INVALID."""
        with self._database.write_session() as session:
            row = cases.case_row(session, case_id, accept_damaged=True)
            row.state = PRESENT
            row.name, row.changed_at = validate_name(name, of="name of the case"), self._database.now
            session.flush()
            renamed = cases.case_of(row)
        self._on_change(Change(case_id=case_id, kind="case", before="here", after="here, with another name"))
        return renamed

    def delete(self, case_id: str, *, confirm: str) -> None:
        """Delete a case permanently; `confirm` must be its name.

        Raises:
            InvalidInput: CONFIRMATION_WRONG.
            StoreConflict: CASE_OPEN, CASE_IN_USE.
        """
        try:
            self._mark_deleting(case_id, confirm)
        except StoreError as error:
            if error.code != FULL:
                raise
            self.home.release_reserve()
            self._mark_deleting(case_id, confirm)
        remove_case(self._database, case_id)
        self.home.allocate_reserve()
        self._on_change(Change(case_id=case_id, kind="case", before="here", after=None))

    def _mark_deleting(self, case_id: str, confirm: str) -> None:
        with self._database.write_session() as session:
            cases.reject_removal(session, case_id, confirm)
            self._database.reject_in_use(case_id)
            cases.mark_deleting(session, case_id)
            self._forget_after_commit(session)

    def in_use(self, case_id: str) -> AbstractContextManager[None]:
        """Return a context manager that prevents the deletion of a case."""
        return self._database.in_use(case_id)

    # ------------------------------------------------------------ documents

    def put(
        self,
        case_id: str,
        kind: DocumentKind,
        name: str,
        content: Mapping[str, object],
        *,
        made_by: str,
        depends_on: Sequence[str] = (),
        files: Sequence[str] = (),
        expected_version: int | None = None,
        companions: Callable[[Document], Sequence[NewDocument]] = lambda _: (),
    ) -> Document:
        """Store the next version of a document, with its companions, in one transaction.

        Args:
            case_id: the case.
            kind: kind of the document; only PATIENT may identify the patient.
            name: unique among the documents of its kind.
            content: JSON: strings, finite numbers, booleans, None, lists and mappings of them.
            made_by: name of the author.
            depends_on: ids of the documents that it was made from.
            files: ids of the files that belong to it.
            expected_version: version that the change was based on, 0 for none; verified if given.
            companions: given the stored document, returns further documents. They are stored in the same
                transaction: all of them or none.

        Raises:
            InvalidInput: NAME_INVALID, CONTENT_NOT_JSON, CONTENT_TOO_LARGE, DEPENDS_ON_IDENTITY.
            StoreConflict: VERSION_CONFLICT.
        """
        new = NewDocument.validated(
            kind,
            name,
            content,
            made_by=made_by,
            depends_on=depends_on,
            files=files,
            expected_version=expected_version,
        )
        document, *others = self._add(case_id, new, companions)
        for one in (document, *others):
            self._on_change(Change.added(one))
        return document

    def _add(
        self,
        case_id: str,
        new: NewDocument,
        companions: Callable[[Document], Sequence[NewDocument]] = lambda _: (),
    ) -> tuple[Document, ...]:
        """Store a document and its companions in one transaction."""
        with self._database.write_session() as session:
            row, now = cases.case_row(session, case_id), self._database.now
            row.changed_at = now
            document = documents.add_document(session, case_id, new, now=now)
            others = [documents.add_document(session, case_id, one, now=now) for one in companions(document)]
        return (document, *others)

    def document(self, case_id: str, document_id: str) -> Document:
        """Return a document; StoreError DOCUMENT_DAMAGED."""
        return self._index.documents(case_id, [self._heading(case_id, document_id)])[0]

    def latest(self, case_id: str, kind: DocumentKind, name: str) -> Document | None:
        """Return the newest version; None if there is none or it is withdrawn or damaged.

        No older version is reused.
        """
        heading = self.newest_heading(case_id, kind, name)
        if heading is None or not heading.is_usable:
            return None
        return self._index.documents(case_id, [heading])[0]

    def newest_heading(self, case_id: str, kind: DocumentKind, name: str) -> Heading | None:
        """Return the heading of the newest version, also if withdrawn or damaged; None if there is none."""
        return self._index.newest(case_id, kind, name)

    def damaged(self, case_id: str, *kinds: DocumentKind) -> tuple[Heading, ...]:
        """Return the headings of the newest versions of these kinds that are damaged."""
        newest = (one for kind in kinds for one in self._index.newest_of_kind(case_id, kind))
        return tuple(one for one in newest if one.is_damaged)

    def history(self, case_id: str, kind: DocumentKind, name: str) -> tuple[Document, ...]:
        """Return all versions in order, including withdrawn ones, without damaged ones."""
        headings = self._index.headings(case_id)
        named = [one for one in headings if (one.kind, one.name) == (kind, name) and not one.is_damaged]
        return self._index.documents(case_id, sorted(named, key=lambda one: one.version))

    def all(self, case_id: str, kind: DocumentKind) -> tuple[Document, ...]:
        """Return the newest version of each name, without withdrawn and damaged ones, ordered by name."""
        newest = self._index.newest_of_kind(case_id, kind)
        return self._index.documents(case_id, [one for one in newest if one.is_usable])

    def ids(self, case_id: str) -> tuple[str, ...]:
        """Return the ids of all versions of all documents, in order of creation."""
        return tuple(one.id for one in self._index.headings(case_id))

    def outline(self, case_id: str) -> tuple[Entry, ...]:
        """Return the headings of all versions of all documents with their validity, in order of creation.

        Versions that are damaged come last.
        """
        return tuple(
            Entry(heading=heading, validity=self._index.validity(heading))
            for heading in self._index.headings(case_id)
        )

    def validity(self, document: Heading) -> Validity:
        """Return whether a document is valid.

        It is valid if it and all documents that it depends on are the newest versions, and none is withdrawn
        or damaged.
        """
        return self._index.validity(self._heading(document.case_id, document.id))

    def current(self, case_id: str, kind: DocumentKind, name: str) -> Document:
        """Return the newest version, if it is valid.

        Raises:
            OutOfDateError: DOCUMENT_MISSING, DOCUMENT_OUT_OF_DATE.
            StoreError: DOCUMENT_DAMAGED.
        """
        heading = self.newest_heading(case_id, kind, name)
        if heading is not None and heading.is_damaged:
            raise documents.document_damaged(case_id, heading.id)
        document = self.latest(case_id, kind, name)
        if document is None:
            raise OutOfDateError(
                "DOCUMENT_MISSING",
                f"there is no {kind.value} '{name}'",
                f"Create the {kind.value} first.",
                {"kind": kind.value, "name": name},
            )
        validity = self.validity(document)
        if isinstance(validity, OutOfDate):
            raise OutOfDateError(
                "DOCUMENT_OUT_OF_DATE",
                f"{kind.value} '{name}' is out of date: {validity.reason}",
                f"Create the {kind.value} again.",
                {"kind": kind.value, "name": name, "reason": validity.why.message},
            )
        return document

    def find_current(self, case_id: str, kind: DocumentKind, name: str) -> Document | None:
        """Return the newest version, if it is valid; None if there is none or it is out of date."""
        document = self.latest(case_id, kind, name)
        return document if document is not None and self.is_current(document) else None

    def all_current(self, case_id: str, kind: DocumentKind) -> tuple[Document, ...]:
        """Return the newest version of each name, as far as they are valid, ordered by name."""
        return tuple(document for document in self.all(case_id, kind) if self.is_current(document))

    def is_current(self, document: Heading) -> bool:
        """Return whether a document is valid; see `validity` for the reason if it is not."""
        return isinstance(self.validity(document), Current)

    def withdraw(self, document: Heading, *, by: str, reason: str) -> Document:
        """Mark a document as withdrawn; withdrawing it again has no effect."""
        by, reason = (
            validate_name(by, of="name of the person who withdraws it"),
            validate_name(reason, of="reason"),
        )
        with self._database.write_session() as session:
            case = cases.case_row(session, document.case_id)
            found = documents.find_document(session, document.case_id, document.id)
            is_news = found.withdrawn is None
            if is_news:
                self._forget_after_commit(session)
                case.changed_at = self._database.now
                withdrawal = Withdrawal(at=case.changed_at, by=by, reason=reason)
                documents.withdraw_document(session, found, withdrawal)
                found = replace(found, withdrawn=withdrawal)
        if is_news:
            self._on_change(Change.withdrawn(found, by=by))
        return found

    def restore(self, document: Heading, *, by: str) -> Document:
        """Store the content of the last intact version as the newest one, after the newest one was damaged.

        `by` is the person who decided it.

        Raises:
            StoreConflict: NOT_RESTORABLE, the newest version is not damaged, or the last intact one is
                another one or withdrawn.
        """
        newest = self.newest_heading(document.case_id, document.kind, document.name)
        intact = self._index.last_intact(document.case_id, document.kind, document.name)
        is_last = intact is not None and intact.is_usable and intact.id == document.id
        if newest is None or not newest.is_damaged or not is_last:
            raise StoreConflict(
                "NOT_RESTORABLE",
                f"{document.title} is not the last intact version before a damaged one",
                "Load the list of documents again.",
                {"title": document.title_text},
            )
        restored = self.document(document.case_id, document.id)
        new = NewDocument.validated(
            restored.kind,
            restored.name,
            restored.content,
            made_by=by,
            depends_on=restored.depends_on,
            files=restored.files,
            expected_version=newest.version,
        )
        (stored,) = self._add(restored.case_id, new)
        self._on_change(replace(Change.added(stored), before=restored.version))
        return stored

    def mark_lost(
        self, added: Collection[DocumentVersion], withdrawn: Mapping[DocumentVersion, str]
    ) -> Sequence[DocumentVersion]:
        """List confirmed versions that are newer than those that are there as damaged; repeat withdrawals.

        Args:
            added: versions that were confirmed, in any order; those of deleted cases are ignored.
            withdrawn: who withdrew them, by version.

        Returns:
            What was lost.
        """
        with self._database.read_session() as session:
            lost = documents.lost_versions(session, added)
            valid = documents.not_withdrawn(session, withdrawn)
        for one, document_id in valid.items():
            reason = WITHDRAWALS["WITHDRAWAL_LOST"]["en"]
            self.withdraw(self._heading(one.case_id, document_id), by=withdrawn[one], reason=reason)
        for one in lost:
            with self._database.write_session() as session:
                documents.record_newest(session, one)
            lost_version = f"version {one.version} lost on the disk"
            self._on_change(
                Change(
                    case_id=one.case_id, kind=one.kind.value, name=one.name, before=None, after=lost_version
                )
            )
        return (*valid, *lost)

    def _forget_after_commit(self, session: Session) -> None:
        event.listen(session, "after_commit", lambda _: self._index.forget(), once=True)

    def _heading(self, case_id: str, document_id: str) -> Heading:
        heading = self._index.find(case_id, document_id)
        if heading is None:
            raise documents.document_unknown(case_id, document_id)
        return heading

    # ------------------------------------------------------------ files

    def new_file(self, case_id: str, suffix: str) -> AbstractContextManager[files.NewFile]:
        """Context manager for a new file, which is complete in the case after the block, or not at all.

            with store.new_file(case.id, ".npy") as new:
                numpy.save(new.path, volume)
            store.put(..., files=[new.stored.id])

        Raises:
            InvalidInput: SUFFIX_INVALID.
        """
        return files.new_file(self._database, case_id, suffix)

    def file(self, case_id: str, file_id: str) -> StoredFile:
        """Return a file, whose content is compared with its SHA-256 once in a run of the program.

        Raises:
            StoreError: FILE_DAMAGED.
        """
        with self._database.read_session() as session:
            found = files.find_file(self._database, session, case_id, file_id)
        # Not at each access: a CT takes tenths of a second.
        if (case_id, file_id) not in self._intact_files:
            with self._database.in_use(case_id):
                files.reject_damaged(found)
            self._intact_files.add((case_id, file_id))
        return found

    def files(self, case_id: str) -> tuple[StoredFile, ...]:
        """Return all files of a case, oldest first."""
        with self._database.read_session() as session:
            cases.case_row(session, case_id)
            return files.all_files(self._database, session, case_id)

    def verify(self, case_id: str) -> tuple[Damage, ...]:
        """Read every file and document of a case, and return those that are missing or damaged."""
        return files.find_damage(self._database, case_id)

    # ------------------------------------------------------------ archives

    def export_case(
        self, case_id: str, *, with_identity: bool = False, without_damaged: bool = False
    ) -> Archive:
        """Export a case as an archive; its name and the patient's identity are left out by default.

        With `without_damaged` it has what is intact, and its manifest states what is missing.

        Raises:
            StoreError: FILE_DAMAGED, DOCUMENT_DAMAGED.
        """
        return pack(self._database, case_id, with_identity=with_identity, without_damaged=without_damaged)

    def import_archive(self, archive: Path, *, by: str) -> Case:
        """Import an archive as a new case, completely or not at all; `by` is the person who is responsible.

        Raises:
            InvalidInput: NAME_INVALID, ARCHIVE_INVALID, ARCHIVE_NEWER.
        """
        by = validate_name(by, of="name of the person who imports it")
        case, missing = unpack(self._database, archive, by=by)
        without = f", without {missing} damaged documents and files" if missing else ""
        self._on_change(Change(case_id=case.id, kind="case", before=None, after=f"copied in{without}", by=by))
        return case

    # ------------------------------------------------------------ end

    def add_commit_listener(self, listener: Callable[[], None]) -> None:
        """Register a function to be called after each change, in the thread that made it."""
        self._database.add_commit_listener(listener)

    def set_change_listener(self, listener: Callable[[Change], None]) -> None:
        """Set the function that receives each committed change, in the thread that made it."""
        self._on_change = listener

    def record_change(self, change: Change) -> None:
        """Tell the change listener of a change to files of a case that the store does not list."""
        self._on_change(change)

    def dispose(self) -> None:
        """Close the database. The caller that opened the home closes it."""
        self._database.close()

    def __enter__(self) -> "CaseStore":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.dispose()
