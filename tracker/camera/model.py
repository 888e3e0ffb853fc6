"""Pinhole camera model with lens distortion."""

from collections.abc import Mapping
from dataclasses import InitVar, dataclass, field
from typing import cast

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera.lens import pack_lens
from tracker.camera.plausibility import implausibility_of, normalised_from_px
from tracker.errors import InvalidInput
from tracker.geometry import Array

DISTORTION_LENGTHS = (4, 5, 8, 12, 14)
# A pinhole camera with a field of view of 157 degrees; a shorter focal length has a wrong unit.
MIN_FOCAL_RATIO = 0.1
REMEDY = "Calibrate the camera again, or give OpenCV's K (3x3), distortion and image size."


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraModel:
    """Intrinsic parameters of a camera: projects points of the camera frame to pixels.

    Attributes:
        matrix: OpenCV's K (3, 3): focal lengths and principal point in px, no skew.
        distortion: OpenCV's coefficients, 4, 5, 8, 12 or 14 of them (k1 k2 p1 p2 k3 ...).
        size_wh_px: width and height of the images that it was calibrated on.
        lens: the same parameters packed for the compiled kernels, see `pack_lens`; derived.
        is_fit: whether the parameters are a fit to views, which may be implausible in corners without points.
            The calibration report warns of an implausible distortion; only a camera in use is rejected for
            it.

    Raises:
        InvalidInput: CAMERA_MODEL_INVALID, with the number that cannot be.
    """

    matrix: Array
    distortion: Array
    size_wh_px: tuple[int, int]
    lens: Array = field(init=False, repr=False, compare=False)
    is_fit: InitVar[bool] = False

    def __post_init__(self, is_fit: bool) -> None:
        matrix = np.array(self.matrix, dtype=np.float64)
        distortion = np.array(self.distortion, dtype=np.float64).ravel()
        if distortion.size == 0:
            distortion = np.zeros(5)
        malformed = _malformed(matrix, distortion, np.asarray(self.size_wh_px, dtype=np.float64).ravel())
        if malformed:
            raise _invalid(malformed, REMEDY)
        width, height = (int(v) for v in self.size_wh_px)
        lens = pack_lens(matrix, distortion)
        for one in (matrix, distortion, lens):
            one.setflags(write=False)
        object.__setattr__(self, "matrix", matrix)
        object.__setattr__(self, "distortion", distortion)
        object.__setattr__(self, "size_wh_px", (width, height))
        object.__setattr__(self, "lens", lens)
        if not is_fit:
            self.require_plausible()

    def require_plausible(self) -> None:
        """Raise if no lens can have these parameters; see `implausibility_of`.

        Raises:
            InvalidInput: CAMERA_MODEL_INVALID.
        """
        found = implausibility_of(self.matrix, self.distortion, self.size_wh_px)
        if found is not None:
            raise _invalid(found.message, found.remedy)

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle so that the arrays are read-only in another process too.

        For writable arrays the kernels would be compiled again, during tracking.
        """
        return _made, (self.matrix, self.distortion, self.size_wh_px)

    @classmethod
    def from_mapping(cls, values: Mapping[str, object]) -> "CameraModel":
        """Return the model from a camera file's `matrix`, `distortion`, `size_wh_px`; ignore other keys."""
        missing = [key for key in ("matrix", "distortion", "size_wh_px") if key not in values]
        if missing:
            raise InvalidInput(
                "CAMERA_FILE_INCOMPLETE",
                f"the camera file lacks {', '.join(missing)}",
                "A camera file has matrix (3 rows of 3), distortion (4, 5, 8, 12 or 14 numbers) "
                "and size_wh_px (width, height).",
                {"missing": missing, "keys": ", ".join(missing)},
            )
        try:
            matrix = np.asarray(values["matrix"], dtype=np.float64)
            distortion = np.asarray(values["distortion"], dtype=np.float64)
            # Not converted to integers, because 1920.5 px must be rejected and not truncated.
            width, height = np.asarray(values["size_wh_px"], dtype=np.float64).ravel().tolist()
            size_wh_px = cast("tuple[int, int]", (width, height))
        except (TypeError, ValueError, OverflowError) as error:
            raise InvalidInput(
                "CAMERA_FILE_INVALID",
                f"the camera file has a value that is no number: {error}",
                "A camera file has matrix (3 rows of 3), distortion (4, 5, 8, 12 or 14 numbers) "
                "and size_wh_px (width, height).",
                {"library_error": str(error)},
            ) from error
        return cls(matrix=matrix, distortion=distortion, size_wh_px=size_wh_px)

    def has_aspect_of(self, size_wh_px: tuple[int, int]) -> bool:
        """Return whether images of this size have exactly the calibrated ratio of width to height."""
        return self.size_wh_px[0] * size_wh_px[1] == self.size_wh_px[1] * size_wh_px[0]

    def scaled_to(self, size_wh_px: tuple[int, int]) -> "CameraModel":
        """Return the camera model for images of another size that show the same area of the sensor.

        Exact for pixels that are binned or split evenly: their edges coincide, so centres (integers here)
        move by half a pixel's difference. The distortion is unchanged: it applies to normalised coordinates.

        Raises:
            InvalidInput: CAMERA_ASPECT_DIFFERS, width and height would be scaled differently.
        """
        (width, height), (width_before, height_before) = size_wh_px, self.size_wh_px
        if not self.has_aspect_of(size_wh_px):
            raise InvalidInput(
                "CAMERA_ASPECT_DIFFERS",
                f"a camera of {width_before}x{height_before} px cannot be scaled to {width}x{height} px, "
                "which has another ratio of width to height",
                "Calibrate the camera at that size.",
                {"size_wh_px": [width, height], "calibrated_size_wh_px": [width_before, height_before]},
            )
        scale = width / width_before
        matrix = self.matrix.copy()
        matrix[:2] *= scale
        matrix[:2, 2] += (scale - 1.0) / 2.0
        return CameraModel(matrix=matrix, distortion=self.distortion, size_wh_px=size_wh_px)

    def px_from_camera(self, points_mm: npt.ArrayLike) -> Array:
        """Project points (n, 3) in mm of the camera frame, z > 0, to pixels (n, 2)."""
        points = np.asarray(points_mm, dtype=np.float64).reshape(-1, 1, 3)
        px, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), self.matrix, self.distortion)
        return np.asarray(px, dtype=np.float64).reshape(-1, 2)

    def normalised_from_px(self, px: npt.ArrayLike) -> Array:
        """Return undistorted normalised coordinates x/z, y/z (n, 2) of pixels (n, 2)."""
        return normalised_from_px(np.asarray(px, dtype=np.float64), self.matrix, self.distortion)


def _made(matrix: Array, distortion: Array, size_wh_px: tuple[int, int]) -> CameraModel:
    # Plausibility was checked when the model was created.
    return CameraModel(matrix=matrix, distortion=distortion, size_wh_px=size_wh_px, is_fit=True)


def _invalid(problem: str, remedy: str) -> InvalidInput:
    return InvalidInput(
        "CAMERA_MODEL_INVALID",
        f"the camera model cannot be used: {problem}",
        remedy,
        {"camera_problem": problem},
    )


def _malformed(matrix: Array, distortion: Array, size_wh_px: Array) -> str:
    """Return the defect of camera matrix, distortion or image size, or an empty string."""
    if matrix.shape != (3, 3):
        return f"its matrix has shape {matrix.shape}, needed (3, 3)"
    if distortion.size not in DISTORTION_LENGTHS:
        return f"it has {distortion.size} distortion coefficients, allowed {DISTORTION_LENGTHS}"
    if not (np.isfinite(matrix).all() and np.isfinite(distortion).all()):
        return "a number is not finite"
    if size_wh_px.size != 2 or not (np.isfinite(size_wh_px) & (size_wh_px == np.round(size_wh_px))).all():
        return f"its image size is {'x'.join(map(str, size_wh_px.tolist()))} px, needed two whole numbers"
    width, height = size_wh_px.tolist()
    if width < 16 or height < 16:
        return f"its image size is {width:.0f}x{height:.0f} px, at least 16x16"
    if matrix[0, 0] <= 0 or matrix[1, 1] <= 0:
        return f"its focal lengths are {matrix[0, 0]:g} and {matrix[1, 1]:g} px, needed above 0"
    if min(matrix[0, 0], matrix[1, 1]) < MIN_FOCAL_RATIO * max(width, height):
        return (
            f"its focal lengths are {matrix[0, 0]:g} and {matrix[1, 1]:g} px, needed at least "
            f"{MIN_FOCAL_RATIO * max(width, height):g} px for {width:.0f}x{height:.0f} px"
        )
    if abs(matrix[0, 1]) > 1e-9 or np.abs(matrix[2] - [0, 0, 1]).max() > 1e-9 or abs(matrix[1, 0]) > 1e-9:
        return "its matrix is not [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]"
    return ""
