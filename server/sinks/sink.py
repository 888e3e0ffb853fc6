"""One sink in the web process: a thread that sends the newest message when the sink is ready.

A sink is a plug-in, or the publisher of the hub (`server.hub`).
"""

import contextlib
import multiprocessing
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any, TypeAlias

import structlog

from server.live import Instant, LiveHub, Problem
from server.logs import LogSettings
from server.loop.forks import end_process, exit_text
from server.priority import lower_thread_priority
from server.sinks.process import Report, plugin_sink, run_sink

POLL_S = 0.1
SLOW_AFTER_S = 2.0
RESTART_AFTER_S = 5.0
STOP_TIMEOUT_S = 2.0
LOG_AGAIN_AFTER_S = 60.0
REMEDY = (
    "Navigation continues. Correct or update the plug-in, or remove it from plugins.sinks, and start again."
)
Write: TypeAlias = Callable[[Instant], object]
log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class SinkStatus:
    """State of a sink.

    Attributes:
        name: Name of the plug-in.
        problem: Why it receives nothing, or the error that it raised; None while it works.
        messages: Number of messages sent to it.
        skipped: Number of instants not sent to it because it was not ready.
    """

    name: str
    problem: Problem | None = None
    messages: int = 0
    skipped: int = 0


class Sink:
    """Sends the newest message to a sink; nothing waits for it.

    Args:
        name: Name of the plug-in.
        hub: Source of the instants.
        write: Returns the message of an instant. Called from the sink's thread.
        settings: Log settings of the sink's process.
        open_sink: Called in the process, so it can be pickled; default: the plug-in of this name.
        slow_after_s: Time for one message after which the sink counts as slow.
        restart_after_s: Pause before an ended process is restarted.
    """

    def __init__(
        self,
        name: str,
        hub: LiveHub,
        *,
        write: Write,
        settings: LogSettings,
        open_sink: Callable[[], Any] | None = None,
        slow_after_s: float = SLOW_AFTER_S,
        restart_after_s: float = RESTART_AFTER_S,
    ) -> None:
        self.name = name
        self._hub = hub
        self._write = write
        self._settings = settings
        self._open_sink = open_sink or partial(plugin_sink, name)
        self._slow_after_s = slow_after_s
        self._restart_after_s = restart_after_s
        self._stop = threading.Event()
        self._lock = threading.Lock()
        self._problem: Problem | None = None
        self._logged_code, self._logged_at_s = "", 0.0
        self._messages = self._skipped = 0
        self._sequence: int | None = None
        self._process: BaseProcess | None = None
        self._thread = threading.Thread(target=self._run, name=f"sink {name}", daemon=True)

    def start(self) -> None:
        """Start; returns at once, even while the fork server is still loading."""
        self._thread.start()

    def request_stop(self) -> None:
        """Request the sink to close; returns at once."""
        self._stop.set()

    def stop(self) -> None:
        """Request the sink to close, and kill its process if it does not."""
        self.request_stop()
        if self._thread.ident is None:
            return
        self._thread.join(STOP_TIMEOUT_S)
        process = self._process
        if self._thread.is_alive() and process is not None:
            # The thread may be blocked sending to a process that does not read. While the fork server is
            # loading there is no process, and the fork server ends with this process.
            with contextlib.suppress(ValueError, AttributeError):
                process.kill()
            self._thread.join(STOP_TIMEOUT_S)

    @property
    def is_alive(self) -> bool:
        """Whether its thread is running."""
        return self._thread.is_alive()

    @property
    def status(self) -> SinkStatus:
        """State of the sink. From any thread."""
        with self._lock:
            return SinkStatus(
                name=self.name, problem=self._problem, messages=self._messages, skipped=self._skipped
            )

    def _run(self) -> None:
        lower_thread_priority()
        context = multiprocessing.get_context("forkserver")
        goes_on = True
        while goes_on and not self._stop.is_set():
            ours, theirs = context.Pipe()
            self._process = context.Process(
                target=run_sink,
                args=(self.name, self._open_sink, theirs, self._settings),
                name=f"sink {self.name}",
                daemon=True,
            )
            try:
                self._process.start()
                theirs.close()
                goes_on = self._serve(ours)
            except (EOFError, OSError):
                self._process.join(STOP_TIMEOUT_S)
                if not self._stop.is_set():
                    self._report("SINK_ENDED", f"its process ended {exit_text(self._process.exitcode)}")
            except Exception as error:
                log.exception("a sink failed", sink=self.name)
                self._report("SINK_FAILED", f"{type(error).__name__}: {error}")
            finally:
                theirs.close()
                ours.close()
                self._end_process(self._process)
            self._stop.wait(self._restart_after_s)

    def _serve(self, connection: Connection) -> bool:
        """Send messages until the sink is stopped; return whether it is worth starting again.

        Raises:
            EOFError, OSError: its process has ended.
        """
        is_ready = False
        since_s = time.monotonic()
        while not self._stop.is_set():
            if not is_ready:
                is_ready = connection.poll(POLL_S)
                if is_ready:
                    report: Report = connection.recv()
                    if report.is_ended:
                        self._report("SINK_NOT_LOADED", str(report.error))
                        return False
                    if report.problem is not None:
                        self._set(report.problem)
                    else:
                        self._report("SINK_FAILED", report.error)
                elif time.monotonic() - since_s > self._slow_after_s:
                    taken = f"it has taken more than {self._slow_after_s:g} s for one message"
                    self._report("SINK_SLOW", taken)
                continue
            sequence = -1 if self._sequence is None else self._sequence
            instant = self._hub.wait_after(sequence, POLL_S)
            if instant is not None:
                connection.send(self._write(instant))
                is_ready, since_s = False, time.monotonic()
                self._count(instant.sequence)
            elif connection.poll():
                # It sends only responses, so it must have ended; receiving raises the error.
                connection.recv()
        return False

    def _count(self, sequence: int) -> None:
        with self._lock:
            self._messages += 1
            if self._sequence is not None:
                self._skipped += sequence - self._sequence - 1
            self._sequence = sequence

    def _report(self, code: str, what: str | None) -> None:
        """Set a problem, or clear it with None.

        A problem is logged once, and again only after a message has succeeded `LOG_AGAIN_AFTER_S` later,
        because a sink may fail at every other image with a different text.
        """
        problem = None
        if what is not None:
            message = f"the sink {self.name} does not work: {what}"
            problem = Problem(code=code, message=message, remedy=REMEDY, context={"sink": self.name})
        self._set(problem)

    def _set(self, problem: Problem | None) -> None:
        with self._lock:
            self._problem = problem
        if problem is not None and problem.code != self._logged_code:
            self._logged_code, self._logged_at_s = problem.code, time.monotonic()
            log.warning(problem.message, code=problem.code, sink=self.name, remedy=problem.remedy)
        elif problem is None and self._logged_code and self._logs_again():
            self._logged_code = ""
            log.info("sink works again", sink=self.name)

    def _logs_again(self) -> bool:
        return time.monotonic() - self._logged_at_s >= LOG_AGAIN_AFTER_S

    def _end_process(self, process: BaseProcess) -> None:
        if process.pid is None:
            return
        end_process(process, timeout_s=STOP_TIMEOUT_S)
