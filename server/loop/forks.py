"""The process from which all others are forked, with everything loaded that takes time to load.

Jobs are forked from the same process as tracking, at a lower priority: what takes seconds to load is loaded
already, and pose and video keep the cores.
"""

import multiprocessing
import signal
from multiprocessing import forkserver, resource_tracker
from multiprocessing.context import ForkServerContext

PRELOAD = ["server.loop.preload", "server.planning.ct"]


def forking_context() -> ForkServerContext:
    """How processes are made; the process that forks is started if it is not there.

    Call it from the main thread, whose end shall end the process that forks.
    """
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOAD)
    # First by itself: whoever starts it unblocks these signals.
    resource_tracker.ensure_running()
    # Blocked in everything started here: Ctrl+C in a terminal and the end that a service manager asks for
    # reach the whole process group, and only the server may act on them.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    return context


def ending_words(exitcode: int | None) -> str:
    """How a process ended."""
    if exitcode is None:
        return "in an unknown way"
    if exitcode < 0:
        try:
            return f"by signal {-exitcode} ({signal.Signals(-exitcode).name})"
        except ValueError:
            return f"by signal {-exitcode}"
    return f"with status {exitcode}"
