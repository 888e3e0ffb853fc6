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
        "de": "x, y, z in mm in den LPS-Koordinaten des Patienten angeben.",
    },
    {
        "en": "Give a point inside the CT, in LPS mm (x to the patient's left, y backwards).",
        "de": "Einen Punkt im CT angeben, in LPS-mm (x zur linken Seite des Patienten, y nach hinten).",
    },
    {
        "en": "Click into the middle of the pedicle, on a slice that shows it joined to body and arch.",
        "de": "Auf die Mitte des Pedikels tippen, in einer Schicht, die ihn mit Wirbelkörper und Bogen "
        "verbunden zeigt.",
    },
    {
        "en": "Use a series that contains the whole vertebra.",
        "de": "Eine Serie verwenden, die den ganzen Wirbel enthält.",
    },
    {
        "en": "Click nearer to the canal, into the middle of the pedicle; or give its numbers by hand.",
        "de": "Näher am Spinalkanal auf die Mitte des Pedikels tippen, oder seine Maße von Hand angeben.",
    },
    {
        "en": "Click again, nearer to the middle of the pedicle; or give its numbers by hand.",
        "de": "Erneut tippen, näher an der Mitte des Pedikels, oder seine Maße von Hand angeben.",
    },
    {
        "en": "Click into the pedicle's middle; use finer slices if there are any; or give its "
        "numbers by hand.",
        "de": "Auf die Mitte des Pedikels tippen, feinere Schichten verwenden, falls vorhanden, oder "
        "seine Maße von Hand angeben.",
    },
    {
        "en": "Click into the {side} pedicle, or measure this one as the {other_side} one.",
        "de": "Auf den Pedikel {side} tippen, oder diesen als den Pedikel {other_side} messen.",
    },
    {"en": "Click into it first.", "de": "Zuerst auf diesen Pedikel tippen und ihn messen."},
    {
        "en": "Lay the channel first, from the measured pedicle or by hand.",
        "de": "Zuerst den Kanal legen, durch den gemessenen Pedikel oder von Hand.",
    },
    {
        "en": "Add it to the plan, or name one that is there.",
        "de": "Den Wirbel in die Planung aufnehmen, oder einen vorhandenen angeben.",
    },
    {"en": "Give its ends in mm of this CT (LPS).", "de": "Seine Enden in mm dieses CT (LPS) angeben."},
    {"en": "Correct one of these numbers.", "de": "Eine dieser Zahlen korrigieren."},
    {
        "en": "Give the number again, in mm or degrees as its name says.",
        "de": "Die Zahl neu angeben, in mm oder Grad, wie ihr Name sagt.",
    },
    {
        "en": "Set entry point, target and diameter of the channel again.",
        "de": "Eintrittspunkt, Zielpunkt und Durchmesser des Kanals neu setzen.",
    },
    {"en": "Plan the channels on this CT again.", "de": "Die Kanäle auf diesem CT neu planen."},
    {
        "en": "Give it a name and set it on the CT in LPS mm.",
        "de": "Der Landmarke einen Namen geben und sie auf dem CT setzen, in LPS-mm.",
    },
    {"en": "Give each landmark its own name.", "de": "Jeder Landmarke einen eigenen Namen geben."},
    {"en": "Set it on this CT, in LPS mm.", "de": "Die Landmarke auf diesem CT setzen, in LPS-mm."},
    {"en": "Give each vertebra its own name.", "de": "Jedem Wirbel einen eigenen Namen geben."},
    {"en": "Name the patient's side.", "de": "Die Seite des Patienten angeben."},
    {
        "en": "Click into a pedicle first, or choose the slice by hand.",
        "de": "Zuerst auf einen Pedikel tippen, oder die Schicht von Hand wählen.",
    },
    {
        "en": "Measure the other pedicle too, or give the middle by hand.",
        "de": "Auch den anderen Pedikel messen, oder die Mitte von Hand angeben.",
    },
    {
        "en": "Give the middle in LPS mm and the measured distance of the lines.",
        "de": "Die Mitte in LPS-mm und den gemessenen Abstand der Linien angeben.",
    },
    {
        "en": "Set it through a point of this slice, in LPS mm.",
        "de": "Die Linie durch einen Punkt dieser Schicht legen, in LPS-mm.",
    },
    {
        "en": "Move the path to the middle of the pedicle, or add a thinner or shorter screw to "
        "the catalogue.",
        "de": "Den Pfad in die Mitte des Pedikels verschieben, oder eine dünnere oder kürzere "
        "Schraube in den Katalog aufnehmen.",
    },
    {
        "en": "Give diameter and length of the screw in mm.",
        "de": "Durchmesser und Länge der Schraube in mm angeben.",
    },
    {
        "en": "Set window and level again, or choose one by name.",
        "de": "Fensterbreite und Fenstermitte neu einstellen, oder ein Fenster nach Namen wählen.",
    },
    {
        "en": "Choose larger pixels, or a smaller field.",
        "de": "Größere Pixel oder ein kleineres Feld wählen.",
    },
    {"en": "Choose a thinner slab.", "de": "Eine geringere Schichtdicke wählen."},
    {"en": "Give two different directions.", "de": "Zwei verschiedene Richtungen angeben."},
    {
        "en": "Give a threshold between them, or a region in which there is bone.",
        "de": "Einen Schwellwert dazwischen angeben, oder einen Bereich mit Knochen.",
    },
    {
        "en": "Give a region around one vertebra, or a higher threshold above the noise.",
        "de": "Einen Bereich um einen Wirbel angeben, oder einen höheren Schwellwert über dem Rauschen.",
    },
    {
        "en": "Import the surface again: its triangles must be counter-clockwise seen from outside.",
        "de": "Die Oberfläche neu importieren: ihre Dreiecke müssen von außen gesehen gegen den "
        "Uhrzeigersinn laufen.",
    },
    {
        "en": "Check the unit and the coordinates of the surface (mm, LPS, of the channel's own "
        "CT); where its cortex has holes, create it again with a lower threshold.",
        "de": "Einheit und Koordinaten der Oberfläche prüfen (mm, LPS, des CT des Kanals); wo ihre "
        "Kortikalis Löcher hat, die Oberfläche mit niedrigerem Schwellwert neu erzeugen.",
    },
    {
        "en": "Check entry and target of the channel: a channel through a pedicle is 25 to 75 mm long.",
        "de": "Eintritts- und Zielpunkt des Kanals prüfen: ein Kanal durch einen Pedikel ist 25 bis 75 mm "
        "lang.",
    },
    {
        "en": "Choose a diameter of {diameters} and a length of {lengths} mm, or add this size "
        "under plan in the settings.",
        "de": "Einen Durchmesser von {diameters} und eine Länge von {lengths} mm wählen, oder diese "
        "Größe in den Einstellungen unter plan aufnehmen.",
    },
    {
        "en": "Export the bone surface again as triangles, or state the format.",
        "de": "Die Knochenoberfläche neu als Dreiecke exportieren, oder das Format angeben.",
    },
    {
        "en": "The action took effect and writing is retried; check the disk.",
        "de": "Die Aktion ist wirksam, und das Schreiben wird wiederholt; die Platte prüfen.",
    },
    {
        "en": "Give each control point the name of its landmark in 3D Slicer.",
        "de": "Jedem Kontrollpunkt in 3D Slicer den Namen seiner Landmarke geben.",
    },
    {
        "en": "Label the two control points '{entry_label}' and '{target_label}' in 3D Slicer, or "
        "place the entry first.",
        "de": "Die beiden Kontrollpunkte in 3D Slicer mit „{entry_label}“ und „{target_label}“ "
        "bezeichnen, oder den Eintrittspunkt zuerst setzen.",
    },
    {
        "en": "Give the corner with the smallest left, posterior and superior coordinates first.",
        "de": "Zuerst die Ecke mit den kleinsten Koordinaten nach links, hinten und kranial angeben.",
    },
    {
        "en": "Give a region inside of the CT, in its own coordinates (LPS).",
        "de": "Einen Bereich im CT angeben, in dessen Koordinaten (LPS).",
    },
    {
        "en": "Export the plan with a program of the same version.",
        "de": "Den Plan mit einem Programm derselben Version exportieren.",
    },
    {
        "en": "Export the plan again from the program in which it was made.",
        "de": "Den Plan aus dem Programm, in dem er erstellt wurde, neu exportieren.",
    },
    {
        "en": "Open it with the program that wrote it, or plan again.",
        "de": "Ihn mit dem Programm öffnen, das ihn schrieb, oder neu planen.",
    },
    {
        "en": "Have another person review and sign it.",
        "de": "Von einer anderen Person prüfen und zeichnen lassen.",
    },
    {
        "en": "Remove the duplicates.",
        "de": "Doppelte entfernen.",
    },
    {
        "en": "Choose a place inside the CT.",
        "de": "Einen Ort innerhalb des CT wählen.",
    },
    {
        "en": "Use one of them, or give window and level in HU.",
        "de": "Eine davon verwenden, oder Fenster und Zentrum in HU angeben.",
    },
    {
        "en": "Give {name}=x,y,z in mm of LPS.",
        "de": "{name}=x,y,z in mm (LPS) angeben.",
    },
    {
        "en": "Pause for a shorter time; the sound resumes automatically and can be paused again.",
        "de": "Kürzer pausieren; der Ton setzt von selbst wieder ein und kann erneut pausiert werden.",
    },
    {
        "en": "See the server log.",
        "de": "Im Protokoll des Servers nachsehen.",
    },
    {
        "en": "Give a region in which there is bone, or another threshold.",
        "de": "Einen Bereich angeben, in dem Knochen ist, oder eine andere Schwelle.",
    },
    {
        "en": "Correct plan.screw_diameters_mm and plan.screw_lengths_mm in the config.",
        "de": "plan.screw_diameters_mm und plan.screw_lengths_mm in den Einstellungen berichtigen.",
    },
)
