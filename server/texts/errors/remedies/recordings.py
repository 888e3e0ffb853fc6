"""Remedies of errors of recordings."""

from server.texts.language import Text

RECORDINGS: tuple[Text, ...] = (
    {"en": "Use its image and figures.", "de": "Bild und Zahlen verwenden."},
    {
        "en": "Load its timeline, and wait until it is ready.",
        "de": "Die Zeitachse der Aufnahme laden und warten, bis sie bereit ist.",
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
        "en": "Export it again; a new file replaces the previous one of its kind.",
        "de": "Neu exportieren; eine neue Datei ersetzt die vorige ihrer Art.",
    },
    {
        "en": "Give a period with images, and a start before its end.",
        "de": "Einen Zeitraum mit Bildern angeben, dessen Beginn vor dem Ende liegt.",
    },
    {
        "en": "Choose a section in which the size of the images does not change.",
        "de": "Einen Abschnitt wählen, in dem sich die Größe der Bilder nicht ändert.",
    },
    {
        "en": "Choose a shorter section, or free disk space.",
        "de": "Einen kürzeren Abschnitt wählen, oder Platz auf der Platte schaffen.",
    },
    {
        "en": "Check that its folder exists and its disk has free space, then export again.",
        "de": "Prüfen, ob der Ordner vorhanden und auf seiner Platte Platz ist, dann neu exportieren.",
    },
    {
        "en": 'Install it into the environment of Coaxial: pip install "coaxial[parquet]".',
        "de": 'In der Umgebung von Coaxial installieren: pip install "coaxial[parquet]".',
    },
    {"en": "Choose a recording with images.", "de": "Eine Aufnahme mit Bildern wählen."},
    {
        "en": "Replay it with the version of Coaxial that recorded it.",
        "de": "Die Aufnahme mit der Version von Coaxial abspielen, mit der sie entstand.",
    },
    {
        "en": "Review the recording with the version of Coaxial that recorded it.",
        "de": "Die Aufnahme mit der Version von Coaxial durchsehen, mit der sie entstand.",
    },
    {
        "en": 'Install it into the environment of Coaxial: pip install "coaxial[cluster]".',
        "de": 'In der Umgebung von Coaxial installieren: pip install "coaxial[cluster]".',
    },
    {
        "en": "Check its address, as in tcp://host:8786, and that it runs.",
        "de": "Prüfen, ob die Adresse stimmt, etwa tcp://host:8786, und ob er läuft.",
    },
    {
        "en": "Check that its folder exists and its disk has free space, then try again.",
        "de": "Prüfen, ob der Ordner existiert und die Platte Platz hat, dann erneut versuchen.",
    },
    {
        "en": "Give a recording of Coaxial (.mcap).",
        "de": "Eine Aufnahme von Coaxial (.mcap) angeben.",
    },
    {
        "en": "Check the disk of the cases, then start the recording again. Navigation continues, and "
        "the part written so far is readable.",
        "de": "Die Platte der Fälle prüfen, dann die Aufnahme neu starten. Die Navigation läuft "
        "weiter, und der bisher geschriebene Teil ist lesbar.",
    },
    {
        "en": 'Install it into the environment of Coaxial: pip install "coaxial[video]", or pip install av.',
        "de": 'In die Umgebung von Coaxial installieren: pip install "coaxial[video]", oder pip install av.',
    },
)
