"""State of a theatre for the list of many: no figures, since one of half a second ago is too old."""

import json
from typing import Any


def state_of(live_text: str) -> str:
    """Return the state in a `LiveMessage`, both as JSON.

    Headline and alarms have the words that the page shows beside figures that are too old.
    """
    live: dict[str, Any] = json.loads(live_text)
    headline = live["headline"]
    return json.dumps(
        {
            "source": live["source"]["state"],
            "process": live["process"]["state"],
            "has_image": live["snapshot"] is not None,
            "verdict": headline["verdict"],
            "tone": headline["tone"],
            # With a verdict the title has a figure.
            "title": headline["title"] if headline["verdict"] is None else None,
            "alarms": [
                {
                    "number": one["number"],
                    "priority": one["priority"],
                    "state": one["state"],
                    "title": one["title"],
                    "sentence": one["sentence_without_figures"],
                }
                for one in live["alarms"]["alarms"]
            ],
        },
        ensure_ascii=False,
        separators=(",", ":"),
    )
