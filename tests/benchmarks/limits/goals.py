"""Goals by camera and condition, shown beside the measurements in the tables."""

from collections.abc import Mapping

Goals = Mapping[str, float]

_EASY = (
    "base",
    "dark0.06",
    "shadow0.5",
    "shadow0.8",
    "jpeg70",
    "jpeg40",
    "jpeg20",
    "noise4",
    "noise8",
    "noise16",
)
_TILTS = ("tilt0-15", "tilt15-30", "tilt30-45", "tilt45-60")
_BOTH = dict.fromkeys((*_EASY, *_TILTS), 0.99)
FOUND: Mapping[str, Goals] = {
    "A": {
        **_BOTH,
        "cover10": 0.95,
        "cover20": 0.85,
        "cover30": 0.60,
        "motion4": 0.97,
        "motion8": 0.80,
        "defocus2": 0.95,
        "glare0.4": 0.98,
        "glare0.8": 0.80,
        "hard1": 0.97,
        "hard2": 0.60,
    },
    "B": {**_BOTH, "cover10": 0.98, "cover20": 0.92, "cover30": 0.80},
}
TRACKED: Goals = {"cover30": 0.99, "glare1.6": 0.99, "shadow0.8": 0.99}
# Median of the tip's error by the bound of the same scene.
TIP_OF_BOUND: Goals = {
    **dict.fromkeys(("base", "lens", "noise8", "dark0.15"), 1.5),
    "defocus1.5": 2.0,
    **dict.fromkeys(("shadow0.5", "glare0.4", "motion2", "motion4", "jpeg70"), 3.0),
}
# Median, mm.
GAMMA_TIP_MM: Goals = {"A": 1.0, "B": 0.08}
P95_OF_MEDIAN = 3.0
COVERED = (0.92, 0.98)
# By cv2.aruco's defaults on the same images: median, 99th percentile.
SEARCH_OF_ARUCO: Mapping[str, tuple[float, float]] = {"A": (0.40, 1.5), "B": (0.22, 1.5)}
STEP_OF_ARUCO: Mapping[str, tuple[float, float]] = {"A": (0.15, 0.6), "B": (0.12, 0.6)}
IDLE_STEP_OF_ARUCO: Mapping[str, tuple[float, float]] = {"A": (1.0, 2.0), "B": (0.8, 2.0)}
# 95th percentile of the number of images until a marker that comes back is found.
IMAGES_TO_RETURN: Mapping[str, int] = {"base": 3, "hard1": 6}
FOUND_IN_HAND = 0.99
FOUR_OF_ONE = 2.5
FIRST_OF_LATER = 3.0
PAPER_SEARCH_MS = 11.5
