"""Description of the machine and date of a measurement."""

import datetime
import os
import platform
from pathlib import Path

import cv2
import numpy as np

CPUINFO = Path("/proc/cpuinfo")


def machine_line() -> str:
    """Return one sentence with processor, versions and date."""
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    return (
        f"{_processor()}, {os.cpu_count()} cores shared with other work; Python {platform.python_version()}, "
        f"OpenCV {cv2.__version__}, NumPy {np.__version__}; {today}."
    )


def _processor() -> str:
    if CPUINFO.exists():
        for line in CPUINFO.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
