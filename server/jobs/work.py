"""The process that does long work, from its start to its end."""

import json
import os
import signal
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Protocol, TypeAlias

import cv2
import structlog

from server.disk import became_full, is_full
from server.live import Problem
from server.logs import LogSettings, configure_logging
from server.loop.parent import die_with_parent
from tracker.errors import NavigationError

# What is told more often than this is left out.
TELL_EVERY_S = 0.1
# Below the tracking process and the server, where cores are few.
POLITENESS = 10

log = structlog.get_logger(__name__)


class Report(Protocol):
    """Tells how far the work is: 0 to 1, and what is done just now."""

    def __call__(self, progress_ratio: float, doing: str) -> None:
        """May be called as often as is easy."""


# A function at the top of a module: work(report, **arguments) -> what JSON can say, or its `conclude` takes.
Work: TypeAlias = Callable[..., object]


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """How far it is."""

    ratio: float
    doing: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """What came out."""

    value: object


Told: TypeAlias = Progress | Result | Problem


def run_work(
    work: Work, arguments: Mapping[str, object], told: Connection, settings: LogSettings, *, is_answer: bool
) -> None:
    """The whole life of the process. `is_answer`: what comes out is told as it is, not concluded first."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent()
    configure_logging(settings, process="job")
    os.nice(POLITENESS)
    cv2.setNumThreads(1)
    try:
        value = work(_reporter(told), **arguments)
        # What JSON cannot say would fail later, where nobody knows of whom it came.
        told.send(Result(value=as_told(value) if is_answer else value))
    except BrokenPipeError:
        # Nobody wants it any more.
        os._exit(0)
    except NavigationError as error:
        told.send(Problem.from_error(error))
    except Exception as error:
        log.exception("a job failed")
        told.send(_problem(error, arguments))


def as_told(value: object) -> object:
    """What an answer in JSON says of it.

    Raises:
        TypeError, ValueError: JSON cannot say it.
    """
    told: object = json.loads(json.dumps(value, allow_nan=False))
    return told


def _problem(error: Exception, arguments: Mapping[str, object]) -> Problem:
    """What is told of an error that the work did not expect."""
    if isinstance(error, MemoryError):
        return Problem(
            code="JOB_OUT_OF_MEMORY",
            message="the work needed more memory than there is",
            remedy="Close other programs or use smaller files, then start it again.",
        )
    folder = arguments.get("folder")
    if isinstance(error, OSError) and is_full(error) and isinstance(folder, str):
        return Problem.from_error(became_full(Path(folder)))
    return Problem(
        code="JOB_FAILED",
        message="the program made a mistake while it worked",
        remedy="Try again; if it comes back, send the server's log to the maintainer.",
    )


def _reporter(told: Connection) -> Report:
    last_s = -TELL_EVERY_S

    def report(progress_ratio: float, doing: str) -> None:
        nonlocal last_s
        now_s = time.monotonic()
        if now_s - last_s >= TELL_EVERY_S:
            last_s = now_s
            told.send(Progress(ratio=float(progress_ratio), doing=doing))

    return report
