"""Finds confirmed changes that the database has lost.

SQLite ends its journal at the first page that the disk has damaged, without an error: after a crash the
changes behind it are gone, and an older plan would be the newest one. The entry of a change in the audit log
is on the disk before its answer, in another file, so that it shows what was confirmed.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import structlog

from server.security.audit.chain import sha256_of
from server.security.audit.log import AuditLog
from server.store import CaseStore, DocumentKind, DocumentVersion

KINDS = frozenset(kind.value for kind in DocumentKind)
log = structlog.get_logger(__name__)


def mark_lost_changes(store: CaseStore, audit: AuditLog) -> int:
    """Mark documents that the audit log has and the store lacks as damaged, and repeat lost withdrawals.

    Returns how many changes were lost.

    If the last opening or closing of a case was lost, no case is open afterwards. Alarms and the patient's
    identity are not in the audit log, and new and renamed cases are not found. Call it after an entry of this
    start, which confirms the entry before it.

    Raises:
        StoreError: log or database cannot be read or written.
    """
    added: set[DocumentVersion] = set()
    withdrawn: dict[DocumentVersion, str] = {}
    opened: str | None = None
    is_stated = False
    for change in _intact_changes(audit.complete_lines().splitlines()):
        kind, name, after = change.get("what"), change.get("name"), change.get("to")
        if kind == "open case":
            opened, is_stated = None if after is None else f"{after}", True
        version = change.get("from") if after == "withdrawn" else after
        if kind not in KINDS or not isinstance(name, str) or not isinstance(version, int):
            continue
        document = DocumentVersion(f"{change.get('case_id')}", DocumentKind(kind), name, version)
        if after == "withdrawn":
            withdrawn[document] = f"{change.get('by') or 'Coaxial'}"
        else:
            added.add(document)
    found = store.get_open_case()
    is_other_open = is_stated and found is not None and found.id != opened
    if is_other_open:
        store.close()
    lost = store.mark_lost(added, withdrawn)
    if lost or is_other_open:
        log.error(
            "the disk has lost changes that were confirmed",
            code="STORE_CHANGES_LOST",
            documents=[
                f"{one.kind.value} {one.name!r} version {one.version} of {one.case_id}" for one in lost[:20]
            ],
            count=len(lost),
            open_case_closed=is_other_open,
            remedy="The documents are listed as damaged: do their steps again. Check the disk.",
        )
    return len(lost) + is_other_open


def _intact_changes(lines: Sequence[bytes]) -> Iterator[Mapping[str, object]]:
    """Yield the changes in lines whose sum the next line confirms."""
    for raw, following in pairwise(lines):
        if b'"changes"' in raw and f'"before":"{sha256_of(raw)}"'.encode() in following:
            yield from json.loads(raw)["changes"]
