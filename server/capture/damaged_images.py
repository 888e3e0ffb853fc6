"""Damaged images of a live source: skipped, counted and reported; if all are damaged, the source is reopened.

A single damaged image is no reason to reopen a camera, which costs a second or two without numbers.
"""

from server.errors import CaptureError

# Below capture.STALLED_AFTER_S, so that this reason is reported instead of that of a silent source.
MAX_DAMAGED_S = 1.5
# Images are counted over this time, so that the sentence does not change with each image.
COUNTED_OVER_S = 10.0


class DamagedImages:
    """Counts the intact and damaged images of a source, by their times.

    Args:
        name: Name of the source.

    Attributes:
        were_all: Once no image was intact from an opening of the source to its end: some cameras write
            invalid JPEGs, on any port.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self.were_all = False
        self.restart()

    def restart(self) -> None:
        """Reset after the source was opened."""
        self._problem: CaptureError | None = None
        self._is_intact_seen = False
        self._intact_at_s: float | None = None
        self._damaged_in_a_row = 0
        self._began_s: float | None = None
        self._images = 0
        self._damaged = 0
        self._reason = ""

    @property
    def problem(self) -> CaptureError | None:
        """The damaged images of the last seconds; None without one."""
        return self._problem

    def add_intact(self, at_s: float) -> None:
        """Count an intact image."""
        self._is_intact_seen = True
        self._intact_at_s = at_s
        self._damaged_in_a_row = 0
        self._count(at_s)

    def add_damaged(self, reason: str, at_s: float) -> None:
        """Count a damaged image.

        Raises:
            CaptureError: IMAGES_DAMAGED: no image has been intact for so long that the source is reopened.
        """
        if self._intact_at_s is None:
            self._intact_at_s = at_s
        self._damaged_in_a_row += 1
        self._damaged += 1
        self._reason = reason
        row_s = at_s - self._intact_at_s
        if row_s > MAX_DAMAGED_S:
            self.were_all = self.were_all or not self._is_intact_seen
            raise self._error(self._damaged_in_a_row, self._damaged_in_a_row, row_s)
        self._count(at_s)
        if self._problem is None:
            self._problem = self._error(self._damaged, self._images, at_s - (self._began_s or at_s))

    def _count(self, at_s: float) -> None:
        if self._began_s is None:
            self._began_s = at_s
        self._images += 1
        if at_s - self._began_s >= COUNTED_OVER_S:
            duration_s = at_s - self._began_s
            self._problem = self._error(self._damaged, self._images, duration_s) if self._damaged else None
            self._began_s, self._images, self._damaged = at_s, 0, 0

    def _error(self, damaged: int, images: int, duration_s: float) -> CaptureError:
        return CaptureError(
            "IMAGES_DAMAGED",
            f"damaged and not used: {damaged} of {images} images of {self._name} within {duration_s:.1f} s "
            f"({self._reason})",
            "Use a short cable and a USB port without a hub, or a wired network instead of Wi-Fi, and a "
            "smaller image or lower rate. If all images are damaged on any port, the camera writes invalid "
            "JPEGs: take a size for which coaxial cameras lists YUYV.",
            {
                "source": self._name,
                "damaged_images": damaged,
                "images": images,
                "duration_s": duration_s,
                "library_error": self._reason,
            },
        )
