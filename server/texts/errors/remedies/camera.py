"""Remedies of errors of the camera and its images."""

from server.texts.language import Text

CAMERA: tuple[Text, ...] = (
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
        "Rechner neu starten und das Kabel prüfen. Sie wird automatisch neu geöffnet.",
    },
    {
        "en": "Run 'coaxial cameras'; check its cable and power, and that no other program uses it. It is "
        "retried automatically.",
        "de": "„coaxial cameras“ aufrufen; Kabel und Strom prüfen, und dass kein anderes Programm sie "
        "verwendet. Es wird automatisch neu versucht.",
    },
    {
        "en": "Check its cable, that no other program uses it, and the read permission (group 'video'); it "
        "is retried automatically.",
        "de": "Das Kabel prüfen, dass kein anderes Programm sie verwendet, und das Leserecht (Gruppe "
        "„video“); es wird automatisch neu versucht.",
    },
    {
        "en": "Check its cable and power; it is retried automatically.",
        "de": "Kabel und Strom prüfen; es wird automatisch neu versucht.",
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
        "en": "Close other programs on this computer. Tracking continues as soon as it gets a processor.",
        "de": "Andere Programme auf diesem Rechner schließen. Das Tracking läuft weiter, sobald es einen "
        "Prozessor bekommt.",
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
        "de": "Pfad, Benutzer und Passwort des Videostroms prüfen; es wird automatisch neu versucht.",
    },
    {
        "en": "Set the camera to low latency, connect it by cable, and check that this machine is not "
        "overloaded. It is reopened automatically.",
        "de": "Die Kamera auf geringe Latenz stellen, per Kabel anschließen, und prüfen, dass dieser "
        "Rechner nicht überlastet ist. Sie wird automatisch neu geöffnet.",
    },
    {
        "en": "Restart the camera, or the device between it and this machine; it is reopened automatically.",
        "de": "Die Kamera neu starten, oder das Gerät zwischen ihr und diesem Rechner; sie wird automatisch "
        "neu geöffnet.",
    },
    {
        "en": "Check the camera, its power and the network; it is retried automatically.",
        "de": "Kamera, Strom und Netz prüfen; es wird automatisch neu versucht.",
    },
    {
        "en": "Copy or export the file again; the existing images are played.",
        "de": "Die Datei neu kopieren oder exportieren; die vorhandenen Bilder werden gespielt.",
    },
    {
        "en": "Leave it out to select the number by cross-validation.",
        "de": "Die Angabe weglassen, um die Zahl durch Kreuzvalidierung zu wählen.",
    },
    {
        "en": "Take 10 to 20 views with the board tilted by 20 to 45 deg to different sides, near and far.",
        "de": "10 bis 20 Ansichten aufnehmen, mit der Tafel um 20 bis 45° nach verschiedenen Seiten "
        "geneigt, nah und fern.",
    },
    {
        "en": "Move the board a little slower or use more light, so that it is sharp, and keep all "
        "of it in the picture.",
        "de": "Die Tafel etwas langsamer bewegen oder mehr Licht verwenden, damit sie scharf ist, und "
        "sie ganz im Bild halten.",
    },
    {
        "en": "Give the images of two cameras or more.",
        "de": "Die Bilder von zwei oder mehr Kameras angeben.",
    },
    {
        "en": "Check that images of all cameras are of the same instant, and that no camera was moved.",
        "de": "Prüfen, dass die Bilder aller Kameras vom selben Zeitpunkt sind und keine Kamera "
        "bewegt wurde.",
    },
    {
        "en": "Take views in which both cameras see the board at the same time.",
        "de": "Ansichten aufnehmen, in denen beide Kameras die Tafel zugleich sehen.",
    },
    {
        "en": "Check that images of both cameras are of the same instant, that no camera was "
        "moved, and that the board has a unique orientation.",
        "de": "Prüfen, dass die Bilder beider Kameras vom selben Zeitpunkt sind, keine Kamera bewegt "
        "wurde und die Tafel eine eindeutige Ausrichtung hat.",
    },
    {
        "en": "Fit the plane to other points than those that are measured.",
        "de": "Die Ebene an andere Punkte anpassen als die, die gemessen werden.",
    },
    {
        "en": "A camera file has matrix (3 rows of 3), distortion (4, 5, 8, 12 or 14 numbers) and "
        "size_wh_px (width, height).",
        "de": "Eine Kameradatei hat matrix (3 Zeilen zu 3), distortion (4, 5, 8, 12 oder 14 "
        "Zahlen) und size_wh_px (Breite, Höhe).",
    },
    {"en": "Calibrate the camera at that size.", "de": "Die Kamera mit dieser Größe kalibrieren."},
    {
        "en": "Set the camera to {calibrated_size_wh_px[0]}x{calibrated_size_wh_px[1]} px and measure "
        "again, or calibrate it at {image_size_wh_px[0]}x{image_size_wh_px[1]} px.",
        "de": "Die Kamera auf {calibrated_size_wh_px[0]}x{calibrated_size_wh_px[1]} px stellen und "
        "neu messen, oder sie mit {image_size_wh_px[0]}x{image_size_wh_px[1]} px kalibrieren.",
    },
    {
        "en": "Wait until the video runs smoothly, and start again.",
        "de": "Warten, bis das Bild ruckfrei läuft, und neu beginnen.",
    },
    {
        "en": "Give the value of its data sheet, 0 (a global shutter) to {max_ms:g} ms.",
        "de": "Den Wert des Datenblatts angeben, 0 (Global Shutter) bis {max_ms:g} ms.",
    },
    {
        "en": "Set the camera to a smaller size, at most 7680x4320 px.",
        "de": "Die Kamera auf eine kleinere Größe stellen, höchstens 7680x4320 px.",
    },
    {
        "en": "Start it with coaxial run --source phone.",
        "de": "Den Server mit coaxial run --source phone starten.",
    },
    {
        "en": "Restart the program; if the error persists, send the server log to the maintainer.",
        "de": "Das Programm neu starten; bleibt der Fehler, das Protokoll des Servers an die Betreuung "
        "senden.",
    },
    {
        "en": "Do not change the camera (camera.lock_controls disables autofocus), and start again.",
        "de": "Die Kamera nicht verstellen (camera.lock_controls schaltet den Autofokus ab) und neu "
        "beginnen.",
    },
    {
        "en": "Give an address such as rtsp://user:password@camera:554/path; write / ? # @ in a "
        "password as %2F %3F %23 %40.",
        "de": "Eine Adresse wie rtsp://user:password@camera:554/path angeben; / ? # @ in einem "
        "Passwort als %2F %3F %23 %40 schreiben.",
    },
    {
        "en": "Keep the distance from the phone to the field as during the calibration, and check on a "
        "landmark often. Chrome on Android can lock the focus of most phones.",
        "de": "Den Abstand vom Telefon zum Operationsfeld wie bei der Kalibrierung halten und oft an "
        "einer Landmarke prüfen. Chrome auf Android kann den Fokus der meisten Telefone "
        "feststellen.",
    },
    {
        "en": "Set camera.trigger to an available trigger ({triggers}), or to null.",
        "de": "camera.trigger auf einen verfügbaren Trigger ({triggers}) oder auf null setzen.",
    },
    {
        "en": "Install it with pip install 'coaxial[{extra}]', and start again.",
        "de": "Sie mit pip install 'coaxial[{extra}]' installieren und neu starten.",
    },
    {
        "en": "Close other pages, select a smaller picture or lower camera.rate_hz, and measure again.",
        "de": "Andere Seiten schließen, ein kleineres Bild wählen oder camera.rate_hz senken, und neu "
        "messen.",
    },
)
