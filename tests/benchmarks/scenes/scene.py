"""Image formation of a scene with markers of exactly known pose.

Reflectance of the background, the printed boards and a finger, exactly integrated over quarters of a
pixel; averaged over the shutter's time; blurred by the lens; integrated over the pixel; lit; then shot noise,
read noise, the camera's answer, 8 bits and JPEG.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import cv2
import numpy as np
import numpy.typing as npt

from tests.benchmarks.scenes.area import coverage_image
from tests.benchmarks.scenes.clutter import Floats, clutter
from tests.benchmarks.scenes.conditions import Condition
from tests.benchmarks.scenes.faces import Face
from tests.benchmarks.scenes.finger import Finger
from tests.benchmarks.scenes.illumination import Illumination
from tests.benchmarks.scenes.rigs import Rig
from tracker.geometry import Array, Camera, Marker, Rigid

# Cells a side in each pixel; with 4 the blur of an edge is true to a thousandth of its contrast.
FINE = 4
BLACK, WHITE = 0.07, 0.84
FULL_SCALE = 255.0
# Straight lines that a lens bends are cut to this part of a side.
BENT_PIECE_RATIO = 0.05

Pose = Rigid[Camera, Marker]


@dataclass(frozen=True, slots=True, kw_only=True)
class Window:
    """A part of the image: first pixel and size."""

    left: int
    top: int
    size_wh: tuple[int, int]

    def grown(self, by_px: int) -> "Window":
        """Return the window with a margin on each side."""
        width, height = self.size_wh
        return Window(
            left=self.left - by_px, top=self.top - by_px, size_wh=(width + 2 * by_px, height + 2 * by_px)
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Board:
    """A printed marker with its poses spread evenly over the exposure."""

    face: Face
    poses: tuple[Pose, ...]

    @property
    def pose(self) -> Pose:
        """Return the pose at the middle of the exposure: the ground truth."""
        return self.poses[len(self.poses) // 2]


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """All parameters of an image.

    Attributes:
        rig, condition: by what camera, and how hard.
        boards: what is to be found; none in an image without markers.
        illumination, finger: drawn for the condition.
        background_seed: of the clutter; None for an even grey that is as bright as paper.
        noise_seed: of the noise.
    """

    rig: Rig
    condition: Condition
    boards: tuple[Board, ...]
    illumination: Illumination
    finger: Finger | None
    background_seed: int | None
    noise_seed: tuple[int, ...]

    @property
    def board(self) -> Board:
        """Return the first marker."""
        return self.boards[0]

    @property
    def pose(self) -> Pose:
        """Return the pose of the first marker."""
        return self.board.pose

    @property
    def corners_px(self) -> Array:
        """Return the first marker's corners in the image (4, 2)."""
        return self.rig.px_of(self.pose, self.board.face.corners_mm)

    @property
    def side_px(self) -> float:
        """Return the width of the first marker as seen from the front."""
        far = float(np.linalg.norm(self.pose.translation_mm))
        return self.rig.focal_px * self.board.face.side_mm / far

    def moved(self, by: Callable[[Pose], Pose]) -> "Scene":
        """Return the scene with the first marker's pose changed throughout the exposure."""
        board = replace(self.board, poses=tuple(map(by, self.board.poses)))
        return replace(self, boards=(board, *self.boards[1:]))


def image_of(scene: Scene) -> npt.NDArray[np.uint8]:
    """Return the image (h, w) of a scene; deterministic."""
    return recorded(mean_of(scene), scene)


def recorded(mean: Floats, scene: Scene) -> npt.NDArray[np.uint8]:
    """Return the recorded 8-bit image of mean grey levels (h, w): noise, response curve, quantisation."""
    condition = scene.condition
    noise = np.random.default_rng(list(scene.noise_seed)).standard_normal(mean.shape, dtype=np.float32)
    variance = condition.read_noise_grey**2 + np.clip(mean, 0.0, FULL_SCALE) * _shot(condition)
    grey = mean + np.sqrt(variance, dtype=np.float32) * noise
    if condition.gamma != 1.0:
        grey = FULL_SCALE * (np.clip(grey, 0.0, FULL_SCALE) / FULL_SCALE) ** np.float32(1.0 / condition.gamma)
    image: npt.NDArray[np.uint8] = np.clip(np.rint(grey), 0.0, FULL_SCALE).astype(np.uint8)
    if condition.jpeg_quality:
        _, packed = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, condition.jpeg_quality])
        image = np.asarray(cv2.imdecode(packed, cv2.IMREAD_GRAYSCALE), dtype=np.uint8)
    return image


def noise_variance_grey2(mean: npt.NDArray[np.floating], condition: Condition) -> Array:
    """Return the noise variance at these mean grey levels, including quantisation."""
    shot = np.clip(np.asarray(mean, dtype=np.float64), 0.0, FULL_SCALE) * _shot(condition)
    return condition.read_noise_grey**2 + shot + 1.0 / 12.0


def _shot(condition: Condition) -> np.float32:
    return np.float32(FULL_SCALE / condition.full_well_electrons)


def mean_of(scene: Scene) -> Floats:
    """Return the whole image (h, w) before noise, in linear grey levels."""
    whole = Window(left=0, top=0, size_wh=scene.rig.size_wh_px)
    background = _background(scene, whole)
    finger = scene.finger
    if finger is not None:
        share = finger.share(0.0, 0.0, whole.size_wh).astype(np.float32)
        background = background + share * (finger.shade(0.0, 0.0, whole.size_wh) - background)
    kernel = _pixel_kernel(scene.condition.blur_px)
    blurred = cv2.sepFilter2D(background, cv2.CV_32F, kernel, kernel, borderType=cv2.BORDER_REPLICATE)
    seen = np.asarray(blurred, dtype=np.float32)
    for number in range(len(scene.boards)):
        window = window_of(scene, number)
        width, height = window.size_wh
        part = seen[window.top : window.top + height, window.left : window.left + width]
        part[:] = _reflectance(scene, window)
    return _exposed(scene, seen, whole)


def window_mean_of(scene: Scene, window: Window) -> Array:
    """Return the same for a window inside the image (h, w); it must not touch the image border."""
    return np.asarray(_exposed(scene, _reflectance(scene, window), window), dtype=np.float64)


def window_of(scene: Scene, number: int = 0) -> Window:
    """Return the part of the image that one of the boards can reach, with its blur."""
    board, margin = scene.boards[number], _reach_px(scene.condition.blur_px) + 1
    seen = np.concatenate([scene.rig.px_of(pose, board.face.outlines_mm[0]) for pose in board.poses])
    width, height = scene.rig.size_wh_px
    left, top = np.maximum(np.floor(seen.min(axis=0)).astype(int) - margin, 0).tolist()
    right, bottom = np.minimum(np.ceil(seen.max(axis=0)).astype(int) + margin + 1, [width, height]).tolist()
    return Window(left=left, top=top, size_wh=(max(right - left, 1), max(bottom - top, 1)))


def _exposed(scene: Scene, reflectance: Floats, window: Window) -> Floats:
    lit = scene.illumination.on(reflectance, window.left, window.top)
    return np.asarray(lit * np.float32(FULL_SCALE * scene.condition.illumination_ratio), dtype=np.float32)


def _background(scene: Scene, window: Window) -> Floats:
    """Return the reflectance of the background; the border is replicated."""
    width, height = window.size_wh
    if scene.background_seed is None:
        return np.full((height, width), WHITE, np.float32)
    whole = clutter(scene.rig.size_wh_px, scene.background_seed)
    rows = np.clip(np.arange(window.top, window.top + height), 0, whole.shape[0] - 1)
    columns = np.clip(np.arange(window.left, window.left + width), 0, whole.shape[1] - 1)
    return whole[rows[:, None], columns[None, :]]


def _reflectance(scene: Scene, window: Window) -> Floats:
    """Return the reflectance of boards, finger and background in a window (h, w), before lens blur."""
    margin = _reach_px(scene.condition.blur_px)
    wide = window.grown(margin)
    size = (wide.size_wh[0] * FINE, wide.size_wh[1] * FINE)
    fine = _background(scene, wide).repeat(FINE, axis=0).repeat(FINE, axis=1).astype(np.float64)
    for board in scene.boards:
        paper, ink = _board_layers(scene.rig, board, wide, size)
        fine = fine * (1.0 - paper) + ink
    if scene.finger is not None:
        share = scene.finger.share(wide.left, wide.top, size, FINE)
        fine += share * (scene.finger.shade(wide.left, wide.top, size, FINE) - fine)
    kernel = _fine_kernel(scene.condition.blur_px)
    blurred = cv2.sepFilter2D(fine, cv2.CV_64F, kernel, kernel, borderType=cv2.BORDER_REPLICATE)
    pixels = blurred.reshape(wide.size_wh[1], FINE, wide.size_wh[0], FINE).mean(axis=(1, 3))
    return np.asarray(pixels[margin:-margin, margin:-margin], dtype=np.float32)


def _board_layers(rig: Rig, board: Board, wide: Window, size: tuple[int, int]) -> tuple[Array, Array]:
    """Return board coverage of each cell and its reflectance, averaged over the exposure."""
    outlines = [_cut(outline, rig, board.face) for outline in board.face.outlines_mm]
    ends = np.cumsum([len(outline) for outline in outlines])[:-1]
    seen: list[Array] = []
    for pose in board.poses:
        points = (rig.px_of(pose, np.concatenate(outlines)) - [wide.left, wide.top]) * FINE + (FINE - 1) / 2
        seen += np.split(points, ends)
    share = 1.0 / len(board.poses)
    weights = [share * weight for weight in board.face.weights(BLACK, WHITE)] * len(board.poses)
    paper = coverage_image(seen[:: len(outlines)], [share] * len(board.poses), size)
    return paper, coverage_image(seen, weights, size)


def _cut(outline: Array, rig: Rig, face: Face) -> Array:
    """Return the outline, subdivided along its straight edges if the lens has distortion."""
    if not rig.is_bent:
        return outline
    ends = np.roll(outline, -1, axis=0)
    pieces = []
    for a, b in zip(outline, ends, strict=True):
        count = max(1, int(np.ceil(np.linalg.norm(b - a) / (BENT_PIECE_RATIO * face.side_mm))))
        pieces.append(a + np.arange(count)[:, None] / count * (b - a))
    return np.concatenate(pieces)


def _reach_px(blur_px: float) -> int:
    return int(np.ceil(5.0 * blur_px)) + 1


@cache
def _fine_kernel(blur_px: float) -> Array:
    """Return the lens blur on cells of a quarter pixel."""
    reach = _reach_px(blur_px) * FINE - 1
    at = np.arange(-reach, reach + 1) / (FINE * blur_px)
    kernel = np.exp(-0.5 * at * at)
    return np.asarray(kernel / kernel.sum(), dtype=np.float64)


@cache
def _pixel_kernel(blur_px: float) -> Array:
    """Return the same blur for whole pixels: exactly equal on images that are constant per pixel."""
    reach = _reach_px(blur_px)
    impulse = np.zeros(2 * reach + 1)
    impulse[reach] = 1.0
    fine = np.convolve(impulse.repeat(FINE), _fine_kernel(blur_px), mode="same")
    return np.asarray(fine.reshape(-1, FINE).mean(axis=1), dtype=np.float64)
