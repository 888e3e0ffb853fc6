"""Compiles the tracker for this machine on two cores: `python -m server.loop.compiling`.

Numba stores compiled code beside the source (or in NUMBA_CACHE_DIR), so that this is needed once after an
installation or update. Several processes may start it at the same time: one compiles, the others wait.

Numba keys its cache by the file of the called function, not by the files of its callees, so that stale
machine code would run after a source change. `make` therefore deletes the cache before compiling, which costs
a minute after each update.
"""

import gc
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import filelock

from server.loop.parent import die_with_parent
from tracker.compiled import DISPATCHERS
from tracker.warm_up import Part, warm_up

# Both parts take about equally long. Each process reuses what the other has compiled before it.
PARTS_PER_PROCESS = ((Part.SEARCH,), (Part.FIT, Part.REST))
POLL_INTERVAL_S = 0.5
# Number of new objects after which Python collects garbage in a process that compiles; usually 700.
GARBAGE_THRESHOLD = 100_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """Progress of the compilation for this machine.

    Attributes:
        done: Number of compiled functions.
        total: Number of functions.
    """

    done: int
    total: int

    @property
    def is_complete(self) -> bool:
        """Whether all functions are compiled."""
        return self.done == self.total


def progress() -> Progress:
    """Return the progress, from the files of Numba's cache. Takes a few milliseconds."""
    return Progress(done=sum(_is_compiled(loop) for loop in DISPATCHERS), total=len(DISPATCHERS))


def compile_tracker(on_progress: Callable[[Progress], None] = lambda _: None) -> None:
    """Compile missing functions, and return when done; a second caller waits for the first.

    Args:
        on_progress: called about twice a second.
    """
    if not progress().is_complete:
        with filelock.FileLock(_folder() / "coaxial-compiling.lock"):
            _compile(on_progress)
    # Repeated here, because an index entry may be lost if two processes write it at once; errors are raised.
    warm_up()


def _compile(on_progress: Callable[[Progress], None]) -> None:
    """Compile in two processes; do nothing if another process did it meanwhile."""
    if not progress().is_complete:
        children = [_child(share) for share in PARTS_PER_PROCESS]
        while any(child.poll() is None for child in children):
            on_progress(progress())
            time.sleep(POLL_INTERVAL_S)
    on_progress(progress())


def compile_parts(*names: str) -> None:
    """Compile these parts in this process, which ends with its parent."""
    die_with_parent()
    # Most of what the compiler creates stays. Searching it for garbage took a seventh of the time.
    gc.set_threshold(GARBAGE_THRESHOLD)
    warm_up(*(Part(name) for name in names))


def _child(parts: tuple[Part, ...]) -> subprocess.Popen[bytes]:
    code = f"from {__spec__.name} import compile_parts; compile_parts(*{list(map(str, parts))})"
    return subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.DEVNULL)  # noqa: S603  own code


def _folder() -> Path:
    """Return a cache folder that is writable for this process."""
    folder = Path(DISPATCHERS[0].stats.cache_path)
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _is_compiled(loop: object) -> bool:
    """Return whether the cache has an index for this function that is as new as its source."""
    function = loop.py_func  # pyrefly: ignore[missing-attribute]  # Numba's dispatcher
    source = Path(function.__code__.co_filename)
    name = f"{function.__module__.rpartition('.')[2]}.{function.__qualname__}-*.nbi"
    indexes = Path(loop.stats.cache_path).glob(name)  # pyrefly: ignore[missing-attribute]
    return any(index.stat().st_mtime >= source.stat().st_mtime for index in indexes)


if __name__ == "__main__":
    compile_tracker(lambda now: print(f"{now.done} of {now.total}", flush=True))  # noqa: T201
