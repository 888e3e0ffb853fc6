"""Notes about the camera that do not prevent navigation."""

import math
from dataclasses import dataclass

from server.texts.language import Text, number_text, text_of
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


_TIMES = text_of(lambda language: number_text(math.sqrt(VARIANCE_FACTOR), language))

PREDICTED_VIDEO = CameraNote(
    code="VIDEO_PREDICTED",
    message={
        "en": f"The video codec predicts images from earlier ones (as H.264 does): all stated errors are "
        f"{_TIMES['en']} times as large.",
        "de": f"Der Videocodec sagt Bilder aus früheren voraus (wie H.264): alle Fehlerangaben sind "
        f"{_TIMES['de']}-mal so groß.",
    },
    remedy={
        "en": "Set the camera to MJPEG, or to uncompressed images.",
        "de": "Die Kamera auf MJPEG oder unkomprimierte Bilder stellen.",
    },
)
