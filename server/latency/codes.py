"""The codes that the page shows: markers of OpenCV's DICT_4X4_250, one after the other."""

import math
from dataclasses import dataclass
from functools import cache

import cv2

DICTIONARY = cv2.aruco.DICT_4X4_250
# Cells along a side, without the black border of one cell.
CELLS = 4
# At 30 images/s a code stands for three to four and a half image periods, and 160 of them take 20 s.
MIN_CODE_MS = 100.0
# Of a slower camera a code stands for at least so many image periods: one image may fall on the change.
MIN_CODE_PERIODS = 2.0
# Times between the shortest and this many times as long keep codes and images out of step.
MAX_CODE_RATIO = 1.5
# Of the codes that are painted; 100 of 160.
MIN_TIMED_RATIO = 0.625


@dataclass(frozen=True, slots=True, kw_only=True)
class CodePlan:
    """How many codes are shown, and for how long each.

    Attributes:
        codes: how many are shown once the first has been read.
        min_code_ms, max_code_ms: a code stands for a random time between these.
        min_timed: how many of the codes must be timed.
    """

    codes: int
    min_code_ms: float
    max_code_ms: float
    min_timed: int


def plan_codes(codes: int, *, rate_hz: float) -> CodePlan:
    """The plan for a camera of this rate."""
    min_code_ms = max(MIN_CODE_MS, MIN_CODE_PERIODS * 1000.0 / rate_hz)
    return CodePlan(
        codes=codes,
        min_code_ms=min_code_ms,
        max_code_ms=min_code_ms * MAX_CODE_RATIO,
        min_timed=math.ceil(codes * MIN_TIMED_RATIO),
    )


@cache
def code_patterns() -> tuple[str, ...]:
    """The cells of each code, row by row from the top left: "1" is white. The border is black."""
    dictionary = cv2.aruco.getPredefinedDictionary(DICTIONARY)
    side = CELLS + 2
    patterns = []
    for code in range(len(dictionary.bytesList)):
        cells = cv2.aruco.generateImageMarker(dictionary, code, side)[1:-1, 1:-1]
        patterns.append("".join("1" if cell else "0" for cell in cells.flat))
    return tuple(patterns)
