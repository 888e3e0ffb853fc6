"""The header of a live message: one line of JSON before its content.

Clocks of two computers may disagree by minutes, so no time of day is sent. The theatre states the age of
the image at sending by its own monotonic clock. The transfer is measured by the hub alone: it sends its
monotonic time several times a second, and the theatre returns the newest of these beats with each message,
with the time for which it held it. The time since that beat, without the time held, is at least the
transfer of the message (`delays.py`).
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

MAX_HUBS = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class Echo:
    """The newest beat of a hub, as returned by a theatre.

    Attributes:
        beat_s: The hub's monotonic time in the beat.
        held_s: Time from the beat's arrival in the theatre to the sending, by the theatre's clock.
    """

    beat_s: float
    held_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Header:
    """Header of a live message.

    Attributes:
        run: Run of the publishing process, so that numbers of two runs are not mixed.
        number: Increases by one with each message of a subject in this run; a gap is what was lost.
        age_ms: Time from the capture of the image to the sending; None without an image.
        echoes: The newest beat of each hub, by the hub's id.
    """

    run: str
    number: int
    age_ms: float | None
    echoes: Mapping[str, Echo] = field(default_factory=dict)


def packed(header: Header, content: bytes) -> bytes:
    """Return a message for the wire."""
    members = {
        "run": header.run,
        "number": header.number,
        "age_ms": header.age_ms,
        "echoes": {hub: [echo.beat_s, echo.held_s] for hub, echo in header.echoes.items()},
    }
    return json.dumps(members, separators=(",", ":")).encode() + b"\n" + content


def unpacked(message: bytes) -> tuple[Header, bytes]:
    """Return header and content of a message.

    Raises:
        ValueError: it is none.
    """
    line, separator, content = message.partition(b"\n")
    if not separator:
        raise ValueError("the message has no header")
    try:
        members: dict[str, Any] = json.loads(line)
        age_ms = members["age_ms"]
        return (
            Header(
                run=str(members["run"]),
                number=int(members["number"]),
                age_ms=None if age_ms is None else float(age_ms),
                echoes={
                    str(hub): Echo(beat_s=float(beat_s), held_s=float(held_s))
                    for hub, (beat_s, held_s) in members["echoes"].items()
                },
            ),
            content,
        )
    except (KeyError, TypeError, AttributeError, OverflowError, RecursionError) as error:
        raise ValueError(f"the header is not valid: {error}") from None


class Beats:
    """The newest beat of each hub, in the theatre. Times are monotonic."""

    def __init__(self) -> None:
        self._newest: dict[str, tuple[float, float]] = {}

    def take(self, hub: str, beat_s: float, *, now_s: float) -> None:
        """Store a beat that has just arrived; the hubs that were silent for longest are dropped."""
        self._newest.pop(hub, None)
        self._newest[hub] = (beat_s, now_s)
        if len(self._newest) > MAX_HUBS:
            del self._newest[next(iter(self._newest))]

    def echoes(self, *, now_s: float) -> dict[str, Echo]:
        """Return what a message sent at `now_s` returns to the hubs."""
        return {
            hub: Echo(beat_s=beat_s, held_s=now_s - arrived_s)
            for hub, (beat_s, arrived_s) in self._newest.items()
        }
