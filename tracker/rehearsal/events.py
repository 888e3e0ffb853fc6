"""What goes wrong in the theatre, and when: something moves, is hidden, or gives no images."""

import math
from dataclasses import dataclass
from enum import StrEnum

from tracker.errors import InvalidInput

MAX_S, MAX_MM, MAX_DEG = 1e5, 60.0, 20.0


class EventKind(StrEnum):
    """What happens."""

    CAMERA_MOVES = "camera_moves"  # somebody bumps into it: everything in the image is elsewhere
    PATIENT_MOVES = "patient_moves"  # bone, needles and reference move in a room that stands still
    DRILL_JUMPS = "drill_jumps"  # from one image to the next the drill is elsewhere
    DRILL_HIDDEN = "drill_hidden"  # a cloth lies over its marker
    REFERENCE_HIDDEN = "reference_hidden"  # a cloth lies over the reference marker
    CAMERA_STOPS = "camera_stops"  # its cable is out
    CAMERA_STALLS = "camera_stalls"  # it is open, and gives nothing


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """Something that happens at a known time; it is there, or not, from one image to the next.

    Attributes:
        kind: what happens.
        at_s: when, on the theatre's clock.
        lasts_s: how long; infinite is for good.
        every_s: it comes back after this; infinite is once.
        size_mm: how far what moves is moved; which way follows from the seed.
        size_deg: how far it is turned.

    Raises:
        InvalidInput: REHEARSAL_SETTING_INVALID, with the key, its value and what is allowed.
    """

    kind: EventKind
    at_s: float
    lasts_s: float = math.inf
    every_s: float = math.inf
    size_mm: float = 12.0
    size_deg: float = 2.0

    def __post_init__(self) -> None:
        for key, most in (("at_s", MAX_S), ("size_mm", MAX_MM), ("size_deg", MAX_DEG)):
            value = float(getattr(self, key))
            if not 0.0 <= value <= most:
                raise rejected(f"events.{key}", value, f"a number from 0 to {most:g}")
        for key in ("lasts_s", "every_s"):
            value = float(getattr(self, key))
            if not value > 0.0:
                raise rejected(f"events.{key}", value, "a number above 0")

    def is_on(self, at_s: float) -> bool:
        """Whether it is there at this time."""
        since_s = at_s - self.at_s
        if since_s < 0.0:
            return False
        return (since_s if math.isinf(self.every_s) else since_s % self.every_s) < self.lasts_s

    def over_at_s(self, at_s: float) -> float:
        """When it is over, once it is there at this time; infinite for never."""
        begun_s = self.at_s
        if not math.isinf(self.every_s):
            begun_s += (at_s - self.at_s) // self.every_s * self.every_s
            if self.lasts_s >= self.every_s:
                return math.inf
        return begun_s + self.lasts_s


def rejected(key: str, value: object, allowed: str) -> InvalidInput:
    """The error for a setting of the rehearsal."""
    return InvalidInput(
        "REHEARSAL_SETTING_INVALID",
        f"the rehearsal's {key} is {value}, allowed is {allowed}",
        f"Set {key} to {allowed}.",
        {"key": key, "value": value},
    )
