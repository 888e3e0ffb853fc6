"""Phrases in problems of the server's processes."""

from collections.abc import Mapping

from server.texts.language import Text

PROCESS: Mapping[str, tuple[Text, ...]] = {
    "exit": (
        {
            "en": "in an unknown way",
            "de": "auf unbekannte Weise",
        },
        {
            "en": "by signal {signal}",
            "de": "durch Signal {signal}",
        },
        {
            "en": "with status {status}",
            "de": "mit dem Status {status}",
        },
        {
            "en": "because of an error ({error_type}: {library_error})",
            "de": "durch einen Fehler ({error_type}: {library_error})",
        },
    ),
    "process_problem": (
        {
            "en": "ended",
            "de": "endete",
        },
        {
            "en": "was stopped",
            "de": "wurde angehalten",
        },
        {
            "en": "ended {exit}",
            "de": "endete {exit}",
        },
        {
            "en": "could not be started: {library_error}",
            "de": "ließ sich nicht starten: {library_error}",
        },
        {
            "en": "sent nothing for {silent_s} s, limit {limit_s} s",
            "de": "sendete {silent_s} s lang nichts, Grenze {limit_s} s",
        },
        {
            "en": "could not be monitored",
            "de": "ließ sich nicht überwachen",
        },
        {
            "en": "returned a result that could not be stored",
            "de": "lieferte ein Ergebnis, das sich nicht speichern ließ",
        },
    ),
    "last_problem": (
        {
            "en": "the tracking process {process_problem}",
            "de": "der Tracking-Prozess {process_problem}",
        },
    ),
    "activity": (
        {
            "en": "collecting poses of {tool}",
            "de": "die Aufnahme von Lagen von {tool}",
        },
        {
            "en": "capturing {landmark}",
            "de": "das Antasten von {landmark}",
        },
        {
            "en": "sweeping {vertebra}",
            "de": "das Abfahren von {vertebra}",
        },
        {
            "en": "collecting views of the board",
            "de": "die Aufnahme von Ansichten der Tafel",
        },
        {
            "en": "reading codes for the latency",
            "de": "das Lesen der Codes für die Latenz",
        },
        {
            "en": "watching the moving board",
            "de": "das Beobachten der bewegten Tafel",
        },
        {
            "en": "watching for moves",
            "de": "das Beobachten von Bewegungen",
        },
    ),
}
