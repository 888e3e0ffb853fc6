"""One pose as a file tells it, and how a mistake in a file is told."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput
from tracker.geometry import Camera, Marker, Rigid

FORMATS_REMEDY = (
    "Give a folder of files with a 4x4 matrix each, or one file: rows of 4, 12 or 16 numbers, a CSV with a "
    "header (time, x, y, z, qx, qy, qz, qw), .npy (n, 4, 4), JSON, or the lines of 'coaxial track --json'."
)
# Names of a column or key that holds a time in seconds.
TIME_NAMES = ("time_s", "time", "t", "timestamp", "stamp", "sec", "seconds")


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseRecord:
    """A pose, and where it stands.

    Attributes:
        place: file, line or number, as a person finds it.
        pose: camera from marker, in mm.
        covariance: (6, 6) [mm, rad] where it is stated.
        marker: which marker, where that is told.
        side_mm: the side that it was tracked with, where that is told.
        time_s: on the source's clock, where that is told.
    """

    place: str
    pose: Rigid[Camera, Marker]
    covariance: npt.NDArray[np.float64] | None = None
    marker: str | None = None
    side_mm: float | None = None
    time_s: float | None = None


def unreadable(place: str, what: str) -> InvalidInput:
    """The error for a file, or a line of it, that holds no pose."""
    return InvalidInput("POSES_UNREADABLE", f"{place}: {what}", FORMATS_REMEDY, {"place": place})


def at_place(place: str, error: InvalidInput) -> InvalidInput:
    """The same error, saying where."""
    return InvalidInput(
        error.code, f"{place}: {error.message}", error.remedy, {**error.context, "place": place}
    )
