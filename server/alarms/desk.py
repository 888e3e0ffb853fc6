"""Where everything meets that raises or ends an alarm: images, silence, people, screens, the disk."""

import threading
import time
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from datetime import datetime
from math import inf

from server.alarms.entries import entry_of
from server.alarms.log import AlarmLog, NoLog
from server.alarms.screens import Screens
from server.clock import utc_now, utc_text
from server.config import Config
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import (
    NOT_KNOWN,
    QUIET,
    AlarmEngine,
    AlarmEvent,
    AlarmLimits,
    AlarmPicture,
    Condition,
    Memory,
    Observed,
    observed_of,
    remembered,
)
from tracker.navigation.figures import rounded_down, rounded_up

# A clock that is disciplined by NTP drifts less than this between two looks.
MAX_CLOCK_DRIFT_S = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcedureFacts:
    """What the steps of the procedure know, and an image does not say.

    Attributes:
        navigating: somebody navigates; None leaves it to what the images say.
        registration_current: it is not out of date.
        calibration_current: neither camera nor tool are out of date.
        checked_at_s: when the tip was last put on a landmark, monotonic; None where no check is asked for.
        recording_runs: nothing that should be recorded is not.
    """

    navigating: bool | None = None
    registration_current: bool = True
    calibration_current: bool = True
    checked_at_s: float | None = None
    recording_runs: bool = True


def alarm_limits(config: Config) -> AlarmLimits:
    """The limits as the settings have them, rounded as those of the figures are."""
    alarms = config.alarms
    return AlarmLimits(
        warning_distance_mm=rounded_up(alarms.warning_distance_mm),
        hysteresis_mm=alarms.hysteresis_mm,
        breach_ratio=rounded_down(100.0 * alarms.breach_ratio, decimals=0) / 100.0,
        breach_hysteresis_ratio=alarms.breach_hysteresis_ratio,
        again_after_mm=alarms.again_after_mm,
        drill_unseen_after_s=alarms.drill_unseen_after_ms / 1000.0,
        reference_unseen_after_s=alarms.reference_unseen_after_ms / 1000.0,
        camera_silent_after_s=config.limits.video_stale_after_ms / 1000.0,
        check_due_after_s=config.registration.check_again_after_min * 60.0,
        min_free_disk_mb=alarms.min_free_disk_mb,
    )


class AlarmDesk:
    """The alarms of one server. Safe to use from any thread; none of its calls waits for the disk.

    Args:
        config: the limits.
        log: where changes are kept.
        clock: monotonic, the one that images are stamped with.
        wall_clock: for the log.
    """

    def __init__(
        self,
        config: Config,
        *,
        log: AlarmLog | None = None,
        clock: Callable[[], float] = time.monotonic,
        wall_clock: Callable[[], datetime] = utc_now,
    ) -> None:
        self._limits = alarm_limits(config)
        self._put_away_after_s = config.alarms.put_away_after_s
        self._log: AlarmLog = log or NoLog()
        self._clock = clock
        self._wall_clock = wall_clock
        self._lock = threading.Lock()
        self._engine = AlarmEngine(self._limits)
        self._screens = Screens(lost_after_s=config.alarms.screen_lost_after_s)
        self._memory = Memory()
        self._snapshot: NavigationSnapshot | None = None
        self._camera_works = True
        self._tracker_works = True
        self._facts = ProcedureFacts()
        self._hold_asked_by = ""
        self._unix_offset_s = inf
        # Called after a change that no image brought, so that it is published at once.
        self.tell: Callable[[], None] = lambda: None

    @property
    def picture(self) -> AlarmPicture:
        """What the alarms say now."""
        with self._lock:
            return self._stepped(self._clock())

    @property
    def log(self) -> AlarmLog:
        """Where changes are kept."""
        return self._log

    def look(
        self, snapshot: NavigationSnapshot | None, source: SourceStatus, process: ProcessStatus
    ) -> AlarmPicture:
        """One more moment of the live images: a new image, or None when none came."""
        with self._lock:
            at_s = self._clock()
            if snapshot is not None:
                self._snapshot = snapshot
                fresh_s = self._limits.camera_silent_after_s
                self._memory = remembered(self._memory, snapshot, now_s=at_s, fresh_s=fresh_s)
            self._tracker_works = process.state is ProcessState.RUNNING
            # Without the process that reads the camera, nobody knows whether it works.
            self._camera_works = source.state is SourceState.RUNNING or not self._tracker_works
            return self._stepped(at_s)

    def know(self, facts: ProcedureFacts) -> None:
        """What the procedure knows from now on."""
        with self._lock:
            is_current = facts.registration_current and facts.calibration_current
            if self._memory.navigating and not is_current:
                # What goes out of date under the hand takes the numbers away; that ends nothing by itself.
                facts = replace(facts, navigating=True)
            self._facts = facts
        self.tell()

    @property
    def facts(self) -> ProcedureFacts:
        """What the procedure knows."""
        with self._lock:
            return self._facts

    def acknowledge(self, numbers: Collection[int], *, by: str) -> AlarmPicture:
        """Somebody knows of these alarms; on the disk only after `log.flush()`."""
        with self._lock:
            at_s = self._clock()
            named = [alarm.condition for alarm in self._engine.picture.alarms if alarm.number in numbers]
            picture = self._kept(self._engine.acknowledge(numbers, by=by, at_s=at_s))
            if Condition.VIEWER_LOST in named:
                self._screens.forget_lost()
        self.tell()
        return picture

    def pause(self, seconds: float, *, by: str) -> AlarmPicture:
        """No sound for this long.

        Raises:
            InvalidInput: ALARM_PAUSE_TOO_LONG.
        """
        with self._lock:
            picture = self._kept(self._engine.pause(seconds, by=by, at_s=self._clock()))
        self.tell()
        return picture

    def resume(self, *, by: str) -> AlarmPicture:
        """Sound again."""
        with self._lock:
            picture = self._kept(self._engine.resume(by=by, at_s=self._clock()))
        self.tell()
        return picture

    def ask_hold(self, *, by: str) -> AlarmPicture:
        """A clinician asks to hold; nothing but an alarm comes of it."""
        return self._held(by, by=by)

    def release_hold(self, *, by: str) -> AlarmPicture:
        """Nobody asks any more."""
        return self._held("", by=by)

    def screen_said(self, name: str, *, armed: bool) -> AlarmPicture:
        """A screen says whether its sound is armed."""
        with self._lock:
            at_s = self._clock()
            self._screens.said(name, armed=armed, at_s=at_s)
            return self._stepped(at_s)

    def screen_left(self, name: str) -> None:
        """A screen says that it is closed."""
        with self._lock:
            self._screens.left(name)

    def _held(self, asked_by: str, *, by: str) -> AlarmPicture:
        with self._lock:
            self._hold_asked_by, at_s = asked_by, self._clock()
            picture = self._kept(self._engine.step(self._observed(at_s), at_s), by=by)
        self.tell()
        return picture

    def _stepped(self, at_s: float) -> AlarmPicture:
        return self._kept(self._engine.step(self._observed(at_s), at_s))

    def _observed(self, at_s: float) -> Observed:
        facts, free_mb = self._facts, self._log.free_mb
        works = self._camera_works and self._tracker_works
        seen = observed_of(
            self._snapshot,
            self._memory,
            now_s=at_s,
            # Of a camera or a tracker that is known not to work no number is of now.
            fresh_s=self._limits.camera_silent_after_s if works else -inf,
            put_away_after_s=self._put_away_after_s,
            navigating=facts.navigating,
        )
        return replace(
            seen,
            camera_works=self._camera_works,
            tracker_works=self._tracker_works,
            registration_current=facts.registration_current,
            calibration_current=facts.calibration_current,
            check_age_s=NOT_KNOWN if facts.checked_at_s is None else at_s - facts.checked_at_s,
            armed_screens=self._screens.armed(at_s),
            lost_screens=self._screens.lost(at_s),
            free_disk_mb=NOT_KNOWN if free_mb is None else free_mb,
            recording_runs=facts.recording_runs and self._log.is_well,
            hold_asked_by=self._hold_asked_by,
        )

    def _kept(self, picture: AlarmPicture, *, by: str = "") -> AlarmPicture:
        now = self._wall_clock()
        offset_s = now.timestamp() - self._clock()
        # Held, so that the time of an event does not jump by a second from message to message; replaced when
        # the wall clock was set, or the computer slept.
        if not abs(offset_s - self._unix_offset_s) < MAX_CLOCK_DRIFT_S:
            self._unix_offset_s = offset_s
        picture = replace(picture, unix_offset_s=self._unix_offset_s)
        if picture.events:
            events = [replace(one, by=one.by or _doer(one, by)) for one in picture.events]
            entries = [
                entry_of(event, at=utc_text(now), unix_offset_s=self._unix_offset_s, snapshot=self._snapshot)
                for event in events
            ]
            self._log.append(entries)
        return picture


def _doer(event: AlarmEvent, by: str) -> str:
    return by if event.condition is Condition.HOLD_ASKED else ""


def no_alarms(
    snapshot: NavigationSnapshot | None, source: SourceStatus, process: ProcessStatus
) -> AlarmPicture:
    """Where nobody looks for alarms."""
    del snapshot, source, process
    return QUIET
