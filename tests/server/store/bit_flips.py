"""Flip single bits of a closed database: what is read is what was stored, or it is named as damaged.

    PYTHONPATH=. python -m tests.server.store.bit_flips --flips 2000 [--seed 1] [--journal]
        [--fault no-checksum]

The bits are anywhere in the file, or with --journal in the journal that a crash leaves, which has the newest
changes. After each flip a store opens the folder as at the next start, everything is read through its
interface, a document is added and withdrawn, and what is intact is exported and imported. --fault introduces
a deliberate fault, which must be found.
"""

import argparse
import random
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from unittest.mock import patch

from server.security.audit import AuditLog, Entry, mark_lost_changes
from server.security.person import SERVER
from server.store import (
    Case,
    CaseStore,
    Current,
    Document,
    DocumentKind,
    Home,
    StoredFile,
    StoreError,
    checksums,
)
from tracker.errors import NavigationError

CAMERA, CT, PLAN, REGISTRATION = (
    DocumentKind.CAMERA,
    DocumentKind.CT,
    DocumentKind.PLAN,
    DocumentKind.REGISTRATION,
)
FAULTS = ("none", "no-checksum", "no-newest-version", "no-audit")


@dataclass(frozen=True, slots=True, kw_only=True)
class Stored:
    """What a store answered before a flip.

    Attributes:
        cases: all cases; without the time of the last change where that may be lost with the change.
        documents: all versions of all documents, in their order, by case.
        current: ids of the valid documents.
        files: files by case.
        opened: id of the open case; None if none is open.
    """

    cases: dict[str, Case]
    documents: dict[str, list[Document]]
    current: set[str]
    files: dict[str, tuple[StoredFile, ...]]
    opened: str | None

    @classmethod
    def of(cls, store: CaseStore) -> "Stored":
        """Read everything from an intact store."""
        cases = {one.id: one for one in store.list()}
        outlines = {one: store.outline(one) for one in cases}
        return cls(
            cases=cases,
            documents={
                one: [store.document(one, entry.heading.id) for entry in outline]
                for one, outline in outlines.items()
            },
            current={
                entry.heading.id
                for outline in outlines.values()
                for entry in outline
                if isinstance(entry.validity, Current)
            },
            files={one: store.files(one) for one in cases},
            opened=None if (opened := store.get_open_case()) is None else opened.id,
        )


@dataclass(slots=True, kw_only=True)
class Flips:
    """Result of the flips.

    Attributes:
        outcomes: number of flips by outcome: "no effect", "named", "start rejected: CODE".
        silent: what differed and was not named, and what ended in an error that is not for people.
    """

    outcomes: Counter[str] = field(default_factory=Counter)
    silent: list[str] = field(default_factory=list)


def write_cases(store: CaseStore, *, versions: int = 3) -> None:
    """Write two cases with documents that depend on each other, withdrawals and files."""
    for name in ("L3 left", "L4"):
        case = store.create(name).id
        with store.new_file(case, ".npy") as new:
            new.path.write_bytes(bytes(100))
        camera = store.put(case, CAMERA, "main", {"rms_px": 0.25}, made_by="M. Ito")
        ct = store.put(case, CT, "main", {"size": [64, 64, 40]}, made_by="M. Ito", files=[new.stored.id])
        for version in range(versions):
            entries = [[round(0.37 * version + 0.01 * k, 3), -4.125 * k, 88.0 + k] for k in range(60)]
            content = {"vertebra": "L3", "entries_mm": entries, "diameter_mm": 5.5 + version}
            plan = store.put(case, PLAN, "main", content, made_by="A. Kato", depends_on=[ct.id])
        on = [plan.id, camera.id]
        registered = store.put(case, REGISTRATION, "L3", {"rms_mm": 0.41}, made_by="M. Ito", depends_on=on)
        store.put(case, DocumentKind.CHECK, "L3", {"mm": 0.6}, made_by="M. Ito", depends_on=[registered.id])
        tool = store.put(case, DocumentKind.TOOL, "drill", {"tip_mm": [0, 0, 120.5]}, made_by="M. Ito")
        store.withdraw(tool, by="A. Kato", reason="the drill was changed")
        store.open(case)


def change_cases(store: CaseStore) -> None:
    """Change all cases: new versions, a withdrawal, a new file, and another open case."""
    for case in (one.id for one in store.list()):
        plan = store.latest(case, PLAN, "main")
        camera = store.latest(case, CAMERA, "main")
        assert plan is not None
        assert camera is not None
        with store.new_file(case, ".npy") as new:
            new.path.write_bytes(bytes(200))
        ct = store.put(case, CT, "main", {"size": [9, 9, 9]}, made_by="A. Kato", files=[new.stored.id])
        plan = store.put(case, PLAN, "main", {"vertebra": "L4"}, made_by="A. Kato", depends_on=[ct.id])
        store.put(case, PLAN, "right", {"vertebra": "L4"}, made_by="A. Kato", depends_on=[ct.id])
        store.put(case, REGISTRATION, "L4", {}, made_by="M. Ito", depends_on=[plan.id, camera.id])
        store.withdraw(camera, by="A. Kato", reason="the camera was moved")
    opened = store.get_open_case()
    store.open(next(one.id for one in store.list() if one != opened))


def flip_bits(folder: Path, *, flips: int, seed: int, versions: int = 3, in_journal: bool = False) -> Flips:
    """Write cases, and flip one bit after the other."""
    with Home(folder / "written") as home:
        audit = AuditLog(folder / "written" / "security")
        with CaseStore(home) as store:
            store.set_change_listener(audit.record_change)
            write_cases(store, versions=versions)
            stored = Stored.of(store)
        with CaseStore(home) as store:
            if in_journal:
                store.set_change_listener(audit.record_change)
                change_cases(store)
                stored = Stored.of(store)
                cases = {key: replace(case, changed_at="") for key, case in stored.cases.items()}
                stored = replace(stored, cases=cases)
            # As a crash leaves it: with a journal, while the database is open.
            shutil.copytree(folder / "written", folder / "intact")
    name = f"{home.database.name}-wal" if in_journal else home.database.name
    content = (folder / "intact" / name).read_bytes()
    result, rng = Flips(), random.Random(seed)
    for _ in range(flips):
        bit = rng.randrange(8 * len(content))
        changed = bytearray(content)
        changed[bit // 8] ^= 1 << bit % 8
        shutil.copytree(folder / "intact", folder / "flipped")
        (folder / "flipped" / name).write_bytes(changed)
        try:
            outcome = _outcome(folder / "flipped", stored)
        except Exception as error:  # noqa: BLE001  any other error would be an internal error for the user
            outcome = f"{type(error).__name__}: {str(error)[:200]}"
        if outcome in {"no effect", "named"} or outcome.startswith("start rejected"):
            result.outcomes[outcome] += 1
        else:
            result.silent.append(f"bit {bit % 8} of byte {bit // 8} of {len(content)}: {outcome}")
        shutil.rmtree(folder / "flipped")
    return result


def _outcome(folder: Path, stored: Stored) -> str:
    with Home(folder) as home:
        try:
            opened = CaseStore(home)
        except NavigationError as error:
            return f"start rejected: {error.code}"
        with opened as store:
            audit = AuditLog(folder / "security")
            store.set_change_listener(audit.record_change)
            audit.append(Entry(who=SERVER, what="start"))
            try:
                mark_lost_changes(store, audit)
                named = sum(_named(store, stored))
                _move_intact(store, stored)
            except _SilentError as silent:
                return str(silent)
            return "named" if named else "no effect"


class _SilentError(Exception):
    """Something was read that was not stored, and nothing names it."""


def _named(store: CaseStore, stored: Stored) -> Iterator[bool]:
    """Yield for each of the things that are read whether it is named as damaged."""
    # Files have the path of another folder.
    listed = {one.id: one for one in store.list()}
    damaged = [one for one in listed.values() if one.is_damaged]
    yield bool(damaged)
    for case_id, case in stored.cases.items():
        found = listed.get(case_id)
        if found is not None and not case.changed_at:
            found = replace(found, changed_at="")
        if found != case and not damaged:
            raise _SilentError(f"{case} became {found}")
        if found != case:
            continue
        try:
            yield from _named_documents(store, stored, case_id)
            yield from _named_files(store, stored, case_id)
            if case_id == next(iter(stored.cases)):
                yield bool(store.verify(case_id))
                yield from _changes(store, case_id)
        except NavigationError:
            yield True
    opened = store.get_open_case()
    yield opened is None
    if opened is not None and stored.cases.get(opened.id) is None:
        raise _SilentError(f"the open case became {opened}")
    if opened is not None and opened.id != stored.opened:
        raise _SilentError("another case is open")


def _named_documents(store: CaseStore, stored: Stored, case_id: str) -> Iterator[bool]:
    documents = {one.id: one for one in stored.documents[case_id]}
    outline = store.outline(case_id)
    lost = {
        (one.heading.kind, one.heading.name, one.heading.version) for one in outline if one.heading.is_damaged
    }
    yield bool(lost)
    for entry in outline:
        if isinstance(entry.validity, Current) and entry.heading.id not in stored.current:
            raise _SilentError(f"{entry.heading.title} became valid")
    seen = {entry.heading.id for entry in outline if not entry.heading.is_damaged}
    for document in documents.values():
        if document.id not in seen and (document.kind, document.name, document.version) not in lost:
            raise _SilentError(f"{document.title} is missing")
    for kind, name in {(one.kind, one.name) for one in documents.values()}:
        try:
            for read in store.history(case_id, kind, name):
                expected = documents.get(read.id)
                if expected is not None and expected.withdrawn and read.withdrawn:
                    # A lost withdrawal is repeated later.
                    expected = replace(expected, withdrawn=read.withdrawn)
                if expected != read:
                    raise _SilentError(f"{read.title} was changed")
            current = store.current(case_id, kind, name)
        except NavigationError:
            continue
        if current.id not in stored.current:
            raise _SilentError(f"{current.title} became current")


def _named_files(store: CaseStore, stored: Stored, case_id: str) -> Iterator[bool]:
    for file in stored.files[case_id]:
        read = store.file(case_id, file.id)
        if (read.size_bytes, read.sha256, read.made_at) != (file.size_bytes, file.sha256, file.made_at):
            raise _SilentError(f"the file {file.id} was changed")
        yield False


def _move_intact(store: CaseStore, stored: Stored) -> None:
    """Export what is intact of the cases and import it: as much is valid, and as much is named as damaged."""
    for case_id in stored.cases:
        try:
            archive = store.export_case(case_id, with_identity=True, without_damaged=True)
        except NavigationError as error:
            if error.code not in {"CASE_DAMAGED", "CASE_UNKNOWN"}:
                raise _SilentError(f"what is intact cannot be exported: {error.message}") from error
            continue
        try:
            again = store.import_archive(archive.path, by="M. Ito").id
        except StoreError:
            # With damaged names of tables nothing can be written, as a user is told.
            continue
        finally:
            archive.path.unlink()
        before, after = _described(store, case_id), _described(store, again)
        if before != after:
            raise _SilentError(f"the import has {after} in place of {before}")


def _described(store: CaseStore, case_id: str) -> list[object]:
    headings = [
        (one.heading.title, one.heading.is_damaged, isinstance(one.validity, Current))
        for one in store.outline(case_id)
    ]
    return [*sorted(headings), len(store.verify(case_id))]


def _changes(store: CaseStore, case_id: str) -> Iterator[bool]:
    """Change something, as a user would, who may be told that this is impossible."""
    added = store.put(case_id, PLAN, "main", {"vertebra": "L3"}, made_by="M. Ito")
    if store.latest(case_id, PLAN, "main") != added:
        raise _SilentError("the added plan is not the newest one")
    store.withdraw(added, by="M. Ito", reason="wrong level")
    if store.latest(case_id, PLAN, "main") is not None:
        raise _SilentError("the withdrawal was lost")
    yield False


@contextmanager
def fault_of(name: str) -> Iterator[None]:
    """Context manager for a store with a deliberate fault."""
    if name == "no-checksum":
        with patch.object(checksums, "_checksum", lambda *_: "0" * 64):
            yield
    elif name == "no-newest-version":
        with patch("server.store.validity.newest_version", lambda intact, _: intact):
            yield
    elif name == "no-audit":
        with patch(f"{__name__}.mark_lost_changes", lambda *_: None):
            yield
    else:
        yield


def main() -> int:
    """Run the flips and print the result."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--flips", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--versions", type=int, default=3, help="of each plan")
    parser.add_argument("--journal", action="store_true", help="flip bits of the journal after a crash")
    parser.add_argument("--fault", choices=FAULTS, default="none")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, fault_of(given.fault):
        result = flip_bits(
            Path(folder),
            flips=given.flips,
            seed=given.seed,
            versions=given.versions,
            in_journal=given.journal,
        )
    sys.stdout.write("".join(f"{one}\n" for one in result.silent[:50]))
    counts = ", ".join(f"{count} {outcome}" for outcome, count in sorted(result.outcomes.items()))
    sys.stdout.write(f"{given.flips} flips: {counts}, {len(result.silent)} silent or internal errors\n")
    return 1 if result.silent else 0


if __name__ == "__main__":
    sys.exit(main())
