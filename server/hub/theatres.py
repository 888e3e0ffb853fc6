"""The list of all theatres: what each states, and how old that is at most."""

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from server.hub.connection import LEASE_S
from server.hub.subjects import Leaf
from server.hub.watcher import Received
from server.texts.headline import verdict_title
from server.texts.language import Language
from tracker.navigation import Verdict

# A theatre states itself twice a second.
STALE_AFTER_MS = 2000.0
GONE_AFTER_MS = LEASE_S * 1000.0
NOTHING: tuple[str, str, tuple["AlarmRow", ...]] = ("", "none", ())


class TheatrePresence(StrEnum):
    """What is known of a theatre now."""

    LIVE = "live"
    UNMEASURED = "unmeasured"  # it sends, and how old its messages are is not known yet
    UNREADABLE = "unreadable"  # its newest message is of another version: it may have alarms
    STALE = "stale"  # its newest message is too old: nothing of it is shown
    GONE = "gone"  # it has sent nothing for so long that its name is free


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmRow:
    """One alarm of a theatre: its level, whether it is active, and its title."""

    priority: str
    state: str
    title: str


@dataclass(frozen=True, slots=True, kw_only=True)
class TheatreRow:
    """One theatre.

    Attributes:
        name: Its name.
        presence: What is known of it now.
        age_ms: Age of its newest message at most; None while it is not measured.
        image_age_ms: Age of the image in it at most; None without one.
        headline: Its headline, or the verdict of its figures without figures; empty unless live.
        tone: Colour of the headline; "none" unless live.
        alarms: Its alarms, the highest priority first; empty unless live.
    """

    name: str
    presence: TheatrePresence
    age_ms: float | None
    image_age_ms: float | None
    headline: str
    tone: str
    alarms: tuple[AlarmRow, ...]


def theatre_rows(
    newest: Mapping[tuple[str, Leaf], Received], *, now_s: float, language: Language = "en"
) -> list[TheatreRow]:
    """Return all theatres that were ever heard, by name, `OR-2` before `OR-10`."""
    rows = [
        _row(name, received, now_s=now_s, language=language)
        for (name, leaf), received in newest.items()
        if leaf is Leaf.STATE
    ]
    return sorted(rows, key=lambda row: [int(part) if part.isdigit() else part for part in _parts(row.name)])


def _parts(name: str) -> list[str]:
    """Text and numbers in turn, text first."""
    return re.split(r"(\d+)", name)


def _row(name: str, received: Received, *, now_s: float, language: Language) -> TheatreRow:
    arrival = received.arrival
    age_ms = arrival.message_age_ms(now_s=now_s)
    # Without a measurement its age is at least the time since the arrival.
    known_ms = (now_s - arrival.arrived_s) * 1000.0 if age_ms is None else age_ms
    presence = TheatrePresence.UNMEASURED if age_ms is None else TheatrePresence.LIVE
    if known_ms > STALE_AFTER_MS:
        presence = TheatrePresence.GONE if known_ms > GONE_AFTER_MS else TheatrePresence.STALE
    headline, tone, alarms = NOTHING
    if presence is TheatrePresence.LIVE:
        try:
            headline, tone, alarms = _shown(received.content, language)
        except (ValueError, KeyError, TypeError, RecursionError):
            presence = TheatrePresence.UNREADABLE
    return TheatreRow(
        name=name,
        presence=presence,
        age_ms=age_ms,
        image_age_ms=arrival.image_age_ms(now_s=now_s),
        headline=headline,
        tone=tone,
        alarms=alarms,
    )


def _shown(content: bytes, language: Language) -> tuple[str, str, tuple[AlarmRow, ...]]:
    """Return headline, tone and alarms of a state.

    Raises:
        ValueError, KeyError, TypeError, RecursionError: it is none, or of another version.
    """
    state: dict[str, Any] = json.loads(content)
    title, verdict = state["title"], state["verdict"]
    headline = verdict_title(Verdict(verdict), language) if title is None else _text(title[language])
    alarms = tuple(
        AlarmRow(
            priority=_text(alarm["priority"]),
            state=_text(alarm["state"]),
            title=_text(alarm["title"][language]),
        )
        for alarm in state["alarms"]
    )
    return headline, _text(state["tone"]), alarms


def _text(value: object) -> str:
    """Return a text that can be sent on: half a surrogate pair of one theatre would end the list of all."""
    text = str(value)
    text.encode()
    return text
