"""Phrases in errors of accuracy tests and their plate."""

from collections.abc import Mapping
from itertools import combinations

from server.texts.language import Text

_FAULTS: tuple[Text, ...] = (
    {"en": "a wrong scale of plate or marker", "de": "ein falscher Maßstab von Platte oder Marker"},
    {"en": "a wrong tip", "de": "eine falsche Spitze"},
    {"en": "a wrong focal length", "de": "eine falsche Brennweite"},
)

ACCURACY: Mapping[str, tuple[Text, ...]] = {
    "fault_phrase": _FAULTS,
    "faults": tuple(
        {
            "en": " or ".join(one["en"] for one in candidates),
            "de": " oder ".join(one["de"] for one in candidates),
        }
        for count in (2, 3)
        for candidates in combinations(_FAULTS, count)
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
}
