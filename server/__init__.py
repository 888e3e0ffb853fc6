"""Coaxial's server: owns time, threads, processes, files and the network, and computes no geometry."""

import os

# Set before any import, because NumPy reads it when it is loaded. The matrices are small, so that further
# BLAS threads only busy-wait on a core that another process needs: with them the measurement of a pedicle
# takes 27 s instead of 11 s beside a busy core, and three times the CPU time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
