"""Compiles the tracker for this machine, on two of its cores: `python -m server.loop.compiling`.

Numba keeps what is compiled beside the source (or in NUMBA_CACHE_DIR), so this is needed once after an
installation or an update. Several processes may ask for it at the same time: one does it, the others wait.

Numba keys its cache by the file of the called function, not by the files of the functions that it calls in
turn; after a change of sources old machine code would go on running. So `make` deletes the cache before it
compiles again, which costs a minute after each update.
"""

import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import filelock

from server.loop.parent import die_with_parent
from tracker.compiled import LOOPS
from tracker.warm_up import Part, warm_up

# Both take about as long. Each finds compiled what the other one has reached before it.
SHARES = ((Part.SEARCH,), (Part.FIT, Part.REST))
LOOK_EVERY_S = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """How much of the tracker is compiled for this machine.

    Attributes:
        done: how many of its loops.
        total: how many there are.
    """

    done: int
    total: int

    @property
    def is_complete(self) -> bool:
        """Whether nothing is left to be compiled."""
        return self.done == self.total


def progress() -> Progress:
    """How much of the tracker is compiled, judged by the files of Numba's cache. Costs some milliseconds."""
    return Progress(done=sum(_is_compiled(loop) for loop in LOOPS), total=len(LOOPS))


def compile_tracker(tell: Callable[[Progress], None] = lambda _: None) -> None:
    """Compile what is not compiled yet, and return when all is; a second caller waits for the first.

    Args:
        tell: is told about twice a second how far it is.
    """
    if not progress().is_complete:
        with filelock.FileLock(_folder() / "coaxial-compiling.lock"):
            _compile(tell)
    # What two processes wrote to the same index at once may have lost an entry; a fault is raised here.
    warm_up()


def _compile(tell: Callable[[Progress], None]) -> None:
    """Compile side by side; nothing is left where somebody else did it meanwhile."""
    if not progress().is_complete:
        children = [_child(share) for share in SHARES]
        while any(child.poll() is None for child in children):
            tell(progress())
            time.sleep(LOOK_EVERY_S)
    tell(progress())


def compile_parts(*names: str) -> None:
    """Compile these parts in this process, which ends with the one that started it."""
    die_with_parent()
    warm_up(*(Part(name) for name in names))


def _child(parts: tuple[Part, ...]) -> subprocess.Popen[bytes]:
    code = f"from {__spec__.name} import compile_parts; compile_parts(*{list(map(str, parts))})"
    return subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.DEVNULL)  # noqa: S603  own code


def _folder() -> Path:
    """Where the cache of one loop lies; there this process may write."""
    folder = Path(LOOPS[0].stats.cache_path)
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _is_compiled(loop: object) -> bool:
    """Whether the cache has an index for this loop that is as new as its source."""
    function = loop.py_func  # type: ignore[attr-defined]  # Numba's dispatcher
    source = Path(function.__code__.co_filename)
    name = f"{function.__module__.rpartition('.')[2]}.{function.__qualname__}-*.nbi"
    indexes = Path(loop.stats.cache_path).glob(name)  # type: ignore[attr-defined]
    return any(index.stat().st_mtime >= source.stat().st_mtime for index in indexes)


if __name__ == "__main__":
    compile_tracker(lambda now: print(f"{now.done} of {now.total}", flush=True))  # noqa: T201
