"""Plausibility of camera parameters: field of view, pixel aspect ratio, and effect of the distortion.

Distortion coefficients are tested by their effect on the image, because their values alone mean little: k3 =
1000 has no effect in a telephoto lens and folds the image of a wide-angle one. Every limit is beyond the
lenses on the market; parameters outside have a wrong unit, are read from the wrong line of a file, or are a
diverged fit.
"""

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

# Between opposite corners. Stereo microscopes at their largest zoom and 3000 mm (35 mm equivalent) lenses see
# 0.8 deg; below, perspective is smaller than the noise of a corner, and the focal length is not observable.
MIN_FIELD_DEG = 0.5
# From the optical axis to a corner. Action cameras see up to 150 deg between corners, rectilinear lenses 135.
# At 80 deg, 1 deg is a tenth of the coordinate x/z: fisheye lenses need another model.
MAX_AXIS_ANGLE_DEG = 80.0
# Pixels of television on a wide screen are 16/11 = 1.45 times as wide as high (PAL), 4/3 in HDV, 1.09 in PAL;
# 2 is one field of interlaced video, or an image squeezed to half its width.
MAX_PIXEL_ASPECT_RATIO = 1.5
# Pixels per radian, over those at the axis of a lens without distortion: in the mean up to the border, and
# anywhere. The strongest compression that lenses are built with (orthographic fisheye) has 0.74 and 0.26 at
# 75 deg. Polynomials fitted to real views have 0.04 in corners that no view reached; 0 is a fold.
MIN_MEAN_SCALE_RATIO, MIN_SCALE_RATIO = 0.2, 0.02
# Local image scale over that of the same lens without distortion. The strongest pincushion of eyepieces and
# converters reaches 1.5, polynomials 2.1 in corners that no view reached.
MAX_STRETCH_RATIO = 5.0
# Of the sensor (tau_x, tau_y): Scheimpflug mounts tilt by 10 to 20 deg, those for laser lines by 30 deg.
MAX_TILT_RAD = np.pi / 4

# Usual lenses reach the tolerance in 5 to 20 iterations, the corners of 150 degrees in some hundred. Where it
# takes more in one pixel, it may diverge in the next.
UNDISTORT_TOLERANCE_PX, MAX_ITERATIONS, MAX_ITERATIONS_OF_CHECK = 1e-10, 1000, 500
# Of a pixel undistorted and distorted again. The iteration ends early where the image is nearly folded.
MAX_ROUND_TRIP_PX = 0.1
# Per side of the image; from the axis at most; from the axis to the border of the image; of a grid's side.
BORDER_POINTS, COARSE_STEPS, FINE_STEPS, GRID_POINTS = 6, 240, 60, 25
ASPECT_REMEDY = (
    "Check fx and fy. Pixels that are far from square come from one field of interlaced video or a squeezed "
    "image: use images of full width and height, and calibrate on them."
)
PRINCIPAL_POINT_REMEDY = (
    "Check cx and cy, and that they belong to this image size; a region of the sensor must contain the axis."
)
FIELD_REMEDY = (
    "Check that the focal lengths are in pixels of images of this size, not in mm, or calibrate again."
)
DISTORTION_REMEDY = (
    "Check the order k1 k2 p1 p2 k3 ... and that the coefficients belong to this matrix and image size, or "
    "calibrate again with views of the board up to the corners of the image."
)


@dataclass(frozen=True, slots=True)
class Implausibility:
    """An implausible property: message with numbers (without full stop), and remedy."""

    message: str
    remedy: str


def implausibility_of(matrix: Array, distortion: Array, size_wh_px: tuple[int, int]) -> Implausibility | None:
    """Return the implausible property of K (3, 3) and OpenCV's coefficients; None if they are plausible.

    A plausible camera maps directions one to one onto its image: the distortion has a positive
    Jacobian determinant in the connected set of directions around the axis that the image shows.
    """
    coefficients = tuple(distortion.ravel().tolist())
    return _implausibility_of(tuple(matrix.ravel().tolist()), coefficients, size_wh_px)


# It takes about 10 ms, and the camera of a case is read at each request for the procedure's state.
@lru_cache(maxsize=32)
def _implausibility_of(
    numbers: tuple[float, ...], coefficients: tuple[float, ...], size_wh_px: tuple[int, int]
) -> Implausibility | None:
    matrix, distortion = np.array(numbers).reshape(3, 3), np.array(coefficients)
    focal, middle = matrix[[0, 1], [0, 1]], matrix[:2, 2]
    size = np.array(size_wh_px, dtype=np.float64)
    width, height = size_wh_px
    away = float(np.abs((middle + 0.5) / size - 0.5).max())
    if away > 0.5:
        return Implausibility(
            f"its principal point is ({middle[0]:g}, {middle[1]:g}) px, {away:.1f} image sizes from the "
            f"middle of {width}x{height} px, outside of the image",
            PRINCIPAL_POINT_REMEDY,
        )
    aspect = float(focal.max() / focal.min())
    if aspect > MAX_PIXEL_ASPECT_RATIO:
        return Implausibility(
            f"its focal lengths are {focal[0]:g} and {focal[1]:g} px, a ratio of {aspect:.3g}, allowed "
            f"{MAX_PIXEL_ASPECT_RATIO:g}",
            ASPECT_REMEDY,
        )
    field_deg = float(np.degrees(2.0 * np.arctan(np.linalg.norm(size / focal) / 2.0)))
    if field_deg < MIN_FIELD_DEG:
        return Implausibility(
            f"with focal lengths of {focal[0]:g} and {focal[1]:g} px an image of {width}x{height} px shows "
            f"{field_deg:.2g} deg between opposite corners, needed {MIN_FIELD_DEG:g} deg",
            FIELD_REMEDY,
        )
    tilt_rad = float(np.abs(distortion[12:]).max(initial=0.0))
    if tilt_rad > MAX_TILT_RAD:
        return Implausibility(
            f"its sensor tilts by {np.degrees(tilt_rad):.3g} deg, allowed {np.degrees(MAX_TILT_RAD):g} deg",
            DISTORTION_REMEDY,
        )
    border = (_border_px(size) - middle) / focal
    with np.errstate(all="ignore"):
        return _fault_of_distortion(matrix, distortion, size, border) or _fault_of_inverse(
            matrix, distortion, size
        )


def normalised_from_px(
    px: Array, matrix: Array, distortion: Array, *, max_iterations: int = MAX_ITERATIONS
) -> Array:
    """Return undistorted normalised coordinates x/z, y/z (n, 2) of pixels (n, 2), by OpenCV's iteration."""
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, max_iterations, UNDISTORT_TOLERANCE_PX)
    out = cv2.undistortPoints(px.reshape(-1, 1, 2), matrix, distortion, criteria=criteria)
    return np.asarray(out, dtype=np.float64).reshape(-1, 2)


def _fault_of_distortion(
    matrix: Array, distortion: Array, size: Array, border: Array
) -> Implausibility | None:
    """Return the fault of the distortion along directions from the axis to the border of the image."""
    azimuths = np.arctan2(border[:, 1], border[:, 0])
    ends = np.linalg.norm(border, axis=1) / MIN_MEAN_SCALE_RATIO
    ends = np.minimum(ends, np.radians(MAX_AXIS_ANGLE_DEG))
    angles = np.linspace(0.0, 1.0, COARSE_STEPS + 1) * ends[:, None]
    is_outside = ~_is_inside(_projected(angles, azimuths, matrix, distortion)[0], size)
    leaves = is_outside.any(axis=1)
    ends = np.where(leaves, angles[np.arange(len(ends)), is_outside.argmax(axis=1)], ends)
    angles = np.linspace(0.0, 1.0, FINE_STEPS + 1) * ends[:, None]
    px, jacobian = _projected(angles, azimuths, matrix, distortion)
    is_seen = np.logical_and.accumulate(_is_inside(px, size), axis=1)
    # The first step beyond the border counts too, because the border lies before it.
    is_seen[:, 1:] |= is_seen[:, :-1].copy()
    determinant, scale, stretch = _local_scales(jacobian, angles, azimuths)
    is_sound = (determinant > 0.0) & (scale >= MIN_SCALE_RATIO) & (stretch <= MAX_STRETCH_RATIO)
    is_faulty = is_seen & ~is_sound
    if is_faulty.any():
        step = int(is_faulty.any(axis=0).argmax())
        at = int(is_faulty[:, step].argmax()), step
        if not determinant[at] > 0.0:
            what = "folds the image"
        elif not scale[at] >= MIN_SCALE_RATIO:
            what = f"leaves {scale[at]:.2g} of the scale at its axis, needed {MIN_SCALE_RATIO:g}"
        else:
            what = f"stretches the image {stretch[at]:.3g} times, allowed {MAX_STRETCH_RATIO:g}"
        where = f"at {np.degrees(angles[at]):.3g} deg from its axis, inside of the image"
        return Implausibility(f"its distortion {what}, {where}", DISTORTION_REMEDY)
    if not leaves.all():
        angle_deg = np.degrees(angles[~leaves][0, -1])
        u, v = px[~leaves][0, -1]
        return Implausibility(
            f"it sees farther than {angle_deg:.3g} deg from its axis, where this image should end: that is "
            f"({u:.0f}, {v:.0f}) px, inside of {size[0]:g}x{size[1]:g} px",
            FIELD_REMEDY,
        )
    return None


def _fault_of_inverse(matrix: Array, distortion: Array, size: Array) -> Implausibility | None:
    """Return the fault if pixels undistorted and distorted again differ: the iteration may diverge."""
    u, v = np.meshgrid(*(np.linspace(-0.5, side - 0.5, GRID_POINTS) for side in size))
    px = np.column_stack([u.ravel(), v.ravel()])
    seen = normalised_from_px(px, matrix, distortion, max_iterations=MAX_ITERATIONS_OF_CHECK)
    points = np.column_stack([seen, np.ones(len(px))])
    again, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), matrix, distortion)
    off_px = np.nan_to_num(np.linalg.norm(again.reshape(-1, 2) - px, axis=1), nan=np.inf)
    at = int(off_px.argmax())
    if off_px[at] <= MAX_ROUND_TRIP_PX:
        return None
    return Implausibility(
        f"its distortion cannot be removed at ({px[at, 0]:.0f}, {px[at, 1]:.0f}) px: removed and "
        f"applied again it leaves {off_px[at]:.2g} px, allowed {MAX_ROUND_TRIP_PX:g} px",
        DISTORTION_REMEDY,
    )


def _border_px(size: Array) -> Array:
    """Return points (n, 2) on the outer edge of the image, its corners among them."""
    along = np.linspace(0.0, 1.0, BORDER_POINTS + 1)[:-1]
    start, end = np.zeros_like(along), np.ones_like(along)
    u = np.concatenate([along, end, 1.0 - along, start])
    v = np.concatenate([start, along, end, 1.0 - along])
    return np.column_stack([u, v]) * size - 0.5


def _is_inside(px: Array, size: Array) -> npt.NDArray[np.bool_]:
    return np.asarray(((px >= -0.5) & (px <= size - 0.5)).all(axis=-1))


def _projected(angles: Array, azimuths: Array, matrix: Array, distortion: Array) -> tuple[Array, Array]:
    """Return pixels (m, n, 2) of directions, and the Jacobian (m, n, 2, 2) of x', y' by x, y.

    Args:
        angles: (m, n) from the optical axis, in rad.
        azimuths: (m,) about the axis, in rad.
        matrix: K (3, 3).
        distortion: OpenCV's coefficients.
    """
    tangents = np.tan(angles)
    x, y = tangents * np.cos(azimuths)[:, None], tangents * np.sin(azimuths)[:, None]
    points = np.stack([x, y, np.ones_like(x)], axis=-1).reshape(-1, 1, 3)
    bent, derivative = cv2.projectPoints(points, np.zeros(3), np.zeros(3), np.eye(3), distortion)
    # Columns 3 and 4 are the derivatives by a translation along x and y, which at z = 1 are those by x, y.
    jacobian = derivative[:, 3:5].reshape(*angles.shape, 2, 2)
    px = bent.reshape(*angles.shape, 2) * matrix[[0, 1], [0, 1]] + matrix[:2, 2]
    return np.asarray(px, dtype=float), np.asarray(jacobian, dtype=float)


def _local_scales(jacobian: Array, angles: Array, azimuths: Array) -> tuple[Array, Array, Array]:
    """Return determinant, minimum scale by angle, and maximum scale by x, y (each m, n) of Jacobians.

    The scale by angle is that of the image over steps of the direction on the unit sphere: 1 at the axis.
    """
    determinant, _, stretch = _singular_values(jacobian)
    cos, sin = np.cos(azimuths), np.sin(azimuths)
    radial = np.stack([cos, sin], axis=-1)[:, None, :] / np.cos(angles)[..., None] ** 2
    tangential = np.stack([-sin, cos], axis=-1)[:, None, :] / np.cos(angles)[..., None]
    _, scale, _ = _singular_values(jacobian @ np.stack([radial, tangential], axis=-1))
    return determinant, scale, stretch


def _singular_values(matrices: Array) -> tuple[Array, Array, Array]:
    """Return determinant, smaller and larger singular value of matrices (..., 2, 2); NaN stays NaN."""
    determinant = matrices[..., 0, 0] * matrices[..., 1, 1] - matrices[..., 0, 1] * matrices[..., 1, 0]
    squares = (matrices**2).sum(axis=(-2, -1))
    total = np.sqrt(squares + 2.0 * np.abs(determinant))
    apart = np.sqrt(np.maximum(squares - 2.0 * np.abs(determinant), 0.0))
    return determinant, (total - apart) / 2.0, (total + apart) / 2.0
