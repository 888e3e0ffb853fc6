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
    "at_rate": (
        {
            "en": " at {rate_hz} images/s",
            "de": " bei {rate_hz} Bildern/s",
        },
        NO_TEXT,
        {
            "en": " at {rate_text}",
            "de": " bei {rate_text}",
        },
    ),
    "rate_text": (
        {
            "en": "{rate_hz} images/s",
            "de": "{rate_hz} Bildern/s",
        },
        {
            "en": "{rate_hz} images/s{camera_rate}",
            "de": "{rate_hz} Bildern/s{camera_rate}",
        },
    ),
    "rate_remedy": (
        NO_TEXT,
        {
            "en": " The machine skips images: end other programs, or ask the camera for smaller images "
            "(camera.width, camera.height).",
            "de": " Der Rechner überspringt Bilder: andere Programme beenden, oder von der Kamera kleinere "
            "Bilder verlangen (camera.width, camera.height).",
        },
        {
            "en": " The camera is slow: give it more light, or ask it for smaller images or more of them "
            "(camera.width, camera.height, camera.rate_hz).",
            "de": " Die Kamera ist langsam: ihr mehr Licht geben, oder kleinere oder mehr Bilder von ihr "
            "verlangen (camera.width, camera.height, camera.rate_hz).",
        },
    ),
    "order": (
        NO_TEXT,
        {
            "en": ", out of order",
            "de": ", in falscher Reihenfolge",
        },
    ),
    "hold_hint": (
        NO_TEXT,
        {
            "en": " for {hold_s} s at {rate_text},",
            "de": " für {hold_s} s bei {rate_text}",
        },
    ),
    "left_hint": (
        NO_TEXT,
        {
            "en": " for another {left_s} s,",
            "de": " noch {left_s} s",
        },
    ),
    "unseen_reason": (
        {
            "en": "the tool's marker is not seen",
            "de": "der Marker des Instruments ist nicht zu sehen",
        },
        {
            "en": "the tool's marker is in view twice",
            "de": "der Marker des Instruments ist doppelt im Bild",
        },
        {
            "en": "the position of the tip is uncertain by millimetres",
            "de": "der Ort der Spitze ist um Millimeter unsicher",
        },
        {
            "en": "the camera is not calibrated",
            "de": "die Kamera ist nicht kalibriert",
        },
        {
            "en": "focus or zoom of the camera has changed since the calibration",
            "de": "Schärfe oder Zoom der Kamera wurde seit der Kalibrierung verstellt",
        },
        {
            "en": "the marker '{marker}' on the patient is not seen",
            "de": "der Marker „{marker}“ am Patienten ist nicht zu sehen",
        },
    ),
    "worst_observation": (
        {
            "en": "needle '{name}'",
            "de": "Nadel „{name}“",
        },
        {
            "en": "touched point '{name}'",
            "de": "der angetastete Punkt „{name}“",
        },
        {
            "en": "the camera's tilt, by {tilt_deg} deg",
            "de": "die Neigung der Kamera, um {tilt_deg}°",
        },
        {
            "en": "the camera's distance, by {distance_mm} mm",
            "de": "der Abstand der Kamera, um {distance_mm} mm",
        },
    ),
    "camera_rate": (
        {
            "en": " (the camera gives {camera_hz})",
            "de": " (die Kamera liefert {camera_hz})",
        },
    ),
}
