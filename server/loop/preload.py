"""Loaded once into the process that all tracking processes are forked from, so that a restart is quick.

Importing it loads the tracker and runs every compiled loop once; where they were never compiled on this
machine, they are now.
No thread may be left running here: a forked child would lack it, and wait for it for ever.
"""

import signal

from server.loop.parent import die_with_parent

# Ctrl+C goes to the whole process group; only the server may act on it.
signal.signal(signal.SIGINT, signal.SIG_IGN)
die_with_parent()

import contextlib  # noqa: E402  the lines above come before everything that takes time

import cv2  # noqa: E402

import server.loop.worker  # noqa: E402, F401  loaded here so that no child has to
import tracker.rehearsal  # noqa: E402, F401
from server.loop.compiling import compile_tracker  # noqa: E402

threads = cv2.getNumThreads()
cv2.setNumThreads(1)
# A fault of the tracker is told by the first tracking process, with its traceback, not by this silent one.
with contextlib.suppress(Exception):
    compile_tracker()
cv2.setNumThreads(threads)
