"""Phrases in warnings about completed work."""

from collections.abc import Mapping, Sequence
from itertools import combinations

from server.texts.language import NO_TEXT, Text

_CORNERS: tuple[Text, ...] = (
    {"en": "top left", "de": "oben links"},
    {"en": "top right", "de": "oben rechts"},
    {"en": "bottom right", "de": "unten rechts"},
    {"en": "bottom left", "de": "unten links"},
)
_CT_ENDS: tuple[Text, ...] = (
    {"en": "first column", "de": "erste Spalte"},
    {"en": "first row", "de": "erste Zeile"},
    {"en": "first slice", "de": "erste Schicht"},
    {"en": "last column", "de": "letzte Spalte"},
    {"en": "last row", "de": "letzte Zeile"},
    {"en": "last slice", "de": "letzte Schicht"},
)


def _lists_of(parts: Sequence[Text]) -> tuple[Text, ...]:
    """Return the texts of all lists that are made of these parts in their order."""
    return tuple(
        {"en": ", ".join(part["en"] for part in some), "de": ", ".join(part["de"] for part in some)}
        for count in range(1, len(parts) + 1)
        for some in combinations(parts, count)
    )


REMARKS: Mapping[str, tuple[Text, ...]] = {
    "board_points": ({"en": "inner corners", "de": "innere Ecken"}, {"en": "dots", "de": "Punkte"}),
    "body_wall": (
        {"en": "side", "de": "Seitenwand"},
        {"en": "upper endplate", "de": "Deckplatte"},
        {"en": "lower endplate", "de": "Bodenplatte"},
    ),
    "count_hint": (
        NO_TEXT,
        {"en": ", one fewer each way than squares", "de": ", je Richtung eine weniger als Felder"},
    ),
    "cut_ends": _lists_of(_CT_ENDS),
    "doubtful_landmarks": (
        {"en": "each of them", "de": "jeder davon"},
        {"en": "{doubtful_names}", "de": "{doubtful_names}"},
    ),
    "error_extent": (
        {"en": "of any size", "de": "beliebiger Größe"},
        {"en": "of up to {undetected_mm:.1f} mm", "de": "von bis zu {undetected_mm:.1f} mm"},
    ),
    "excluded_files": (
        {"en": "DICOM files without an image", "de": "DICOM-Dateien ohne Bild"},
        {"en": "NIfTI files", "de": "NIfTI-Dateien"},
        {"en": "archives inside the archive", "de": "Archive im Archiv"},
        {"en": "colour pictures (screens, reports)", "de": "Farbbilder (Bildschirme, Berichte)"},
        {"en": "empty files", "de": "leere Dateien"},
        {"en": "files that are not DICOM", "de": "Dateien, die kein DICOM sind"},
        {"en": "files that cannot be opened", "de": "Dateien, die sich nicht öffnen lassen"},
        {
            "en": "files that declare more than {max_frames} images",
            "de": "Dateien, die mehr als {max_frames} Bilder angeben",
        },
        {
            "en": "files that exceed the maximum size when unpacked",
            "de": "Dateien, die entpackt die größte zulässige Größe überschreiten",
        },
        {"en": "localizers (scouts)", "de": "Übersichtsaufnahmen (Scouts)"},
        {
            "en": "multi-frame files without positions of their images",
            "de": "Mehrbilddateien ohne Positionen ihrer Bilder",
        },
        {"en": "not regular files", "de": "keine gewöhnlichen Dateien"},
        {
            "en": "pictures of a screen (secondary captures)",
            "de": "Bildschirmbilder (Secondary Captures)",
        },
        {"en": "truncated or damaged DICOM files", "de": "abgeschnittene oder beschädigte DICOM-Dateien"},
    ),
    "model_reason": (
        {
            "en": "{few} without a trial: {views} views, to hold some out takes {needed}",
            "de": "{few} ohne Vergleich: {views} Ansichten, zum Zurückhalten sind {needed} nötig",
        },
        {"en": "{coefficients} were requested", "de": "{coefficients} waren verlangt"},
        {
            "en": "8 describe views held out to {rms8} px, 5 to {rms5} px",
            "de": "8 beschreiben zurückgehaltene Ansichten auf {rms8} px, 5 auf {rms5} px",
        },
        {
            "en": "4 describe views held out to {rms4} px, 5 only to {rms5} px",
            "de": "4 beschreiben zurückgehaltene Ansichten auf {rms4} px, 5 nur auf {rms5} px",
        },
        {
            "en": "5 describe views held out to {rms5} px, 4 to {rms4} px, 8 to {rms8} px",
            "de": "5 beschreiben zurückgehaltene Ansichten auf {rms5} px, 4 auf {rms4} px, 8 auf {rms8} px",
        },
    ),
    "side_name": ({"en": "left", "de": "linke"}, {"en": "right", "de": "rechte"}),
    "size_comparison": ({"en": "larger", "de": "größer"}, {"en": "smaller", "de": "kleiner"}),
    "uncovered_corners": _lists_of(_CORNERS),
    "vertebra_part": ({"en": "canal", "de": "Kanal"}, {"en": "body", "de": "Wirbelkörper"}),
    "view_names": (
        {
            "en": "{named_views} and {further_views} more",
            "de": "{named_views} und {further_views} weitere",
        },
        {"en": "{named_views}", "de": "{named_views}"},
    ),
}
