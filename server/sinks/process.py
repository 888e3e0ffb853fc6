"""The process of one sink, in which the plug-in runs.

In a thread of the server it could block or crash the interpreter. Its process has a low priority.
"""

import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

from server.live import Problem
from server.logs import LogSettings, configure_logging
from server.loop.parent import die_with_parent
from server.plugins import SINKS, load_plugin
from server.priority import lower_process_priority
from tracker.errors import NavigationError

MAX_ERROR_LENGTH = 300


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """The sink is ready for a message.

    Attributes:
        error: Error that it raised for the last message; None if none.
        problem: The same with code and remedy, where the sink is one of our own.
        is_ended: Whether loading failed, so that this is its only report.
    """

    error: str | None = None
    problem: Problem | None = None
    is_ended: bool = False


def plugin_sink(name: str) -> Any:  # noqa: ANN401  whatever the entry point returns
    """Return the sink of a plug-in."""
    return load_plugin(SINKS, name)()


def run_sink(name: str, open_sink: Callable[[], Any], connection: Connection, settings: LogSettings) -> None:
    """Open the sink and pass it each received message, until the connection is closed."""
    die_with_parent()
    configure_logging(settings, process=f"sink {name}")
    lower_process_priority()
    try:
        sink = open_sink()
    except NavigationError as error:
        connection.send(Report(error=error.message, is_ended=True))
        return
    except Exception as error:  # noqa: BLE001  a plug-in may raise anything
        connection.send(Report(error=f"it cannot be opened: {_text(error)}", is_ended=True))
        return
    report = Report()
    try:
        while True:
            connection.send(report)
            message = connection.recv()
            try:
                sink.receive(message)
                report = Report()
            except NavigationError as error:
                report = Report(error=error.message, problem=Problem.from_error(error))
            except Exception as error:  # noqa: BLE001  as above
                report = Report(error=_text(error))
    except (EOFError, OSError):
        # The server is stopping.
        sink.close()


def _text(error: Exception) -> str:
    return textwrap.shorten(f"{type(error).__name__}: {error}", MAX_ERROR_LENGTH)
