"""Renders flat markers with known truth: each pixel is the mean of many rays through the lens."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
import numpy.typing as npt

from tracker import CameraModel, MarkerModel, Seen, Sighting
from tracker.geometry import Array, Camera, Marker, Rigid, rotation_from_vector
from tracker.pose import FoundBy

Image8 = npt.NDArray[np.uint8]

BLACK, WHITE = 30.0, 215.0
RAYS = 6  # a side, in each pixel
RAYS_FROM_CORNERS = np.array(
    [
        [(1.0 - b) * (1.0 - a), (1.0 - b) * a, b * (1.0 - a), b * a]
        for b in (np.arange(RAYS) + 0.5) / RAYS
        for a in (np.arange(RAYS) + 0.5) / RAYS
    ]
)
QUIET_RATIO = 0.2
SIDE_MM = 25.0

# A 3x3 code in the middle half of the square; white is 1. It has no rotational symmetry.
CODE = ((1, 1, 0), (0, 0, 1), (1, 0, 0))
OTHER = ((0, 1, 1), (1, 0, 0), (1, 0, 1))
Fields = tuple[tuple[int, ...], ...]
# The codes that differ from it in one field.
NEIGHBOURS: list[Fields] = [
    tuple(tuple(v ^ (3 * r + c == k) for c, v in enumerate(row)) for r, row in enumerate(CODE))
    for k in range(9)
]
LENS = (-0.16, 0.04, 0.0004, -0.0003, 0.0)
STRAIGHT = (0.0, 0.0, 0.0, 0.0, 0.0)


def camera_of(
    size_wh_px: tuple[int, int] = (640, 480),
    *,
    focal_px: float = 700.0,
    distortion: Sequence[float] = LENS,
) -> CameraModel:
    """A camera with its principal point slightly off-centre."""
    width, height = size_wh_px
    matrix = [[focal_px, 0.0, width / 2 + 3.3], [0.0, focal_px * 1.002, height / 2 - 2.7], [0.0, 0.0, 1.0]]
    return CameraModel(matrix=np.array(matrix), distortion=np.array(distortion), size_wh_px=size_wh_px)


def code_image(fields: Sequence[Sequence[int]] = CODE, *, field_px: int = 20) -> Image8:
    """A black square with these fields, white 1, in its middle half."""
    count = len(fields)
    cells = np.kron(np.array(fields, dtype=np.uint8) * 255, np.ones((field_px, field_px), np.uint8))
    border = count * field_px // 2
    return np.pad(cells, border)


def code_model(
    fields: Sequence[Sequence[int]] = CODE, *, name: str = "code", side_mm: float = SIDE_MM
) -> MarkerModel:
    """The marker with these fields; cached, because it takes a third of a second."""
    return _code_model(tuple(map(tuple, fields)), name, side_mm)


@cache
def _code_model(fields: Fields, name: str, side_mm: float) -> MarkerModel:
    return MarkerModel.from_image(code_image(fields), side_mm=side_mm, name=name)


def facing(
    at_mm: Sequence[float], *, tilt_deg: float = 0.0, about_deg: float = 0.0, roll_deg: float = 0.0
) -> Rigid[Camera, Marker]:
    """A marker that looks at the camera, tilted about a line of the image plane, rolled in its own plane."""
    about, tilt, roll = np.radians([about_deg, tilt_deg, roll_deg])
    tilted = rotation_from_vector(np.array([np.cos(about), np.sin(about), 0.0]) * tilt)
    rolled = rotation_from_vector([0.0, 0.0, roll])
    return Rigid(
        rotation=tilted @ np.diag([1.0, -1.0, -1.0]) @ rolled, translation_mm=np.array(at_mm, dtype=float)
    )


def facing_at_px(
    camera: CameraModel,
    centre_px: Sequence[float],
    side_px: float,
    *,
    tilt_deg: float = 0.0,
    about_deg: float = 0.0,
    roll_deg: float = 0.0,
) -> Rigid[Camera, Marker]:
    """The same with its centre at a given pixel, about `side_px` wide."""
    depth_mm = SIDE_MM * float(camera.matrix[0, 0]) / side_px
    x, y = camera.normalised_from_px([centre_px])[0]
    return facing(
        [x * depth_mm, y * depth_mm, depth_mm], tilt_deg=tilt_deg, about_deg=about_deg, roll_deg=roll_deg
    )


@dataclass(frozen=True, kw_only=True)
class Print:
    """One printed square in the scene."""

    picture: Image8
    pose: Rigid[Camera, Marker]
    side_mm: float = SIDE_MM
    quiet_ratio: float = QUIET_RATIO


def corners_px_of(camera: CameraModel, pose: Rigid[Camera, Marker], side_mm: float = SIDE_MM) -> Array:
    """Image positions of the four corners: top-left, top-right, bottom-right, bottom-left."""
    square = np.array([[-0.5, 0.5, 0], [0.5, 0.5, 0], [0.5, -0.5, 0], [-0.5, -0.5, 0]]) * side_mm
    return camera.px_from_camera(pose.move_points(square))


def rendered(
    camera: CameraModel,
    prints: Sequence[Print],
    *,
    background: npt.NDArray[np.float64] | float = 170.0,
    blur_px: float = 0.6,
    noise_grey: float = 1.5,
    seed: int = 0,
) -> Image8:
    """The grey image (h, w) of these prints: exact area samples, then blur, then the sensor's noise."""
    width, height = camera.size_wh_px
    picture = np.broadcast_to(np.asarray(background, dtype=np.float64), (height, width)).copy()
    for one in prints:
        _draw(picture, camera, one)
    if blur_px > 0.0:
        picture = np.asarray(cv2.GaussianBlur(picture, (0, 0), blur_px), dtype=np.float64)
    picture = picture + np.random.default_rng([seed, 77]).normal(0.0, 1.0, picture.shape) * noise_grey
    return np.asarray(np.clip(np.rint(picture), 0, 255), dtype=np.uint8)


def _draw(picture: npt.NDArray[np.float64], camera: CameraModel, one: Print) -> None:
    paper = corners_px_of(camera, one.pose, one.side_mm * (1.0 + 2.0 * one.quiet_ratio))
    height, width = picture.shape
    left, top = np.maximum(np.floor(paper.min(axis=0)).astype(int) - 3, 0)
    right, bottom = np.minimum(np.ceil(paper.max(axis=0)).astype(int) + 4, [width, height])
    if right <= left or bottom <= top:
        return
    forms = _plane_forms(camera, one, left, top, right, bottom)
    grey, is_even = _even_grey(one, forms)
    part = picture[top:bottom, left:right]
    part[is_even] = np.where(np.isnan(grey), part, grey)[is_even]
    x, y, denominator = (RAYS_FROM_CORNERS @ one_form[:, ~is_even] for one_form in forms)
    x, y = x / denominator, y / denominator
    rows, columns = one.picture.shape
    ink = one.picture[
        np.clip(np.floor((0.5 - y) * rows), 0, rows - 1).astype(int),
        np.clip(np.floor((x + 0.5) * columns), 0, columns - 1).astype(int),
    ]
    far = np.maximum(np.abs(x), np.abs(y))
    on_paper = far <= 0.5 + one.quiet_ratio
    seen = np.where(far <= 0.5, BLACK + (WHITE - BLACK) / 255.0 * ink, WHITE)
    part[~is_even] = np.where(on_paper, seen, part[~is_even]).mean(axis=0)


def _plane_forms(camera: CameraModel, one: Print, left: int, top: int, right: int, bottom: int) -> Array:
    """Numerators of x and y on the print, in sides, and their denominator (3, 4, h, w), at corners of pixels.

    They are linear in the direction of a ray. The lens is evaluated at the corners; within a pixel it is
    linear to a millionth of a pixel.

    """
    u, v = np.meshgrid(np.arange(left, right + 1) - 0.5, np.arange(top, bottom + 1) - 0.5)
    rays = camera.normalised_from_px(np.stack([u, v], axis=-1).reshape(-1, 2)).T.reshape(2, *u.shape)
    right_of, up_of, normal = (
        axis[0] * rays[0] + axis[1] * rays[1] + axis[2] for axis in one.pose.rotation.T
    )
    offset = one.pose.rotation.T @ one.pose.translation_mm / one.side_mm
    forms = np.stack(
        [offset[2] * right_of - offset[0] * normal, offset[2] * up_of - offset[1] * normal, normal]
    )
    return np.stack([forms[:, :-1, :-1], forms[:, :-1, 1:], forms[:, 1:, :-1], forms[:, 1:, 1:]], axis=1)


def _even_grey(one: Print, forms: Array) -> tuple[Array, npt.NDArray[np.bool_]]:
    """The grey (h, w) of pixels on ink or paper of one grey, NaN beside the paper, and which pixels are such.

    A pixel shows a part of the rectangle that spans its corners.

    """
    x, y = forms[:2] / forms[2]
    (x_low, x_high), (y_low, y_high) = ((at.min(axis=0), at.max(axis=0)) for at in (x, y))
    rows, columns = one.picture.shape
    first, last = np.floor((x_low + 0.5) * columns), np.floor((x_high + 0.5) * columns)
    upper, lower = np.floor((0.5 - y_high) * rows), np.floor((0.5 - y_low) * rows)
    in_square = (first >= 0) & (last < columns) & (upper >= 0) & (lower < rows)
    i, k = (np.clip(at, 0, columns - 1).astype(int) for at in (first, last))
    j, m = (np.clip(at, 0, rows - 1).astype(int) for at in (upper, lower))
    sums = cv2.integral(one.picture)
    total = sums[m + 1, k + 1] - sums[j, k + 1] - sums[m + 1, i] + sums[j, i]
    is_white = in_square & (total == 255 * (m + 1 - j) * (k + 1 - i))
    is_black = in_square & (total == 0)
    edge = 0.5 + one.quiet_ratio
    is_beside_square = (x_low > 0.5) | (x_high < -0.5) | (y_low > 0.5) | (y_high < -0.5)
    is_on_paper = (x_low >= -edge) & (x_high <= edge) & (y_low >= -edge) & (y_high <= edge)
    is_margin = is_beside_square & is_on_paper
    is_beside_paper = (x_low > edge) | (x_high < -edge) | (y_low > edge) | (y_high < -edge)
    grey = np.where(is_black, BLACK, np.where(is_white | is_margin, WHITE, np.nan))
    return grey, is_black | is_white | is_margin | is_beside_paper


def cluttered(camera: CameraModel, seed: int, *, count: int = 40) -> npt.NDArray[np.float64]:
    """A background of dark and bright quadrilaterals, bars and discs, none of them a marker."""
    random = np.random.default_rng([seed, 5])
    width, height = camera.size_wh_px
    picture = np.full((height, width), 150.0, dtype=np.float64)
    for _ in range(count):
        centre = random.uniform([0, 0], [width, height])
        angle, size = random.uniform(0, 2 * np.pi), random.uniform(10, 60, 2)
        box = cv2.boxPoints((tuple(centre), tuple(size), float(np.degrees(angle))))
        grey = float(random.uniform(20, 235))
        if random.uniform() < 0.25:
            cv2.circle(picture, (int(centre[0]), int(centre[1])), int(size[0] / 2), grey, -1, cv2.LINE_AA)
        else:
            cv2.fillConvexPoly(picture, np.rint(box).astype(np.int32), grey, cv2.LINE_AA)
    return picture


def in_clutter(
    camera: CameraModel,
    pose: Rigid[Camera, Marker],
    *,
    clutter: int = 0,
    blur_px: float = 0.6,
    noise_grey: float = 1.5,
    seed: int = 0,
) -> tuple[Image8, Array]:
    """The image (h, w) of one code in clutter, and its corners (4, 2)."""
    image = rendered(
        camera,
        [Print(picture=code_image(), pose=pose)],
        background=cluttered(camera, clutter),
        blur_px=blur_px,
        noise_grey=noise_grey,
        seed=seed,
    )
    return image, corners_px_of(camera, pose)


def motion_blurred(image: Image8, way_px: float, from_deg: float) -> Image8:
    """The image with motion of this many pixels during the exposure."""
    height, width = image.shape
    reach = 0.5 * way_px * np.array([np.cos(np.radians(from_deg)), np.sin(np.radians(from_deg))])
    shifts = [np.array([[1, 0, s * reach[0]], [0, 1, s * reach[1]]]) for s in np.linspace(-1, 1, 21)]
    moved = [cv2.warpAffine(image.astype(np.float64), shift, (width, height)) for shift in shifts]
    return np.asarray(np.rint(np.mean(moved, axis=0)), dtype=np.uint8)


def poorly_lit(
    plain: Image8, middle_px: tuple[float, float], side_px: float, random: np.random.Generator
) -> Image8:
    """Half the light, a shadow's edge across a square, a highlight, motion blur of 3 px, and noise."""
    height, width = plain.shape
    ways = random.uniform(0.0, 360.0, 3)
    v, u = np.mgrid[0:height, 0:width].astype(np.float64) - np.array(middle_px)[::-1, None, None]
    across = u * np.cos(ways[0]) + v * np.sin(ways[0]) - random.uniform(-0.2, 0.2) * side_px
    lit = motion_blurred(plain, 3.0, ways[2]) * (1.0 - 0.6 / (1.0 + np.exp(-across / (0.12 * side_px))))
    x, y = u - 0.3 * side_px * np.cos(ways[1]), v - 0.3 * side_px * np.sin(ways[1])
    lit = lit + 160.0 * np.exp(-0.5 * (x * x + y * y) / (0.25 * side_px) ** 2)
    noisy = 0.4 * lit + random.normal(0.0, 5.0, lit.shape)
    return np.asarray(np.clip(np.rint(noisy), 0, 255), dtype=np.uint8)


def perfectly_seen(
    pose: Rigid[Camera, Marker],
    *,
    covariance: Array | None = None,
    corners_px: Array | None = None,
    found_by: FoundBy = "track",
) -> Seen:
    """A sighting with this pose and all edges found; very certain by default."""
    return Seen(
        camera_from_marker=pose,
        pose_covariance=1e-6 * np.eye(6) if covariance is None else covariance,
        corners_px=np.zeros((4, 2)) if corners_px is None else corners_px,
        score_ratio=1.0,
        target_score_ratio=1.0,
        model_coverage_ratio=1.0,
        target_coverage_ratio=1.0,
        fit_error_px2=0.0,
        found_by=found_by,
    )


def seen(sighting: Sighting) -> Seen:
    """The sighting; fails if there is none."""
    assert isinstance(sighting, Seen), sighting
    return sighting
