"""Priority of work that may wait: figures and alarms of the newest image come first on a busy machine."""

import contextlib
import os
import sys
import threading

# Of a thread or process with this niceness the scheduler takes a tenth of the weight of others.
NICENESS = 10


def lower_process_priority() -> None:
    """Let every other process go first."""
    with contextlib.suppress(OSError):
        os.nice(NICENESS)


def lower_thread_priority() -> None:
    """Let every other thread and process go first, where the system knows priorities of threads (Linux)."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError):
            thread = threading.get_native_id()
            # What is more than the largest niceness is set to it.
            os.setpriority(os.PRIO_PROCESS, thread, os.getpriority(os.PRIO_PROCESS, thread) + NICENESS)
