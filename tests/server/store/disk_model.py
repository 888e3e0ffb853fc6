"""What a power cut leaves on the disk: only what was synced, and any part of the rest.

Each fsync of Python and each sync of SQLite is recorded: of a file its content, of a folder its entries.
SQLite calls the system itself, so that the methods of its files are replaced (`sqlite3_vfs`, by ctypes).
"""

import ctypes
import os
import random
import sqlite3
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

SECTOR_BYTES = 512
X_OPEN, X_SYNC = 5, 5
METHODS = 19  # version, and 18 functions
OPENED = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p
)
SYNCED = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int)


@dataclass(slots=True, kw_only=True)
class Disk:
    """The durable state of a folder.

    Attributes:
        root: the folder.
        syncs: number of syncs so far.
        before_sync: called before each; the power may be cut there.
    """

    root: Path
    syncs: int = 0
    before_sync: Callable[[], None] = lambda: None
    _contents: dict[int, bytes] = field(default_factory=dict)
    _descriptors: dict[int, int] = field(default_factory=dict)
    _entries: dict[int, dict[str, tuple[int, bool]]] = field(default_factory=dict)

    def sync(self, path: Path) -> None:
        """Record the content of a file, or the entries of a folder."""
        if not self._has(path):
            return
        found = path.stat()
        if found.st_ino not in self._descriptors:
            # An inode that is in use is not given to another file.
            self._descriptors[found.st_ino] = os.open(path, os.O_RDONLY)
        if stat.S_ISDIR(found.st_mode):
            self._entries[found.st_ino] = {
                one.name: (one.stat().st_ino, one.is_dir())
                for one in path.iterdir()
                # Shared memory, which SQLite makes again.
                if not one.name.endswith("-shm")
            }
        else:
            self._contents[found.st_ino] = path.read_bytes()
        self.syncs += 1

    def add_entry(self, path: Path) -> None:
        """Record that a file is in its folder, as SQLite does at the first sync of a journal."""
        if self._has(path):
            self._entries.setdefault(path.parent.stat().st_ino, {})[path.name] = (path.stat().st_ino, False)

    def close(self) -> None:
        """Release what is held of the folder."""
        for descriptor in self._descriptors.values():
            os.close(descriptor)

    def _has(self, path: Path) -> bool:
        return path == self.root or self.root in path.parents

    def write_cut(self, target: Path, rng: random.Random | None) -> None:
        """Write what is left after a power cut now.

        Without `rng` nothing that was not synced is there; with it, any sectors of it are.
        """
        current = {path.stat().st_ino: path for path in self.root.rglob("*") if path.is_file()}
        self._write_folder(self.root.stat().st_ino, target, current, rng)

    def _write_folder(
        self, inode: int, target: Path, current: dict[int, Path], rng: random.Random | None
    ) -> None:
        target.mkdir(mode=0o700, parents=True)
        for name, (inside, is_folder) in self._entries.get(inode, {}).items():
            if is_folder:
                self._write_folder(inside, target / name, current, rng)
                continue
            content = self._contents.get(inside, b"")
            if rng is not None and inside in current:
                content = _torn(content, current[inside].read_bytes(), rng)
            (target / name).write_bytes(content)


def _torn(durable: bytes, written: bytes, rng: random.Random) -> bytes:
    """Return a content of which any sectors that were written since the last sync are there."""
    persisted_ratio = rng.choice((0.1, 0.5, 0.9))
    length = rng.choice((len(durable), len(written)))
    sectors = []
    for at in range(0, length, SECTOR_BYTES):
        source = written if rng.random() < persisted_ratio else durable
        sectors.append(source[at : at + SECTOR_BYTES].ljust(min(SECTOR_BYTES, length - at), b"\0"))
    return b"".join(sectors)


@contextmanager
def recorded(disk: Disk) -> Iterator[None]:
    """Context manager that records all syncs of this process in a folder.

    Raises:
        LookupError: SQLite is not a library of its own here.
    """
    real_fsync = os.fsync

    def fsync(descriptor: int) -> None:
        path = Path(f"/proc/self/fd/{descriptor}").readlink()
        disk.before_sync()
        real_fsync(descriptor)
        disk.sync(path)

    os.fsync = fsync  # pyrefly: ignore[bad-assignment]  # only descriptors are given
    try:
        with _sqlite_recorded(disk):
            yield
    finally:
        os.fsync = real_fsync


@contextmanager
def _sqlite_recorded(disk: Disk) -> Iterator[None]:
    library = _library()
    library.sqlite3_vfs_find.restype = ctypes.c_void_p
    vfs = library.sqlite3_vfs_find(None)
    # Three integers, then pointers: next, name, data, xOpen.
    places = (ctypes.c_void_p * (X_OPEN + 1)).from_address(vfs)
    real_open, callbacks = places[X_OPEN], []
    opened_really = OPENED(real_open)

    def opened(own: int, name: int | None, file: int, flags: int, out: int) -> int:
        # The name is passed on as a pointer, because the file keeps it.
        status = int(opened_really(own, name, file, flags, out))
        if status == 0 and name:
            callbacks.append(_with_sync(file, Path(os.fsdecode(ctypes.string_at(name))), disk))
        return status

    replaced = OPENED(opened)
    places[X_OPEN] = ctypes.cast(replaced, ctypes.c_void_p).value
    try:
        yield
    finally:
        places[X_OPEN] = real_open


def _with_sync(file: int, path: Path, disk: Disk) -> tuple[object, object]:
    """Replace the method xSync of an open file; return what must outlive it."""
    pointer = ctypes.c_void_p.from_address(file)
    methods = (ctypes.c_void_p * METHODS).from_address(pointer.value or 0)
    own = (ctypes.c_void_p * METHODS)(*methods)
    synced_really = SYNCED(methods[X_SYNC])

    def synced(this: int, flags: int) -> int:
        disk.before_sync()
        status = int(synced_really(this, flags))
        disk.sync(path)
        if path.name.endswith(("-wal", "-journal")):
            disk.add_entry(path)
        return status

    callback = SYNCED(synced)
    own[X_SYNC] = ctypes.cast(callback, ctypes.c_void_p).value
    pointer.value = ctypes.addressof(own)
    return own, callback


def can_record() -> bool:
    """Return whether the syncs of SQLite can be recorded here."""
    try:
        _library()
    except (LookupError, OSError):
        return False
    return True


def _library() -> ctypes.CDLL:
    """Return the library that the module sqlite3 has loaded."""
    sqlite3.connect(":memory:").close()
    for line in Path("/proc/self/maps").read_text(encoding="utf-8").splitlines():
        if "libsqlite3" in line:
            return ctypes.CDLL(line.split()[-1])
    library = ctypes.CDLL(None)
    if not hasattr(library, "sqlite3_vfs_find"):
        raise LookupError("SQLite is not a library of its own here")
    return library
