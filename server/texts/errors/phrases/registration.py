"""Phrases in errors of registration, its landmarks and its check."""

from collections.abc import Mapping

from server.texts.language import NO_TEXT, Text

_ANCHORS: tuple[Text, ...] = (
    {"en": "camera", "de": "die Kamera"},
    {"en": "reference", "de": "den Patientenmarker"},
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

REGISTRATION: Mapping[str, tuple[Text, ...]] = {
    "wrong_way": ({"en": "small", "de": "klein"}, {"en": "large", "de": "groß"}),
    "points_where": (
        {"en": "on the CT", "de": "auf dem CT"},
        {"en": "as touched", "de": "beim Antasten"},
        {"en": "marked", "de": "auf dem CT"},
        {"en": "touched", "de": "beim Antasten"},
    ),
    "unit_guess": (
        NO_TEXT,
        {
            "en": ": those {points_where} seem to be in {length_unit}",
            "de": ": die {points_where} sind offenbar in {length_unit} angegeben",
        },
    ),
    "spread_hint": (
        NO_TEXT,
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
        NO_TEXT,
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
    "length_unit": (
        {
            "en": "metres",
            "de": "Metern",
        },
        {
            "en": "centimetres",
            "de": "Zentimetern",
        },
        {
            "en": "micrometres",
            "de": "Mikrometern",
        },
        {
            "en": "inches",
            "de": "Zoll",
        },
    ),
}
