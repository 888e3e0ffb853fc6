"""Remedies of errors of DICOM objects and of their way to and from an archive."""

from server.texts.language import Text

DICOM: tuple[Text, ...] = (
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
)
