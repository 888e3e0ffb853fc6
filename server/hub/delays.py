"""How old a received message is at most, by the hub's own clock."""

from dataclasses import dataclass
from math import inf, isfinite

from server.hub.envelope import Header

# Two clocks may differ in rate by 200 ppm, which is 2 ms in this time.
MAX_HELD_S = 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Arrival:
    """Arrival of a message, and what is known of its age then.

    Attributes:
        arrived_s: Monotonic time of the arrival at the hub.
        transfer_ms: Upper bound of the time from the theatre's sending to the arrival: the round trip of the
            beat that it returns. None while the theatre has returned no beat of this hub.
        age_ms: Age of the image at the theatre's sending; None without an image.
    """

    arrived_s: float
    transfer_ms: float | None
    age_ms: float | None

    def message_age_ms(self, *, now_s: float) -> float | None:
        """Upper bound of the time since the theatre sent the message; None while it is not measured."""
        if self.transfer_ms is None:
            return None
        return self.transfer_ms + (now_s - self.arrived_s) * 1000.0

    def image_age_ms(self, *, now_s: float) -> float | None:
        """Upper bound of the time since the capture of the image; None without an image, or not measured."""
        age_ms = self.message_age_ms(now_s=now_s)
        return None if age_ms is None or self.age_ms is None else age_ms + self.age_ms


def arrival_of(header: Header, hub: str, *, now_s: float) -> Arrival:
    """Return the arrival of a message at `now_s` at the hub of this id.

    Beat and message travel one after the other: the time between sending the beat and receiving the message
    is the sum of both transfers and the time held. Without the time held it is an upper bound of each
    transfer, whatever the two clocks show. Statements that no theatre can make (a beat of the future, a
    negative age) are not used.
    """
    echo = header.echoes.get(hub)
    transfer_ms = None
    if echo is not None and 0.0 <= echo.held_s <= MAX_HELD_S:
        round_trip_ms = (now_s - echo.beat_s - echo.held_s) * 1000.0
        transfer_ms = round_trip_ms if 0.0 <= round_trip_ms < inf else None
    age_ms = header.age_ms
    is_valid = age_ms is not None and isfinite(age_ms) and age_ms >= 0.0
    return Arrival(arrived_s=now_s, transfer_ms=transfer_ms, age_ms=age_ms if is_valid else None)
