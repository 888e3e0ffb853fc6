"""Remedies of problems of the server's processes."""

from server.texts.language import Text

PROCESS: tuple[Text, ...] = (
    {
        "en": "Do not navigate. Restart the program; if the error persists, send the server log to the "
        "maintainer.",
        "de": "Nicht navigieren. Das Programm neu starten; bleibt der Fehler, das Protokoll des Servers an "
        "die Betreuung senden.",
    },
    {
        "en": "Start it again. If it is ended by SIGKILL each time, the machine has too little memory.",
        "de": "Den Vorgang neu starten. Wird er jedes Mal durch SIGKILL beendet, hat der Rechner zu wenig "
        "Speicher.",
    },
    {
        "en": "Try again; if the error persists, send the server log to the maintainer.",
        "de": "Erneut versuchen; bleibt der Fehler, das Protokoll des Servers an die Betreuung senden.",
    },
    {
        "en": "Close other programs or use smaller files, then start it again.",
        "de": "Andere Programme schließen oder kleinere Dateien verwenden, dann neu starten.",
    },
    {
        "en": "Start the recording again; the part written so far is readable. Navigation continues.",
        "de": "Die Aufnahme neu starten; der bisher geschriebene Teil ist lesbar. Die Navigation läuft "
        "weiter.",
    },
    {
        "en": "Start it again; if the error persists, send the server log to the maintainer.",
        "de": "Neu starten; bleibt der Fehler, das Protokoll des Servers an die Betreuung senden.",
    },
    {
        "en": "Wait a minute or two; it starts automatically.",
        "de": "Ein bis zwei Minuten warten; es startet automatisch.",
    },
    {
        "en": "It is restarted automatically; if this repeats, check the server log.",
        "de": "Er wird automatisch neu gestartet; wiederholt sich das, das Protokoll des Servers prüfen.",
    },
    {
        "en": "Check the server log for the reason. It is retried within {window_s:g} s; to retry at once, "
        "restart the program.",
        "de": "Den Grund im Protokoll des Servers suchen. Innerhalb von {window_s:g} s wird es neu "
        "versucht; für einen sofortigen Versuch das Programm neu starten.",
    },
)
