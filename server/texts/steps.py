"""Reasons of the steps of the procedure, and of documents that are out of date, by code."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from server.texts.language import NO_TEXT, Text


@dataclass(frozen=True, slots=True)
class Sentence:
    """Templates of the message, without its full stop, and of the remedy."""

    message: Text
    remedy: Text = field(default_factory=lambda: NO_TEXT)


CALIBRATE_CAMERA: Text = {
    "en": "Calibrate the camera with views of the board.",
    "de": "Die Kamera mit Ansichten der Tafel kalibrieren.",
}
PIVOT_TOOL: Text = {
    "en": "Calibrate the tool by pivoting it.",
    "de": "Das Instrument durch Schwenken kalibrieren.",
}
MAKE_PLAN: Text = {
    "en": "Upload the CT, and add a vertebra to the plan.",
    "de": "Das CT hochladen und einen Wirbel in die Planung aufnehmen.",
}
SELECT_CHANNEL: Text = {
    "en": "Select the channel to be drilled in the plan.",
    "de": "In der Planung den Kanal wählen, der gebohrt wird.",
}
REGISTER: Text = {
    "en": "Register by touching the landmarks of the plan.",
    "de": "Durch Antasten der geplanten Landmarken registrieren.",
}
CHECK: Text = {
    "en": "Hold the tip on a landmark that was not used.",
    "de": "Die Spitze auf eine Landmarke halten, die nicht zur Registrierung diente.",
}

STEPS: Mapping[str, Text] = {
    "camera": {"en": "the camera", "de": "Kamera"},
    "tool": {"en": "the tool", "de": "Instrument"},
    "plan": {"en": "the plan", "de": "Planung"},
    "register": {"en": "the registration", "de": "Registrierung"},
    "check": {"en": "the check on anatomy", "de": "Prüfung"},
    "navigate": {"en": "navigation", "de": "Navigation"},
}
METHODS: Mapping[str, Text] = {
    "points": {"en": "landmarks", "de": "Landmarken"},
    "needles": {"en": "needles", "de": "Nadeln"},
    "surface": {"en": "a surface sweep", "de": "Abfahren der Oberfläche"},
    "rehearsal": {"en": "the rehearsal", "de": "Probebetrieb"},
}

REASONS: Mapping[str, Sentence] = {
    "NO_CASE_OPEN": Sentence(
        {"en": "no case is open", "de": "es ist kein Fall geöffnet"},
        {
            "en": "Create a case and open it, or open an existing one.",
            "de": "Einen Fall anlegen und öffnen, oder einen vorhandenen öffnen.",
        },
    ),
    # camera
    "CAMERA_NOT_CALIBRATED": Sentence(
        {"en": "the camera is not calibrated", "de": "die Kamera ist nicht kalibriert"}, CALIBRATE_CAMERA
    ),
    "CAMERA_IN_SETTINGS": Sentence(
        {
            "en": "the camera calibration is in the settings",
            "de": "die Kalibrierung der Kamera steht in den Einstellungen",
        }
    ),
    "EXTERNAL_TRACKER": Sentence(
        {
            "en": "an external tracker measures in place of a camera",
            "de": "ein externes Trackingsystem misst anstelle einer Kamera",
        }
    ),
    "CAMERA_CALIBRATED": Sentence({"en": "the camera is calibrated", "de": "die Kamera ist kalibriert"}),
    "CAMERA_CHECKED": Sentence(
        {
            "en": "the camera is calibrated and its accuracy checked",
            "de": "die Kamera ist kalibriert und ihre Genauigkeit geprüft",
        }
    ),
    "CAMERA_INACCURATE": Sentence(
        {
            "en": "the error of a known distance is {error_mm} mm, limit {limit_mm} mm",
            "de": "der Fehler eines bekannten Abstands ist {error_mm} mm, Grenze {limit_mm} mm",
        },
        {
            "en": "Check the accuracy again on a flat board, or calibrate the camera again.",
            "de": "Die Genauigkeit erneut an einer ebenen Tafel prüfen oder die Kamera neu kalibrieren.",
        },
    ),
    # tool
    "NO_TOOL_CALIBRATED": Sentence(
        {"en": "no tool is calibrated", "de": "es ist kein Instrument kalibriert"}, PIVOT_TOOL
    ),
    "TOOL_AXIS_MISSING": Sentence(
        {"en": "the axis of '{tool}' is not calibrated", "de": "die Achse von „{tool}“ ist nicht kalibriert"},
        {
            "en": "Calibrate the axis by spinning the tool about it.",
            "de": "Die Achse kalibrieren: das Instrument um seine Achse drehen.",
        },
    ),
    "TOOLS_CALIBRATED": Sentence({"en": "calibrated: {tools}", "de": "kalibriert: {tools}"}),
    # plan
    "NOT_PLANNED": Sentence({"en": "nothing is planned", "de": "es ist nichts geplant"}, MAKE_PLAN),
    "NO_CHANNEL_SELECTED": Sentence(
        {"en": "no channel is selected for drilling", "de": "es ist kein Kanal zum Bohren gewählt"},
        SELECT_CHANNEL,
    ),
    "PLAN_OF_REHEARSAL": Sentence(
        {
            "en": "{reason}; the figures are of the rehearsal's own plan and registration",
            "de": "{reason}; die Werte gehören zu Planung und Registrierung des Probebetriebs",
        }
    ),
    "CHANNEL_SELECTED": Sentence(
        {
            "en": "a channel of {vertebra} is chosen for drilling",
            "de": "ein Kanal von {vertebra} ist zum Bohren gewählt",
        }
    ),
    # registration
    "VERTEBRA_UNKNOWN": Sentence(
        {
            "en": "the vertebra to be drilled is not known",
            "de": "es ist nicht bekannt, welcher Wirbel gebohrt wird",
        },
        SELECT_CHANNEL,
    ),
    "NOT_REGISTERED": Sentence(
        {"en": "{vertebra} is not registered", "de": "{vertebra} ist nicht registriert"}, REGISTER
    ),
    "REGISTERED": Sentence(
        {
            "en": "{vertebra} is registered by {method}",
            "de": "{vertebra} ist registriert, Verfahren: {method}",
        }
    ),
    # check
    "NOTHING_TO_CHECK": Sentence(
        {
            "en": "there is no registration to check",
            "de": "es gibt keine gültige Registrierung, die geprüft werden könnte",
        },
        REGISTER,
    ),
    "NOT_CHECKED": Sentence(
        {
            "en": "{title} has not been checked on a landmark",
            "de": "{title} ist nicht an einer Landmarke geprüft",
        },
        CHECK,
    ),
    "CHECK_WITHDRAWN": Sentence(
        {
            "en": "the check was withdrawn by {by}: {why}",
            "de": "die Prüfung wurde zurückgezogen von {by}: {why}",
        },
        CHECK,
    ),
    "UNCHECKED_SINCE_RESTART": Sentence(
        {
            "en": "the server was restarted after {vertebra} was registered to the camera; a move of the "
            "camera meanwhile was not detected",
            "de": "der Server wurde neu gestartet, nachdem {vertebra} zur Kamera registriert war; eine "
            "Bewegung der Kamera in dieser Zeit wurde nicht erkannt",
        },
        CHECK,
    ),
    "CHECK_PASSED": Sentence(
        {
            "en": "the tip on {landmark} was {distance_mm:.2f} mm from the planned landmark, limit "
            "{max_mm:.2f} mm",
            "de": "die Spitze auf {landmark} war {distance_mm:.2f} mm von der geplanten Landmarke entfernt, "
            "Grenze {max_mm:.2f} mm",
        }
    ),
    "CHECK_FAILED": Sentence(
        {
            "en": "the tip on {landmark} was {distance_mm:.2f} mm from the planned landmark, limit "
            "{max_mm:.2f} mm",
            "de": "die Spitze auf {landmark} war {distance_mm:.2f} mm von der geplanten Landmarke entfernt, "
            "Grenze {max_mm:.2f} mm",
        },
        {
            "en": "Check again, nudge the registration, or register again.",
            "de": "Erneut prüfen, die Registrierung feinkorrigieren oder neu registrieren.",
        },
    ),
    "CHECK_DUE": Sentence(
        {
            "en": "the check on {landmark} is {age_min:.0f} min old, required every {again_after_min:g} min",
            "de": "die Prüfung an {landmark} ist {age_min:.0f} min alt, nötig alle {again_after_min:g} min",
        },
        CHECK,
    ),
    # navigation
    "NAVIGATION_ALLOWED": Sentence(
        {
            "en": "the tool is shown relative to the channel",
            "de": "das Instrument wird relativ zum Kanal angezeigt",
        }
    ),
    "WAITS_FOR_STEP": Sentence(
        {"en": "{step} waits for {waits_for}: {reason}", "de": "{step} wartet auf {waits_for}: {reason}"}
    ),
    "WAITS_FOR_COSIGNATURE": Sentence(
        {
            "en": "navigation waits for a co-signature: {reason}",
            "de": "Navigation wartet auf eine Gegenzeichnung: {reason}",
        }
    ),
    "WAITS_FOR_CONFIRMATION": Sentence(
        {
            "en": "navigation waits for a confirmation: {reason}",
            "de": "Navigation wartet auf eine Bestätigung: {reason}",
        }
    ),
    "NOT_COSIGNED": Sentence(
        {
            "en": "{title} is not signed by a second person",
            "de": "{title} ist nicht von einer zweiten Person gegengezeichnet",
        },
        {
            "en": "Have a second person review and sign it on the supervisor's page.",
            "de": "Von einer zweiten Person auf der Seite der Aufsicht prüfen und gegenzeichnen lassen.",
        },
    ),
    "SERVER_STARTED": Sentence(
        {
            "en": "the server was restarted, and nobody has confirmed yet that patient, marker and camera "
            "have not moved",
            "de": "der Server wurde neu gestartet, und niemand hat bestätigt, dass Patient, Marker und "
            "Kamera nicht bewegt wurden",
        }
    ),
    "TRACKING_STARTED": Sentence(
        {
            "en": "tracking was restarted, and a move of the camera meanwhile was not detected",
            "de": "das Tracking wurde neu gestartet, und eine Bewegung der Kamera in dieser Zeit wurde "
            "nicht erkannt",
        }
    ),
    # documents
    "WITHDRAWN": Sentence(
        {"en": "{title} was withdrawn by {by}: {why}", "de": "{title} wurde zurückgezogen von {by}: {why}"}
    ),
    "DAMAGED": Sentence(
        {"en": "{title} is damaged on the disk", "de": "{title} ist auf der Platte beschädigt"}
    ),
    "REPLACED": Sentence(
        {
            "en": "{title} was replaced by version {version}",
            "de": "{title} wurde durch Version {version} ersetzt",
        }
    ),
    "BASIS_WITHDRAWN": Sentence(
        {
            "en": "it depends on {title}, which was withdrawn by {by}: {why}",
            "de": "beruht auf {title}, zurückgezogen von {by}: {why}",
        }
    ),
    "BASIS_DAMAGED": Sentence(
        {
            "en": "it depends on {title}, which is damaged on the disk",
            "de": "beruht auf {title}, auf der Platte beschädigt",
        }
    ),
    "BASIS_REPLACED": Sentence(
        {
            "en": "it depends on {title}, which was replaced by version {version}",
            "de": "beruht auf {title}, ersetzt durch Version {version}",
        }
    ),
    # damage of a case on the disk
    "FILE_NOT_READ": Sentence(
        {
            "en": "the file {file} cannot be read: {system_error}",
            "de": "die Datei {file} ist nicht lesbar: {system_error}",
        }
    ),
    "FILE_SIZE_DIFFERS": Sentence(
        {
            "en": "the file {file} has {size_bytes} bytes, but was stored with {stored_bytes}",
            "de": "die Datei {file} hat {size_bytes} Bytes, wurde aber mit {stored_bytes} gespeichert",
        }
    ),
    "FILE_CONTENT_DIFFERS": Sentence(
        {
            "en": "the content of the file {file} differs from the stored one (SHA-256)",
            "de": "der Inhalt der Datei {file} weicht vom gespeicherten ab (SHA-256)",
        }
    ),
    "FILE_ENTRY_DAMAGED": Sentence(
        {
            "en": "the entry of the file {file} in the database is missing or was changed",
            "de": "der Eintrag der Datei {file} in der Datenbank fehlt oder wurde verändert",
        }
    ),
    "DOCUMENT_ENTRY_DAMAGED": Sentence(
        {
            "en": "a document is damaged in the database",
            "de": "ein Dokument ist in der Datenbank beschädigt",
        }
    ),
    "BASE_MISSING": Sentence(
        {
            "en": "a document that others depend on is missing in the database",
            "de": "ein Dokument, von dem andere abhängen, fehlt in der Datenbank",
        }
    ),
}
CONFIRM: Mapping[str, Text] = {
    "reference": {
        "en": "Verify that this is the patient and that the marker on the bone is untouched. Then confirm, "
        "or check on a landmark.",
        "de": "Prüfen, dass es dieser Patient ist und der Marker unverändert am Knochen sitzt. Dann "
        "bestätigen, oder an einer Landmarke prüfen.",
    },
    "camera": {
        "en": "Verify in the video that the planned channel is still on the bone. Then confirm, or check on "
        "a landmark.",
        "de": "Im Bild prüfen, dass der geplante Kanal noch auf dem Knochen liegt. Dann bestätigen, oder an "
        "einer Landmarke prüfen.",
    },
}
KINDS: Mapping[str, Text] = {
    "patient": {"en": "patient", "de": "Patient"},
    "camera": {"en": "camera", "de": "Kamera"},
    "marker": {"en": "marker", "de": "Marker"},
    "tool": {"en": "tool", "de": "Instrument"},
    "ct": {"en": "ct", "de": "CT"},
    "labels": {"en": "labels", "de": "Wirbel-Labels"},
    "surface": {"en": "a surface sweep", "de": "Oberfläche"},
    "plan": {"en": "plan", "de": "Planung"},
    "registration": {"en": "registration", "de": "Registrierung"},
    "check": {"en": "check", "de": "Prüfung"},
    "confirmation": {"en": "confirmation", "de": "Bestätigung"},
    "placement": {"en": "placed screw", "de": "gesetzte Schraube"},
    "signature": {"en": "signature", "de": "Gegenzeichnung"},
    "consent": {"en": "consent", "de": "Einwilligung"},
    "comment": {"en": "comment", "de": "Kommentar"},
    "snapshot": {"en": "snapshot", "de": "Momentaufnahme"},
    "alarm": {"en": "alarm", "de": "Alarm"},
    "audit": {"en": "audit", "de": "Protokoll"},
}
# Why the server withdraws a document. The document stores the English text.
WITHDRAWALS: Mapping[str, Text] = {
    "CAMERA_MOVED": {
        "en": "the camera has moved since the registration",
        "de": "die Kamera wurde seit der Registrierung bewegt",
    },
    "REFERENCE_MOVED": {
        "en": "the marker on the patient has moved since the registration",
        "de": "der Patientenmarker wurde seit der Registrierung bewegt",
    },
    "SIGNATURE_WITHDRAWN": {
        "en": "the signature was withdrawn",
        "de": "die Gegenzeichnung wurde zurückgezogen",
    },
    "CHANNEL_UNSET": {
        "en": "the active channel was unset",
        "de": "der Kanal, der gebohrt wird, wurde abgewählt",
    },
    "SCREW_NOT_PLACED": {"en": "the screw is not placed", "de": "die Schraube ist nicht gesetzt"},
    "MARKER_REMOVED": {"en": "the marker was removed", "de": "der Marker wurde entfernt"},
    "WITHDRAWAL_LOST": {
        "en": "it was withdrawn before, and the disk has lost that",
        "de": "es wurde schon zurückgezogen, und die Platte hat das verloren",
    },
}
