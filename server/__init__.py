"""Coaxial's server: owns time, threads, processes, files and the network, and computes no geometry."""

import os

# Read when NumPy is loaded, so it stands here, before all else. Its matrices are small: more threads only
# wait for each other, at full speed, on the core that the picture or another process needs. With them a
# pedicle takes 27 s beside a busy core in place of 11, and three times the work.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
