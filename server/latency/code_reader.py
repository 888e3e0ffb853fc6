"""Detection of the code in an image of a screen."""

import cv2
import numpy as np
import numpy.typing as npt

from server.latency.codes import DICTIONARY

# Large enough for a code that fills a twentieth of the width; a full-HD image costs no more than a small one.
MAX_WIDTH_PX = 640
# Relative to the image's larger side: a smaller code is on another page, or in the displayed video.
MIN_PERIMETER_RATIO = 0.2
# About half a cell of a code that fills the image.
THRESHOLD_WINDOW_PX = 23


class CodeReader:
    """Reads the largest code in an image. For one thread.

    Bits are not corrected, because an image exposed during a change shows a mixture of two codes, which a
    correction could turn into a third one.
    """

    def __init__(self) -> None:
        settings = cv2.aruco.DetectorParameters()
        settings.minMarkerPerimeterRate = MIN_PERIMETER_RATIO
        settings.errorCorrectionRate = 0.0
        settings.adaptiveThreshWinSizeMin = THRESHOLD_WINDOW_PX
        settings.adaptiveThreshWinSizeMax = THRESHOLD_WINDOW_PX
        dictionary = cv2.aruco.getPredefinedDictionary(DICTIONARY)
        self._detector = cv2.aruco.ArucoDetector(dictionary, settings)

    def read(self, image: npt.NDArray[np.uint8]) -> int | None:
        """Return the number of the code in an (h, w, 3) BGR image; None if none is read."""
        height, width = image.shape[:2]
        if width > MAX_WIDTH_PX:
            size = (MAX_WIDTH_PX, max(1, round(height * MAX_WIDTH_PX / width)))
            image = np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA), np.uint8)
        corners, ids, _ = self._detector.detectMarkers(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY))
        if ids is None or len(ids) == 0:
            return None
        areas = [cv2.contourArea(one) for one in corners]
        return int(np.ravel(ids)[int(np.argmax(areas))])
