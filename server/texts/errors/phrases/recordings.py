"""Phrases in errors of recordings."""

from collections.abc import Mapping

from server.texts.language import Text

RECORDINGS: Mapping[str, tuple[Text, ...]] = {
    "image_range": (
        {
            "en": "has images from 0 to {last_s:.1f} s",
            "de": "hat Bilder von 0 bis {last_s:.1f} s",
        },
        {
            "en": "has no image",
            "de": "hat kein Bild",
        },
    ),
    "write_problem": (
        {
            "en": "the disk is full",
            "de": "die Platte ist voll",
        },
        {
            "en": "{system_error}",
            "de": "{system_error}",
        },
    ),
    "read_problem": (
        {
            "en": "it is not an MCAP file",
            "de": "sie ist keine MCAP-Datei",
        },
        {
            "en": "it is not a recording of Coaxial",
            "de": "sie ist keine Aufnahme von Coaxial",
        },
        {
            "en": "this version cannot read its images ({encoding})",
            "de": "diese Version kann ihre Bilder nicht lesen ({encoding})",
        },
        {
            "en": "{system_error}",
            "de": "{system_error}",
        },
    ),
    "incomplete_reason": (
        {
            "en": "a checksum is wrong",
            "de": "eine Prüfsumme stimmt nicht",
        },
        {
            "en": "it ends inside a chunk",
            "de": "sie endet mitten in einem Abschnitt",
        },
        {
            "en": "its end record is missing",
            "de": "ihr Endeintrag fehlt",
        },
    ),
    "encoder_problem": (
        {
            "en": "they are written with PyAV, which is not installed",
            "de": "dazu dient PyAV, das nicht installiert ist",
        },
        {
            "en": "the FFmpeg of the installed PyAV lacks {codec}",
            "de": "dem FFmpeg des installierten PyAV fehlt {codec}",
        },
    ),
}
