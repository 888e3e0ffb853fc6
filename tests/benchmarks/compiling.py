"""Processor time of compiling the tracker, by part and by function: `python -m tests.benchmarks.compiling`.

Compiles everything in this process into an empty temporary cache, which takes minutes; the cache of the
tracker is neither read nor written. Numba's functions are in the table too: it stores none of them, so that
each process that compiles anything needs them again. A part is without what parts before it have compiled.

The time of a function is without its callees, but with optimising their code again where LLVM inlines it.
Times are comparable within a run: on a busy machine everything takes longer.
"""

import argparse
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Callable
from operator import itemgetter

import numba
from numba.core.codegen import CPUCodeLibrary
from numba.core.event import Event, Listener, register

from tests.benchmarks.tables import Table, number


class CompileTimes(Listener):
    """Processor time of each function that Numba compiles, in s, and of LLVM in it.

    Attributes:
        signatures: Number of compilations of each function.
        total_s: Time of each function without its callees.
        llvm_s: Time of optimisation and code generation, which is part of it.
    """

    def __init__(self) -> None:
        self.signatures: Counter[str] = Counter()
        self.total_s: defaultdict[str, float] = defaultdict(float)
        self.llvm_s: defaultdict[str, float] = defaultdict(float)
        self._open: list[str] = []
        self._changed_s = 0.0

    def on_start(self, event: Event) -> None:
        self._charge()
        function = event.data["dispatcher"].py_func
        self._open.append(f"{function.__module__}.{function.__qualname__}")
        self.signatures[self._open[-1]] += 1

    def on_end(self, event: Event) -> None:  # noqa: ARG002  Numba passes it
        self._charge()
        self._open.pop()

    def timed(self, step: Callable[..., None]) -> Callable[..., None]:
        """Return this step of LLVM so that its time is added to the function that is being compiled."""

        def run(*arguments: object) -> None:
            started_s = time.process_time()
            step(*arguments)
            if self._open:
                self.llvm_s[self._open[-1]] += time.process_time() - started_s

        return run

    def _charge(self) -> None:
        now_s = time.process_time()
        if self._open:
            self.total_s[self._open[-1]] += now_s - self._changed_s
        self._changed_s = now_s


def main(rows: int) -> None:
    """Compile, and print both tables."""
    # Imported after the cache is set.
    from tracker.warm_up import Part, warm_up  # noqa: PLC0415

    times = CompileTimes()
    register("numba:compile", times)
    for step in ("add_ir_module", "finalize"):
        setattr(CPUCodeLibrary, step, times.timed(getattr(CPUCodeLibrary, step)))
    parts = []
    for part in Part:
        started_s, before = time.process_time(), times.signatures.total()
        warm_up(part)
        parts.append(
            (part.value, str(times.signatures.total() - before), number(time.process_time() - started_s, 1))
        )
    parts.append(("all", str(times.signatures.total()), number(sum(times.total_s.values()), 1)))
    functions = [
        (name, str(times.signatures[name]), number(spent_s), number(times.llvm_s[name]))
        for name, spent_s in sorted(times.total_s.items(), key=itemgetter(1), reverse=True)[:rows]
    ]
    tables = (
        Table(title="Parts", columns=("part", "compilations", "s"), rows=parts),
        Table(title="Functions", columns=("function", "signatures", "s", "LLVM s"), rows=functions),
    )
    sys.stdout.write("\n".join(table.markdown for table in tables))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--rows", type=int, default=40, help="number of functions in the table")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        numba.config.CACHE_DIR = folder
        main(chosen.rows)
