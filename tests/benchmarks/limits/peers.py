"""Reference detectors for comparison: OpenCV's ArUco and AprilTag."""

import atexit
import contextlib
from collections.abc import Sequence
from functools import cache
from typing import Protocol

import cv2
import numpy as np
import numpy.typing as npt

from tests.benchmarks.limits.evaluation import Claim
from tests.benchmarks.scenes.faces import Face, dictionary_face
from tests.benchmarks.scenes.rigs import Rig
from tests.benchmarks.scenes.scene import Pose
from tracker.geometry import Array, Rigid

Image = npt.NDArray[np.uint8]
NUMBER = 7
APRILTAG_ABSENT = "not installed"
# Which of AprilTag's corners are the top-left, top-right, bottom-right, bottom-left ones of the tag as
# OpenCV prints it.
APRILTAG_CORNERS = [1, 0, 3, 2]


class Peer(Protocol):
    """A reference detector with its own marker."""

    name: str
    face: Face

    def search(self, rig: Rig, image: Image) -> Claim | None:
        """Where its marker is in an image."""

    def detect(self, image: Image) -> None:
        """All its work on an image short of the pose, to be timed."""


class Aruco:
    """`cv2.aruco`: defaults for timing, sub-pixel corner refinement for everything else."""

    name = "cv2.aruco"

    def __init__(self) -> None:
        self.face = dictionary_face("aruco", cv2.aruco.DICT_4X4_50, NUMBER, 4)
        known = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
        self._fast = cv2.aruco.ArucoDetector(known)
        self._fine = {}
        for is_small, window_px in ((True, 3), (False, 5)):
            parameters = cv2.aruco.DetectorParameters()
            parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
            parameters.cornerRefinementWinSize = window_px
            self._fine[is_small] = cv2.aruco.ArucoDetector(known, parameters)

    def detect(self, image: Image) -> None:
        """Detection with OpenCV's own defaults."""
        self._fast.detectMarkers(image)

    def search(self, rig: Rig, image: Image) -> Claim | None:
        """Corners refined in a window that suits the marker's size, then the better planar solution."""
        found, numbers, _ = self._fine[rig.is_small].detectMarkers(image)
        listed = [] if numbers is None else numbers.ravel().tolist()
        if NUMBER not in listed:
            return None
        return _claim(rig, self.face, np.asarray(found[listed.index(NUMBER)], np.float64).reshape(4, 2))


class Tag(Protocol):
    """A tag detected by AprilTag."""

    tag_id: int
    corners: npt.NDArray[np.float64]


class NativeDetector(Protocol):
    """The used part of `pupil_apriltags.Detector`."""

    tag_detector_ptr: object

    def detect(self, img: Image) -> Sequence[Tag]:
        """All tags in an image."""


class AprilTag:
    """AprilTag's own detector, at full resolution, on a tag36h11."""

    name = "AprilTag"

    def __init__(self) -> None:
        self.face = dictionary_face("tag36h11", cv2.aruco.DICT_APRILTAG_36h11, NUMBER, 6)
        self._detector = _one_detector()

    def detect(self, image: Image) -> None:
        """Detection."""
        self._detector.detect(image)

    def search(self, rig: Rig, image: Image) -> Claim | None:
        """Its corners count from the corner of the first pixel, and begin at another one than OpenCV's."""
        for found in self._detector.detect(image):
            if found.tag_id == NUMBER:
                return _claim(rig, self.face, np.asarray(found.corners, np.float64)[APRILTAG_CORNERS] - 0.5)
        return None


@cache
def _one_detector() -> NativeDetector:
    """Return a single detector for the whole run, because its destructor can crash the process."""
    from pupil_apriltags import Detector  # noqa: PLC0415, where it is not installed all else works

    detector: NativeDetector = Detector(families="tag36h11", nthreads=1, quad_decimate=1.0)
    atexit.register(_detach, detector)
    return detector


def _detach(detector: NativeDetector) -> None:
    """Drop the native detector without its destructor; the process ends anyway."""
    detector.tag_detector_ptr = None


def peers() -> list[Peer]:
    """Return all installed reference detectors."""
    found: list[Peer] = [Aruco()]
    with contextlib.suppress(ImportError):
        found.append(AprilTag())
    return found


def _claim(rig: Rig, face: Face, corners_px: Array) -> Claim | None:
    """Return the pose of four corners: of both planar solutions the one that OpenCV ranks first."""
    count, turns, moves, _ = cv2.solvePnPGeneric(
        face.corners_mm.reshape(4, 1, 3),
        corners_px.reshape(4, 1, 2),
        rig.matrix,
        np.array(rig.distortion),
        flags=cv2.SOLVEPNP_IPPE_SQUARE,
    )
    if not count or not np.isfinite(turns[0]).all():
        return None
    rotation = np.asarray(cv2.Rodrigues(turns[0])[0], dtype=np.float64)
    pose: Pose = Rigid(rotation=rotation, translation_mm=np.asarray(moves[0], np.float64).ravel())
    return Claim(pose=pose, corners_px=corners_px)
