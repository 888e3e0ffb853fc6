"""Lower priority for background work, so that figures and alarms of the newest image are not delayed."""

import contextlib
import os
import sys
import threading

# The scheduler gives a thread or process with this niceness a tenth of the weight of others.
NICENESS = 10


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
