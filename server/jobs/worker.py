"""Entry point of the process that runs a job."""

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

from server.disk import disk_full_error, is_full
from server.live import Problem
from server.logs import LogSettings, configure_logging
from server.loop.parent import die_with_parent
from server.priority import lower_process_priority
from tracker.errors import NavigationError

# Progress reports at shorter intervals are dropped.
MIN_REPORT_INTERVAL_S = 0.1

log = structlog.get_logger(__name__)


class Report(Protocol):
    """Reports progress (0 to 1) and the current activity."""

    def __call__(self, progress_ratio: float, doing: str) -> None:
        """Report; calls are rate limited."""


# A module-level function: work(report, **arguments) -> a JSON-serialisable value, or what `conclude` takes.
Work: TypeAlias = Callable[..., object]


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """Progress of the work."""

    ratio: float
    doing: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """Return value of the work."""

    value: object


def run_work(
    work: Work,
    arguments: Mapping[str, object],
    messages: Connection,
    settings: LogSettings,
    *,
    is_answer: bool,
) -> None:
    """Run the process. With `is_answer` the return value is the result, without `conclude`."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent()
    configure_logging(settings, process="job")
    lower_process_priority()
    cv2.setNumThreads(1)
    try:
        value = work(_reporter(messages), **arguments)
        # Fails here if the value is not JSON-serialisable; later its origin would be unknown.
        messages.send(Result(value=to_json_value(value) if is_answer else value))
    except BrokenPipeError:
        # The server has closed the pipe.
        os._exit(0)
    except NavigationError as error:
        messages.send(Problem.from_error(error))
    except Exception as error:
        log.exception("a job failed")
        messages.send(_problem(error, arguments))


def to_json_value(value: object) -> object:
    """Return the value as it reads back from JSON.

    Raises:
        TypeError, ValueError: it is not JSON-serialisable.
    """
    messages: object = json.loads(json.dumps(value, allow_nan=False))
    return messages


def _problem(error: Exception, arguments: Mapping[str, object]) -> Problem:
    """Return the problem for an unexpected error of the work."""
    if isinstance(error, MemoryError):
        return Problem(
            code="JOB_OUT_OF_MEMORY",
            message="the job needed more memory than is available",
            remedy="Close other programs or use smaller files, then start it again.",
        )
    folder = arguments.get("folder")
    if isinstance(error, OSError) and is_full(error) and isinstance(folder, str):
        return Problem.from_error(disk_full_error(Path(folder)))
    return Problem(
        code="JOB_FAILED",
        message="an internal error occurred in the job",
        remedy="Try again; if the error persists, send the server log to the maintainer.",
    )


def _reporter(messages: Connection) -> Report:
    last_s = -MIN_REPORT_INTERVAL_S

    def report(progress_ratio: float, doing: str) -> None:
        nonlocal last_s
        now_s = time.monotonic()
        if now_s - last_s >= MIN_REPORT_INTERVAL_S:
            last_s = now_s
            messages.send(Progress(ratio=float(progress_ratio), doing=doing))

    return report
