"""Job functions for tests."""

import errno
import math
import os
import signal
import threading
from pathlib import Path

from server.jobs import Report
from tracker.errors import InvalidInput


def add(report: Report, *, a: int, b: int) -> dict[str, int]:
    report(0.5, "adding")
    return {"sum": a + b}


def go_back(report: Report) -> list[float]:
    report(0.7, "far")
    return [os.nice(0), os.getpid()]


def reject(_report: Report, *, slices: int) -> None:
    raise InvalidInput("TOO_FEW_SLICES", f"{slices} slices found", "Take more.", {"slices": slices})


def blunder(_report: Report) -> None:
    raise ZeroDivisionError("the patient is called Zaphod")


def say_nothing_sensible(_report: Report) -> float:
    return math.nan


def die(_report: Report, *, folder: str) -> None:
    (Path(folder) / "half").write_bytes(b"half")
    os.kill(os.getpid(), signal.SIGKILL)


def leave(_report: Report) -> None:
    os._exit(3)


def never_end(report: Report, *, folder: str) -> None:
    (Path(folder) / "half").write_bytes(b"half")
    report(0.25, "waiting")
    threading.Event().wait()


def fill_the_disk(_report: Report, *, folder: str) -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), f"{folder}/surface.ply")
