"""The open case and the documents of a case in memory, so that a change reads only what it added.

After each change a dozen readers ask for the newest versions and their validity. Only one server writes to a
folder, and a document is never changed, so that what was read stays true until a withdrawal. All documents
of a case are compared with their checksums when it is read first, and each again when its content is read.
"""

import threading
from collections.abc import Mapping, Sequence

from server.store.case_database import CaseDatabase
from server.store.cases import case_row, find_open_case
from server.store.documents import content_of, document_damaged, read_documents, recorded_versions
from server.store.errors import StoreError
from server.store.records import Case, Document, DocumentKind, Heading, Validity
from server.store.validity import Lineage, new_documents

# Contents that are kept in memory; a case uses some thirty documents at a time.
MAX_CONTENTS = 200


class CaseIndex:
    """The documents of the case that was asked for last. Thread-safe.

    Raises (every method that names a case):
        StoreError: the database cannot be read.
        NotFound: CASE_UNKNOWN.
    """

    def __init__(self, database: CaseDatabase) -> None:
        self._database = database
        self._lock = threading.RLock()
        # Number of commits, and the number at which case and documents were read.
        self._commits, self._open_read_at, self._read_at = 0, -1, -1
        self._open: Case | None = None
        self._case_id = ""
        self._lineage = Lineage()
        self._contents: dict[str, Mapping[str, object]] = {}
        database.add_commit_listener(self._note_commit)

    def forget(self) -> None:
        """Read the documents again before the next answer.

        Call it after a withdrawal or deletion is committed, and before the listeners of the commit.
        """
        with self._lock:
            self._case_id, self._contents = "", {}

    def open_case(self) -> Case | None:
        """Return the open case; None if none is open."""
        with self._lock:
            if self._open_read_at != self._commits:
                with self._database.read_session() as session:
                    self._open = find_open_case(session)
                self._open_read_at = self._commits
            return self._open

    def newest(self, case_id: str, kind: DocumentKind, name: str) -> Heading | None:
        """Return the newest version, also if it is withdrawn or damaged; None if there is none."""
        with self._lock:
            return self._current(case_id).newest(kind).get(name)

    def last_intact(self, case_id: str, kind: DocumentKind, name: str) -> Heading | None:
        """Return the newest version that is not damaged, also if it is withdrawn; None if there is none."""
        with self._lock:
            return self._current(case_id).last_intact(kind, name)

    def newest_of_kind(self, case_id: str, kind: DocumentKind) -> tuple[Heading, ...]:
        """Return the newest version of each name, also if it is withdrawn or damaged, ordered by name."""
        with self._lock:
            newest = self._current(case_id).newest(kind)
            return tuple(newest[name] for name in sorted(newest))

    def find(self, case_id: str, document_id: str) -> Heading | None:
        """Return the heading of a document; None if the case has none with this id."""
        with self._lock:
            return self._current(case_id).headings.get(document_id)

    def headings(self, case_id: str) -> tuple[Heading, ...]:
        """Return the headings of all versions of all documents, in order of creation."""
        with self._lock:
            return tuple(self._current(case_id).headings.values())

    def validity(self, heading: Heading) -> Validity:
        """Return whether a document, which the case must have, is valid."""
        with self._lock:
            return self._current(heading.case_id).validity(heading.id)

    def documents(self, case_id: str, headings: Sequence[Heading]) -> tuple[Document, ...]:
        """Return documents of one case with their contents.

        Raises:
            StoreError: DOCUMENT_DAMAGED.
        """
        with self._lock:
            self._current(case_id)
            for heading in headings:
                if heading.is_damaged:
                    raise document_damaged(case_id, heading.id)
            missing = [heading.id for heading in headings if heading.id not in self._contents]
            if missing:
                if len(self._contents) + len(missing) > MAX_CONTENTS:
                    self._contents.clear()
                    missing = [heading.id for heading in headings]
                self._contents |= self._read(case_id, missing)
            return tuple(Document.of(heading, self._contents[heading.id]) for heading in headings)

    def _read(self, case_id: str, ids: Sequence[str]) -> dict[str, Mapping[str, object]]:
        try:
            with self._database.read_session() as session:
                case_row(session, case_id)
                return {one.id: one.content for one in read_documents(session, case_id, ids)}
        except StoreError:
            # It was intact when its heading was read, and what depends on it is no longer valid.
            self.forget()
            raise

    def _current(self, case_id: str) -> Lineage:
        """Return the documents of a case, after reading those that are new."""
        if self._case_id != case_id:
            self._lineage, self._contents, self._case_id = Lineage(case_id), {}, case_id
        elif self._read_at == self._commits:
            return self._lineage
        try:
            with self._database.read_session() as session:
                case_row(session, case_id)
                is_first = not self._lineage.last_row
                for document in new_documents(session, self._lineage):
                    self._lineage.add(document)
                    # Of a whole case only few contents are asked for.
                    if not is_first and document.heading is not None:
                        if len(self._contents) >= MAX_CONTENTS:
                            self._contents.clear()
                        self._contents[document.id] = content_of(document.content)
                self._lineage.complete(recorded_versions(session, case_id))
        except BaseException:
            self._case_id = ""
            raise
        self._read_at = self._commits
        return self._lineage

    def _note_commit(self) -> None:
        with self._lock:
            self._commits += 1
