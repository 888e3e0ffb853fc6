"""Templates of the alarm texts in all languages."""

from collections.abc import Mapping
from dataclasses import dataclass

from server.texts.language import Language, Text
from tracker.navigation.alarms import Condition


@dataclass(frozen=True, slots=True, kw_only=True)
class Phrases:
    """Templates of one condition in one language.

    Attributes:
        title: In capitals.
        present: The condition is present.
        past: The condition was present.
        over: Appended to `past` if its absence is measured.
        lost: The condition was present when last observed and cannot be observed now.
        remedy, lost_remedy: What to do while it is present, and while it cannot be observed.
        bare: `present` without a value; empty if there always or never is one.
        bare_past: `past` without a value.
    """

    title: str
    present: str
    past: str
    over: str = ""
    lost: str = ""
    remedy: str = ""
    lost_remedy: str = ""
    bare: str = ""
    bare_past: str = ""


_WITHDRAW: Text = {"en": "Stop. Withdraw the drill.", "de": "Anhalten. Bohrer zurückziehen."}
# Another alarm or the headline states why tracking is lost and what to do.
_STOP: Text = {"en": "Stop.", "de": "Anhalten."}

ENGLISH: Mapping[Condition, Phrases] = {
    Condition.BREACH: Phrases(
        title="BREACH",
        present="{tool}Drill {value} {through}{at}.",
        past="{worst_tool}Was {worst} {worst_through}{worst_at}, {time}.",
        over=" Not through now.",
        lost="Not tracked. {worst_tool}Was {worst} {worst_through}{worst_at}, {time}.",
        remedy=_WITHDRAW["en"],
        lost_remedy=_STOP["en"],
    ),
    Condition.PAST_DEPTH: Phrases(
        title="TOO DEEP",
        present="{tool}Tip {value} past the planned depth.",
        past="{worst_tool}Was {worst} past the planned depth, {time}.",
        over=" Not past it now.",
        lost="Not tracked. {worst_tool}Was {worst} past the planned depth, {time}.",
        remedy=_WITHDRAW["en"],
        lost_remedy=_STOP["en"],
    ),
    Condition.BREACH_LIKELY: Phrases(
        title="BREACH RISK",
        present="{tool}Risk of breach {value} within 2 mm, limit {limit}.",
        past="{worst_tool}Risk of breach was {worst}.",
        lost="Not tracked. {worst_tool}Risk of breach was {worst}.",
        remedy="Do not advance. Aim back to the channel's axis.",
        lost_remedy=_STOP["en"],
    ),
    Condition.CLEARANCE_LOW: Phrases(
        title="NEAR WALL",
        present="{tool}{value} to the {near}, limit {limit}.",
        past="{worst_tool}Was {worst} from the {worst_near}.",
        lost="Not tracked. {worst_tool}Was {worst} from the {worst_near}.",
        remedy="Do not advance. Aim back to the channel's axis.",
        lost_remedy=_STOP["en"],
    ),
    Condition.DRILL_UNSEEN: Phrases(
        title="DRILL NOT SEEN",
        present="Drill marker not seen for {value}.",
        past="Drill marker was not seen for {worst}.",
        remedy="Bring the marker into view. Acknowledge if the drill is put away.",
    ),
    Condition.REFERENCE_UNSEEN: Phrases(
        title="PATIENT NOT SEEN",
        present="Patient marker not seen for {value}.",
        past="Patient marker was not seen for {worst}.",
        remedy="Clear the view of the patient marker.",
    ),
    Condition.MARKER_TWICE: Phrases(
        title="MARKER TWICE IN VIEW",
        present="Two prints of one marker are in view.",
        past="Two prints of one marker were in view.",
        remedy="Stop. Cover or remove all but one.",
    ),
    Condition.CAMERA_STALLED: Phrases(
        title="NO IMAGE",
        present="No image for {value}.",
        past="No image came for {worst}.",
        remedy="Check the camera and its cable.",
    ),
    Condition.CAMERA_GONE: Phrases(
        title="CAMERA DISCONNECTED",
        present="No images from the camera.",
        past="The camera temporarily sent no images.",
        remedy="Check the camera and its cable. Reconnecting.",
    ),
    Condition.TRACKING_STOPPED: Phrases(
        title="TRACKING STOPPED",
        present="The tracking process does not run.",
        past="The tracking process temporarily did not run.",
        remedy="Wait for its restart. If none comes, restart the server.",
    ),
    Condition.POSE_UNCERTAIN: Phrases(
        title="POSE UNCERTAIN",
        present="95 % error ±{value}, limit {limit}.",
        past="95 % error was ±{worst}.",
        bare="Tip position too uncertain to be shown.",
        bare_past="Tip position was too uncertain to be shown.",
        remedy="Hold the marker closer, steadier and more tilted.",
    ),
    Condition.SETUP_INSUFFICIENT: Phrases(
        title="SET-UP INSUFFICIENT",
        present="95 % error ±{value}, limit {limit}. No camera view meets it with this registration "
        "and tool.",
        past="95 % error was ±{worst}.",
        remedy="Register with more landmarks, or plan a thinner screw.",
    ),
    Condition.POSE_JUMPED: Phrases(
        title="POSE AMBIGUOUS",
        present="Two poses fit the image, or the pose jumped.",
        past="The pose was ambiguous.",
        remedy="Hold still. Tilt the marker towards the camera.",
    ),
    Condition.CAMERA_MOVED: Phrases(
        title="CAMERA MOVED",
        present="Camera moved since registration.",
        past="The camera had moved since registration.",
        remedy="Stop. Register again.",
    ),
    Condition.REFERENCE_MOVED: Phrases(
        title="PATIENT MARKER MOVED",
        present="Patient marker moved since registration.",
        past="The patient marker had moved since registration.",
        remedy="Stop. Fix the marker. Register again.",
    ),
    Condition.CAMERA_CHANGED: Phrases(
        title="CAMERA CHANGED",
        present="{control} changed from {calibrated} to {set} since the calibration.",
        past="{control} was not as calibrated.",
        bare="The camera was changed since the calibration.",
        remedy="Stop. Set it back, or calibrate and register again.",
    ),
    Condition.FOCAL_LENGTH_DOUBTFUL: Phrases(
        title="FOCAL LENGTH DOUBTFUL",
        present="The calibrated focal length and the view of the markers differ by {value}, limit {limit}.",
        past="The calibrated focal length and the view of the markers differed by {worst}.",
        remedy="Check that the prints are flat and the lens as calibrated. Calibrate the camera again.",
    ),
    Condition.REGISTRATION_OUT_OF_DATE: Phrases(
        title="REGISTRATION OUT OF DATE",
        present="Data that the registration depends on have changed.",
        past="The registration was out of date.",
        remedy="Stop. Register again.",
    ),
    Condition.CALIBRATION_OUT_OF_DATE: Phrases(
        title="CALIBRATION OUT OF DATE",
        present="The calibration is no longer valid.",
        past="The calibration was out of date.",
        remedy="Stop. Calibrate again, then register again.",
    ),
    Condition.CHECK_DUE: Phrases(
        title="CHECK DUE",
        present="Last landmark check {value} ago, limit {limit}.",
        past="A landmark check was due.",
        remedy="Check the tip on an unused landmark.",
    ),
    Condition.NO_ARMED_SCREEN: Phrases(
        title="NO SOUND",
        present="Sound is off on every screen.",
        past="Sound was off on every screen.",
        remedy="Touch the alarm band of the theatre screen.",
    ),
    Condition.DISK_NEARLY_FULL: Phrases(
        title="DISK NEARLY FULL",
        present="{value} free for cases, limit {limit}.",
        past="Free disk space was down to {worst}.",
        remedy="Free space on the disk.",
    ),
    Condition.VIEWER_LOST: Phrases(
        title="SCREEN LOST",
        present="A screen with armed sound disconnected.",
        past="A screen with armed sound was disconnected.",
        remedy="Check that the theatre screen shows the page.",
    ),
    Condition.RECORDING_STOPPED: Phrases(
        title="NOT RECORDED",
        present="Events are not written to the disk.",
        past="Events were temporarily not written to the disk.",
        remedy="Check whether the disk is full or disconnected.",
    ),
    Condition.HOLD_REQUESTED: Phrases(
        title="HOLD REQUESTED",
        present="{by} requests a hold.",
        past="{by} requested a hold.",
        remedy="Consult this person before you continue.",
    ),
}

GERMAN: Mapping[Condition, Phrases] = {
    Condition.BREACH: Phrases(
        title="WANDDURCHBRUCH",
        present="{tool}Bohrer {value} {through}{at}.",
        past="{worst_tool}War {worst} {worst_through}{worst_at}, {time}.",
        over=" Jetzt nicht mehr.",
        lost="Nicht verfolgt. {worst_tool}War {worst} {worst_through}{worst_at}, {time}.",
        remedy=_WITHDRAW["de"],
        lost_remedy=_STOP["de"],
    ),
    Condition.PAST_DEPTH: Phrases(
        title="ZU TIEF",
        present="{tool}Spitze {value} tiefer als geplant.",
        past="{worst_tool}War {worst} tiefer als geplant, {time}.",
        over=" Jetzt nicht mehr.",
        lost="Nicht verfolgt. {worst_tool}War {worst} tiefer als geplant, {time}.",
        remedy=_WITHDRAW["de"],
        lost_remedy=_STOP["de"],
    ),
    Condition.BREACH_LIKELY: Phrases(
        title="DURCHBRUCHRISIKO",
        present="{tool}Durchbruchrisiko {value} innerhalb von 2 mm, Grenze {limit}.",
        past="{worst_tool}Durchbruchrisiko war {worst}.",
        lost="Nicht verfolgt. {worst_tool}Durchbruchrisiko war {worst}.",
        remedy="Nicht weiter bohren. Zurück zur Kanalachse richten.",
        lost_remedy=_STOP["de"],
    ),
    Condition.CLEARANCE_LOW: Phrases(
        title="NAHE DER WAND",
        present="{tool}Noch {value}: {near}, Grenze {limit}.",
        past="{worst_tool}Kleinster Abstand war {worst}: {worst_near}.",
        lost="Nicht verfolgt. {worst_tool}Kleinster Abstand war {worst}: {worst_near}.",
        remedy="Nicht weiter bohren. Zurück zur Kanalachse richten.",
        lost_remedy=_STOP["de"],
    ),
    Condition.DRILL_UNSEEN: Phrases(
        title="BOHRER NICHT GESEHEN",
        present="Bohrermarker seit {value} nicht gesehen.",
        past="Bohrermarker war {worst} nicht gesehen.",
        remedy="Marker ins Bild bringen. Quittieren, wenn der Bohrer weggelegt ist.",
    ),
    Condition.REFERENCE_UNSEEN: Phrases(
        title="PATIENT NICHT GESEHEN",
        present="Patientenmarker seit {value} nicht gesehen.",
        past="Patientenmarker war {worst} nicht gesehen.",
        remedy="Sicht auf den Patientenmarker freimachen.",
    ),
    Condition.MARKER_TWICE: Phrases(
        title="MARKER DOPPELT IM BILD",
        present="Ein Marker ist zweimal im Bild.",
        past="Ein Marker war zweimal im Bild.",
        remedy="Anhalten. Alle bis auf einen abdecken oder entfernen.",
    ),
    Condition.CAMERA_STALLED: Phrases(
        title="KEIN BILD",
        present="Seit {value} kein Bild.",
        past="{worst} lang kam kein Bild.",
        remedy="Kamera und Kabel prüfen.",
    ),
    Condition.CAMERA_GONE: Phrases(
        title="KAMERA GETRENNT",
        present="Keine Bilder von der Kamera.",
        past="Die Kamera lieferte zeitweise keine Bilder.",
        remedy="Kamera und Kabel prüfen. Die Verbindung wird erneut aufgebaut.",
    ),
    Condition.TRACKING_STOPPED: Phrases(
        title="TRACKING ANGEHALTEN",
        present="Der Tracking-Prozess läuft nicht.",
        past="Der Tracking-Prozess lief zeitweise nicht.",
        remedy="Neustart abwarten. Kommt keiner, den Server neu starten.",
    ),
    Condition.POSE_UNCERTAIN: Phrases(
        title="LAGE UNSICHER",
        present="95-%-Fehler ±{value}, Grenze {limit}.",
        past="95-%-Fehler war ±{worst}.",
        bare="Position der Spitze für eine Anzeige zu unsicher.",
        bare_past="Position der Spitze war für eine Anzeige zu unsicher.",
        remedy="Marker näher, ruhiger und schräger halten.",
    ),
    Condition.SETUP_INSUFFICIENT: Phrases(
        title="AUFBAU REICHT NICHT",
        present="95-%-Fehler ±{value}, Grenze {limit}. Mit dieser Registrierung und diesem Werkzeug "
        "nicht erreichbar.",
        past="95-%-Fehler war ±{worst}.",
        remedy="Mit mehr Landmarken registrieren oder dünnere Schraube planen.",
    ),
    Condition.POSE_JUMPED: Phrases(
        title="LAGE NICHT EINDEUTIG",
        present="Zwei Lagen passen zum Bild, oder die Lage ist gesprungen.",
        past="Die Lage war nicht eindeutig.",
        remedy="Ruhig halten. Marker zur Kamera neigen.",
    ),
    Condition.CAMERA_MOVED: Phrases(
        title="KAMERA BEWEGT",
        present="Kamera seit der Registrierung bewegt.",
        past="Die Kamera war seit der Registrierung bewegt worden.",
        remedy="Anhalten. Neu registrieren.",
    ),
    Condition.REFERENCE_MOVED: Phrases(
        title="PATIENTENMARKER BEWEGT",
        present="Patientenmarker seit der Registrierung bewegt.",
        past="Der Patientenmarker war seit der Registrierung bewegt worden.",
        remedy="Anhalten. Marker befestigen. Neu registrieren.",
    ),
    Condition.CAMERA_CHANGED: Phrases(
        title="KAMERA VERSTELLT",
        present="{control} seit der Kalibrierung von {calibrated} auf {set} verstellt.",
        past="{control} war anders als bei der Kalibrierung.",
        bare="Die Kamera wurde seit der Kalibrierung verstellt.",
        remedy="Anhalten. Zurückstellen, oder neu kalibrieren und registrieren.",
    ),
    Condition.FOCAL_LENGTH_DOUBTFUL: Phrases(
        title="BRENNWEITE ZWEIFELHAFT",
        present="Kalibrierte Brennweite und Ansicht der Marker weichen um {value} ab, Grenze {limit}.",
        past="Kalibrierte Brennweite und Ansicht der Marker wichen um {worst} ab.",
        remedy="Prüfen, ob Objektiv und Marker unverändert und die Marker eben sind. Kamera neu kalibrieren.",
    ),
    Condition.REGISTRATION_OUT_OF_DATE: Phrases(
        title="REGISTRIERUNG VERALTET",
        present="Daten, von denen die Registrierung abhängt, wurden geändert.",
        past="Die Registrierung war veraltet.",
        remedy="Anhalten. Neu registrieren.",
    ),
    Condition.CALIBRATION_OUT_OF_DATE: Phrases(
        title="KALIBRIERUNG VERALTET",
        present="Die Kalibrierung gilt nicht mehr.",
        past="Die Kalibrierung war veraltet.",
        remedy="Anhalten. Neu kalibrieren, dann neu registrieren.",
    ),
    Condition.CHECK_DUE: Phrases(
        title="PRÜFUNG FÄLLIG",
        present="Letzte Prüfung an einer Landmarke vor {value}, Grenze {limit}.",
        past="Eine Prüfung an einer Landmarke war fällig.",
        remedy="Spitze an einer nicht benutzten Landmarke prüfen.",
    ),
    Condition.NO_ARMED_SCREEN: Phrases(
        title="KEIN TON",
        present="Auf jedem Bildschirm ist der Ton aus.",
        past="Auf jedem Bildschirm war der Ton aus.",
        remedy="Alarmzeile des OP-Bildschirms berühren.",
    ),
    Condition.DISK_NEARLY_FULL: Phrases(
        title="PLATTE FAST VOLL",
        present="{value} frei für Fälle, Grenze {limit}.",
        past="Auf der Platte waren nur noch {worst} frei.",
        remedy="Platz auf der Platte schaffen.",
    ),
    Condition.VIEWER_LOST: Phrases(
        title="BILDSCHIRM VERLOREN",
        present="Ein Bildschirm mit eingeschaltetem Ton ist getrennt.",
        past="Ein Bildschirm mit eingeschaltetem Ton war getrennt.",
        remedy="Prüfen, ob der OP-Bildschirm die Seite zeigt.",
    ),
    Condition.RECORDING_STOPPED: Phrases(
        title="NICHT AUFGEZEICHNET",
        present="Ereignisse werden nicht auf die Platte geschrieben.",
        past="Ereignisse wurden zeitweise nicht auf die Platte geschrieben.",
        remedy="Prüfen, ob die Platte voll oder getrennt ist.",
    ),
    Condition.HOLD_REQUESTED: Phrases(
        title="BITTE ANHALTEN",
        present="{by} bittet um einen Halt.",
        past="{by} bat um einen Halt.",
        remedy="Vor dem Fortfahren Rücksprache halten.",
    ),
}
PHRASES: Mapping[Language, Mapping[Condition, Phrases]] = {"en": ENGLISH, "de": GERMAN}
