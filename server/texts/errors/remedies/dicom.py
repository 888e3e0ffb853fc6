"""Remedies of errors of DICOM objects and of their way to and from an archive."""

from server.texts.language import Text

DICOM: tuple[Text, ...] = (
    {
        "en": "Check address, port, TLS and network of the archive.",
        "de": "Adresse, Port, TLS und Netz des Archivs prüfen.",
    },
    {
        "en": "Enter this AE title in the archive, and check the archive's own AE title in the settings.",
        "de": "Diesen AE-Titel im Archiv eintragen, und den des Archivs in den Einstellungen prüfen.",
    },
    {
        "en": "Give a PEM file in dicom.archive.ca.",
        "de": "Unter dicom.archive.ca eine PEM-Datei angeben.",
    },
    {
        "en": "Set host, port and ae_title under dicom.archive.",
        "de": "Unter dicom.archive host, port und ae_title setzen.",
    },
    {
        "en": "Export the CT from the archive again, without anonymising or converting it.",
        "de": "Das CT erneut aus dem Archiv exportieren, ohne es zu anonymisieren oder umzuwandeln.",
    },
    {
        "en": "Give the labels and the CT of the same case.",
        "de": "Labels und CT desselben Falls geben.",
    },
    {
        "en": "Measure a pedicle, place a channel, or give labels.",
        "de": "Einen Pedikel messen, einen Kanal legen oder Labels geben.",
    },
    {
        "en": "Write models and report without labels, or use a CT without gantry tilt.",
        "de": "Modelle und Bericht ohne Labels schreiben, oder ein CT ohne gekippte Gantry verwenden.",
    },
    {
        "en": "Check the AE titles under dicom in the settings, and those of the sender.",
        "de": "Die AE-Titel unter dicom in den Einstellungen und die des Absenders prüfen.",
    },
    {
        "en": "Discard the series, and send it again.",
        "de": "Die Serie verwerfen und erneut senden.",
    },
    {
        "en": "Free space on the disk, and send again.",
        "de": "Platz auf der Platte schaffen und erneut senden.",
    },
    {
        "en": "Read the list again; it may have been taken, discarded or too old.",
        "de": "Die Liste erneut lesen; sie kann übernommen, verworfen oder zu alt geworden sein.",
    },
    {
        "en": "Send the CT series alone.",
        "de": "Die CT-Serie allein senden.",
    },
    {
        "en": "Send the series again that was being sent.",
        "de": "Die Serie erneut senden, die gerade gesendet wurde.",
    },
    {
        "en": "Send the series again.",
        "de": "Die Serie erneut senden.",
    },
    {
        "en": "Set it in the settings, or upload the CT.",
        "de": "Es in den Einstellungen setzen, oder das CT hochladen.",
    },
    {
        "en": "Take or discard a series that waits, and send again.",
        "de": "Eine wartende Serie übernehmen oder verwerfen und erneut senden.",
    },
    {
        "en": "Wait until the sender has finished, or send the series again.",
        "de": "Warten, bis der Absender fertig ist, oder die Serie erneut senden.",
    },
)
