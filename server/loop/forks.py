"""The fork server: all other processes are forked from it, with slow imports loaded once.

Jobs are forked from the same process as tracking, at a lower priority, so they start at once while pose and
video keep the cores.
"""

import contextlib
import multiprocessing
import signal
from multiprocessing import forkserver, resource_tracker
from multiprocessing.context import ForkServerContext
from multiprocessing.process import BaseProcess

PRELOAD = ["server.loop.preload"]


def forking_context() -> ForkServerContext:
    """Return the multiprocessing context; start the fork server if it is not running.

    Call it from the main thread: the fork server ends with that thread.
    """
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOAD)
    # Started first: its start unblocks these signals.
    resource_tracker.ensure_running()
    # Blocked in all child processes: Ctrl+C and a service manager's stop signal reach the whole process
    # group, and only the server may act on them.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    return context


def exit_text(exitcode: int | None) -> str:
    """Return a text for an exit code."""
    if exitcode is None:
        return "in an unknown way"
    if exitcode < 0:
        try:
            return f"by signal {-exitcode} ({signal.Signals(-exitcode).name})"
        except ValueError:
            return f"by signal {-exitcode}"
    return f"with status {exitcode}"


def end_process(process: BaseProcess, *, timeout_s: float) -> int | None:
    """Wait for a started process to end, kill it after `timeout_s`, and release it.

    Returns:
        Its exit code; None if it had to be killed.
    """
    process.join(timeout_s)
    exitcode = process.exitcode
    if exitcode is None:
        process.kill()
        process.join(timeout_s)
    # Not released while even a killed process remains, in a system call that does not return.
    with contextlib.suppress(ValueError):
        process.close()
    return exitcode
