"""Texts of the reasons for missing figures."""

from collections.abc import Mapping
from dataclasses import dataclass

from server.texts.language import Language
from tracker.navigation import AbsentReason
from tracker.pose import UnseenReason


@dataclass(frozen=True, slots=True)
class State:
    """Title in capitals, and the meaning or what to do."""

    title: str
    detail: str


STATES: Mapping[Language, Mapping[AbsentReason, State]] = {
    "en": {
        AbsentReason.MARKER_UNSEEN: State("NO TRACKING", "marker not seen"),
        AbsentReason.MARKER_TWICE: State("MARKER TWICE IN VIEW", "cover or remove all but one"),
        AbsentReason.CAMERA_NOT_CALIBRATED: State("CAMERA NOT CALIBRATED", "calibrate the camera first"),
        AbsentReason.CAMERA_CHANGED: State("CAMERA CHANGED", "set it back, or calibrate again"),
        AbsentReason.POSE_UNCERTAIN: State("POSE UNCERTAIN", "hold the marker closer, steadier, more tilted"),
        AbsentReason.TOOL_NOT_DEFINED: State("TOOL NOT DEFINED", "calibrate the tool first"),
        AbsentReason.NOT_REGISTERED: State("NOT REGISTERED", "register plan and patient"),
        AbsentReason.NO_PLAN: State("NO PLAN", "plan a channel on the CT"),
        AbsentReason.REFERENCE_UNSEEN: State("PATIENT NOT SEEN", "clear the view of the patient marker"),
        AbsentReason.CAMERA_MOVED: State("CAMERA MOVED", "register again"),
        AbsentReason.REFERENCE_MOVED: State("PATIENT MOVED", "check on a landmark, or register again"),
        AbsentReason.POSE_JUMPED: State("POSE AMBIGUOUS", "hold the drill still for a moment"),
        AbsentReason.NOT_CHECKED: State("NOT CHECKED", "touch a landmark to check the registration"),
        AbsentReason.NOT_CONFIRMED: State("NAVIGATION STOPPED", "restarted: the operator must confirm"),
        AbsentReason.NOT_COSIGNED: State("NOT CO-SIGNED", "a second person must sign plan and registration"),
    },
    "de": {
        AbsentReason.MARKER_UNSEEN: State("KEIN TRACKING", "Marker nicht gesehen"),
        AbsentReason.MARKER_TWICE: State(
            "MARKER DOPPELT IM BILD", "alle bis auf einen abdecken oder entfernen"
        ),
        AbsentReason.CAMERA_NOT_CALIBRATED: State("KAMERA NICHT KALIBRIERT", "zuerst die Kamera kalibrieren"),
        AbsentReason.CAMERA_CHANGED: State("KAMERA VERSTELLT", "zurückstellen oder neu kalibrieren"),
        AbsentReason.POSE_UNCERTAIN: State("LAGE UNSICHER", "Marker näher, ruhiger und schräger halten"),
        AbsentReason.TOOL_NOT_DEFINED: State("WERKZEUG NICHT DEFINIERT", "zuerst das Werkzeug kalibrieren"),
        AbsentReason.NOT_REGISTERED: State("NICHT REGISTRIERT", "Plan und Patient registrieren"),
        AbsentReason.NO_PLAN: State("KEIN PLAN", "einen Kanal im CT planen"),
        AbsentReason.REFERENCE_UNSEEN: State(
            "PATIENT NICHT GESEHEN", "Sicht auf den Patientenmarker freimachen"
        ),
        AbsentReason.CAMERA_MOVED: State("KAMERA BEWEGT", "neu registrieren"),
        AbsentReason.REFERENCE_MOVED: State(
            "PATIENT BEWEGT", "an einer Landmarke prüfen oder neu registrieren"
        ),
        AbsentReason.POSE_JUMPED: State("LAGE NICHT EINDEUTIG", "den Bohrer kurz ruhig halten"),
        AbsentReason.NOT_CHECKED: State("NICHT GEPRÜFT", "zum Prüfen eine Landmarke berühren"),
        AbsentReason.NOT_CONFIRMED: State(
            "NAVIGATION ANGEHALTEN", "neu gestartet: die Bedienung muss bestätigen"
        ),
        AbsentReason.NOT_COSIGNED: State(
            "NICHT GEGENGEZEICHNET", "eine zweite Person muss Plan und Registrierung unterschreiben"
        ),
    },
}
UNSEEN: Mapping[Language, Mapping[UnseenReason, str]] = {
    "en": {
        UnseenReason.NO_CANDIDATE: "not seen, no similar square in the image",
        UnseenReason.SCORE_TOO_LOW: "not seen, too few of its edges found",
        UnseenReason.TARGET_SCORE_TOO_LOW: "not seen, edges found that are not the marker's",
        UnseenReason.SHAPE_DIFFERS: "not seen, similar object of another shape",
        UnseenReason.NOT_REPORTED: "not seen, the tracker reports no valid pose",
        UnseenReason.MARKER_TWICE: "in view twice, cover or remove all but one",
    },
    "de": {
        UnseenReason.NO_CANDIDATE: "nicht gesehen, kein ähnliches Quadrat im Bild",
        UnseenReason.SCORE_TOO_LOW: "nicht gesehen, zu wenige seiner Kanten gefunden",
        UnseenReason.TARGET_SCORE_TOO_LOW: "nicht gesehen, Kanten gefunden, die nicht zum Marker gehören",
        UnseenReason.SHAPE_DIFFERS: "nicht gesehen, ähnliches Objekt mit anderer Form",
        UnseenReason.NOT_REPORTED: "nicht gesehen, das Trackingsystem meldet keine gültige Lage",
        UnseenReason.MARKER_TWICE: "doppelt im Bild, alle bis auf einen abdecken oder entfernen",
    },
}
