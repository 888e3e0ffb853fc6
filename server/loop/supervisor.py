"""Starts the tracking process, watches it, and starts it again when it dies or falls silent.

At most 5 restarts in 60 s; then it says so and waits until the first of them is a minute old, because an
untouched screen in theatre has to come back by itself.
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

from server.live import Problem, ProcessState, ProcessStatus
from server.loop.board import Board
from server.loop.compiling import Progress, progress
from server.loop.forks import ending_words, forking_context
from server.loop.ring import ImageRing
from server.loop.staging import SceneOrder
from server.loop.worker import WorkerLink, WorkerOrder, run_worker
from server.setup import CaseSetup

STOP_TIMEOUT_S = 1.0

Target: TypeAlias = Callable[[WorkerOrder, WorkerLink], None]
log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Watch:
    """When the tracking process counts as dead, and how often it is started again.

    Attributes:
        silent_after_s: without a report, once it has tracked its first image.
        first_image_after_s: without a report before that: the first image may have to compile the tracker.
        restarts: how often it is started again within `window_s`.
        window_s: see `restarts`.
        look_every_s: how often silence is looked for; a death is noticed at once.
        compiles_within_s: after this without another compiled loop, the compiling is no longer waited for.
    """

    silent_after_s: float = 2.5
    first_image_after_s: float = 90.0
    restarts: int = 5
    window_s: float = 60.0
    look_every_s: float = 0.25
    compiles_within_s: float = 120.0


class Supervisor:
    """Keeps one tracking process running, from a thread of its own."""

    def __init__(
        self,
        *,
        order: WorkerOrder,
        board: Board,
        watch: Watch | None = None,
        target: Target = run_worker,
        clock: Callable[[], float] = time.monotonic,
        compiled: Callable[[], Progress] = progress,
    ) -> None:
        self._compiled = compiled
        self._order = order
        self._board = board
        self._watch = watch or Watch()
        self._target = target
        self._clock = clock
        self._context = multiprocessing.get_context("forkserver")
        self._stop = threading.Event()
        self._asleep, self._awake = multiprocessing.Pipe(duplex=False)
        self._restarted_at_s: deque[float] = deque()
        self._restarts = 0
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
        """Begin; call it from the main thread, whose end shall end the process that forks."""
        forking_context()
        self._thread.start()

    @property
    def tracks_from_s(self) -> float:
        """Since when this tracking process runs, monotonic: it saw nothing before; -inf at first."""
        with self._orders_lock:
            return self._tracks_from_s

    def adopt(self, case: CaseSetup) -> None:
        """Have the tracking process, and every later one, work with what this case knows. From any thread."""
        with self._orders_lock:
            self._order = replace(self._order, case=case)
            self._tell(case.tracked_from(self._tracks_from_s))

    def play(self, scene: SceneOrder) -> None:
        """Have the tracking process, and every later one, rehearse this scene. From any thread."""
        with self._orders_lock:
            self._order = replace(self._order, scene=scene)
            self._tell(scene)

    def _tell(self, told: CaseSetup | SceneOrder) -> None:
        if self._orders is not None:
            # A process that is just ending is followed by one that has it in its order.
            with contextlib.suppress(OSError):
                self._orders.send(told)

    def stop(self) -> None:
        """End the tracking process, and wait for it."""
        self._stop.set()
        self._awake.close()
        self._thread.join(STOP_TIMEOUT_S * 3)

    def _run(self) -> None:
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        self._board.post(ProcessStatus(state=ProcessState.STARTING), None)
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
        """Tell how far the process that forks is with compiling the tracker, until it is done or stuck."""
        most, since_s = -1, self._clock()
        while not (now := self._compiled()).is_complete:
            if most == -1:
                log.info("the tracker is being compiled for this machine (once); the page shows the progress")
            if now.done > most:
                most, since_s = now.done, self._clock()
            if self._clock() - since_s > self._watch.compiles_within_s:
                break
            self._post(ProcessState.STARTING, _compiling(now))
            if wait([self._asleep], timeout=self._watch.look_every_s):
                break
        self._post(ProcessState.STARTING, None)

    def _run_once(self) -> Problem:
        """Start a process, watch it to its end, and say how it ended."""
        ring = ImageRing()
        heard, orders = self._context.Pipe(duplex=False)
        link = WorkerLink(ring=ring, notice=self._board.notice, orders=heard)
        with self._orders_lock:
            self._tracks_from_s = time.monotonic()
            order, self._orders = self._next_order(), orders
        process = self._context.Process(target=self._target, args=(order, link), name="tracking", daemon=True)
        started_s = time.monotonic()
        try:
            process.start()
        except (OSError, EOFError) as error:
            self._let_go(orders)
            return _problem(f"could not be started: {error}")
        finally:
            heard.close()
        self._pid = process.pid
        state = self._board.posted.process.state
        restarting = state if state is ProcessState.STARTING else ProcessState.RESTARTING
        self._post(restarting, self._board.posted.process.problem, ring)
        log.debug("tracking process started", pid=process.pid, took_s=round(time.monotonic() - started_s, 2))
        ending = self._watch_process(process, ring)
        # From here on nothing it left behind is live; everybody is told before it is cleaned up.
        if not self._stop.is_set():
            self._post(ProcessState.RESTARTING, ending)
        self._let_go(orders)
        self._end(process)
        self._pid = None
        ring.close()
        return ending

    def _watch_process(self, process: ForkServerProcess, ring: ImageRing) -> Problem:
        """Returns when the process is dead, silent, or to be stopped."""
        began_s = time.monotonic()
        while True:
            ready = wait([process.sentinel, self._asleep], timeout=self._watch.look_every_s)
            if process.sentinel in ready:
                process.join(STOP_TIMEOUT_S)
                return _problem("ended", pid=process.pid, how=ending_words(process.exitcode))
            if self._asleep in ready:
                return _problem("was stopped")
            limit_s = self._watch.silent_after_s if ring.images else self._watch.first_image_after_s
            silent_s = time.monotonic() - max(ring.written_at_s, began_s)
            if silent_s > limit_s:
                return _problem(f"sent nothing for {silent_s:.1f} s, limit {limit_s:g} s", pid=process.pid)

    def _end(self, process: ForkServerProcess) -> None:
        if self._stop.is_set():
            process.join(STOP_TIMEOUT_S)
        if process.exitcode is None:
            process.kill()
            process.join(STOP_TIMEOUT_S)
        if process.exitcode is not None:
            process.close()

    def _let_go(self, orders: Connection) -> None:
        """The process that listens at the other end shall end."""
        with self._orders_lock:
            self._orders = None
        orders.close()

    def _next_order(self) -> WorkerOrder:
        source, begun, scene = self._board.source, self._board.begun, self._order.scene
        if scene is not None and begun is not None and begun.scene_number == scene.number:
            scene = replace(scene, first_number=begun.first_number)
        return replace(
            self._order,
            case=self._order.case.tracked_from(self._tracks_from_s),
            first_number=source.images,
            skipped_before=source.skipped_images,
            scene=scene,
        )

    def _wait_until_allowed(self, problem: Problem) -> None:
        """Returns when it may be started again; until then it is given up, and says so."""
        watch = self._watch
        while not self._stop.is_set():
            now_s = self._clock()
            while self._restarted_at_s and now_s - self._restarted_at_s[0] >= watch.window_s:
                self._restarted_at_s.popleft()
            if len(self._restarted_at_s) < watch.restarts:
                return
            if self._board.posted.process.state is not ProcessState.GIVEN_UP:
                given_up = _given_up(watch, problem)
                log.error(given_up.message, code=given_up.code, remedy=given_up.remedy)
                self._post(ProcessState.GIVEN_UP, given_up)
            wait([self._asleep], timeout=watch.look_every_s)

    def _post(self, state: ProcessState, problem: Problem | None, ring: ImageRing | None = None) -> None:
        self._board.post(ProcessStatus(state=state, restarts=self._restarts, problem=problem), ring)


def _compiling(now: Progress) -> Problem:
    return Problem(
        code="TRACKER_COMPILING",
        message=f"the tracker is being compiled for this machine (once): {now.done} of {now.total} functions",
        remedy="Wait a minute or two; it starts by itself.",
        context={"done": now.done, "total": now.total},
    )


def _problem(what: str, **details: object) -> Problem:
    """What everybody reads; pid and exit status are for the log."""
    return Problem(
        code="TRACKING_PROCESS_ENDED",
        message=f"the tracking process {what}",
        remedy="It is started again by itself; if this repeats, look at the log.",
        context=details,
    )


def _given_up(watch: Watch, last: Problem) -> Problem:
    return Problem(
        code="TRACKING_GIVEN_UP",
        message=f"the tracking process was started again {watch.restarts} times within {watch.window_s:g} s "
        f"and ended again; the last time: {last.message}",
        remedy=f"Look at the log for the reason. It is tried again within {watch.window_s:g} s; "
        "to try at once, stop the program and start it again.",
        context={"restarts": watch.restarts, "window_s": watch.window_s},
    )
