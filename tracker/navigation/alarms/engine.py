"""All alarms as one deterministic state machine: inputs and commands in, snapshots out.

The publisher steps it with each image before drawing, so that picture, message and sound agree, and a
recording reproduces the alarms. It runs in the web process and is also stepped twenty times a second without
an image, because the tracking process cannot report its own end.
"""

from collections.abc import Collection
from math import inf, isfinite

from tracker.errors import InvalidInput
from tracker.navigation.alarms.evidence import UNKNOWN, Evidence, Presence, evaluate_condition
from tracker.navigation.alarms.inputs import AlarmInputs
from tracker.navigation.alarms.limits import MAX_PAUSE_S, AlarmLimits
from tracker.navigation.alarms.occurrence import AlarmState, Occurrence, StepContext, acknowledged, advanced
from tracker.navigation.alarms.rules import ALARM_RULES, Condition, Priority
from tracker.navigation.alarms.snapshot import (
    QUIET,
    Alarm,
    AlarmEvent,
    AlarmSnapshot,
    Change,
    Sound,
)

NO_PAUSE_S = -inf


class AlarmEngine:
    """The alarms of one theatre. Mutable; has no clock: each call passes the time.

    A time earlier than the last one is replaced by the last one.
    """

    def __init__(self, limits: AlarmLimits | None = None) -> None:
        self._limits = limits or AlarmLimits()
        self._occurrences = dict.fromkeys(Condition, Occurrence())
        self._presence = dict.fromkeys(Condition, Presence.NO)
        self._numbers = dict.fromkeys(Condition, 0)
        self._number = 0
        self._image_number = -1
        self._captured_at_s = -inf
        self._at_s = -inf
        self._paused_until_s = NO_PAUSE_S
        self._covered: frozenset[Condition] = frozenset()
        self._events: list[AlarmEvent] = []
        self._picture = QUIET

    @property
    def picture(self) -> AlarmSnapshot:
        """Return the alarms after the last call."""
        return self._picture

    def step(self, inputs: AlarmInputs, at_s: float) -> AlarmSnapshot:
        """Update all alarms for one more step, with or without a new image."""
        at_s = self._forward(at_s)
        moment = self._moment(inputs, at_s)
        for condition, was in self._occurrences.items():
            evidence = self._evidence(condition, inputs, was)
            now = advanced(was, evidence, ALARM_RULES[condition], moment)
            if now is not was:
                self._occurrences[condition] = now
                self._note(condition, was, now)
        return self._snapshot()

    def _evidence(self, condition: Condition, inputs: AlarmInputs, was: Occurrence) -> Evidence:
        """Evaluate a condition with hysteresis; store its presence by the limit alone."""
        plain = evaluate_condition(condition, inputs, self._limits, raised=False)
        is_watched = inputs.navigating or ALARM_RULES[condition].outside_navigation
        if ALARM_RULES[condition].latches and plain.presence is Presence.NO and _is_unseen(was, inputs):
            # The affected drill is not seen, and the state of another drill must not clear its alarm.
            plain = UNKNOWN
        self._presence[condition] = plain.presence if is_watched else Presence.UNKNOWN
        if not was.is_raised or plain is UNKNOWN:
            return plain
        return evaluate_condition(condition, inputs, self._limits, raised=True)

    def acknowledge(self, numbers: Collection[int], *, by: str, at_s: float) -> AlarmSnapshot:
        """Acknowledge the alarms with these numbers; alarms raised later are not affected."""
        self._forward(at_s)
        for condition, was in self._occurrences.items():
            now = acknowledged(was, by=by)
            if self._numbers[condition] in numbers and now is not was:
                self._occurrences[condition] = now
                # Acknowledging a cleared alarm removes it; the log records its last state.
                logged = was if now.state is AlarmState.NORMAL else now
                self._log(Change.ACKNOWLEDGED, condition, logged, by=by)
        return self._snapshot()

    def pause(self, seconds: float, *, by: str, at_s: float) -> AlarmSnapshot:
        """Silence the present alarms for this long; new alarms and alarms of higher priority still sound.

        Raises:
            InvalidInput: ALARM_PAUSE_TOO_LONG.
        """
        if not (isfinite(seconds) and 0.0 < seconds <= MAX_PAUSE_S):
            raise InvalidInput(
                "ALARM_PAUSE_TOO_LONG",
                f"a pause of {seconds:g} s was requested, allowed is more than 0 and up to {MAX_PAUSE_S:g} s",
                "Pause for a shorter time; the sound resumes automatically and can be paused again.",
                {"requested_s": seconds if isfinite(seconds) else str(seconds), "max_s": MAX_PAUSE_S},
            )
        at_s = self._forward(at_s)
        self._paused_until_s = at_s + seconds
        self._covered = frozenset(
            condition
            for condition, occurrence in self._occurrences.items()
            if occurrence.state is not AlarmState.NORMAL
        )
        self._events.append(AlarmEvent(at_s=at_s, change=Change.PAUSED, by=by, pause_s=seconds))
        return self._snapshot()

    def resume(self, *, by: str, at_s: float) -> AlarmSnapshot:
        """End the pause now."""
        self._forward(at_s)
        self._end_pause(Change.RESUMED, by=by)
        return self._snapshot()

    def _forward(self, at_s: float) -> float:
        self._at_s = max(self._at_s, at_s)
        self._events = []
        if self._at_s >= self._paused_until_s:
            self._end_pause(Change.PAUSE_OVER)
        return self._at_s

    def _moment(self, inputs: AlarmInputs, at_s: float) -> StepContext:
        new = inputs.image_number >= 0 and inputs.image_number != self._image_number
        gap_s = inputs.captured_at_s - self._captured_at_s if new else 0.0
        if new:
            self._image_number, self._captured_at_s = inputs.image_number, inputs.captured_at_s
        return StepContext(
            at_s=at_s, new_image=new, image_gap_s=gap_s, realarm_after_mm=self._limits.realarm_after_mm
        )

    def _note(self, condition: Condition, was: Occurrence, now: Occurrence) -> None:
        """Number a newly raised alarm, log the change, and end a pause for a new alarm."""
        if now.state is was.state:
            return
        if now.state is AlarmState.ACTIVE:
            self._number += 1
            self._numbers[condition] = self._number
            worse = was.state is AlarmState.ACKNOWLEDGED
            self._log(Change.WORSE if worse else Change.RAISED, condition, now)
            if condition not in self._covered or ALARM_RULES[condition].priority is Priority.HIGH:
                self._end_pause(Change.PAUSE_BROKEN)
            return
        latched = now.state is AlarmState.LATCHED
        self._log(Change.LATCHED if latched else Change.CLEARED, condition, now)

    def _log(self, change: Change, condition: Condition, now: Occurrence, *, by: str = "") -> None:
        alarm = self._alarm(condition, now)
        event = AlarmEvent(at_s=self._at_s, change=change, alarm=alarm, by=by or now.by)
        self._events.append(event)

    def _end_pause(self, change: Change, *, by: str = "") -> None:
        if self._paused_until_s == NO_PAUSE_S:
            return
        self._paused_until_s, self._covered = NO_PAUSE_S, frozenset()
        self._events.append(AlarmEvent(at_s=self._at_s, change=change, by=by))

    def _snapshot(self) -> AlarmSnapshot:
        alarms = sorted(
            (
                self._alarm(condition, occurrence)
                for condition, occurrence in self._occurrences.items()
                if occurrence.state is not AlarmState.NORMAL
            ),
            key=_place,
        )
        # A change of presence is a change too, because it changes the displayed text.
        shown = [(alarm.number, alarm.presence) for alarm in alarms]
        is_changed = bool(self._events) or shown != [(a.number, a.presence) for a in self._picture.alarms]
        paused = self._paused_until_s > self._at_s
        sounding = None if paused else next((a for a in alarms if a.state is AlarmState.ACTIVE), None)
        self._picture = AlarmSnapshot(
            at_s=self._at_s,
            alarms=tuple(alarms),
            sound=Sound.SILENT if sounding is None else Sound(sounding.priority.value),
            sound_number=0 if sounding is None else sounding.number,
            paused_until_s=self._paused_until_s if paused else 0.0,
            revision=self._picture.revision + (1 if is_changed else 0),
            events=tuple(self._events),
        )
        return self._picture

    def _alarm(self, condition: Condition, occurrence: Occurrence) -> Alarm:
        return Alarm(
            number=self._numbers[condition],
            condition=condition,
            state=occurrence.state,
            raised_at_s=occurrence.raised_at_s,
            presence=self._presence[condition],
            measure=occurrence.measure,
            site=occurrence.site,
            peak=occurrence.peak,
            earlier_peak=occurrence.earlier_peak,
            acknowledged_by=occurrence.acknowledged_by,
            by=occurrence.by,
            control=occurrence.control,
        )


def _is_unseen(was: Occurrence, inputs: AlarmInputs) -> bool:
    return was.site is not None and was.site.tool in inputs.unseen_tools


_ORDER = {AlarmState.ACTIVE: 0, AlarmState.LATCHED: 1, AlarmState.ACKNOWLEDGED: 2}


def _place(alarm: Alarm) -> tuple[int, int, int]:
    """Sort key: by priority, then active, latched, acknowledged, then newest first.

    A latched alarm has its priority until somebody acknowledges it, so that no lower one takes its place.
    """
    return (-alarm.priority.rank, _ORDER[alarm.state], -alarm.number)
