"""Starts the tracking process, monitors it, and restarts it when it dies or stops reporting.

Time that the process waits for a processor is no silence: on a busy machine a restart makes it worse.

After 5 restarts in 60 s it reports GIVEN_UP and waits until the first of them is a minute old, because an
unattended screen in theatre must recover automatically.
"""

import contextlib
import math
import multiprocessing
import signal
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkServerProcess
from typing import TypeAlias

import structlog

from server.errors import CaptureError
from server.live import Problem, ProcessState, ProcessStatus
from server.loop.compiling import Progress, progress
from server.loop.forks import exit_text, forking_context
from server.loop.processor_wait import ProcessorWait
from server.loop.ring import SLOTS, ImageRing
from server.loop.shared_status import SharedStatus
from server.loop.staging import SceneOrder
from server.loop.tracking_state import StateRequest
from server.loop.worker import WorkerLink, WorkerOrder, run_worker
from server.priority import raise_process_priority
from server.setup import CaseSetup

STOP_TIMEOUT_S = 1.0
STARVATION_LOG_PERIOD_S = 60.0

Target: TypeAlias = Callable[[WorkerOrder, WorkerLink], None]
log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class WatchdogSettings:
    """Timeouts and restart limit of the tracking process.

    Attributes:
        silent_after_s: maximum time without a report, after the first tracked image. Time in which the
            process waited for a processor does not count.
        starved_after_s: time without a report after which it is shown that at least half was such a wait.
        first_image_after_s: the same before it: the first image may have to compile the tracker.
        restarts: maximum number of restarts within `window_s`.
        window_s: see `restarts`.
        poll_interval_s: interval of the timeout check; a death is noticed at once.
        compiles_within_s: time without progress of the compilation after which it is no longer waited for.
    """

    silent_after_s: float = 2.5
    starved_after_s: float = 1.0
    first_image_after_s: float = 90.0
    restarts: int = 5
    window_s: float = 60.0
    poll_interval_s: float = 0.25
    compiles_within_s: float = 120.0


class Supervisor:
    """Keeps one tracking process running, from its own thread."""

    def __init__(
        self,
        *,
        order: WorkerOrder,
        status: SharedStatus,
        watchdog: WatchdogSettings | None = None,
        target: Target = run_worker,
        clock: Callable[[], float] = time.monotonic,
        compiled: Callable[[], Progress] = progress,
        processor_wait: Callable[[int], ProcessorWait] = ProcessorWait,
        slots: int = SLOTS,
    ) -> None:
        self._slots = slots
        self._compiled = compiled
        self._processor_wait = processor_wait
        self._order = order
        self._status = status
        self._watchdog = watchdog or WatchdogSettings()
        self._target = target
        self._clock = clock
        self._context = multiprocessing.get_context("forkserver")
        self._stop = threading.Event()
        self._wakeup_reader, self._wakeup_writer = multiprocessing.Pipe(duplex=False)
        self._restarted_at_s: deque[float] = deque()
        self._restarts = 0
        self._starvation_logged_s = -math.inf
        self._pid: int | None = None
        self._orders_lock = threading.Lock()
        self._orders: Connection | None = None
        self._tracks_from_s = -math.inf
        self._thread = threading.Thread(target=self._run, name="supervisor", daemon=True)

    @property
    def pid(self) -> int | None:
        """The tracking process, None while there is none."""
        return self._pid

    def start(self) -> None:
        """Start; call it from the main thread, with which the fork server ends."""
        forking_context()
        self._thread.start()

    @property
    def tracks_from_s(self) -> float:
        """Start of the present tracking process, monotonic; -inf before the first."""
        with self._orders_lock:
            return self._tracks_from_s

    def adopt(self, case: CaseSetup) -> None:
        """Use the data of this case in the tracking process, and after restarts. From any thread."""
        with self._orders_lock:
            self._order = replace(self._order, case=case)
            self._send(case.tracked_from(self._tracks_from_s))

    def play(self, scene: SceneOrder) -> None:
        """Rehearse this scene in the tracking process, and after restarts. From any thread."""
        with self._orders_lock:
            self._order = replace(self._order, scene=scene)
            self._send(scene)

    def record(self, *, is_recording: bool) -> None:
        """Request the state before the next image, and after each change and restart. From any thread."""
        with self._orders_lock:
            self._order = replace(self._order, is_recording=is_recording)
            self._send(StateRequest(is_recording=is_recording))

    def _send(self, order: CaseSetup | SceneOrder | StateRequest) -> None:
        if self._orders is not None:
            # If the process is ending, the next one receives the value in its order.
            with contextlib.suppress(OSError):
                self._orders.send(order)

    def stop(self) -> None:
        """Stop the tracking process, and wait for it."""
        self._stop.set()
        self._wakeup_writer.close()
        self._thread.join(STOP_TIMEOUT_S * 3)

    def _run(self) -> None:
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        self._status.post(ProcessStatus(state=ProcessState.STARTING), None)
        self._wait_until_compiled()
        while not self._stop.is_set():
            problem = self._run_once()
            if self._stop.is_set():
                return
            log.error(problem.message, code=problem.code, restarts=self._restarts, **problem.context)
            self._post(ProcessState.RESTARTING, problem)
            self._wait_until_allowed(problem)
            self._restarts += 1
            self._restarted_at_s.append(self._clock())

    def _wait_until_compiled(self) -> None:
        """Report the progress of the compilation in the fork server, until it is complete or stuck."""
        maximum, since_s = -1, self._clock()
        while not (now := self._compiled()).is_complete:
            if maximum == -1:
                log.info("the tracker is being compiled for this machine (once); the page shows the progress")
            if now.done > maximum:
                maximum, since_s = now.done, self._clock()
            if self._clock() - since_s > self._watchdog.compiles_within_s:
                break
            self._post(ProcessState.STARTING, _compiling(now))
            if wait([self._wakeup_reader], timeout=self._watchdog.poll_interval_s):
                break
        self._post(ProcessState.STARTING, None)

    def _run_once(self) -> Problem:
        """Start a process, monitor it to its end, and return how it ended."""
        ring = ImageRing(slots=self._slots)
        order_reader, orders = self._context.Pipe(duplex=False)
        link = WorkerLink(ring=ring, notice=self._status.notice, orders=order_reader)
        with self._orders_lock:
            self._tracks_from_s = time.monotonic()
            order, self._orders = self._next_order(), orders
        process = self._context.Process(target=self._target, args=(order, link), name="tracking", daemon=True)
        started_s = time.monotonic()
        try:
            process.start()
        except (OSError, EOFError) as error:
            self._disconnect(orders)
            return _problem(f"could not be started: {error}")
        finally:
            order_reader.close()
        self._pid = process.pid
        state = self._status.current.process.state
        restarting = state if state is ProcessState.STARTING else ProcessState.RESTARTING
        self._post(restarting, self._status.current.process.problem, ring)
        log.debug("tracking process started", pid=process.pid, took_s=round(time.monotonic() - started_s, 2))
        ending = self._watch_process(process, ring)
        # Its output is no longer live; viewers are informed before the cleanup.
        if not self._stop.is_set():
            self._post(ProcessState.RESTARTING, ending)
        self._disconnect(orders)
        self._end(process)
        self._pid = None
        ring.close()
        return ending

    def _watch_process(self, process: ForkServerProcess, ring: ImageRing) -> Problem:
        """Return when the process is dead, silent, or to be stopped."""
        pid = process.pid or 0
        waiting = self._processor_wait(pid)
        seen_s = checked_s = time.monotonic()
        starved_s = 0.0
        while True:
            ready = wait([process.sentinel, self._wakeup_reader], timeout=self._watchdog.poll_interval_s)
            if process.sentinel in ready:
                process.join(STOP_TIMEOUT_S)
                return _problem("ended", pid=pid, how=exit_text(process.exitcode))
            if self._wakeup_reader in ready:
                return _problem("was stopped")
            now_s = time.monotonic()
            starved_s += waiting.since_last(now_s - checked_s)
            checked_s = now_s
            if ring.written_at_s > seen_s:
                seen_s, starved_s = ring.written_at_s, 0.0
            silent_s = now_s - seen_s
            if silent_s > self._watchdog.starved_after_s and starved_s > silent_s / 2:
                self._report_starvation(pid, silent_s, starved_s)
            limit_s = self._watchdog.silent_after_s if ring.images else self._watchdog.first_image_after_s
            if silent_s - starved_s > limit_s:
                return _problem(f"sent nothing for {silent_s:.1f} s, limit {limit_s:g} s", pid=pid)

    def _report_starvation(self, pid: int, silent_s: float, starved_s: float) -> None:
        """Show that the process is starved, until its next report, and raise its priority."""
        problem = _starved(silent_s, starved_s)
        self._status.set_problem(problem)
        raise_process_priority(pid)
        if self._clock() - self._starvation_logged_s > STARVATION_LOG_PERIOD_S:
            self._starvation_logged_s = self._clock()
            log.warning(problem.message, code=problem.code, remedy=problem.remedy)

    def _end(self, process: ForkServerProcess) -> None:
        if self._stop.is_set():
            process.join(STOP_TIMEOUT_S)
        if process.exitcode is None:
            process.kill()
            process.join(STOP_TIMEOUT_S)
        if process.exitcode is not None:
            process.close()

    def _disconnect(self, orders: Connection) -> None:
        """Close the order pipe, which ends the process at its other end."""
        with self._orders_lock:
            self._orders = None
        orders.close()

    def _next_order(self) -> WorkerOrder:
        source, played_scene, scene = self._status.source, self._status.played_scene, self._order.scene
        if scene is not None and played_scene is not None and played_scene.scene_number == scene.number:
            scene = replace(scene, first_number=played_scene.first_number)
        return replace(
            self._order,
            case=self._order.case.tracked_from(self._tracks_from_s),
            first_number=source.images,
            skipped_before=source.skipped_images,
            scene=scene,
        )

    def _wait_until_allowed(self, problem: Problem) -> None:
        """Wait until a restart is allowed; meanwhile the state is GIVEN_UP."""
        watchdog = self._watchdog
        while not self._stop.is_set():
            now_s = self._clock()
            while self._restarted_at_s and now_s - self._restarted_at_s[0] >= watchdog.window_s:
                self._restarted_at_s.popleft()
            if len(self._restarted_at_s) < watchdog.restarts:
                return
            if self._status.current.process.state is not ProcessState.GIVEN_UP:
                given_up = _given_up(watchdog, problem)
                log.error(given_up.message, code=given_up.code, remedy=given_up.remedy)
                self._post(ProcessState.GIVEN_UP, given_up)
            wait([self._wakeup_reader], timeout=watchdog.poll_interval_s)

    def _post(self, state: ProcessState, problem: Problem | None, ring: ImageRing | None = None) -> None:
        self._status.post(ProcessStatus(state=state, restarts=self._restarts, problem=problem), ring)


def _compiling(now: Progress) -> Problem:
    return Problem(
        code="TRACKER_COMPILING",
        message=f"the tracker is being compiled for this machine (once): {now.done} of {now.total} functions",
        remedy="Wait a minute or two; it starts automatically.",
        context={"done": now.done, "total": now.total},
    )


def _problem(what: str, **details: object) -> Problem:
    """Return the public problem; pid and exit status are for the log."""
    return Problem(
        code="TRACKING_PROCESS_ENDED",
        message=f"the tracking process {what}",
        remedy="It is restarted automatically; if this repeats, check the server log.",
        context={"process_problem": what, **details},
    )


def _starved(silent_s: float, starved_s: float) -> Problem:
    error = CaptureError(
        "TRACKING_STARVED",
        f"this computer is overloaded: no image was tracked for {silent_s:.1f} s, of which the tracking "
        f"process waited {starved_s:.1f} s for a processor",
        "Close other programs on this computer. Tracking continues as soon as it gets a processor.",
        {"silent_s": silent_s, "starved_s": starved_s},
    )
    return Problem.from_error(error)


def _given_up(watchdog: WatchdogSettings, last: Problem) -> Problem:
    return Problem(
        code="TRACKING_GIVEN_UP",
        message=f"the tracking process was restarted {watchdog.restarts} times in {watchdog.window_s:g} s "
        f"and ended again; the last time: {last.message}",
        remedy=f"Check the server log for the reason. It is retried within {watchdog.window_s:g} s; "
        "to retry at once, restart the program.",
        context={"restarts": watchdog.restarts, "window_s": watchdog.window_s, "last_problem": last.message},
    )
