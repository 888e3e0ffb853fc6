"""A camera that gives the same image again and again: frozen, or a card that has no signal.

A capture card repeats its last image, or a test picture, when the camera is unplugged; its times are
current, so video and numbers would look live. After a quarter of a second repeated images are dropped, and
the checks for a silent camera apply; after two seconds the source is opened again (`SOURCE_FROZEN`). Files,
folders and rehearsals may repeat. A stream compressed so strongly that a still scene repeats exactly counts
as silent.
"""

from server.capture.shot import Shot
from tracker.pipeline import is_same_image


class SameImage:
    """For how long a source has given one image. No two of a camera's sensor are equal in each pixel."""

    def __init__(self) -> None:
        self._first: Shot | None = None

    def for_s(self, shot: Shot) -> float:
        """Since when this image has been given, in seconds; 0 of a new one. To be told of every image."""
        first = self._first
        if first is not None and is_same_image(first.image, shot.image):
            return shot.captured_at_s - first.captured_at_s
        self._first = shot
        return 0.0
