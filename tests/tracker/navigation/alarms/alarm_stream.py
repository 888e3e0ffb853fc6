"""A theatre without alarms, and an engine that is stepped image by image."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from tracker.navigation.alarms import AlarmEngine, AlarmEvent, AlarmInputs, AlarmLimits, AlarmSnapshot, Change

RATE_HZ = 30.0


def good(image_number: int = 0, at_s: float = 0.0, **changes: object) -> AlarmInputs:
    """A drill in the middle of its channel, on an armed screen."""
    whole = AlarmInputs(
        navigating=True,
        image_number=image_number,
        captured_at_s=at_s,
        clearance_mm=2.0,
        breach_ratio=0.001,
        past_depth_mm=-10.0,
        tip_sd_mm=0.3,
        max_tip_sd_mm=1.0,
        check_age_s=60.0,
        armed_screens=1,
        free_disk_mb=50_000.0,
    )
    return replace(whole, **changes)  # pyrefly: ignore[bad-argument-type]  # any field of it


@dataclass(slots=True)
class Stream:
    """Images one after the other, each looked at as it is grabbed."""

    engine: AlarmEngine = field(default_factory=lambda: AlarmEngine(AlarmLimits()))
    at_s: float = 100.0
    image_number: int = -1
    rate_hz: float = RATE_HZ
    events: list[AlarmEvent] = field(default_factory=list)

    def image(self, **changes: object) -> AlarmSnapshot:
        """One more image."""
        self.at_s += 1.0 / self.rate_hz
        self.image_number += 1
        return self._took(self.engine.step(good(self.image_number, self.at_s, **changes), self.at_s))

    def images(self, seconds: float, **changes: object) -> AlarmSnapshot:
        """Images for this long, all alike."""
        picture = self.engine.picture
        for _ in range(max(1, round(seconds * self.rate_hz))):
            picture = self.image(**changes)
        return picture

    def silence(self, seconds: float, **changes: object) -> AlarmSnapshot:
        """No image for this long; looked at twenty times a second."""
        captured_at_s, picture = self.at_s, self.engine.picture
        for _ in range(max(1, round(seconds * 20))):
            self.at_s += 0.05
            silent_s = self.at_s - captured_at_s
            seen = good(self.image_number, captured_at_s, **{"camera_silent_s": silent_s, **changes})
            picture = self._took(self.engine.step(seen, self.at_s))
        return picture

    def acknowledge(self, by: str = "surgeon") -> AlarmSnapshot:
        """Everything that is in sight."""
        numbers = [alarm.number for alarm in self.engine.picture.alarms]
        return self._took(self.engine.acknowledge(numbers, by=by, at_s=self.at_s))

    def command(self, call: Callable[[AlarmEngine], AlarmSnapshot]) -> AlarmSnapshot:
        """Something that a person does."""
        return self._took(call(self.engine))

    def raised(self) -> list[str]:
        """The conditions that were raised, in their order."""
        kinds = (Change.RAISED, Change.WORSE)
        return [str(event.condition) for event in self.events if event.change in kinds]

    def _took(self, picture: AlarmSnapshot) -> AlarmSnapshot:
        self.events += picture.events
        return picture
