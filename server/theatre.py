"""Simulated theatre of the rehearsal from the settings."""

import math
from typing import TYPE_CHECKING

from server.config import RehearsalConfig

if TYPE_CHECKING:
    from tracker.rehearsal import Theatre


def theatre_from_config(rehearsal: RehearsalConfig) -> "Theatre":
    """Return the theatre of these settings.

    Raises:
        InvalidInput: REHEARSAL_SETTING_INVALID.
    """
    # Imported here, because it loads slowly and only the rehearsal needs it.
    from tracker.rehearsal import (  # noqa: PLC0415
        BoardKind,
        Event,
        EventKind,
        Scene,
        Skill,
        Theatre,
        TheatreSettings,
    )

    events = tuple(
        Event(
            kind=EventKind(event.kind),
            at_s=event.at_s,
            lasts_s=math.inf if event.lasts_s is None else event.lasts_s,
            every_s=math.inf if event.every_s is None else event.every_s,
            size_mm=event.size_mm,
            size_deg=event.size_deg,
        )
        for event in rehearsal.events
    )
    return Theatre(
        TheatreSettings(
            seed=rehearsal.seed,
            size_wh_px=(rehearsal.width, rehearsal.height),
            noise=rehearsal.noise,
            blur=rehearsal.blur,
            clutter=rehearsal.clutter,
            light=rehearsal.light,
            scene=Scene(rehearsal.scene),
            board=BoardKind(rehearsal.board),
            skill=Skill(rehearsal.skill),
            rest_s=rehearsal.rest_s,
            reference=rehearsal.reference,
            events=events,
        )
    )
