"""Detection of a camera that repeats one image: a frozen camera, or a capture card without a signal.

A capture card repeats its last image, or a test picture, when the camera is unplugged; its timestamps are
current, so video and numbers would look live. After a quarter of a second repeated images are dropped, and
the checks for a silent camera apply; after two seconds the source is reopened (`SOURCE_FROZEN`). Files,
folders and rehearsals may repeat, and so may the blank image of an external tracker, whose poses are compared
in `pose_frames`. A stream compressed so strongly that a static scene repeats exactly counts as silent.
"""

from server.capture.shot import Shot
from tracker.pipeline import is_same_image


class FrozenImageDetector:
    """Measures for how long a source has repeated one image. Sensor noise makes any two images differ."""

    def __init__(self) -> None:
        self._first: Shot | None = None

    def repeated_for_s(self, shot: Shot) -> float:
        """Return for how many seconds this image has repeated, 0 for a new one; call it for each image."""
        if shot.poses is not None:
            return 0.0
        first = self._first
        if first is not None and is_same_image(first.image, shot.image):
            return shot.captured_at_s - first.captured_at_s
        self._first = shot
        return 0.0
