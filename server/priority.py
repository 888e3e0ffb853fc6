"""Priorities of processes and threads: figures and alarms of the newest image come before background work."""

import contextlib
import os
import sys
import threading
from pathlib import Path

# The scheduler gives a thread or process with this niceness a tenth of the weight of others.
NICENESS = 10
# Three times the weight of others.
RAISED_NICENESS = -5


def lower_process_priority() -> None:
    """Lower the priority of this process below all others."""
    with contextlib.suppress(OSError):
        os.nice(NICENESS)


def lower_thread_priority() -> None:
    """Lower the priority of this thread below all others, if the system supports it (Linux)."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError):
            thread = threading.get_native_id()
            # A value above the largest niceness is clipped to it.
            os.setpriority(os.PRIO_PROCESS, thread, os.getpriority(os.PRIO_PROCESS, thread) + NICENESS)


def raise_process_priority(pid: int) -> None:
    """Raise the threads of a process above others, except lowered ones, if the system permits it (Linux)."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError):
            for task in Path(f"/proc/{pid}/task").iterdir():
                if os.getpriority(os.PRIO_PROCESS, int(task.name)) <= 0:
                    os.setpriority(os.PRIO_PROCESS, int(task.name), RAISED_NICENESS)
