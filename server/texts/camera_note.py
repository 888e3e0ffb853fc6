"""Notes about the camera that do not prevent navigation."""

import math
from dataclasses import dataclass

from server.number_format import format_number
from server.texts.language import Text
from tracker.pose.predicted_video import VARIANCE_FACTOR


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraNote:
    """A note about the camera that does not prevent navigation.

    Attributes:
        code: Identifier of the note.
        message: The finding, with numbers.
        remedy: What to do.
    """

    code: str
    message: Text
    remedy: Text


_TIMES = format_number(math.sqrt(VARIANCE_FACTOR), decimals=1)

PREDICTED_VIDEO = CameraNote(
    code="VIDEO_PREDICTED",
    message={
        "en": f"The video predicts its images (as H.264): all stated errors are {_TIMES} times as large.",
        "de": f"Das Video sagt Bilder voraus (wie H.264): alle Fehlerangaben sind {_TIMES}-mal so groß.",
    },
    remedy={
        "en": "Set the camera to MJPEG, or to uncompressed images.",
        "de": "Kamera auf MJPEG oder unkomprimierte Bilder stellen.",
    },
)
