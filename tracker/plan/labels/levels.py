"""Levels of the spine: names, order, and class numbers of TotalSegmentator."""

import re

# From the head down.
LEVELS: tuple[str, ...] = (
    *(f"C{number}" for number in range(1, 8)),
    *(f"T{number}" for number in range(1, 13)),
    *(f"L{number}" for number in range(1, 6)),
    "S1",
)
# Class numbers of the task "total" of TotalSegmentator v2 (`class_map` of its map_to_binary.py): 26 is
# vertebrae_S1, 27 vertebrae_L5, and so on upwards to 50, vertebrae_C1. 25, the sacrum, is not one vertebra.
CLASS_OF_LEVEL: dict[str, int] = {level: 50 - place for place, level in enumerate(LEVELS)}
LEVEL_OF_CLASS: dict[int, str] = {number: level for level, number in CLASS_OF_LEVEL.items()}
MAX_CLASS = 117
MAX_NAME_LETTERS = 64

# `L3`, `vertebrae_L3` (TotalSegmentator), `L3 vertebra` (SNOMED CT), `LWK 3` (German), `Th12` or `D12`.
_NAME = re.compile(
    r"(?:vertebrae?[ _])?(?P<region>c|t|th|d|l|s|hwk|bwk|lwk|swk) ?(?P<number>\d{1,2})(?: vertebrae?)?"
)
_REGIONS = {"c": "C", "hwk": "C", "t": "T", "th": "T", "d": "T", "bwk": "T", "l": "L", "lwk": "L"}


def level_from_name(name: str) -> str | None:
    """Return the level that a name denotes; None if it denotes none."""
    if len(name) > MAX_NAME_LETTERS:
        return None
    found = _NAME.fullmatch(" ".join(name.casefold().split()))
    if found is None:
        return None
    level = f"{_REGIONS.get(found['region'], 'S')}{int(found['number'])}"
    return level if level in CLASS_OF_LEVEL else None
