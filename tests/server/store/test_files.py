"""Files of a case: complete or absent, whatever happens."""

import errno
import hashlib
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from server.store import CaseStore, DocumentKind, Home, NotFound, StoreError, files
from tracker.errors import InvalidInput


@pytest.fixture
def case_id(store: CaseStore) -> str:
    return store.create("one").id


def put_file(store: CaseStore, case_id: str, content: bytes = b"content") -> str:
    with store.new_file(case_id, ".bin") as new:
        new.path.write_bytes(content)
    return new.stored.id


def test_a_file_is_there_with_its_size_and_sum(store: CaseStore, case_id: str) -> None:
    stored = store.file(case_id, put_file(store, case_id, b"abc" * 10**6))
    assert stored.size_bytes == 3 * 10**6
    assert stored.sha256 == hashlib.sha256(b"abc" * 10**6).hexdigest()
    assert stored.path.read_bytes() == b"abc" * 10**6
    assert stored.path.stat().st_mode & 0o222 == 0
    assert store.files(case_id) == (stored,)
    assert store.verify(case_id) == ()


def test_a_file_that_was_not_finished_is_nowhere(store: CaseStore, home: Home, case_id: str) -> None:
    def half() -> None:
        with store.new_file(case_id, ".bin") as new:
            new.path.write_bytes(b"half")
            with pytest.raises(RuntimeError):
                _ = new.stored
            assert store.files(case_id) == ()
            raise KeyError

    with pytest.raises(KeyError):
        half()
    assert store.files(case_id) == ()
    assert list((home.cases / case_id).iterdir()) == []


def test_a_full_disk_while_a_file_is_written_is_reported(store: CaseStore, case_id: str) -> None:
    def write(code: int) -> None:
        with store.new_file(case_id, ".bin"):
            raise OSError(code, os.strerror(code))

    with pytest.raises(StoreError) as full:
        write(errno.ENOSPC)
    assert full.value.code == "STORE_FULL"
    # An error unrelated to the disk is the caller's.
    with pytest.raises(ConnectionResetError):
        write(errno.ECONNRESET)
    assert store.files(case_id) == ()


@pytest.mark.parametrize("suffix", ["", "npy", ".", "./x", ".a/../b", ".NPY", ".a.b.c", ".\0"])
def test_a_strange_ending_is_rejected(store: CaseStore, case_id: str, suffix: str) -> None:
    with pytest.raises(InvalidInput), store.new_file(case_id, suffix):
        pass


def test_a_document_names_only_files_that_are_there(store: CaseStore, case_id: str) -> None:
    file = put_file(store, case_id)
    other = store.create("two").id
    for case, name in ((other, file), (case_id, "0" * 16 + ".bin"), (case_id, "../x")):
        with pytest.raises(NotFound):
            store.put(case, DocumentKind.CT, "a", {}, made_by="ito", files=[name])
    assert store.put(case_id, DocumentKind.CT, "a", {}, made_by="ito", files=[file]).files == (file,)


def spoiled(change: Callable[[Path], object]) -> Callable[[Path], None]:
    def spoil(path: Path) -> None:
        path.chmod(0o600)
        change(path)

    return spoil


@pytest.mark.parametrize(
    ("spoil", "problem"),
    [
        pytest.param(spoiled(Path.unlink), "missing", id="missing"),
        pytest.param(spoiled(lambda path: path.write_bytes(b"conten")), "size", id="shorter"),
        pytest.param(spoiled(lambda path: path.write_bytes(b"Content")), "content", id="another-byte"),
    ],
)
def test_a_damaged_file_is_reported_with_what_needs_it(
    store: CaseStore, case_id: str, spoil: Callable[[Path], None], problem: str
) -> None:
    sound, file = put_file(store, case_id), put_file(store, case_id)
    store.put(case_id, DocumentKind.CT, "main", {}, made_by="ito", files=[sound, file])
    spoil(store.file(case_id, file).path)
    (damage,) = store.verify(case_id)
    titles = tuple(title["en"] for title in damage.documents)
    assert (damage.file_id, damage.problem, titles) == (file, problem, ("ct 'main' version 1",))


def test_files_that_the_database_does_not_know_are_left_alone(tmp_path: Path) -> None:
    with Home(tmp_path) as home:
        with CaseStore(home) as store:
            case = store.create("one")
            put_file(store, case.id)
        strays = [home.cases / case.id / "0123456789abcdef.bin", home.cases / "0123456789abcdef" / "x.bin"]
        for stray in strays:
            stray.parent.mkdir(exist_ok=True)
            stray.write_bytes(b"from a newer database")
        with CaseStore(home) as store:
            assert store.verify(case.id) == ()
        assert all(stray.exists() for stray in strays)


STEPS = ("make_folder", "commit_file", "_record", "fsync", "replace", "sync_path")


class Copies:
    """The home folder as a power failure would leave it, after each step of the store on disk."""

    def __init__(self, home: Home, to: Path) -> None:
        self._home, self._to = home, to
        self.taken: list[Path] = []

    def take(self) -> None:
        copy = self._to / f"{len(self.taken)}"
        shutil.copytree(self._home.folder, copy)
        self.taken.append(copy)


@pytest.fixture
def copies(home: Home, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Copies]:
    copies = Copies(home, tmp_path / "copies")

    def around(owner: object, name: str) -> None:
        real = getattr(owner, name)

        def step(*given: object, **named: object) -> object:
            copies.take()
            done = real(*given, **named)
            copies.take()
            return done

        monkeypatch.setattr(owner, name, step)

    around(os, "fsync")
    around(files, "make_folder")
    around(files, "sync_path")
    around(Path, "replace")
    around(Path, "unlink")
    around(shutil, "rmtree")
    yield copies
    monkeypatch.undo()


def test_power_lost_between_any_two_steps_costs_nothing_that_was_confirmed(
    store: CaseStore, case_id: str, copies: Copies
) -> None:
    first = put_file(store, case_id, b"first")
    confirmed = len(copies.taken)
    put_file(store, case_id, b"second")
    archive = store.export_case(case_id)
    after_second = len(copies.taken)
    store.import_archive(archive.path, by="M. Ito")
    after_copy = len(copies.taken)
    store.delete(case_id, confirm="one")
    copies.take()
    assert (confirmed, after_second - confirmed, after_copy - after_second) > (5, 5, 5)
    for number, copy in enumerate(list(copies.taken)):
        with Home(copy) as home, CaseStore(home) as again:
            there = {case.name for case in again.list()}
            assert ("one" in there) or number >= after_copy, number
            # A deletion is confirmed at its end, and effective from its first commit.
            assert ("one" not in there) or number <= after_copy, number
            assert (f"Case {case_id[:6]}" in there) is (number >= after_copy), number
            for case in again.list():
                assert again.verify(case.id) == (), number
                contents = {file.path.read_bytes() for file in again.files(case.id)}
                assert contents >= {b"first"} or number < confirmed, number
                assert contents >= {b"first", b"second"} or number < after_second, number
            on_disk = {path.name for path in home.cases.rglob("*") if path.is_file()}
            assert on_disk == {file.id for case in again.list() for file in again.files(case.id)}, number
    assert first


def test_a_file_that_the_disk_changed_is_not_given_to_anybody(store: CaseStore, case_id: str) -> None:
    with store.new_file(case_id, ".npy") as new:
        new.path.write_bytes(bytes(100_000))
    path = store.file(case_id, new.stored.id).path
    content = bytearray(path.read_bytes())
    content[70_001] ^= 4
    path.chmod(0o600)
    path.write_bytes(content)
    with CaseStore(store.home) as again, pytest.raises(StoreError, match="its SHA-256 differs") as damaged:
        again.file(case_id, new.stored.id)
    assert damaged.value.code == "FILE_DAMAGED"
