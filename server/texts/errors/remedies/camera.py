"""Remedies of errors of the camera and its images."""

from server.texts.language import Text

CAMERA: tuple[Text, ...] = (
    {
        "en": "Check columns, rows and layout of the board; zoom and focus must stay the same in all images.",
        "de": "Spalten, Zeilen und Muster der Tafel prüfen; Zoom und Schärfe müssen in allen Bildern gleich "
        "bleiben.",
    },
    {
        "en": "Add the section external_tracker to the settings.",
        "de": "Den Abschnitt external_tracker in den Einstellungen ergänzen.",
    },
    {
        "en": "Start Plus, and check external_tracker.host and external_tracker.port; it is retried "
        "automatically.",
        "de": "Plus starten und external_tracker.host und external_tracker.port prüfen; es wird automatisch "
        "erneut versucht.",
    },
    {
        "en": "Check Plus and the tracker; it is reconnected automatically.",
        "de": "Plus und das Trackingsystem prüfen; es wird automatisch neu verbunden.",
    },
    {
        "en": "Bring drill and patient into its view, and check that Plus sends transforms of these names; "
        "it is reconnected automatically.",
        "de": "Bohrer und Patient in sein Messfeld bringen und prüfen, dass Plus Transformationen mit diesen "
        "Namen sendet; es wird automatisch neu verbunden.",
    },
    {
        "en": "Check the network and the load of the computer of Plus, or whether its clock was set back; it "
        "is reconnected automatically.",
        "de": "Netz und Auslastung des Rechners von Plus prüfen, oder ob dessen Uhr zurückgestellt wurde; es "
        "wird automatisch neu verbunden.",
    },
    {
        "en": "Let it send only TRANSFORM or TDATA, as rigid motions in mm with time stamps; it is "
        "reconnected automatically.",
        "de": "Nur TRANSFORM oder TDATA senden lassen, als starre Bewegungen in mm mit Zeitstempeln; es wird "
        "automatisch neu verbunden.",
    },
    {
        "en": "Use a step without images, or start with a camera as the source.",
        "de": "Einen Schritt ohne Bilder wählen, oder mit einer Kamera als Quelle starten.",
    },
    {
        "en": "GET /api/markers states which markers have one.",
        "de": "GET /api/markers gibt an, welche Marker eines haben.",
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
        "en": "Check the cable, and set the camera to MJPEG or YUYV; it is retried automatically.",
        "de": "Das Kabel prüfen und die Kamera auf MJPEG oder YUYV stellen; es wird automatisch erneut "
        "versucht.",
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
        "en": "Use a short cable and a USB port without a hub, or a wired network instead of Wi-Fi, and a "
        "smaller image or lower rate. If all images are damaged on any port, the camera writes invalid "
        "JPEGs: take a size for which coaxial cameras lists YUYV.",
        "de": "Ein kurzes Kabel und einen USB-Anschluss ohne Hub verwenden, oder ein Netzkabel statt WLAN, "
        "und ein kleineres Bild oder eine niedrigere Rate. Sind an jedem Anschluss alle Bilder beschädigt, "
        "schreibt die Kamera ungültige JPEGs: eine Größe wählen, für die „coaxial cameras“ YUYV nennt.",
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
    {
        "en": "Take another image that is sharp and shows the whole board without glare.",
        "de": "Ein anderes Bild aufnehmen, das scharf ist und die ganze Tafel ohne Spiegelung zeigt.",
    },
    {
        "en": "Hold the whole board still and in focus, and try again.",
        "de": "Die ganze Tafel ruhig und scharf im Bild halten und erneut versuchen.",
    },
    {
        "en": "Take 10 to 20 images with the whole board in view, tilted by 20 to 45 deg to different sides.",
        "de": "10 bis 20 Bilder mit der ganzen Tafel aufnehmen, um 20 bis 45° nach verschiedenen Seiten "
        "geneigt.",
    },
    {
        "en": "Check columns, rows and layout of the board, and take 10 to 20 views with the board tilted "
        "by up to 45 deg in different directions.",
        "de": "Spalten, Zeilen und Muster der Tafel prüfen, und 10 bis 20 Ansichten aufnehmen, mit der "
        "Tafel um bis zu 45° in verschiedene Richtungen geneigt.",
    },
    {
        "en": "Give more points of the plane, spread over it and other than those that are measured.",
        "de": "Mehr Punkte der Ebene angeben, über sie verteilt und andere als die gemessenen.",
    },
    {
        "en": "Give two coordinates in mm and two in px for each point.",
        "de": "Zu jedem Punkt zwei Koordinaten in mm und zwei in px angeben.",
    },
    {
        "en": "Give numbers for all coordinates.",
        "de": "Für alle Koordinaten Zahlen angeben.",
    },
    {
        "en": "Use images of the size that the camera was calibrated with.",
        "de": "Bilder der Größe verwenden, mit der die Kamera kalibriert wurde.",
    },
    {
        "en": "Count the board again: dots, or inner corners of a checkerboard, or squares of a ChArUco "
        "board, or tags of an AprilGrid.",
        "de": "Die Tafel neu auszählen: Punkte, oder innere Ecken eines Schachbretts, oder Quadrate einer "
        "ChArUco-Tafel, oder Tags eines AprilGrid.",
    },
    {
        "en": "Give the image as the camera made it.",
        "de": "Das Bild so angeben, wie die Kamera es lieferte.",
    },
    {
        "en": "Check that the image file exists.",
        "de": "Prüfen, ob die Bilddatei existiert.",
    },
    {
        "en": "Give grey or BGR images with 8 bits.",
        "de": "Graue oder BGR-Bilder mit 8 Bit angeben.",
    },
    {
        "en": "Give an image of the camera that was calibrated.",
        "de": "Ein Bild der kalibrierten Kamera angeben.",
    },
    {
        "en": "Detect the board again in its image.",
        "de": "Die Tafel in ihrem Bild neu suchen.",
    },
    {
        "en": "Give the two ends of each displacement, in mm on the plane and in px in the image.",
        "de": "Beide Enden jeder Verschiebung angeben, in mm auf der Ebene und in px im Bild.",
    },
    {
        "en": "Calibrate the camera again, or give OpenCV's K (3x3), distortion and image size.",
        "de": "Die Kamera neu kalibrieren, oder K (3x3), Verzeichnung und Bildgröße wie in OpenCV angeben.",
    },
    {
        "en": "Check fx and fy. Pixels that are far from square come from one field of interlaced video or "
        "a squeezed image: use images of full width and height, and calibrate on them.",
        "de": "fx und fy prüfen. Stark längliche Pixel stammen aus einem Halbbild oder einem gestauchten "
        "Bild: Bilder in voller Breite und Höhe verwenden und mit ihnen kalibrieren.",
    },
    {
        "en": "Check cx and cy, and that they belong to this image size; a region of the sensor must "
        "contain the axis.",
        "de": "cx und cy prüfen, und dass sie zu dieser Bildgröße gehören; ein Ausschnitt des Sensors muss "
        "die Achse enthalten.",
    },
    {
        "en": "Check that the focal lengths are in pixels of images of this size, not in mm, or calibrate "
        "again.",
        "de": "Prüfen, dass die Brennweiten in Pixeln von Bildern dieser Größe sind, nicht in mm, oder neu "
        "kalibrieren.",
    },
    {
        "en": "Check the order k1 k2 p1 p2 k3 ... and that the coefficients belong to this matrix and "
        "image size, or calibrate again with views of the board up to the corners of the image.",
        "de": "Die Reihenfolge k1 k2 p1 p2 k3 ... prüfen, und dass die Koeffizienten zu dieser Matrix und "
        "Bildgröße gehören, oder neu kalibrieren mit Ansichten der Tafel bis in die Ecken des Bildes.",
    },
    {
        "en": "Omit controls, or give values for some of: {names}.",
        "de": "controls weglassen, oder Werte für einige davon angeben: {names}.",
    },
    {
        "en": "Omit readout_ms if it is unknown; 0 is a global shutter.",
        "de": "readout_ms weglassen, wenn die Zeit unbekannt ist; 0 ist ein Global Shutter.",
    },
    {
        "en": "A camera file is YAML or JSON with matrix (3 rows of 3), distortion (4, 5, 8, 12 or 14 "
        "numbers) and size_wh_px (width, height).",
        "de": "Eine Kameradatei ist YAML oder JSON mit matrix (3 Zeilen zu 3), distortion (4, 5, 8, 12 "
        "oder 14 Zahlen) und size_wh_px (Breite, Höhe).",
    },
    {
        "en": "Move it quickly to and fro, sideways and up and down, about twice a second, and keep it in "
        "the picture.",
        "de": "Sie schnell hin und her bewegen, seitwärts und auf und ab, etwa zweimal je Sekunde, und im "
        "Bild halten.",
    },
    {
        "en": "Hold the board nearer, so that it fills half of the picture, and facing the camera. Move it "
        "quickly to and fro, sideways and up and down, about twice a second, and keep it in the "
        "picture.",
        "de": "Die Tafel näher halten, so dass sie das halbe Bild füllt und zur Kamera zeigt. Sie schnell "
        "hin und her bewegen, seitwärts und auf und ab, etwa zweimal je Sekunde, und im Bild halten.",
    },
    {
        "en": "Switch off rotation and mirroring of the image. If that does not help, the times of the "
        "images are wrong: try another port.",
        "de": "Drehung und Spiegelung des Bildes abschalten. Hilft das nicht, sind die Zeiten der Bilder "
        "falsch: einen anderen Anschluss versuchen.",
    },
    {
        "en": "Measure V and H from the camera to the object in mm again, and a displacement that can be "
        "seen.",
        "de": "V und H von der Kamera zum Objekt in mm neu messen, und eine Verschiebung, die zu sehen ist.",
    },
    {
        "en": "Replace the image or remove it from the folder; it is skipped until then.",
        "de": "Das Bild ersetzen oder aus dem Ordner entfernen; bis dahin wird es übersprungen.",
    },
    {
        "en": "Replace them or remove them from the folder; they are skipped until then.",
        "de": "Sie ersetzen oder aus dem Ordner entfernen; bis dahin werden sie übersprungen.",
    },
    {
        "en": "Put images into the folder, or give another folder; it is retried automatically.",
        "de": "Bilder in den Ordner legen, oder einen anderen Ordner angeben; es wird automatisch neu "
        "versucht.",
    },
    {
        "en": "Check the path in camera.source or --source; it is retried automatically.",
        "de": "Den Pfad in camera.source oder --source prüfen; es wird automatisch neu versucht.",
    },
    {
        "en": "Give a complete video file (MP4, MOV, AVI or MKV); copy or export a truncated file again.",
        "de": "Eine vollständige Videodatei angeben (MP4, MOV, AVI oder MKV); eine abgeschnittene Datei "
        "neu kopieren oder exportieren.",
    },
    {
        "en": "Set camera.width, camera.height and camera.rate_hz to a mode of the phone's camera, or to "
        "null.",
        "de": "camera.width, camera.height und camera.rate_hz auf einen Modus der Kamera des Telefons oder "
        "auf null setzen.",
    },
    {
        "en": "Check the camera of the plug-in and its address in camera.source; it is retried "
        "automatically.",
        "de": "Die Kamera des Plug-ins und ihre Adresse in camera.source prüfen; es wird automatisch neu "
        "versucht.",
    },
    {
        "en": "Install its package into the environment of Coaxial, or correct its name in the settings.",
        "de": "Sein Paket in die Umgebung von Coaxial installieren, oder seinen Namen in den Einstellungen "
        "berichtigen.",
    },
    {
        "en": "Uninstall all of them but one.",
        "de": "Alle bis auf eines deinstallieren.",
    },
    {
        "en": "Correct or update its package, then start again.",
        "de": "Sein Paket berichtigen oder aktualisieren, dann neu starten.",
    },
    {
        "en": "Check address, cable and power of the camera; it is retried automatically.",
        "de": "Adresse, Kabel und Strom der Kamera prüfen; es wird automatisch neu versucht.",
    },
    {
        "en": "Point the camera at the screen, darken the room, or move closer until the code is large.",
        "de": "Die Kamera auf den Bildschirm richten, den Raum abdunkeln, oder näher herangehen, bis der "
        "Code groß ist.",
    },
    {
        "en": "Draw each snapshot into the image from which it was computed.",
        "de": "Jedes Ergebnis in das Bild zeichnen, aus dem es berechnet wurde.",
    },
    {
        "en": "Use images with 1 or 3 channels and at most 65,500 px on a side.",
        "de": "Bilder mit 1 oder 3 Kanälen und höchstens 65 500 px Seitenlänge verwenden.",
    },
    {
        "en": "Give a smaller --dot-mm, or a larger --pitch-mm; larger dots have 1.5 times --dot-mm.",
        "de": "--dot-mm kleiner oder --pitch-mm größer angeben; größere Punkte haben das 1,5-Fache von "
        "--dot-mm.",
    },
    {
        "en": "Use fewer or smaller dots or squares, or a larger paper with --paper A3.",
        "de": "Weniger oder kleinere Punkte oder Quadrate verwenden, oder ein größeres Papier mit --paper "
        "A3.",
    },
    {
        "en": "Give --paper with one of {papers}.",
        "de": "--paper mit einem von {papers} angeben.",
    },
    {
        "en": "Give another side with --side-mm.",
        "de": "Mit --side-mm eine andere Seitenlänge angeben.",
    },
    {
        "en": "{omit_hint}Set the camera to {calibrated_size_wh_px[0]}x{calibrated_size_wh_px[1]} px, or "
        "calibrate it at {image_size_wh_px[0]}x{image_size_wh_px[1]} px. {scaling_hint}",
        "de": "{omit_hint}Die Kamera auf {calibrated_size_wh_px[0]}x{calibrated_size_wh_px[1]} px stellen, "
        "oder sie mit {image_size_wh_px[0]}x{image_size_wh_px[1]} px kalibrieren. {scaling_hint}",
    },
    {
        "en": "Give a square grey image that the black square fills edge to edge, with no white margin.",
        "de": "Ein quadratisches graues Bild angeben, das das schwarze Quadrat von Rand zu Rand füllt, "
        "ohne weißen Rand.",
    },
    {
        "en": "Set a ratio between 0 and 1.",
        "de": "Ein Verhältnis zwischen 0 und 1 setzen.",
    },
    {
        "en": "Set {key} to {allowed_values}.",
        "de": "{key} neu setzen: {allowed_values}.",
    },
    {
        "en": "Check the camera, its power and its cable; it is retried automatically.",
        "de": "Kamera, Strom und Kabel prüfen; es wird automatisch neu versucht.",
    },
    {
        "en": "Start the trigger source, and check its cable; or set camera.trigger to null.",
        "de": "Die Triggerquelle starten und ihr Kabel prüfen; oder camera.trigger auf null setzen.",
    },
    {
        "en": "Reload the page on the phone; if the error persists, use another browser.",
        "de": "Die Seite auf dem Telefon neu laden; bleibt der Fehler, einen anderen Browser verwenden.",
    },
    {
        "en": "Move the phone closer to its access point, or set smaller images with camera.width and "
        "camera.height.",
        "de": "Das Telefon näher an seinen Zugangspunkt bringen, oder mit camera.width und camera.height "
        "kleinere Bilder einstellen.",
    },
    {
        "en": "Touch STOP and START on the phone.",
        "de": "Auf dem Telefon STOP und START berühren.",
    },
    {
        "en": "Set camera.width and camera.height to a size of the phone's camera.",
        "de": "camera.width und camera.height auf eine Größe der Kamera des Telefons setzen.",
    },
    {
        "en": "Start it with coaxial run --source phone, or set camera.source to phone in its settings.",
        "de": "Den Server mit coaxial run --source phone starten, oder in seinen Einstellungen "
        "camera.source auf phone setzen.",
    },
    {
        "en": "Set {control} back to {calibrated} (a restart does this, unless camera.lock_controls is "
        "false), or calibrate the camera again.",
        "de": "{control} auf {calibrated} zurückstellen (ein Neustart tut das, außer wenn "
        "camera.lock_controls false ist), oder die Kamera neu kalibrieren.",
    },
)
