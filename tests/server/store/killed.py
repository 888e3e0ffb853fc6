"""Kill a writing store with `kill -9` at random times: a child reports what was confirmed until it is killed.

    PYTHONPATH=. python -m tests.server.store.killed --times 200 [--fault acknowledge-early | name-early]

After each kill the folder is opened as at the next start, and everything confirmed must exist. --fault
introduces a deliberate fault, which must be found.

"""

import argparse
import contextlib
import hashlib
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from sqlalchemy.orm import Session

from server.store import CaseStore, Document, DocumentKind, Home, documents, files

REPOSITORY = Path(__file__).parents[3]
FAULTS = ("none", "acknowledge-early", "name-early")


@dataclass(slots=True)
class Promised:
    """Everything confirmed so far.

    Attributes:
        cases: names by id.
        documents: content and version by case and document id.
        files: SHA-256 by case and file id.
        deleted: deleted cases.

    """

    cases: dict[str, str] = field(default_factory=dict)
    documents: dict[tuple[str, str], tuple[int, object]] = field(default_factory=dict)
    files: dict[tuple[str, str], str] = field(default_factory=dict)
    deleted: set[str] = field(default_factory=set)

    def note(self, line: str) -> None:
        """Record one line of the child."""
        said = json.loads(line)
        what, case_id = said["what"], said["case"]
        if what == "case":
            self.cases[case_id] = said["name"]
        elif what == "document":
            self.documents[case_id, said["id"]] = (said["version"], said["content"])
        elif what == "file":
            self.files[case_id, said["id"]] = said["sha256"]
        elif what == "leaving":
            # Begun and possibly done: neither its presence nor its absence is promised.
            self.cases.pop(case_id, None)
        elif what == "gone":
            self.deleted.add(case_id)

    @property
    def count(self) -> int:
        """Number of confirmed changes."""
        return len(self.cases) + len(self.documents) + len(self.files) + len(self.deleted)


def broken_promises(folder: Path, promised: Promised) -> Iterator[str]:
    """Open the folder as at a start; return differences from what was confirmed."""
    with Home(folder) as home, CaseStore(home) as store:
        there = {case.id: case for case in store.list()}
        for case_id, name in promised.cases.items():
            if case_id not in there or there[case_id].name != name:
                yield f"case {case_id} is missing"
        yield from (f"case {case_id} is there again" for case_id in promised.deleted if case_id in there)
        for (case_id, document_id), (version, content) in promised.documents.items():
            if case_id in promised.cases and case_id in there:
                found = {entry.heading.id for entry in store.outline(case_id)}
                if document_id not in found:
                    yield f"document {document_id} version {version} is missing"
                elif store.document(case_id, document_id).content != content:
                    yield f"document {document_id} has another content"
        for case_id in there:
            yield from (damage.why.message["en"] for damage in store.verify(case_id))
        whole = {(case_id, file.id): file.sha256 for case_id in there for file in store.files(case_id)}
        for (case_id, file_id), sha256 in promised.files.items():
            if case_id in promised.cases and whole.get((case_id, file_id)) != sha256:
                yield f"file {file_id} is missing"
        on_disk = {(path.parent.name, path.name) for path in home.cases.rglob("*") if path.is_file()}
        yield from (f"{stray} was left behind" for stray in sorted(on_disk - whole.keys()))
        yield from (f"{path.name} was left behind" for path in home.temporary.iterdir())


class Writers:
    """Children that write, forked from one process with everything loaded; each is killed."""

    def __init__(self, fault: str = "none") -> None:
        self._forker = subprocess.Popen(
            [sys.executable, "-m", "tests.server.store.killed", "--forker", "--fault", fault],
            env={**os.environ, "PYTHONPATH": str(REPOSITORY)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )

    def kill_once(
        self, folder: Path, promised: Promised, *, after_changes: int, after_s: float, seed: int
    ) -> None:
        """Let a child make this many changes, kill it after this delay, and record its lines."""
        requested, said = self._forker.stdin, self._forker.stdout
        assert requested is not None
        assert said is not None
        requested.write(f"{json.dumps([str(folder), seed])}\n".encode())
        requested.flush()
        pid = int(said.readline())
        lines = [said.readline().decode() for _ in range(after_changes)]
        # Not a wait for an event: the time of the kill is the variable.
        time.sleep(after_s)
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
        while not (line := said.readline().decode()).startswith("end"):
            lines.append(line)
        assert line == f"end {signal.SIGKILL}\n", "the child ended by itself, with an error"
        for line in lines:
            # An incomplete line does not count.
            with contextlib.suppress(json.JSONDecodeError):
                promised.note(line)

    def __enter__(self) -> "Writers":
        return self

    def __exit__(self, *ending: object) -> None:
        self._forker.kill()
        self._forker.communicate()


def fork_for_ever(*, fault: str) -> None:
    """Fork a child for each line of input, and print how it ended."""
    for line in sys.stdin:
        folder, seed = json.loads(line)
        sys.stdout.flush()
        pid = os.fork()
        if pid == 0:
            _say_line(str(os.getpid()))
            try:
                write_for_ever(Path(folder), seed=seed, fault=fault)
            except Exception:  # noqa: BLE001  a child of a fork must not go on as its parent
                traceback.print_exc()
            os._exit(1)
        _, status = os.waitpid(pid, 0)
        # On its own line, even if the child was killed within one.
        _say_line(f"\nend {os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0}")


def write_for_ever(folder: Path, *, seed: int, fault: str) -> None:
    """The child: makes changes, and prints each after the store has confirmed it."""
    if fault == "acknowledge-early":
        _acknowledge_before_commit()
    if fault == "name-early":
        _record_before_naming()
    rng = random.Random(seed)
    with Home(folder) as home, CaseStore(home) as store:
        cases = [case.id for case in store.list()]
        while True:
            act = rng.random()
            if not cases or (act < 0.1 and len(cases) < 6):
                case = store.create(f"case {rng.random()}")
                cases.append(case.id)
                _say("case", case.id, name=case.name)
            elif act < 0.15 and len(cases) > 2:
                case_id = cases.pop(0)
                _say("leaving", case_id)
                store.delete(case_id, confirm=store.get(case_id).name)
                _say("gone", case_id)
            elif act < 0.2:
                archive = store.export_case(rng.choice(cases), with_identity=True)
                case = store.import_archive(archive.path, by="M. Ito")
                archive.path.unlink()
                cases.append(case.id)
                _say("case", case.id, name=case.name)
            elif act < 0.5:
                _write_file(store, rng.choice(cases), rng)
            else:
                _write_document(store, rng.choice(cases), rng)


def _write_file(store: CaseStore, case_id: str, rng: random.Random) -> None:
    content = rng.randbytes(rng.randrange(1, 2_000_000))
    with store.new_file(case_id, ".bin") as new, new.path.open("wb") as stream:
        for at in range(0, len(content), 65_536):
            stream.write(content[at : at + 65_536])
        stream.flush()
    _say("file", case_id, id=new.stored.id, sha256=hashlib.sha256(content).hexdigest())


def _write_document(store: CaseStore, case_id: str, rng: random.Random) -> None:
    name, content = (
        f"n{rng.randrange(3)}",
        {"number": rng.random(), "text": "x" * rng.randrange(20_000)},
    )
    document = store.put(case_id, DocumentKind.PLAN, name, content, made_by="child")
    _say_document(document)


def _say_document(document: Document) -> None:
    _say("document", document.case_id, id=document.id, version=document.version, content=document.content)


def _acknowledge_before_commit() -> None:
    """A faulty store that confirms before it has stored."""

    def add_document(session: Session, case_id: str, new: documents.NewDocument, *, now: str) -> Document:
        document = real(session, case_id, new, now=now)
        _say_document(document)
        return document

    real, documents.add_document = documents.add_document, add_document


def _record_before_naming() -> None:
    """A faulty store that records a file as complete before it has its name."""

    def commit_file(part: Path, _whole: Path) -> tuple[int, str]:
        with part.open("rb") as stream:
            return files.size_and_sha256(stream.fileno())

    def record(database: object, case_id: str, file_id: str, size_bytes: int, sha256: str) -> object:
        stored = real_record(database, case_id, file_id, size_bytes, sha256)  # pyrefly: ignore[bad-argument-type]  # a fault
        real_settle(stored.path.with_name(f"{files.UNFINISHED}{file_id}"), stored.path)
        return stored

    real_settle, real_record = files.commit_file, files._record
    files.commit_file, files._record = commit_file, record  # pyrefly: ignore[bad-assignment]  # a fault


def _say(what: str, case_id: str, **more: object) -> None:
    _say_line(json.dumps({"what": what, "case": case_id, **more}))


def _say_line(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def main() -> None:
    """Run the kills and print the results."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--times", type=int, default=200)
    parser.add_argument("--max-changes", type=int, default=10, help="before a kill")
    parser.add_argument("--longest-s", type=float, default=0.1, help="after the last of them")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fault", choices=FAULTS, default="none")
    parser.add_argument("--forker", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.forker:
        fork_for_ever(fault=given.fault)
        return
    rng, found, confirmed = random.Random(given.seed), [], 0
    with tempfile.TemporaryDirectory() as folder, Writers(given.fault) as writers:
        promised = Promised()
        for number in range(given.times):
            if number % 20 == 0:
                confirmed += promised.count
                promised, home = Promised(), Path(folder) / f"{number}"
            seed = given.seed * 1_000_000 + number
            changes, after_s = rng.randrange(given.max_changes), rng.uniform(0, given.longest_s)
            writers.kill_once(home, promised, after_changes=changes, after_s=after_s, seed=seed)
            found += [f"kill {number}: {one}" for one in broken_promises(home, promised)]
        confirmed += promised.count
    sys.stdout.write("".join(f"{one}\n" for one in found))
    sys.stdout.write(f"{given.times} kills, {confirmed} confirmed changes, {len(found)} promises broken\n")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
