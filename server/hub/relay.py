"""A theatre's live message as the hub sends it to a page: on its own clock, with upper bounds of ages.

The page compares its own clock with the one of the server that it talks to, and so counts the transfer from
the hub. Times of the theatre's clock would mean nothing there: the capture time is replaced by the latest
time at which the image was certainly captured already, on the hub's clock.
"""

import json
from dataclasses import dataclass
from typing import Any

from server.hub.delays import Arrival
from server.hub.pictures import PICTURE_WIDTH_PX

# Alarms have no age of their own on the page, which counts a server that is silent for 0.8 s as lost. What
# arrives later than this is therefore not sent: the page covers everything.
MAX_AGE_MS = 1000.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Relayed:
    """A live message that may be sent on.

    Attributes:
        arrival: Its arrival at the hub.
        message: Its members, without those that depend on the time of sending.
        captured_at_s: Capture time by the theatre's clock; None without an image.
        image_number: Of the image; None without one.
    """

    arrival: Arrival
    message: dict[str, Any]
    captured_at_s: float | None
    image_number: int | None

    def text(self, *, now_s: float) -> str | None:
        """Return the message to be sent at `now_s`; None if it is too old, or its age is not known."""
        age_ms = self.arrival.message_age_ms(now_s=now_s)
        if age_ms is None or age_ms > MAX_AGE_MS:
            return None
        sent = {"sent_at_s": now_s, "image_age_ms": self.arrival.image_age_ms(now_s=now_s)}
        return json.dumps(self.message | sent, ensure_ascii=False, separators=(",", ":"))


def relayed(content: bytes, arrival: Arrival, *, has_picture: bool = False) -> Relayed:
    """Return a theatre's live message for the pages of the hub.

    Raises:
        ValueError: it is none, or states an image without its age.
    """
    try:
        message: dict[str, Any] = json.loads(content)
        snapshot = message["snapshot"]
        if snapshot is None:
            return Relayed(arrival=arrival, message=message, captured_at_s=None, image_number=None)
        captured_at_s, number = float(snapshot["captured_at_s"]), int(snapshot["image_number"])
        width_px = int(snapshot["width_px"])
    except (KeyError, TypeError, IndexError, OverflowError, RecursionError) as error:
        raise ValueError(f"the live message is not valid: {error}") from None
    age_ms = arrival.image_age_ms(now_s=arrival.arrived_s)
    if age_ms is None and arrival.transfer_ms is not None:
        raise ValueError("the live message has an image without an age")
    on_hub_s = arrival.arrived_s - (age_ms or 0.0) / 1000.0
    scale = min(1.0, PICTURE_WIDTH_PX / max(1, width_px)) if has_picture else message.get("shown_scale_ratio")
    return Relayed(
        arrival=arrival,
        message=message | {"snapshot": snapshot | {"captured_at_s": on_hub_s}, "shown_scale_ratio": scale},
        captured_at_s=captured_at_s,
        image_number=number,
    )
