"""Errors of the operating system, as it words them, in lower case."""

from server.texts.language import Text

SYSTEM_ERRORS: tuple[Text, ...] = (
    {
        "en": "no such file or directory",
        "de": "Datei oder Ordner nicht gefunden",
    },
    {
        "en": "permission denied",
        "de": "keine Berechtigung",
    },
    {
        "en": "is a directory",
        "de": "es ist ein Ordner",
    },
    {
        "en": "not a directory",
        "de": "es ist kein Ordner",
    },
    {
        "en": "input/output error",
        "de": "Ein-/Ausgabefehler",
    },
    {
        "en": "too many open files",
        "de": "zu viele offene Dateien",
    },
    {
        "en": "no space left on device",
        "de": "kein Platz auf dem Datenträger",
    },
    {
        "en": "connection refused",
        "de": "Verbindung abgelehnt",
    },
    {
        "en": "connection reset by peer",
        "de": "Verbindung von der Gegenseite beendet",
    },
    {
        "en": "connection timed out",
        "de": "Zeitüberschreitung der Verbindung",
    },
    {
        "en": "no route to host",
        "de": "kein Weg zum Rechner",
    },
    {
        "en": "network is unreachable",
        "de": "Netz nicht erreichbar",
    },
    {
        "en": "name or service not known",
        "de": "Name des Rechners unbekannt",
    },
    {
        "en": "temporary failure in name resolution",
        "de": "der Name des Rechners lässt sich zurzeit nicht auflösen",
    },
)
