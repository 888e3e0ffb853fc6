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
)
