"""Cut the power of a writing store at each sync: what was confirmed must be there at the next start.

    PYTHONPATH=. python -m tests.server.store.power_cut --changes 200 [--fault no-sync]

At each sync the folder is written as a disk would have it after a power cut: without anything that was not
synced, and with any sectors of it. Then it is opened as at the next start. --fault introduces a deliberate
fault, which must be found.
"""

import argparse
import json
import random
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from unittest.mock import patch

from server.store import database, files, home
from tests.server.store import killed
from tests.server.store.disk_model import Disk, recorded
from tests.server.store.killed import Promised, broken_promises, write_for_ever

FAULTS = ("none", "no-sync", "no-folder-sync", "no-commit-sync")


class EnoughChanges(Exception):
    """The store has made all changes."""


@dataclass(slots=True, kw_only=True)
class PowerCuts:
    """Result of the cuts.

    Attributes:
        changes: number of changes that the store confirmed.
        cuts: number of cuts.
        broken: what was confirmed and is not there, or was left behind.
    """

    changes: int = 0
    cuts: int = 0
    broken: list[str] = field(default_factory=list)


def cut_power(folder: Path, *, changes: int, seed: int, share_ratio: float = 1.0) -> PowerCuts:
    """Let a store make changes, and cut the power at a share of its syncs, in two ways each.

    Raises:
        LookupError: as `recorded`.
    """
    result, promised, rng = PowerCuts(), Promised(), random.Random(seed)
    real, left = folder / "real", list[Path]()
    real.mkdir()

    def cut() -> None:
        # Another database must not be opened here, inside of a call of SQLite.
        if rng.random() < share_ratio:
            for torn in (None, rng):
                left.append(folder / f"cut-{result.cuts}")
                disk.write_cut(left[-1], torn)
                result.cuts += 1

    def confirmed(line: str) -> None:
        disk.before_sync = lambda: None
        for one in left:
            result.broken += [
                f"{one.name} after {result.changes} changes: {why}" for why in _broken(one, promised)
            ]
            shutil.rmtree(one)
        left.clear()
        promised.note(line)
        result.changes += json.loads(line)["what"] != "leaving"
        if result.changes >= changes:
            raise EnoughChanges
        disk.before_sync = cut

    disk = Disk(root=real, before_sync=cut)
    with recorded(disk), patch.object(killed, "_say_line", confirmed):
        try:
            write_for_ever(real, seed=seed, fault="none")
        except EnoughChanges:
            pass
        finally:
            disk.close()
    if disk.syncs < changes:
        raise LookupError(f"only {disk.syncs} syncs were recorded for {changes} changes")
    return result


def _broken(folder: Path, promised: Promised) -> list[str]:
    try:
        return list(broken_promises(folder, promised))
    except Exception as error:  # noqa: BLE001  a folder that cannot be opened breaks all promises
        return [f"{type(error).__name__}: {error}"]


@contextmanager
def fault_of(name: str) -> Iterator[None]:
    """Context manager for a store with a deliberate fault."""

    def none(_of: object) -> None:
        pass

    with ExitStack() as patches:
        replace: Callable[..., object] = lambda *given: patches.enter_context(patch.object(*given))  # noqa: E731
        if name == "no-sync":
            replace(files, "sync_file", none)
        if name == "no-folder-sync":
            replace(files, "sync_path", none)
            replace(home, "sync_path", none)
        if name == "no-commit-sync":
            replace(database, "PRAGMAS", (*database.PRAGMAS, "PRAGMA synchronous = NORMAL"))
        yield


def main() -> int:
    """Run the cuts and print the result."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--changes", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fault", choices=FAULTS, default="none")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, fault_of(given.fault):
        result = cut_power(Path(folder), changes=given.changes, seed=given.seed)
    sys.stdout.write("".join(f"{one}\n" for one in result.broken[:50]))
    sys.stdout.write(
        f"{result.cuts} cuts, {result.changes} confirmed changes, {len(result.broken)} promises broken\n"
    )
    return 1 if result.broken else 0


if __name__ == "__main__":
    sys.exit(main())
