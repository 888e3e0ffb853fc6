"""Record of one pose in a file, and errors with the place in the file."""

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
    """A pose and its place in the file.

    Attributes:
        place: file with line or number, for messages.
        pose: camera from marker, in mm.
        covariance: (6, 6) [mm, rad], if given.
        marker: name of the marker, if given.
        side_mm: side of the marker that it was tracked with, if given.
        time_s: time on the source's clock, if given.
        calibration_sha256: of the camera model that it was tracked with, if given.
    """

    place: str
    pose: Rigid[Camera, Marker]
    covariance: npt.NDArray[np.float64] | None = None
    marker: str | None = None
    side_mm: float | None = None
    time_s: float | None = None
    calibration_sha256: str | None = None


def unreadable(place: str, what: str) -> InvalidInput:
    """Return the error for a file, or a line of it, without a valid pose."""
    return InvalidInput("POSES_UNREADABLE", f"{place}: {what}", FORMATS_REMEDY, {"place": place})


def at_place(place: str, error: InvalidInput) -> InvalidInput:
    """Return the error with its place added."""
    return InvalidInput(
        error.code, f"{place}: {error.message}", error.remedy, {**error.context, "place": place}
    )
