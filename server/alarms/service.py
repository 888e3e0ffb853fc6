"""`AlarmService`: combines images, timeouts, people, screens and disk into the alarms of one server."""

import threading
import time
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from datetime import datetime
from math import inf
from typing import TypeAlias

from server.alarms.entries import entry_of, guiding_entry
from server.alarms.evaluation import AlarmCall, AlarmEvaluation, AlarmState, AlarmStep, Circumstances
from server.alarms.log import AlarmLog, NoLog
from server.alarms.screens import Screens
from server.clock import slept_s, utc_now, utc_text
from server.config import Config
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import QUIET, AlarmEvent, AlarmLimits, AlarmSnapshot, Condition
from tracker.navigation.figures import rounded_down, rounded_up

StepRecorder: TypeAlias = Callable[[AlarmStep, AlarmSnapshot], None]

# A clock synchronised by NTP drifts less than this between two updates.
MAX_CLOCK_DRIFT_S = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcedureFacts:
    """State of the procedure that affects alarms.

    Attributes:
        navigating: Whether navigation is on; None derives it from the images.
        registration_current: The registration is not out of date.
        calibration_current: Neither camera nor tool calibration is out of date.
        checked_at_s: Monotonic time of the last landmark check; None if no check is required.
        recording_runs: Everything that has to be recorded is being recorded.
    """

    navigating: bool | None = None
    registration_current: bool = True
    calibration_current: bool = True
    checked_at_s: float | None = None
    recording_runs: bool = True


def alarm_limits(config: Config) -> AlarmLimits:
    """Return the alarm limits of the settings, rounded like the displayed limits."""
    alarms = config.alarms
    return AlarmLimits(
        warning_distance_mm=rounded_up(alarms.warning_distance_mm),
        hysteresis_mm=alarms.hysteresis_mm,
        breach_ratio=rounded_down(100.0 * alarms.breach_ratio, decimals=0) / 100.0,
        breach_hysteresis_ratio=alarms.breach_hysteresis_ratio,
        realarm_after_mm=alarms.realarm_after_mm,
        drill_unseen_after_s=alarms.drill_unseen_after_ms / 1000.0,
        reference_unseen_after_s=alarms.reference_unseen_after_ms / 1000.0,
        camera_silent_after_s=config.limits.video_stale_after_ms / 1000.0,
        check_due_after_s=config.registration.check_again_after_min * 60.0,
        min_free_disk_mb=alarms.min_free_disk_mb,
    )


class AlarmService:
    """The alarms of one server. Thread-safe; no call waits for the disk.

    Args:
        config: The limits.
        log: The alarm log.
        clock: Monotonic clock of the capture times.
        wall_clock: Clock for the log.
        slept_s: Returns how long the computer slept so far, during which `clock` stands still.
    """

    def __init__(
        self,
        config: Config,
        *,
        log: AlarmLog | None = None,
        clock: Callable[[], float] = time.monotonic,
        wall_clock: Callable[[], datetime] = utc_now,
        slept_s: Callable[[], float] = slept_s,
    ) -> None:
        self._evaluation = AlarmEvaluation(
            alarm_limits(config), put_away_after_s=config.alarms.put_away_after_s
        )
        self._log: AlarmLog = log or NoLog()
        self._clock = clock
        self._wall_clock = wall_clock
        self._slept_s = slept_s
        self._lock = threading.Lock()
        self._screens = Screens(lost_after_s=config.alarms.screen_lost_after_s)
        self._guiding: dict[str, str] = {}
        self._camera_works = True
        self._tracker_works = True
        self._facts = ProcedureFacts()
        self._slept_before_facts_s = 0.0
        self._hold_requested_by = ""
        self._unix_offset_s = inf
        self._recorder: StepRecorder | None = None
        self._records = True
        # Called after a change without an image, so that it is published at once.
        self.on_change: Callable[[], None] = lambda: None

    @property
    def picture(self) -> AlarmSnapshot:
        """The present alarms."""
        with self._lock:
            return self._step(self._clock())

    @property
    def log(self) -> AlarmLog:
        """The alarm log."""
        return self._log

    def observe(
        self, snapshot: NavigationSnapshot | None, source: SourceStatus, process: ProcessStatus
    ) -> AlarmSnapshot:
        """Update the alarms with a new image, or with None if there is none."""
        with self._lock:
            at_s = self._clock()
            self._tracker_works = process.state is ProcessState.RUNNING
            # Without the capture process the state of the camera is unknown.
            self._camera_works = source.state is SourceState.RUNNING or not self._tracker_works
            return self._step(at_s, snapshot)

    def record_steps(
        self, recorder: StepRecorder | None, begin: Callable[[AlarmState, float], None] = lambda *_: None
    ) -> None:
        """Call `begin` with the state and the time, then `recorder` with each step in its order.

        Both are called while the alarms are locked, and must return at once.
        """
        with self._lock:
            self._recorder = recorder
            begin(self._evaluation.state, self._clock())

    @property
    def is_navigating(self) -> bool:
        """Whether navigation is on."""
        with self._lock:
            stated = self._facts.navigating
            return self._evaluation.is_navigating if stated is None else stated

    def set_recording_runs(self, *, runs: bool) -> None:
        """Set whether a recording that should be written is being written."""
        with self._lock:
            self._records = runs
        self.on_change()

    def set_facts(self, facts: ProcedureFacts) -> None:
        """Set the state of the procedure."""
        with self._lock:
            is_current = facts.registration_current and facts.calibration_current
            if self._evaluation.is_navigating and not is_current:
                # A document that becomes out of date removes the numbers but does not end navigation.
                facts = replace(facts, navigating=True)
            self._facts, self._slept_before_facts_s = facts, self._slept_s()
        self.on_change()

    @property
    def facts(self) -> ProcedureFacts:
        """The state of the procedure."""
        with self._lock:
            return self._facts

    def acknowledge(self, numbers: Collection[int], *, by: str) -> AlarmSnapshot:
        """Acknowledge alarms; on the disk only after `log.flush()`."""
        with self._lock:
            at_s = self._clock()
            named = [alarm.condition for alarm in self._evaluation.picture.alarms if alarm.number in numbers]
            picture = self._apply(AlarmCall.ACKNOWLEDGE, at_s, numbers=tuple(numbers), by=by)
            if Condition.VIEWER_LOST in named:
                self._screens.forget_lost()
        self.on_change()
        return picture

    def pause(self, seconds: float, *, by: str) -> AlarmSnapshot:
        """Pause the sound for this time.

        Raises:
            InvalidInput: ALARM_PAUSE_TOO_LONG.
        """
        with self._lock:
            picture = self._apply(AlarmCall.PAUSE, self._clock(), pause_s=seconds, by=by)
        self.on_change()
        return picture

    def resume(self, *, by: str) -> AlarmSnapshot:
        """End the audio pause."""
        with self._lock:
            picture = self._apply(AlarmCall.RESUME, self._clock(), by=by)
        self.on_change()
        return picture

    def request_hold(self, *, by: str) -> AlarmSnapshot:
        """Raise the alarm for a hold request."""
        return self._set_hold(by, by=by)

    def release_hold(self, *, by: str) -> AlarmSnapshot:
        """End the hold request."""
        return self._set_hold("", by=by)

    def report_screen(self, name: str, *, armed: bool, guiding_by: str = "") -> AlarmSnapshot:
        """Record the sound state of a screen, and who hears its guiding sound; empty while that is off."""
        with self._lock:
            at_s = self._clock()
            self._screens.report(name, armed=armed, at_s=at_s, guiding_by=guiding_by)
            return self._step(at_s)

    def close_screen(self, name: str) -> None:
        """Remove a screen that was closed."""
        with self._lock:
            self._screens.close(name)

    def _set_hold(self, requested_by: str, *, by: str) -> AlarmSnapshot:
        with self._lock:
            self._hold_requested_by, at_s = requested_by, self._clock()
            picture = self._apply(AlarmCall.STEP, at_s, by=by)
        self.on_change()
        return picture

    def _step(self, at_s: float, snapshot: NavigationSnapshot | None = None) -> AlarmSnapshot:
        return self._apply(AlarmCall.STEP, at_s, snapshot=snapshot)

    def _apply(
        self,
        call: AlarmCall,
        at_s: float,
        *,
        snapshot: NavigationSnapshot | None = None,
        numbers: tuple[int, ...] = (),
        pause_s: float = 0.0,
        by: str = "",
    ) -> AlarmSnapshot:
        step = AlarmStep(
            call=call,
            at_s=at_s,
            image_number=None if snapshot is None else snapshot.image_number,
            circumstances=self._circumstances(at_s),
            numbers=numbers,
            pause_s=pause_s,
            by=by,
        )
        picture = self._logged(self._evaluation.apply(step, snapshot), by=by)
        self._log_guiding(at_s)
        if self._recorder is not None:
            self._recorder(step, picture)
        return picture

    def _circumstances(self, at_s: float) -> Circumstances:
        facts = self._facts
        # A check is not younger because the computer slept after it. Whole seconds: without sleep exactly 0.
        slept_s = round(self._slept_s() - self._slept_before_facts_s)
        return Circumstances(
            camera_works=self._camera_works,
            tracker_works=self._tracker_works,
            navigating=facts.navigating,
            registration_current=facts.registration_current,
            calibration_current=facts.calibration_current,
            checked_at_s=None if facts.checked_at_s is None else facts.checked_at_s - slept_s,
            armed_screens=self._screens.armed(at_s),
            lost_screens=self._screens.lost(at_s),
            free_disk_mb=self._log.free_mb,
            recording_runs=facts.recording_runs and self._records and self._log.is_well,
            hold_requested_by=self._hold_requested_by,
        )

    def _logged(self, picture: AlarmSnapshot, *, by: str = "") -> AlarmSnapshot:
        now = self._wall_clock()
        offset_s = now.timestamp() - self._clock()
        # Constant, so that the displayed time of an event does not jump between messages; updated after the
        # wall clock was set or the computer slept.
        if not abs(offset_s - self._unix_offset_s) < MAX_CLOCK_DRIFT_S:
            self._unix_offset_s = offset_s
        picture = replace(picture, unix_offset_s=self._unix_offset_s)
        if picture.events:
            events = [replace(one, by=one.by or _doer(one, by)) for one in picture.events]
            at, newest = utc_text(now), self._evaluation.snapshot
            entries = [
                entry_of(event, at=at, unix_offset_s=self._unix_offset_s, snapshot=newest) for event in events
            ]
            self._log.append(entries)
        return picture

    def _log_guiding(self, at_s: float) -> None:
        """Log guiding sounds that were turned on or off; a screen that stopped reporting has none."""
        before, self._guiding = self._guiding, self._screens.guiding(at_s)
        for name in sorted(before.keys() ^ self._guiding.keys()):
            is_on = name in self._guiding
            by = (self._guiding if is_on else before)[name]
            at = utc_text(self._wall_clock())
            self._log.append([guiding_entry(screen=name, by=by, is_on=is_on, at=at, at_s=at_s)])


def _doer(event: AlarmEvent, by: str) -> str:
    return by if event.condition is Condition.HOLD_REQUESTED else ""


def without_alarms(
    snapshot: NavigationSnapshot | None, source: SourceStatus, process: ProcessStatus
) -> AlarmSnapshot:
    """Return no alarms, for servers without alarms."""
    del snapshot, source, process
    return QUIET
