"""Remedies of errors of procedure, plan and supervision."""

from server.texts.language import Text

PROCEDURE: tuple[Text, ...] = (
    {
        "en": "Select the channel that was drilled.",
        "de": "Den gebohrten Kanal wählen.",
    },
    {
        "en": "Select the channel that was drilled, or place the drill in this one.",
        "de": "Den gebohrten Kanal wählen, oder den Bohrer in diesen führen.",
    },
    {
        "en": "Place the drill or screwdriver in the channel, then touch again.",
        "de": "Bohrer oder Schraubendreher in den Kanal führen, dann erneut berühren.",
    },
    {
        "en": "Wait until the video runs, then touch again.",
        "de": "Warten, bis das Bild läuft, dann erneut berühren.",
    },
    {
        "en": "Complete the steps that are due, hold drill and markers in view, then touch again.",
        "de": "Fällige Schritte abschließen, Bohrer und Marker im Bild halten, dann erneut berühren.",
    },
    {
        "en": "State diameter and length of the screw.",
        "de": "Durchmesser und Länge der Schraube angeben.",
    },
    {
        "en": "GET /api/navigation/placements lists the placed screws.",
        "de": "GET /api/navigation/placements nennt die gesetzten Schrauben.",
    },
    {
        "en": "Give both, or none for the planned screw.",
        "de": "Beides angeben, oder keines für die geplante Schraube.",
    },
    {
        "en": "Show the board to the camera until views are taken: at least 3, better 12 or more.",
        "de": "Die Tafel vor die Kamera halten, bis Ansichten aufgenommen sind: mindestens 3, besser 12 "
        "oder mehr.",
    },
    {
        "en": "Wait until the video shows the board, and try again.",
        "de": "Warten, bis das Bild die Tafel zeigt, und erneut versuchen.",
    },
    {
        "en": "Wait until the video runs, and try again.",
        "de": "Warten, bis das Bild läuft, und erneut versuchen.",
    },
    {
        "en": "Wait until the video runs, and capture again.",
        "de": "Warten, bis das Bild läuft, und neu antasten.",
    },
    {
        "en": "Take sharp views of a flat, stiff board, or check the report for views that do not fit.",
        "de": "Scharfe Ansichten einer ebenen, steifen Tafel aufnehmen, oder im Bericht nach unpassenden "
        "Ansichten sehen.",
    },
    {
        "en": "Calibrate this camera, or give its own camera file.",
        "de": "Diese Kamera kalibrieren, oder ihre eigene Kameradatei angeben.",
    },
    {
        "en": "Keep only one camera connected, and start again.",
        "de": "Nur eine Kamera angeschlossen lassen und neu beginnen.",
    },
    {
        "en": "Calibrate this camera, or start with the calibrated one.",
        "de": "Diese Kamera kalibrieren, oder mit der kalibrierten starten.",
    },
    {
        "en": "Connect the calibrated camera, or calibrate this one.",
        "de": "Die kalibrierte Kamera anschließen, oder diese kalibrieren.",
    },
    {"en": "Calibrate with them, or start again.", "de": "Mit ihnen kalibrieren, oder neu beginnen."},
    {
        "en": "Set the camera to its working size, and start again.",
        "de": "Die Kamera auf ihre Arbeitsgröße stellen und neu beginnen.",
    },
    {
        "en": "Set the camera to its working size, and measure again.",
        "de": "Die Kamera auf ihre Arbeitsgröße stellen und neu messen.",
    },
    {
        "en": "Wait until the video runs, verify it, then confirm.",
        "de": "Warten, bis das Bild läuft, es prüfen, dann bestätigen.",
    },
    {"en": "Read the new prompt, and confirm it.", "de": "Die neue Frage lesen und bestätigen."},
    {"en": "Upload a CT.", "de": "Ein CT hochladen."},
    {
        "en": "Check the job that read it; the CT may already be stored in the case.",
        "de": "Den Auftrag ansehen, der es las; das CT ist vielleicht schon im Fall gespeichert.",
    },
    {
        "en": "Keep that page open and in the foreground, and measure again.",
        "de": "Diese Seite offen und im Vordergrund lassen und neu messen.",
    },
    {
        "en": "Point the camera at the screen, then measure again.",
        "de": "Die Kamera auf den Bildschirm richten, dann neu messen.",
    },
    {"en": "Measure again in the present case.", "de": "Im jetzigen Fall neu messen."},
    {"en": "GET /api/markers lists the markers.", "de": "GET /api/markers nennt die Marker."},
    {
        "en": "Use another name, or change it under markers in the settings.",
        "de": "Einen anderen Namen verwenden, oder ihn in den Einstellungen unter markers ändern.",
    },
    {
        "en": "Remove a marker that is no longer used.",
        "de": "Einen Marker entfernen, der nicht mehr verwendet wird.",
    },
    {
        "en": "Select the active channel in the plan.",
        "de": "In der Planung den Kanal wählen, der gebohrt wird.",
    },
    {
        "en": "Plan it on the newest CT, and select it again.",
        "de": "Auf dem neuesten CT planen und den Kanal neu wählen.",
    },
    {
        "en": "Create a case and open it, or open an existing one.",
        "de": "Einen Fall anlegen und öffnen, oder einen vorhandenen öffnen.",
    },
    {
        "en": "Open the case of its CT, or set for_other_ct to import it for this CT and check every "
        "channel.",
        "de": "Den Fall ihres CT öffnen, oder sie mit for_other_ct für dieses CT importieren und jeden "
        "Kanal prüfen.",
    },
    {"en": "Select its reference slice.", "de": "Seine Referenzschicht wählen."},
    {
        "en": "Select its reference slice in the plan, or give the landmarks at which the needles enter.",
        "de": "In der Planung seine Referenzschicht wählen, oder die Landmarken angeben, an denen die "
        "Nadeln eintreten.",
    },
    {"en": "Select the slice again on this CT.", "de": "Die Schicht auf diesem CT neu wählen."},
    {"en": "Choose a slice of this CT.", "de": "Eine Schicht dieses CT wählen."},
    {
        "en": "Add a vertebra to start a plan, or import a plan from a file.",
        "de": "Einen Wirbel aufnehmen, um zu planen, oder eine Planung aus einer Datei importieren.",
    },
    {
        "en": "Review the plan on this CT and store it again completely, or store an empty plan.",
        "de": "Die Planung auf diesem CT prüfen und vollständig neu speichern, oder eine leere speichern.",
    },
    {"en": "Click on the pedicle in the new CT.", "de": "Im neuen CT auf den Pedikel tippen."},
    {
        "en": "Move the board until all images are taken and processed.",
        "de": "Die Tafel bewegen, bis alle Bilder aufgenommen und verarbeitet sind.",
    },
    {"en": "Check the newest registration.", "de": "Die neueste Registrierung prüfen."},
    {"en": "GET /api/cases shows which case is open.", "de": "GET /api/cases nennt den geöffneten Fall."},
    {"en": "Answer for the case that is open now.", "de": "Für den Fall antworten, der jetzt geöffnet ist."},
    {
        "en": "Try again in a second; if the error persists, check /health and the server log.",
        "de": "In einer Sekunde erneut versuchen; bleibt der Fehler, /health und das Protokoll des Servers "
        "ansehen.",
    },
    {
        "en": "Give both, or none for the proposed screw.",
        "de": "Beide angeben, oder keines für die vorgeschlagene Schraube.",
    },
    {
        "en": "Set landmarks or place a channel first.",
        "de": "Zuerst Landmarken setzen oder einen Kanal legen.",
    },
    {"en": "Start with camera.source: rehearsal.", "de": "Mit camera.source: rehearsal starten."},
    {
        "en": "Send it again; the received part was discarded.",
        "de": "Erneut senden; der empfangene Teil wurde verworfen.",
    },
    {"en": "Send the file as the body of the request.", "de": "Die Datei als Inhalt der Anfrage senden."},
    {"en": "Send a smaller file.", "de": "Eine kleinere Datei senden."},
    {
        "en": "Send less data per request; send files to the upload addresses.",
        "de": "Weniger Daten je Anfrage senden; Dateien an die Adressen für Uploads senden.",
    },
    {
        "en": "Send an original PNG or JPEG of the camera, neither cropped nor scaled.",
        "de": "Ein unverändertes PNG oder JPEG der Kamera senden, weder beschnitten noch skaliert.",
    },
    {"en": "Extract one from the CT, or upload one.", "de": "Eine aus dem CT erzeugen, oder eine hochladen."},
    {
        "en": "Start it again; jobs do not survive a restart of the server.",
        "de": "Ihn neu starten; Aufträge überdauern keinen Neustart des Servers.",
    },
    {
        "en": "Ask the signer or the operator to withdraw it.",
        "de": "Die unterzeichnende Person oder die Bedienung bitten, sie zurückzuziehen.",
    },
    {
        "en": "Review the newest version, then sign it.",
        "de": "Die neueste Version prüfen, dann gegenzeichnen.",
    },
    {
        "en": "Ask this person or the operator to release it.",
        "de": "Diese Person oder die Bedienung bitten, ihn aufzuheben.",
    },
    {
        "en": "Give each landmark of the plan and the tip on it as three numbers in mm, in the same order.",
        "de": "Jede geplante Landmarke und die Spitze auf ihr als drei Zahlen in mm angeben, in derselben "
        "Reihenfolge.",
    },
    {
        "en": "Export the whole series again as original axial slices, and give that folder alone.",
        "de": "Die ganze Serie als originale axiale Schichten neu exportieren und nur diesen Ordner angeben.",
    },
    {
        "en": "Convert the CT again with its geometry (dcm2niix does), or give its DICOM slices.",
        "de": "Das CT mit seiner Geometrie neu umwandeln (wie dcm2niix), oder seine DICOM-Schichten angeben.",
    },
    {
        "en": "Give x, y, z in mm of the patient's LPS coordinates.",
        "de": "Geben Sie x, y, z in mm in LPS-Koordinaten des Patienten an.",
    },
    {
        "en": "Give a point inside the CT, in LPS mm (x to the patient's left, y backwards).",
        "de": "Geben Sie einen Punkt im CT an, in LPS-mm (x nach links vom Patienten, y nach hinten).",
    },
    {
        "en": "Click into the middle of the pedicle, on a slice that shows it joined to body and arch.",
        "de": "Tippen Sie auf die Mitte des Pedikels, in einer Schicht, die ihn mit Wirbelkörper und Bogen "
        "verbunden zeigt.",
    },
    {
        "en": "Use a series that contains the whole vertebra.",
        "de": "Verwenden Sie eine Serie, die den ganzen Wirbel enthält.",
    },
    {
        "en": "Click nearer to the canal, into the middle of the pedicle; or give its numbers by hand.",
        "de": "Tippen Sie näher am Spinalkanal auf die Mitte des Pedikels, oder geben Sie seine "
        "Maße von Hand an.",
    },
    {
        "en": "Click into the pedicle's middle; use finer slices if there are any; or give its "
        "numbers by hand.",
        "de": "Tippen Sie auf die Mitte des Pedikels, verwenden Sie feinere Schichten, falls "
        "vorhanden, oder geben Sie seine Maße von Hand an.",
    },
    {
        "en": "Click into the {side} pedicle, or measure this one as the {other_side} one.",
        "de": "Tippen Sie auf den Pedikel {side}, oder messen Sie diesen als den Pedikel {other_side}.",
    },
)
