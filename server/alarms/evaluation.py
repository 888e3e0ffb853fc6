"""`AlarmEvaluation`: the alarms as a function of images, circumstances, commands and their times.

It uses no clock and no other input, so that replaying recorded calls gives the same alarms. `AlarmService`
collects the circumstances and is its only caller in a server.
"""

from dataclasses import dataclass, replace
from enum import StrEnum
from math import inf

from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import (
    NOT_KNOWN,
    AlarmEngine,
    AlarmInputHistory,
    AlarmInputs,
    AlarmLimits,
    AlarmSnapshot,
    alarm_inputs,
    update_history,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Circumstances:
    """Inputs of the alarms other than images and time.

    Attributes:
        camera_works, tracker_works: State of source and tracking process.
        navigating, registration_current, calibration_current, checked_at_s: See `ProcedureFacts`.
        armed_screens, lost_screens: See `AlarmInputs`.
        free_disk_mb: None if unknown.
        recording_runs: Everything that has to be recorded is being recorded.
        hold_requested_by: Person who requests a hold; empty if nobody does.
    """

    camera_works: bool = True
    tracker_works: bool = True
    navigating: bool | None = None
    registration_current: bool = True
    calibration_current: bool = True
    checked_at_s: float | None = None
    armed_screens: int = 0
    lost_screens: int = 0
    free_disk_mb: float | None = None
    recording_runs: bool = True
    hold_requested_by: str = ""


class AlarmCall(StrEnum):
    """Kind of a step."""

    STEP = "step"
    ACKNOWLEDGE = "acknowledge"
    PAUSE = "pause"
    RESUME = "resume"


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmStep:
    """One call of the alarms.

    Attributes:
        call: Kind of the step.
        at_s: Monotonic time.
        image_number: Number of the new image of this step; None without one.
        circumstances: Circumstances of this step; for a command those of the previous step.
        numbers: Numbers of the acknowledged alarms.
        pause_s: Duration of a pause.
        by: Person who caused the step; empty if nobody did.
    """

    call: AlarmCall
    at_s: float
    image_number: int | None = None
    circumstances: Circumstances
    numbers: tuple[int, ...] = ()
    pause_s: float = 0.0
    by: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmState:
    """State that determines the next step, with the present alarms.

    Attributes:
        limits, put_away_after_s: Arguments of `AlarmEvaluation`.
        engine: Attributes of the engine.
        history: History of the images.
        snapshot: Result of the newest image; None before the first image.
    """

    limits: AlarmLimits
    put_away_after_s: float
    engine: dict[str, object]
    history: AlarmInputHistory
    snapshot: NavigationSnapshot | None


class AlarmEvaluation:
    """The alarms of one theatre. Mutable; the caller locks.

    Args:
        limits: Alarm limits.
        put_away_after_s: A drill that is unseen for longer counts as put away.
    """

    def __init__(self, limits: AlarmLimits, *, put_away_after_s: float) -> None:
        self.limits = limits
        self._put_away_after_s = put_away_after_s
        self._engine = AlarmEngine(limits)
        self._history = AlarmInputHistory()
        self._snapshot: NavigationSnapshot | None = None

    @classmethod
    def restored(cls, state: AlarmState) -> "AlarmEvaluation":
        """Return an evaluation in the given state."""
        made = cls(state.limits, put_away_after_s=state.put_away_after_s)
        vars(made._engine).update(state.engine)
        made._history, made._snapshot = state.history, state.snapshot
        return made

    @property
    def state(self) -> AlarmState:
        """A copy of the present state."""
        engine = {
            name: value.copy() if isinstance(value, (dict, list)) else value
            for name, value in vars(self._engine).items()
        }
        return AlarmState(
            limits=self.limits,
            put_away_after_s=self._put_away_after_s,
            engine=engine,
            history=self._history,
            snapshot=self._snapshot,
        )

    @property
    def picture(self) -> AlarmSnapshot:
        """The alarms after the last call."""
        return self._engine.picture

    @property
    def snapshot(self) -> NavigationSnapshot | None:
        """Result of the newest image."""
        return self._snapshot

    @property
    def is_navigating(self) -> bool:
        """Whether navigation is on according to the images."""
        return self._history.navigating

    def apply(self, step: AlarmStep, snapshot: NavigationSnapshot | None = None) -> AlarmSnapshot:
        """Perform one step; `snapshot` is the result of its image.

        Raises:
            InvalidInput: ALARM_PAUSE_TOO_LONG.
        """
        match step.call:
            case AlarmCall.ACKNOWLEDGE:
                return self._engine.acknowledge(step.numbers, by=step.by, at_s=step.at_s)
            case AlarmCall.PAUSE:
                return self._engine.pause(step.pause_s, by=step.by, at_s=step.at_s)
            case AlarmCall.RESUME:
                return self._engine.resume(by=step.by, at_s=step.at_s)
            case AlarmCall.STEP:
                pass
        if snapshot is not None:
            self._snapshot = snapshot
            fresh_s = self.limits.camera_silent_after_s
            self._history = update_history(self._history, snapshot, now_s=step.at_s, fresh_s=fresh_s)
        return self._engine.step(self._inputs(step.circumstances, step.at_s), step.at_s)

    def _inputs(self, now: Circumstances, at_s: float) -> AlarmInputs:
        works = now.camera_works and now.tracker_works
        seen = alarm_inputs(
            self._snapshot,
            self._history,
            now_s=at_s,
            # A failed camera or tracker leaves no current result.
            fresh_s=self.limits.camera_silent_after_s if works else -inf,
            put_away_after_s=self._put_away_after_s,
            navigating=now.navigating,
        )
        return replace(
            seen,
            camera_works=now.camera_works,
            tracker_works=now.tracker_works,
            registration_current=now.registration_current,
            calibration_current=now.calibration_current,
            check_age_s=NOT_KNOWN if now.checked_at_s is None else at_s - now.checked_at_s,
            armed_screens=now.armed_screens,
            lost_screens=now.lost_screens,
            free_disk_mb=NOT_KNOWN if now.free_disk_mb is None else now.free_disk_mb,
            recording_runs=now.recording_runs,
            hold_requested_by=now.hold_requested_by,
        )
