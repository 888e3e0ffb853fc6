"""Scheduled disturbances: motion, occlusion, and loss of images."""

import math
from dataclasses import dataclass
from enum import StrEnum

from tracker.errors import InvalidInput

MAX_S, MAX_MM, MAX_DEG = 1e5, 60.0, 20.0


class EventKind(StrEnum):
    """Kind of disturbance."""

    CAMERA_MOVES = "camera_moves"  # the camera moves, and with it everything in the image
    PATIENT_MOVES = "patient_moves"  # bone, needles and reference move in a static room
    DRILL_JUMPS = "drill_jumps"  # the drill is displaced between two images
    DRILL_HIDDEN = "drill_occluded"  # a cloth lies over its marker
    REFERENCE_HIDDEN = "reference_occluded"  # a cloth lies over the reference marker
    CAMERA_STOPS = "camera_stops"  # the camera is disconnected
    CAMERA_STALLS = "camera_stalls"  # the camera is open, but delivers no images


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """A disturbance at a known time; it begins and ends between two images.

    Attributes:
        kind: kind of disturbance.
        at_s: start, on the theatre's clock.
        lasts_s: duration; may be infinite.
        every_s: period of repetition; infinite for a single event.
        size_mm: size of the translation; its direction follows from the seed.
        size_deg: size of the rotation.

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
        for key, maximum in (("at_s", MAX_S), ("size_mm", MAX_MM), ("size_deg", MAX_DEG)):
            value = float(getattr(self, key))
            if not 0.0 <= value <= maximum:
                raise rejected(f"events.{key}", value, f"a number from 0 to {maximum:g}")
        for key in ("lasts_s", "every_s"):
            value = float(getattr(self, key))
            if not value > 0.0:
                raise rejected(f"events.{key}", value, "a number above 0")

    def is_on(self, at_s: float) -> bool:
        """Return whether the event is active at this time."""
        since_s = at_s - self.at_s
        if since_s < 0.0:
            return False
        return (since_s if math.isinf(self.every_s) else since_s % self.every_s) < self.lasts_s

    def over_at_s(self, at_s: float) -> float:
        """Return the end time of the active event; infinite if it does not end."""
        begun_s = self.at_s
        if not math.isinf(self.every_s):
            begun_s += (at_s - self.at_s) // self.every_s * self.every_s
            if self.lasts_s >= self.every_s:
                return math.inf
        return begun_s + self.lasts_s


def rejected(key: str, value: object, allowed: str) -> InvalidInput:
    """Return the error for an invalid rehearsal setting."""
    return InvalidInput(
        "REHEARSAL_SETTING_INVALID",
        f"the rehearsal's {key} is {value}, allowed is {allowed}",
        f"Set {key} to {allowed}.",
        {"key": key, "value": value, "allowed_values": allowed},
    )
