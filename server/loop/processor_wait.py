"""Time that a process waits for a processor (Linux): a silent process may be starved, not hung.

A starved process is runnable and gets no processor; a restart would make that worse. A hung one sleeps, or
computes without a result, and only a restart helps.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

NS_PER_S = 1e9


@dataclass(frozen=True, slots=True, kw_only=True)
class ThreadTimes:
    """What the scheduler has counted for a thread.

    Attributes:
        run_s: processor time.
        waited_s: time spent runnable without a processor; grows when the thread gets one.
        is_runnable: Whether it runs or could run now.
    """

    run_s: float
    waited_s: float
    is_runnable: bool


Times: TypeAlias = Mapping[int, ThreadTimes]


def thread_times(pid: int) -> Times:
    """Return the times of each thread of a process; empty where the system does not provide them."""
    times = {}
    try:
        for task in Path(f"/proc/{pid}/task").iterdir():
            run_ns, waited_ns, _ = (task / "schedstat").read_text().split()
            # The name in parentheses may contain anything.
            state = (task / "stat").read_text().rpartition(")")[2].split()[0]
            times[int(task.name)] = ThreadTimes(
                run_s=int(run_ns) / NS_PER_S, waited_s=int(waited_ns) / NS_PER_S, is_runnable=state == "R"
            )
    except (OSError, ValueError):
        # The process ended, or this is not Linux.
        return {}
    return times


class ProcessorWait:
    """Measures in intervals how long a process waited for a processor.

    Args:
        pid: the process.
        read: Reads the times of its threads.
    """

    def __init__(self, pid: int, *, read: Callable[[int], Times] = thread_times) -> None:
        self._pid = pid
        self._read = read
        self._times: Times = read(pid)

    def since_last(self, elapsed_s: float) -> float:
        """Return the time waited since the last call, at most `elapsed_s`; 0 where it is unknown.

        That of the thread that waited longest, because the others may wait for it.
        """
        before, self._times = self._times, self._read(self._pid)
        waits = [
            _waited(before[thread], times, elapsed_s)
            for thread, times in self._times.items()
            if thread in before
        ]
        return min(elapsed_s, max(waits, default=0.0))


def _waited(before: ThreadTimes, now: ThreadTimes, elapsed_s: float) -> float:
    stood_still = (now.run_s, now.waited_s) == (before.run_s, before.waited_s)
    if stood_still and before.is_runnable and now.is_runnable:
        # A wait that has not ended is not counted yet.
        return elapsed_s
    return now.waited_s - before.waited_s
