"""All alarms as one state machine: moments and commands in, pictures out. The same in, the same out.

The publisher steps it with each image before it is drawn, so picture, message and sound state the same
image, and a recording gives the same alarms again. It runs in the web process and is stepped twenty times a
second without an image, because the tracking process cannot announce its own death.
"""

from collections.abc import Collection
from math import inf, isfinite

from tracker.errors import InvalidInput
from tracker.navigation.alarms.conditions import TRAITS, Condition, Priority
from tracker.navigation.alarms.evidence import UNKNOWN, Evidence, Showing, evidence_of
from tracker.navigation.alarms.limits import MAX_PAUSE_S, AlarmLimits
from tracker.navigation.alarms.observed import Observed
from tracker.navigation.alarms.occurrence import AlarmState, Moment, Occurrence, acknowledged, advanced
from tracker.navigation.alarms.picture import (
    QUIET,
    Alarm,
    AlarmEvent,
    AlarmPicture,
    Change,
    Sound,
)

NO_PAUSE_S = -inf


class AlarmEngine:
    """The alarms of one theatre. Mutable, without a clock: time is a number that each call brings.

    Times never go back; one that does counts as the last one.
    """

    def __init__(self, limits: AlarmLimits | None = None) -> None:
        self._limits = limits or AlarmLimits()
        self._occurrences = dict.fromkeys(Condition, Occurrence())
        self._presence = dict.fromkeys(Condition, Showing.NO)
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
    def picture(self) -> AlarmPicture:
        """What the alarms say since the last call."""
        return self._picture

    def step(self, observed: Observed, at_s: float) -> AlarmPicture:
        """One more moment, with or without a new image."""
        at_s = self._forward(at_s)
        moment = self._moment(observed, at_s)
        for condition, was in self._occurrences.items():
            evidence = self._evidence(condition, observed, was)
            now = advanced(was, evidence, TRAITS[condition], moment)
            if now is not was:
                self._occurrences[condition] = now
                self._note(condition, was, now)
        return self._concluded()

    def _evidence(self, condition: Condition, observed: Observed, was: Occurrence) -> Evidence:
        """What this moment says, with hysteresis; whether it is present by its limit alone is remembered."""
        plain = evidence_of(condition, observed, self._limits, standing=False)
        is_watched = observed.navigating or TRAITS[condition].always
        if TRAITS[condition].latches and plain.showing is Showing.NO and _is_unseen(was, observed):
            # The drill that it is about is not seen: that another one is well says nothing of it.
            plain = UNKNOWN
        self._presence[condition] = plain.showing if is_watched else Showing.UNKNOWN
        if not was.is_standing or plain is UNKNOWN:
            return plain
        return evidence_of(condition, observed, self._limits, standing=True)

    def acknowledge(self, numbers: Collection[int], *, by: str, at_s: float) -> AlarmPicture:
        """Somebody knows of the alarms with these numbers; what was raised since they looked is not meant."""
        self._forward(at_s)
        for condition, was in self._occurrences.items():
            now = acknowledged(was, by=by)
            if self._numbers[condition] in numbers and now is not was:
                self._occurrences[condition] = now
                # An alarm that is over is dropped by this; the log records what it was.
                logged = was if now.state is AlarmState.NORMAL else now
                self._tell(Change.ACKNOWLEDGED, condition, logged, by=by)
        return self._concluded()

    def pause(self, seconds: float, *, by: str, at_s: float) -> AlarmPicture:
        """No sound for this long, of what stands now; what is new or higher sounds all the same.

        Raises:
            InvalidInput: ALARM_PAUSE_TOO_LONG.
        """
        if not (isfinite(seconds) and 0.0 < seconds <= MAX_PAUSE_S):
            raise InvalidInput(
                "ALARM_PAUSE_TOO_LONG",
                f"a pause of {seconds:g} s was asked, allowed is more than 0 and up to {MAX_PAUSE_S:g} s",
                "Pause for a shorter time; the sound comes back by itself and can be paused again.",
                {"asked_s": seconds if isfinite(seconds) else str(seconds), "max_s": MAX_PAUSE_S},
            )
        at_s = self._forward(at_s)
        self._paused_until_s = at_s + seconds
        self._covered = frozenset(
            condition
            for condition, occurrence in self._occurrences.items()
            if occurrence.state is not AlarmState.NORMAL
        )
        self._events.append(AlarmEvent(at_s=at_s, change=Change.PAUSED, by=by, pause_s=seconds))
        return self._concluded()

    def resume(self, *, by: str, at_s: float) -> AlarmPicture:
        """End the pause now."""
        self._forward(at_s)
        self._end_pause(Change.RESUMED, by=by)
        return self._concluded()

    def _forward(self, at_s: float) -> float:
        self._at_s = max(self._at_s, at_s)
        self._events = []
        if self._at_s >= self._paused_until_s:
            self._end_pause(Change.PAUSE_OVER)
        return self._at_s

    def _moment(self, observed: Observed, at_s: float) -> Moment:
        new = observed.image_number >= 0 and observed.image_number != self._image_number
        gap_s = observed.captured_at_s - self._captured_at_s if new else 0.0
        if new:
            self._image_number, self._captured_at_s = observed.image_number, observed.captured_at_s
        return Moment(at_s=at_s, new_image=new, image_gap_s=gap_s, again_after_mm=self._limits.again_after_mm)

    def _note(self, condition: Condition, was: Occurrence, now: Occurrence) -> None:
        """Give what is raised a number, tell what has changed, and let what is new break a pause."""
        if now.state is was.state:
            return
        if now.state is AlarmState.ACTIVE:
            self._number += 1
            self._numbers[condition] = self._number
            worse = was.state is AlarmState.ACKNOWLEDGED
            self._tell(Change.WORSE if worse else Change.RAISED, condition, now)
            if condition not in self._covered or TRAITS[condition].priority is Priority.HIGH:
                self._end_pause(Change.PAUSE_BROKEN)
            return
        latched = now.state is AlarmState.LATCHED
        self._tell(Change.LATCHED if latched else Change.CLEARED, condition, now)

    def _tell(self, change: Change, condition: Condition, now: Occurrence, *, by: str = "") -> None:
        alarm = self._alarm(condition, now)
        event = AlarmEvent(at_s=self._at_s, change=change, alarm=alarm, by=by or now.by)
        self._events.append(event)

    def _end_pause(self, change: Change, *, by: str = "") -> None:
        if self._paused_until_s == NO_PAUSE_S:
            return
        self._paused_until_s, self._covered = NO_PAUSE_S, frozenset()
        self._events.append(AlarmEvent(at_s=self._at_s, change=change, by=by))

    def _concluded(self) -> AlarmPicture:
        alarms = sorted(
            (
                self._alarm(condition, occurrence)
                for condition, occurrence in self._occurrences.items()
                if occurrence.state is not AlarmState.NORMAL
            ),
            key=_place,
        )
        # An alarm that is present has another text than one that is over: that is a change, too.
        shown = [(alarm.number, alarm.presence) for alarm in alarms]
        is_changed = bool(self._events) or shown != [(a.number, a.presence) for a in self._picture.alarms]
        paused = self._paused_until_s > self._at_s
        sounding = None if paused else next((a for a in alarms if a.state is AlarmState.ACTIVE), None)
        self._picture = AlarmPicture(
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


def _is_unseen(was: Occurrence, observed: Observed) -> bool:
    return was.site is not None and was.site.tool in observed.unseen_tools


_ORDER = {AlarmState.ACTIVE: 0, AlarmState.LATCHED: 1, AlarmState.ACKNOWLEDGED: 2}


def _place(alarm: Alarm) -> tuple[bool, int, int, int]:
    """What stands before what is over; of these the highest, of these what is active, of these the newest."""
    return (alarm.state is AlarmState.LATCHED, -alarm.priority.rank, _ORDER[alarm.state], -alarm.number)
