"""On which machine, and when, something was measured."""

import datetime
import os
import platform
from pathlib import Path

import cv2
import numpy as np

CPUINFO = Path("/proc/cpuinfo")


def machine_line() -> str:
    """One sentence that names the processor, the versions and the day."""
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
