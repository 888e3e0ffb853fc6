"""Phrases in the messages of errors, by the name of the value that has one.

Names are those in `context`. A phrase is given there in English, and its templates are filled with the other
values of the same error. An error with a phrase that is not listed here stays English.
"""

from collections.abc import Mapping
from itertools import combinations

from server.texts.language import Text

_NONE: Text = {"en": "", "de": ""}

_ANCHORS: tuple[Text, ...] = (
    {"en": "camera", "de": "die Kamera"},
    {"en": "reference", "de": "den Patientenmarker"},
)
_SIDES: tuple[Text, ...] = ({"en": "left", "de": "links"}, {"en": "right", "de": "rechts"})

_UNIT_GUESSES: tuple[Text, ...] = tuple(
    {
        "en": f": those {where['en']} seem to be in {unit['en']}",
        "de": f": die {where['de']} sind offenbar in {unit['de']} angegeben",
    }
    for where in (
        {"en": "on the CT", "de": "auf dem CT"},
        {"en": "as touched", "de": "vom Antasten"},
    )
    for unit in (
        {"en": "metres", "de": "Metern"},
        {"en": "centimetres", "de": "Zentimetern"},
        {"en": "inches", "de": "Zoll"},
    )
)

_OUTLIER_FITS: tuple[Text, ...] = tuple(
    {
        "en": "the others fit "
        + ", ".join(
            f"without point {{possible_outliers[{n}]}} to {{without_mm[{n}]:.2f}} mm" for n in range(count)
        ),
        "de": "die übrigen passen "
        + ", ".join(
            f"ohne Punkt {{possible_outliers[{n}]}} auf {{without_mm[{n}]:.2f}} mm" for n in range(count)
        ),
    }
    for count in range(1, 5)
)

_FAULTS: tuple[Text, ...] = (
    {"en": "a wrong scale of plate or marker", "de": "ein falscher Maßstab von Platte oder Marker"},
    {"en": "a wrong tip", "de": "eine falsche Spitze"},
    {"en": "a wrong focal length", "de": "eine falsche Brennweite"},
)

# Sorted by their English names, as an error names them.
_ROLES: tuple[Text, ...] = (
    {"en": "operator", "de": "Bedienung"},
    {"en": "screen", "de": "OP-Bildschirm"},
    {"en": "supervisor", "de": "Aufsicht"},
    {"en": "viewer", "de": "Betrachter"},
)

PHRASES: Mapping[str, tuple[Text, ...]] = {
    "wrong_way": ({"en": "small", "de": "klein"}, {"en": "large", "de": "groß"}),
    "fault_phrase": _FAULTS,
    "faults": tuple(
        {"en": " or ".join(one["en"] for one in alike), "de": " oder ".join(one["de"] for one in alike)}
        for count in (2, 3)
        for alike in combinations(_FAULTS, count)
    ),
    "plate_problem": (
        {"en": "a number is not finite or negative", "de": "eine Zahl ist nicht endlich oder negativ"},
        {"en": "it has {divots} divots, needed {needed}", "de": "{divots} Mulden, nötig {needed}"},
        {
            "en": "two divots are {nearest_mm:.1f} mm apart, needed {needed_mm:g} mm",
            "de": "zwei Mulden liegen {nearest_mm:.1f} mm auseinander, nötig {needed_mm:g} mm",
        },
        {"en": "its divots are on one line", "de": "die Mulden liegen auf einer Geraden"},
    ),
    "points_where": (
        {"en": "on the CT", "de": "auf dem CT"},
        {"en": "as touched", "de": "beim Antasten"},
        {"en": "marked", "de": "auf dem CT"},
        {"en": "touched", "de": "beim Antasten"},
    ),
    "unit_guess": (
        _NONE,
        *_UNIT_GUESSES,
    ),
    "spread_hint": (
        _NONE,
        {
            "en": "; all of them lie within {extent_mm:.3g} mm, as if in metres",
            "de": "; alle liegen innerhalb von {extent_mm:.3g} mm, wie in Metern angegeben",
        },
    ),
    "exchanged_points": (
        {
            "en": "points {exchanged[0]} and {exchanged[1]}",
            "de": "die Punkte {exchanged[0]} und {exchanged[1]}",
        },
        {
            "en": "points {exchanged[0]}, {exchanged[1]} and {exchanged[2]}",
            "de": "die Punkte {exchanged[0]}, {exchanged[1]} und {exchanged[2]}",
        },
    ),
    "misfit": (
        {
            "en": "point {worst} is off by {worst_mm:.2f} mm",
            "de": "Punkt {worst} weicht um {worst_mm:.2f} mm ab",
        },
        *_OUTLIER_FITS,
    ),
    "outlier_exception": (
        _NONE,
        {
            "en": ", or {tre_without_outlier_mm:.2f} mm if no landmark is an outlier",
            "de": ", oder {tre_without_outlier_mm:.2f} mm, wenn keine Landmarke ein Ausreißer ist",
        },
    ),
    "direction_sd": (
        {"en": "not known at all", "de": "völlig unbestimmt"},
        {"en": "known to {sd_mm:.1f} mm", "de": "auf {sd_mm:.1f} mm bestimmt"},
    ),
    "direction": (
        {"en": "to the left or right", "de": "nach links oder rechts"},
        {"en": "to the front or back", "de": "nach vorn oder hinten"},
        {"en": "along the spine (to head or feet)", "de": "längs der Wirbelsäule (nach kranial oder kaudal)"},
        {
            "en": "tilting to head or feet (about the left-right axis)",
            "de": "kippend nach kranial oder kaudal (um die Querachse)",
        },
        {
            "en": "tilting to the side (about the front-back axis)",
            "de": "kippend zur Seite (um die sagittale Achse)",
        },
        {"en": "turning about the spine's own axis", "de": "drehend um die Längsachse der Wirbelsäule"},
    ),
    "unregistered": (
        {"en": "{vertebra}", "de": "{vertebra}"},
        {"en": "the vertebra of the active channel", "de": "der Wirbel des Kanals, der gebohrt wird,"},
    ),
    "start_anchor": _ANCHORS,
    "sweep_anchor": _ANCHORS,
    "reference_setting": (
        {"en": "names '{reference}'", "de": "nennt „{reference}“"},
        {"en": "is not set", "de": "ist nicht gesetzt"},
    ),
    "collection": (
        {"en": "collection of board views is", "de": "keine Aufnahme von Ansichten der Tafel"},
        {"en": "latency measurement is", "de": "keine Latenzmessung"},
        {"en": "accuracy test is", "de": "kein Genauigkeitstest"},
        {"en": "readout measurement is", "de": "keine Messung der Auslesezeit"},
        {"en": "collection of tool poses is", "de": "keine Aufnahme von Lagen des Instruments"},
        {"en": "check is", "de": "keine Prüfung"},
        {"en": "registration by landmarks is", "de": "keine Registrierung mit Landmarken"},
        {"en": "sweep is", "de": "kein Abfahren"},
    ),
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
    "may": tuple(
        {"en": " or ".join(one["en"] for one in roles), "de": " oder ".join(one["de"] for one in roles)}
        for count in range(1, 5)
        for roles in combinations(_ROLES, count)
    ),
    "import_phrase": (
        _NONE,
        {
            "en": " and imported by {importer}",
            "de": " und von {importer} importiert",
        },
    ),
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
        _NONE,
        {
            "en": ", but a lookup table",
            "de": ", sondern eine Umsetzungstabelle",
        },
    ),
    "pixel_count": (
        _NONE,
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
        _NONE,
        {
            "en": "; they would be plausible in metres",
            "de": "; in Metern wären sie plausibel",
        },
        {
            "en": "; they would be plausible in micrometres",
            "de": "; in Mikrometern wären sie plausibel",
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
    "focus_phrase": (
        {
            "en": "is automatic",
            "de": "ist automatisch",
        },
        {
            "en": "cannot be locked or read in its browser",
            "de": "lässt sich in seinem Browser weder feststellen noch auslesen",
        },
    ),
    "skip_phrase": (
        {
            "en": "{skipped_images} of {images} images were not shown on this page",
            "de": "{skipped_images} von {images} Bildern wurden auf dieser Seite nicht gezeigt",
        },
        {
            "en": "{unprocessed_images} of {shown_images} images on this page were not searched for a code",
            "de": "in {unprocessed_images} von {shown_images} Bildern auf dieser Seite wurde kein Code "
            "gesucht",
        },
    ),
}
