"""Coaxial's server: owns time, threads, processes, files and the network, and computes no geometry."""

import os

# Set before any import, because NumPy reads it when it is loaded. The matrices are small, so that further
# BLAS threads only busy-wait on a core that another process needs: with them the measurement of a pedicle
# takes 27 s instead of 11 s beside a busy core, and three times the CPU time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# Read when OpenCV is loaded. A picture of some kB may state a thousand megapixels, which its decoder would
# allocate; those of 8K cameras have 33.
MAX_IMAGE_PIXELS = 2**27
os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(MAX_IMAGE_PIXELS))
