"""Remedies of errors. Several errors share one."""

from server.texts.language import Text

REMEDIES: tuple[Text, ...] = (
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
        "en": "Start the registration again with the current plan, camera and tool.",
        "de": "Die Registrierung mit jetziger Planung, Kamera und jetzigem Instrument neu beginnen.",
    },
    {
        "en": "Calibrate the camera first, or set camera.calibration to its file.",
        "de": "Zuerst die Kamera kalibrieren, oder camera.calibration auf ihre Datei setzen.",
    },
    {"en": "Mark each planned needle once.", "de": "Jede geplante Nadel einmal markieren."},
    {"en": "Fit the overlay first.", "de": "Zuerst die Schicht anpassen."},
    {
        "en": "Clear the view of the marker on the patient, and register again.",
        "de": "Die Sicht auf den Patientenmarker freimachen und neu registrieren.",
    },
    {"en": "Turn it to the camera, and register again.", "de": "Ihn zur Kamera drehen und neu registrieren."},
    {
        "en": "Mark more landmarks on the CT in the plan, including one for the check.",
        "de": "In der Planung weitere Landmarken auf dem CT setzen, auch eine für die Prüfung.",
    },
    {
        "en": "Capture another landmark, or include one that was excluded.",
        "de": "Eine weitere Landmarke antasten, oder eine ausgeschlossene wieder verwenden.",
    },
    {
        "en": "Touch at least three landmarks that are not collinear; four or more reveal a gross error.",
        "de": "Mindestens drei Landmarken antasten, die nicht auf einer Geraden liegen; ab vier fällt ein "
        "grober Fehler auf.",
    },
    {
        "en": "Register by these points only, or by the needles only.",
        "de": "Nur mit diesen Punkten registrieren, oder nur mit den Nadeln.",
    },
    {"en": "Capture it first.", "de": "Sie zuerst antasten."},
    {
        "en": "Hold the marker nearer to the camera and in better light, and touch the landmark again.",
        "de": "Den Marker näher an die Kamera und in besseres Licht halten und die Landmarke neu antasten.",
    },
    {
        "en": "Rest the hand, hold the tip still on the landmark, and touch it again.",
        "de": "Die Hand auflegen, die Spitze ruhig auf die Landmarke halten und neu antasten.",
    },
    {
        "en": "Touch it again; if the error remains, patient or reference has moved: register again.",
        "de": "Neu antasten; bleibt der Fehler, hat sich Patient oder Patientenmarker bewegt: neu "
        "registrieren.",
    },
    {
        "en": "Check on another landmark: one that was used fits by construction.",
        "de": "An einer anderen Landmarke prüfen: eine verwendete passt immer.",
    },
    {
        "en": "Check that each needle is on its landmark and marked at its entry into the bone.",
        "de": "Prüfen, dass jede Nadel auf ihrer Landmarke sitzt und an ihrem Eintritt in den Knochen "
        "markiert ist.",
    },
    {
        "en": "Touch a needle's entry with the tool's tip, or measure the camera's tilt more accurately.",
        "de": "Den Eintritt einer Nadel mit der Spitze des Instruments antasten, oder die Neigung der "
        "Kamera genauer messen.",
    },
    {
        "en": "Set a landmark for each needle on the CT, or draw the three lines.",
        "de": "Auf dem CT für jede Nadel eine Landmarke setzen, oder die drei Linien zeichnen.",
    },
    {
        "en": "Set a landmark for each needle on the CT.",
        "de": "Auf dem CT für jede Nadel eine Landmarke setzen.",
    },
    {"en": "Put the needles farther apart.", "de": "Die Nadeln weiter auseinander setzen."},
    {
        "en": "Put one needle farther from the line through the others.",
        "de": "Eine Nadel weiter weg von der Geraden durch die anderen setzen.",
    },
    {
        "en": "Mark each needle by hand, or remove the drill and other instruments from the image.",
        "de": "Jede Nadel von Hand markieren, oder Bohrer und andere Instrumente aus dem Bild nehmen.",
    },
    {
        "en": "Undo nudges, or register again: an error of this size needs a new registration.",
        "de": "Feinkorrekturen rückgängig machen, oder neu registrieren: ein Fehler dieser Größe braucht "
        "eine neue Registrierung.",
    },
    {"en": "The registration is unchanged.", "de": "Die Registrierung ist unverändert."},
    {
        "en": "Give each landmark of the plan and the tip on it as three numbers in mm, in the same order.",
        "de": "Jede geplante Landmarke und die Spitze auf ihr als drei Zahlen in mm angeben, in derselben "
        "Reihenfolge.",
    },
    {
        "en": "Sweep the tip slowly over both laminae, the base of the spinous process and both facets.",
        "de": "Mit der Spitze langsam beide Laminae, die Basis des Dornfortsatzes und beide Facetten "
        "abfahren.",
    },
    {
        "en": "Register by landmarks first, and check that mesh and sweep are both in mm and of this "
        "vertebra.",
        "de": "Zuerst mit Landmarken registrieren, und prüfen, dass Netz und Abfahrt in mm sind und zu "
        "diesem Wirbel gehören.",
    },
    {
        "en": "Keep the tip on bare bone while sweeping, and lift it off only when the sweep has ended.",
        "de": "Die Spitze beim Abfahren auf freiem Knochen halten und erst am Ende abheben.",
    },
    {"en": "Calibrate the tip by pivoting first.", "de": "Zuerst die Spitze durch Schwenken kalibrieren."},
    {
        "en": "Calibrate the tip by pivot calibration first.",
        "de": "Zuerst die Spitze durch Schwenken kalibrieren.",
    },
    {
        "en": "Give radius_mm and length_mm of the drill or awl, measured or from its drawing.",
        "de": "radius_mm und length_mm des Bohrers oder der Ahle angeben, gemessen oder aus der Zeichnung.",
    },
    {
        "en": "Tilt the tool with its tip in the divot.",
        "de": "Das Instrument mit der Spitze in der Mulde schwenken.",
    },
    {
        "en": "Take more images while the tool moves; images of a tool at rest add no information.",
        "de": "Mehr Bilder aufnehmen, während sich das Instrument bewegt; Bilder in Ruhe bringen nichts "
        "Neues.",
    },
    {
        "en": "Prevent the tip from slipping, hold the marker in good light near the camera, and calibrate "
        "again.",
        "de": "Die Spitze nicht abrutschen lassen, den Marker in gutem Licht nahe der Kamera halten und neu "
        "kalibrieren.",
    },
    {
        "en": "Take more poses, tilt farther to all sides, and calibrate again.",
        "de": "Mehr Lagen aufnehmen, weiter nach allen Seiten schwenken und neu kalibrieren.",
    },
    {
        "en": "The tip slipped or was moved: calibrate again in one divot.",
        "de": "Die Spitze ist abgerutscht oder wurde versetzt: in einer einzigen Mulde neu kalibrieren.",
    },
    {
        "en": "Hold the tip in the divot, tilt the tool slowly to all sides by 20 degrees and more, and "
        "calibrate again.",
        "de": "Die Spitze in der Mulde halten, das Instrument langsam um 20 Grad und mehr nach allen Seiten "
        "schwenken und neu kalibrieren.",
    },
    {
        "en": "Keep the tip in the divot and the handle still, rotate the tool about its axis by 180 "
        "degrees, or as far as the marker stays in view, and calibrate again.",
        "de": "Die Spitze in der Mulde und den Griff ruhig halten, das Instrument um 180 Grad um seine "
        "Achse drehen, oder so weit der Marker sichtbar bleibt, und neu kalibrieren.",
    },
    {
        "en": "Check that neither the tool nor its marker is bent or loose, and calibrate the tip again.",
        "de": "Prüfen, dass weder Instrument noch Marker verbogen oder lose ist, und die Spitze neu "
        "kalibrieren.",
    },
    {
        "en": "Keep the tip in the divot, tilt the tool to all sides, and check again.",
        "de": "Die Spitze in der Mulde halten, das Instrument nach allen Seiten schwenken und erneut prüfen.",
    },
    {
        "en": "Check columns, rows and layout of the board; zoom and focus must stay the same in all images.",
        "de": "Spalten, Zeilen und Muster der Tafel prüfen; Zoom und Schärfe müssen in allen Bildern gleich "
        "bleiben.",
    },
    {
        "en": "Set the camera to the size it was calibrated at, or calibrate it at this size.",
        "de": "Die Kamera auf die Größe der Kalibrierung stellen, oder sie mit dieser Größe kalibrieren.",
    },
    {
        "en": "Uncover the lens. If that does not help, restart the camera and any device between it and "
        "this machine, and check its cable. It is reopened automatically.",
        "de": "Das Objektiv freimachen. Hilft das nicht, die Kamera und jedes Gerät zwischen ihr und diesem "
        "Rechner neu starten und das Kabel prüfen. Sie wird selbsttätig neu geöffnet.",
    },
    {
        "en": "Run 'coaxial cameras'; check its cable and power, and that no other program uses it. It is "
        "retried automatically.",
        "de": "„coaxial cameras“ aufrufen; Kabel und Strom prüfen, und dass kein anderes Programm sie "
        "verwendet. Es wird selbsttätig neu versucht.",
    },
    {
        "en": "Check its cable, that no other program uses it, and the read permission (group 'video'); it "
        "is retried automatically.",
        "de": "Das Kabel prüfen, dass kein anderes Programm sie verwendet, und das Leserecht (Gruppe "
        "„video“); es wird selbsttätig neu versucht.",
    },
    {
        "en": "Check its cable and power; it is retried automatically.",
        "de": "Kabel und Strom prüfen; es wird selbsttätig neu versucht.",
    },
    {
        "en": "Use a separate USB 3 port or network card (jumbo frames) for it, or a lower camera.rate_hz.",
        "de": "Einen eigenen USB-3-Anschluss oder eine eigene Netzwerkkarte (Jumbo Frames) verwenden, oder "
        "camera.rate_hz verringern.",
    },
    {
        "en": "Open the page /camera of this server on it and touch START. The page People invites it as a "
        "camera.",
        "de": "Darauf die Seite /camera dieses Servers öffnen und START berühren. Die Seite Personen lädt "
        "es als Kamera ein.",
    },
    {
        "en": "Check the phone: its page /camera must be open, in the foreground and started, and its "
        "network must work.",
        "de": "Das Telefon prüfen: seine Seite /camera muss offen, im Vordergrund und gestartet sein, und "
        "sein Netz muss gehen.",
    },
    {
        "en": "Check the phone: its page must be in the foreground, its screen on, and its camera not in "
        "use by another app.",
        "de": "Das Telefon prüfen: seine Seite muss im Vordergrund sein, sein Bildschirm an, und keine "
        "andere App darf seine Kamera verwenden.",
    },
    {
        "en": "Touch STOP on it or close its page, then touch START here.",
        "de": "Dort STOP berühren oder die Seite schließen, dann hier START berühren.",
    },
    {
        "en": "Use another recording; coaxial replay prints the contents of this one.",
        "de": "Eine andere Aufnahme verwenden; coaxial replay nennt den Inhalt dieser.",
    },
    {
        "en": "Wait until the event has ended, or play a scene without it.",
        "de": "Das Ende des Ereignisses abwarten, oder eine Szene ohne es spielen.",
    },
    {
        "en": "Check path, user and password of the stream; it is retried automatically.",
        "de": "Pfad, Benutzer und Passwort des Videostroms prüfen; es wird selbsttätig neu versucht.",
    },
    {
        "en": "Set the camera to low latency, connect it by cable, and check that this machine is not "
        "overloaded. It is reopened automatically.",
        "de": "Die Kamera auf geringe Latenz stellen, per Kabel anschließen, und prüfen, dass dieser "
        "Rechner nicht überlastet ist. Sie wird selbsttätig neu geöffnet.",
    },
    {
        "en": "Restart the camera, or the device between it and this machine; it is reopened automatically.",
        "de": "Die Kamera neu starten, oder das Gerät zwischen ihr und diesem Rechner; sie wird selbsttätig "
        "neu geöffnet.",
    },
    {
        "en": "Check the camera, its power and the network; it is retried automatically.",
        "de": "Kamera, Strom und Netz prüfen; es wird selbsttätig neu versucht.",
    },
    {
        "en": "Copy or export the file again; the existing images are played.",
        "de": "Die Datei neu kopieren oder exportieren; die vorhandenen Bilder werden gespielt.",
    },
    {
        "en": "Load its timeline, and wait until it is ready.",
        "de": "Ihre Zeitachse laden und warten, bis sie bereit ist.",
    },
    {
        "en": "Give a number from 0 to the number of images minus 1.",
        "de": "Eine Nummer von 0 bis zur Zahl der Bilder minus 1 angeben.",
    },
    {
        "en": "Choose a part before the damage, or take the recording from another copy.",
        "de": "Einen Teil vor dem Schaden wählen, oder eine andere Kopie der Aufnahme verwenden.",
    },
    {"en": "Open another image.", "de": "Ein anderes Bild öffnen."},
    {"en": "Load the list of recordings again.", "de": "Die Liste der Aufnahmen neu laden."},
    {"en": "Free disk space first.", "de": "Zuerst Platz auf der Platte schaffen."},
    {
        "en": "Free disk space, then start the recording again. Navigation continues.",
        "de": "Platz auf der Platte schaffen, dann die Aufnahme neu starten. Die Navigation läuft weiter.",
    },
    {
        "en": "Remove its protection first, if it is no longer needed.",
        "de": "Zuerst den Schutz aufheben, falls er nicht mehr nötig ist.",
    },
    {"en": "Stop the recording first.", "de": "Zuerst die Aufnahme beenden."},
    {
        "en": "Set recording.when to manual or navigating, and start the program again.",
        "de": "recording.when auf manual oder navigating setzen und das Programm neu starten.",
    },
    {
        "en": "State it on the operator's page, or with POST /api/recordings/consent.",
        "de": "Auf der Seite der Bedienung angeben, oder mit POST /api/recordings/consent.",
    },
    {
        "en": "Delete recordings that are not needed, or raise recording.max_total_gb.",
        "de": "Nicht benötigte Aufnahmen löschen, oder recording.max_total_gb erhöhen.",
    },
    {
        "en": "Delete recordings that are not needed, or raise recording.max_total_gb; then start again.",
        "de": "Nicht benötigte Aufnahmen löschen, oder recording.max_total_gb erhöhen; dann neu starten.",
    },
    {
        "en": "Export it again; a new video or part replaces the previous one.",
        "de": "Neu exportieren; ein neues Video oder ein neuer Teil ersetzt den vorigen.",
    },
    {"en": "Choose a recording with images.", "de": "Eine Aufnahme mit Bildern wählen."},
    {
        "en": "Wait until they are done, or cancel them, then try again.",
        "de": "Ihr Ende abwarten, oder sie abbrechen, dann erneut versuchen.",
    },
    {"en": "Create the {kind} first.", "de": "Dieses Dokument zuerst erstellen: {kind}."},
    {"en": "Create the {kind} again.", "de": "Dieses Dokument neu erstellen: {kind}."},
    {
        "en": "GET /api/cases lists the cases; this one may have been deleted.",
        "de": "GET /api/cases nennt die Fälle; dieser wurde vielleicht gelöscht.",
    },
    {"en": "Close it first.", "de": "Ihn zuerst schließen."},
    {
        "en": "Enter the name of the case exactly as in the list; nothing was deleted.",
        "de": "Den Namen des Falls genau wie in der Liste eingeben; nichts wurde gelöscht.",
    },
    {
        "en": "Load the newest version, and apply the change to it again.",
        "de": "Die neueste Version laden und die Änderung an ihr wiederholen.",
    },
    {
        "en": "GET /api/cases/{case_id}/files lists the files of the case.",
        "de": "GET /api/cases/{case_id}/files nennt die Dateien des Falls.",
    },
    {
        "en": "GET /api/cases/{case_id}/documents lists the documents of the case.",
        "de": "GET /api/cases/{case_id}/documents nennt die Dokumente des Falls.",
    },
    {
        "en": "Import it with the Coaxial that exported it, or a newer one; nothing of it was stored.",
        "de": "Mit dem Coaxial importieren, das es exportierte, oder einem neueren; nichts davon wurde "
        "gespeichert.",
    },
    {
        "en": "Give a folder or zip of DICOM slices, a multi-frame DICOM file, or a NIfTI file.",
        "de": "Einen Ordner oder ein Zip mit DICOM-Schichten angeben, eine Multiframe-DICOM-Datei oder eine "
        "NIfTI-Datei.",
    },
    {"en": "Copy or upload the archive again.", "de": "Das Archiv neu kopieren oder hochladen."},
    {
        "en": "Give a folder that contains only this series.",
        "de": "Einen Ordner angeben, der nur diese Serie enthält.",
    },
    {
        "en": "Create the archive again from the folder of slices; do not use one from an unknown source.",
        "de": "Das Archiv aus dem Ordner der Schichten neu erstellen; keines aus unbekannter Quelle "
        "verwenden.",
    },
    {
        "en": "Unpack it with its password, and give the folder or a zip without one.",
        "de": "Es mit seinem Passwort entpacken, und den Ordner oder ein Zip ohne Passwort angeben.",
    },
    {
        "en": "Give a zip that contains only this series.",
        "de": "Ein Zip angeben, das nur diese Serie enthält.",
    },
    {
        "en": "Export one pass as a separate series, and give only that series.",
        "de": "Einen Durchlauf als eigene Serie exportieren und nur diese angeben.",
    },
    {
        "en": "Copy or export the series again; a damaged slice cannot be repaired.",
        "de": "Die Serie neu kopieren oder exportieren; eine beschädigte Schicht lässt sich nicht "
        "reparieren.",
    },
    {"en": "Copy or convert the file again.", "de": "Die Datei neu kopieren oder umwandeln."},
    {"en": "Export the whole series again.", "de": "Die ganze Serie neu exportieren."},
    {
        "en": "Export the whole series again as original axial slices, and give that folder alone.",
        "de": "Die ganze Serie als originale axiale Schichten neu exportieren und nur diesen Ordner angeben.",
    },
    {
        "en": "Convert the CT again with its geometry (dcm2niix does), or give its DICOM slices.",
        "de": "Das CT mit seiner Geometrie neu umwandeln (wie dcm2niix), oder seine DICOM-Schichten angeben.",
    },
    {
        "en": "Convert it into a single .nii or .nii.gz.",
        "de": "In ein einzelnes .nii oder .nii.gz umwandeln.",
    },
    {
        "en": "Export it with fewer triangles; 60000 are enough for a vertebra.",
        "de": "Mit weniger Dreiecken exportieren; 60000 genügen für einen Wirbel.",
    },
    {
        "en": "Export it with fewer triangles, or as binary STL or PLY.",
        "de": "Mit weniger Dreiecken exportieren, oder als binäres STL oder PLY.",
    },
    {
        "en": "Sign in with the link that the server printed at its start, or ask the operator for an "
        "invitation.",
        "de": "Mit dem Link anmelden, den der Server beim Start ausgab, oder die Bedienung um eine "
        "Einladung bitten.",
    },
    {
        "en": "Open the dashboard of this server; a program must send its token as 'Authorization: Bearer' "
        "instead of a cookie.",
        "de": "Die Seite dieses Servers öffnen; ein Programm muss sein Token als „Authorization: Bearer“ "
        "statt als Cookie senden.",
    },
    {"en": "See /api/docs for all addresses.", "de": "Alle Adressen stehen in /api/docs."},
    {
        "en": "Ask the operator for a new invitation; an operator starts the server with "
        "--new-operator-link.",
        "de": "Die Bedienung um eine neue Einladung bitten; die Bedienung selbst startet den Server mit "
        "--new-operator-link.",
    },
    {
        "en": "Sign out on unused devices, or ask the operator to end sessions or for another link.",
        "de": "Auf ungenutzten Geräten abmelden, oder die Bedienung bitten, Sitzungen zu beenden oder einen "
        "anderen Link zu geben.",
    },
    {
        "en": "Revoke invitations and end sessions that are not needed.",
        "de": "Nicht benötigte Einladungen widerrufen und Sitzungen beenden.",
    },
    {
        "en": "Wait {wait_s} s, then open the link again.",
        "de": "{wait_s} s warten, dann den Link neu öffnen.",
    },
    {
        "en": "Stay signed in, or ask the operator for another link.",
        "de": "Angemeldet bleiben, oder die Bedienung um einen anderen Link bitten.",
    },
    {
        "en": "Set security.sign_in to required in the settings, and start the server again.",
        "de": "In den Einstellungen security.sign_in auf required setzen und den Server neu starten.",
    },
    {
        "en": "Hold the tip still on the landmark until it is captured.",
        "de": "Die Spitze ruhig auf die Landmarke halten, bis sie erfasst ist.",
    },
    {
        "en": "Hold the tip still on the landmark for another {left_s:.1f} s, until it is captured.",
        "de": "Die Spitze noch {left_s:.1f} s ruhig auf die Landmarke halten, bis sie erfasst ist.",
    },
    {
        "en": "Hold the tip still on the landmark until it is taken.",
        "de": "Die Spitze ruhig auf die Landmarke halten, bis sie erfasst ist.",
    },
    {
        "en": "Hold the tip still on the landmark for {hold_s:.1f} s at {rate_hz:.1f} images/s, until it is "
        "taken.",
        "de": "Die Spitze {hold_s:.1f} s lang (bei {rate_hz:.1f} Bildern/s) ruhig auf die Landmarke halten, "
        "bis sie erfasst ist.",
    },
    {
        "en": "Turn the markers to the camera, do not cover them, and touch the landmark again.",
        "de": "Die Marker zur Kamera drehen, nicht verdecken, und die Landmarke neu antasten.",
    },
    {
        "en": "Hold the tip still, and touch the landmark again.",
        "de": "Die Spitze ruhig halten und die Landmarke neu antasten.",
    },
    {
        "en": "Touch the landmark again when images come faster.",
        "de": "Die Landmarke neu antasten, wenn die Bilder schneller kommen.",
    },
    {
        "en": "Available tools: {tools}. Calibrate tip and axis first.",
        "de": "Verfügbare Instrumente: {tools}. Zuerst Spitze und Achse kalibrieren.",
    },
    {
        "en": "Existing landmarks: {landmarks}. Set them in the plan.",
        "de": "Vorhandene Landmarken: {landmarks}. In der Planung setzen.",
    },
)
