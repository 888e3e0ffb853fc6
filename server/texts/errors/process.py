"""Messages of problems of the server's processes, by code."""

from collections.abc import Mapping

from server.texts.language import Text

PROCESS: Mapping[str, tuple[Text, ...]] = {
    "ALARMS_FAILED": (
        {
            "en": "alarms cannot be raised: {library_error}",
            "de": "Alarme können nicht ausgelöst werden: {library_error}",
        },
    ),
    "JOB_ENDED": (
        {
            "en": "the process of the job {process_problem}",
            "de": "der Prozess des Vorgangs {process_problem}",
        },
    ),
    "JOB_FAILED": (
        {
            "en": "an internal error occurred in the job",
            "de": "im Vorgang trat ein interner Fehler auf",
        },
    ),
    "JOB_OUT_OF_MEMORY": (
        {
            "en": "the job needed more memory than is available",
            "de": "der Vorgang brauchte mehr Speicher, als verfügbar ist",
        },
    ),
    "OVERLAY_FAILED": (
        {
            "en": "the overlay cannot be drawn: {library_error}",
            "de": "die Einblendung lässt sich nicht zeichnen: {library_error}",
        },
    ),
    "RECORDING_PROCESS_ENDED": (
        {
            "en": "the recording process ended {exit}",
            "de": "der Prozess der Aufnahme endete {exit}",
        },
    ),
    "STEP_FAILED": (
        {
            "en": "{activity} ended because of an error in the server",
            "de": "{activity} endete durch einen Fehler im Server",
        },
    ),
    "TRACKER_COMPILING": (
        {
            "en": "the tracker is being compiled for this machine (once): {done} of {total} functions",
            "de": "das Tracking wird für diesen Rechner übersetzt (einmalig): {done} von {total} Funktionen",
        },
    ),
    "TRACKING_PROCESS_ENDED": (
        {
            "en": "the tracking process {process_problem}",
            "de": "der Tracking-Prozess {process_problem}",
        },
    ),
    "TRACKING_GIVEN_UP": (
        {
            "en": "the tracking process was restarted {restarts} times in {window_s:g} s and ended again; "
            "the last time: {last_problem}",
            "de": "der Tracking-Prozess wurde {restarts}-mal in {window_s:g} s neu gestartet und endete "
            "wieder; zuletzt: {last_problem}",
        },
    ),
}
