"""Phrases in errors of cases, CTs, surfaces and plans."""

from collections.abc import Mapping

from server.texts.language import NO_TEXT, Text

_SIDES: tuple[Text, ...] = ({"en": "left", "de": "links"}, {"en": "right", "de": "rechts"})

CASES: Mapping[str, tuple[Text, ...]] = {
    "bone_shape": (
        {
            "en": "it is {width_mm:.1f} x {height_mm:.1f} mm",
            "de": "er misst {width_mm:.1f} x {height_mm:.1f} mm",
        },
        {
            "en": "it is equally thick for {length_mm:.0f} mm and joins neither body nor arch",
            "de": "er ist über {length_mm:.0f} mm gleich dick und geht weder in Wirbelkörper noch Bogen über",
        },
    ),
    "second": (
        {"en": "from 2 mm aside none is found", "de": "2 mm daneben wird keiner gefunden"},
        {
            "en": "from a few mm aside it is {other_mm[0]:.1f} x {other_mm[1]:.1f} mm, "
            "{apart_mm:.1f} mm away",
            "de": "wenige mm daneben ist er {other_mm[0]:.1f} x {other_mm[1]:.1f} mm, "
            "{apart_mm:.1f} mm entfernt",
        },
    ),
    "side": _SIDES,
    "other_side": _SIDES,
    "plan_problem": (
        {
            "en": "its format is not '{format}'",
            "de": "ihr Format ist nicht „{format}“",
        },
        {
            "en": "it is nested too deeply",
            "de": "sie ist zu tief verschachtelt",
        },
        {
            "en": "it is not valid JSON",
            "de": "sie ist kein gültiges JSON",
        },
        {
            "en": "it is not a JSON object",
            "de": "sie ist kein JSON-Objekt",
        },
    ),
    "table_hint": (
        NO_TEXT,
        {
            "en": ", but a lookup table",
            "de": ", sondern eine Umsetzungstabelle",
        },
    ),
    "pixel_count": (
        NO_TEXT,
        {
            "en": " ({pixel_bytes} bytes of pixels)",
            "de": " ({pixel_bytes} Bytes Pixel)",
        },
        {
            "en": " ({pixel_bytes} bytes of pixels, expected {needed_bytes})",
            "de": " ({pixel_bytes} Bytes Pixel, erwartet {needed_bytes})",
        },
    ),
    "images_where": (
        {
            "en": "the series",
            "de": "die Serie",
        },
        {
            "en": "the folder",
            "de": "der Ordner",
        },
    ),
    "identity_kind": (
        {
            "en": "patient IDs",
            "de": "Patienten-IDs",
        },
        {
            "en": "patient names",
            "de": "Patientennamen",
        },
        {
            "en": "dates of birth",
            "de": "Geburtsdaten",
        },
    ),
    "voxel_unit_guess": (
        NO_TEXT,
        {
            "en": "; they would be plausible in {length_unit}",
            "de": "; in {length_unit} wären sie plausibel",
        },
    ),
    "damage": (
        {
            "en": "it is missing",
            "de": "sie fehlt",
        },
        {
            "en": "its SHA-256 differs",
            "de": "ihr SHA-256 stimmt nicht",
        },
    ),
    "import_phrase": (
        NO_TEXT,
        {
            "en": " and imported by {importer}",
            "de": " und von {importer} importiert",
        },
    ),
    "document_problem": (
        {
            "en": "{count} values are invalid",
            "de": "{count} Werte sind ungültig",
        },
        {
            "en": "a pose is not a rigid motion: its rotation deviates from orthonormal by {off}, allowed "
            "{allowed}, and all numbers must be finite",
            "de": "eine Lage ist keine starre Bewegung: ihre Drehung weicht um {off} von orthonormal ab, "
            "erlaubt {allowed}, und alle Zahlen müssen endlich sein",
        },
        {
            "en": "it has {files} files, expected 1",
            "de": "es hat {files} Dateien, erwartet 1",
        },
    ),
}
