"""The codes that the page shows in sequence: markers of OpenCV's DICT_4X4_250."""

import math
from dataclasses import dataclass
from functools import cache

import cv2

DICTIONARY = cv2.aruco.DICT_4X4_250
# Cells along a side, without the black border of one cell.
CELLS = 4
# At 30 images/s a code is shown for 3 to 4.5 image periods, and 160 codes take 20 s.
MIN_CODE_MS = 100.0
# Minimum duration of a code in image periods of a slower camera; one image may coincide with a change.
MIN_CODE_PERIODS = 2.0
# Ratio of longest to shortest duration; random durations prevent codes and images from being in phase.
MAX_CODE_RATIO = 1.5
# Fraction of the painted codes, 100 of 160.
MIN_TIMED_RATIO = 0.625


@dataclass(frozen=True, slots=True, kw_only=True)
class CodePlan:
    """Number and duration of the codes.

    Attributes:
        codes: Number of codes shown after the first one was read.
        min_code_ms, max_code_ms: Bounds of the random duration of a code.
        min_timed: Minimum number of timed codes.
    """

    codes: int
    min_code_ms: float
    max_code_ms: float
    min_timed: int


def plan_codes(codes: int, *, rate_hz: float) -> CodePlan:
    """Return the plan for a camera of this rate."""
    min_code_ms = max(MIN_CODE_MS, MIN_CODE_PERIODS * 1000.0 / rate_hz)
    return CodePlan(
        codes=codes,
        min_code_ms=min_code_ms,
        max_code_ms=min_code_ms * MAX_CODE_RATIO,
        min_timed=math.ceil(codes * MIN_TIMED_RATIO),
    )


@cache
def code_patterns() -> tuple[str, ...]:
    """Return the cells of each code, row by row from the top left: "1" is white. The border is black."""
    dictionary = cv2.aruco.getPredefinedDictionary(DICTIONARY)
    side = CELLS + 2
    patterns = []
    for code in range(len(dictionary.bytesList)):
        cells = cv2.aruco.generateImageMarker(dictionary, code, side)[1:-1, 1:-1]
        patterns.append("".join("1" if cell else "0" for cell in cells.flat))
    return tuple(patterns)
