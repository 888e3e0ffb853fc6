"""Phrases in errors of access."""

from collections.abc import Mapping
from itertools import combinations

from server.texts.language import Text

# Sorted by their English names, as an error names them.
_ROLES: tuple[Text, ...] = (
    {"en": "operator", "de": "Bedienung"},
    {"en": "screen", "de": "OP-Bildschirm"},
    {"en": "supervisor", "de": "Aufsicht"},
    {"en": "viewer", "de": "Betrachter"},
)

ACCESS: Mapping[str, tuple[Text, ...]] = {
    "may": tuple(
        {"en": " or ".join(one["en"] for one in roles), "de": " oder ".join(one["de"] for one in roles)}
        for count in range(1, 5)
        for roles in combinations(_ROLES, count)
    ),
}
