"""Loaded once into the fork server, so that a restart of tracking is fast.

The import loads the tracker and runs every compiled function once; functions that were never compiled on this
machine are compiled now. No thread may be left running here: a forked child would lack it, and wait for it
forever.
"""

import signal

from server.loop.parent import die_with_parent

# Ctrl+C goes to the whole process group; only the server may act on it.
signal.signal(signal.SIGINT, signal.SIG_IGN)
die_with_parent()

import contextlib  # noqa: E402  the lines above come before everything that takes time
import gc  # noqa: E402

# Imported modules are never freed; garbage collection takes a sixth of the loading and would delay images.
gc.disable()

import cv2  # noqa: E402

# SciPy loads its submodules at their first use, which would delay an image.
import scipy.interpolate  # noqa: E402
import scipy.ndimage  # noqa: E402
import scipy.optimize  # noqa: E402
import scipy.sparse.linalg  # noqa: E402
import scipy.spatial.transform  # noqa: E402
import scipy.special  # noqa: E402, F401

import server.loop.worker  # noqa: E402, F401  loaded here so that no child has to
import tracker.rehearsal  # noqa: E402, F401
from server.loop.compiling import compile_tracker  # noqa: E402

threads = cv2.getNumThreads()
cv2.setNumThreads(1)
# An error of the tracker is reported by the first tracking process, with its traceback.
with contextlib.suppress(Exception):
    compile_tracker()
cv2.setNumThreads(threads)
gc.freeze()
gc.enable()
