"""Detect camera motion from patches of the static scene around the operating field.

Corner patches are stored at the registration and tracked in later images (Lucas-Kanade). Hands and
instruments occlude some and illumination changes all; only a motion common to most visible patches counts.
"""

from dataclasses import dataclass
from enum import StrEnum

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Picture = npt.NDArray[np.uint8]

MAX_SIDE_PX = 480
MAX_PATCHES = 48
HALF_PATCH_PX = 7
WINDOW = (15, 15)
# Patches with a lower correlation are occluded or changed.
MIN_PATCH_CORRELATION = 0.7
# Inlier limits of the similarity transform of a camera motion: in pixels, and as a ratio of the displacement,
# because of parallax.
FIT_TOLERANCE_PX = 0.6
PARALLAX_RATIO = 0.2
MIN_PATCHES = 6


class SceneState(StrEnum):
    """Camera motion according to the static scene."""

    STILL = "still"  # most patches have not moved
    MOVED = "moved"  # most visible patches moved by a common motion
    UNSURE = "unsure"  # too few patches are found: occluded, dark, or outside the image
    NO_TEXTURE = "no-texture"  # there were too few textured patches from the beginning


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneSettings:
    """Thresholds for camera motion.

    Attributes:
        max_px: in pixels of the full image; 0.7 milliradian for a usual lens; noise is a third of it.
        min_visible_ratio: with a smaller share of visible patches the state is unsure.
        confirm_images: number of consecutive checks that must show a motion.
    """

    max_px: float = 1.0
    min_visible_ratio: float = 0.3
    confirm_images: int = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneCheck:
    """Result of one check of the scene.

    Attributes:
        state: of the scene.
        moved_px: median displacement of the visible patches, in pixels of the full image.
        visible: number of patches found again.
        patches: number of all patches.
    """

    state: SceneState
    moved_px: float
    visible: int
    patches: int


class SceneMonitor:
    """Monitor the scene of one registration. Mutable: number of consecutive checks with motion.

    A check takes about a millisecond; two to five per second suffice.
    """

    def __init__(
        self, image: Picture, *, exclude_px: tuple[Array, ...] = (), settings: SceneSettings | None = None
    ) -> None:
        """Store the patches of a scene.

        Args:
            image: (h, w) grey, at the registration.
            exclude_px: outlines (n, 2) of moving regions: the drill with a margin.
            settings: thresholds.
        """
        self._settings = settings or SceneSettings()
        self._size = image.shape[:2]
        self._scale = min(1.0, MAX_SIDE_PX / max(self._size))
        self._picture = _normalised(image, self._scale)
        self._points = _corners(self._picture, [self._scale * outline for outline in exclude_px])
        self._moved = 0

    @property
    def max_px(self) -> float:
        """Minimum displacement that counts as motion."""
        return self._settings.max_px

    def check(self, image: Picture) -> SceneCheck:
        """Track the patches in a later grey image (h, w) of the same size."""
        count = len(self._points)
        if count < MIN_PATCHES:
            return self._result(SceneState.NO_TEXTURE, 0.0, 0)
        if image.shape[:2] != self._size:
            return self._result(SceneState.UNSURE, 0.0, 0)
        picture = _normalised(image, self._scale)
        found, visible = self._found(picture, self._points)
        if visible.sum() < 0.5 * count:
            # Test for a larger common shift by phase correlation.
            shift, _ = cv2.phaseCorrelate(self._picture.astype(np.float64), picture.astype(np.float64))
            far, far_in_sight = self._found(picture, self._points + np.array(shift, dtype=np.float32))
            if far_in_sight.sum() > visible.sum():
                found, visible = far, far_in_sight
        moved_px, inlier_ratio = self._motion(found[visible], self._points[visible])
        needed = max(MIN_PATCHES, self._settings.min_visible_ratio * count)
        if visible.sum() < needed or inlier_ratio < 0.5:
            return self._result(SceneState.UNSURE, moved_px, int(visible.sum()))
        state = SceneState.MOVED if moved_px > self._settings.max_px else SceneState.STILL
        return self._result(state, moved_px, int(visible.sum()))

    def _result(self, state: SceneState, moved_px: float, visible: int) -> SceneCheck:
        self._moved = self._moved + 1 if state is SceneState.MOVED else 0
        if state is SceneState.MOVED and self._moved < self._settings.confirm_images:
            state = SceneState.UNSURE
        return SceneCheck(state=state, moved_px=moved_px, visible=visible, patches=len(self._points))

    def _found(
        self, picture: Picture, guess: npt.NDArray[np.float32]
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.bool_]]:
        """Track the patches; return positions (n, 2), and which ones still correlate (n,)."""
        found, status, _ = cv2.calcOpticalFlowPyrLK(
            self._picture,
            picture,
            self._points[:, None],
            guess[:, None].copy(),
            winSize=WINDOW,
            maxLevel=2,
            flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
        )
        places = np.asarray(found[:, 0], dtype=np.float32)
        seen = status[:, 0] > 0
        for n in np.flatnonzero(seen):
            seen[n] = (
                _patch_correlation(self._picture, picture, self._points[n], places[n])
                >= MIN_PATCH_CORRELATION
            )
        return places, seen

    def _motion(
        self, found: npt.NDArray[np.float32], retained: npt.NDArray[np.float32]
    ) -> tuple[float, float]:
        """Return the median displacement in full-image pixels, and the share of inlier patches."""
        if len(found) < MIN_PATCHES:
            return 0.0, 0.0
        far_px = float(np.median(np.linalg.norm(found - retained, axis=1)))
        within_px = FIT_TOLERANCE_PX + PARALLAX_RATIO * far_px
        fitted, _ = cv2.estimateAffinePartial2D(retained, found, ransacReprojThreshold=within_px)
        if fitted is None or not np.isfinite(fitted).all():
            return 0.0, 0.0
        expected = retained @ fitted[:, :2].T + fitted[:, 2]
        is_inlier = np.linalg.norm(expected - found, axis=1) < within_px
        moved = np.linalg.norm(expected - retained, axis=1)[is_inlier]
        return (float(np.median(moved)) / self._scale if is_inlier.any() else 0.0), float(is_inlier.mean())


def _normalised(image: Picture, scale: float) -> Picture:
    """Return a small image normalised by its local mean, to remove illumination."""
    small = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    wide = cv2.blur(small, (31, 31))
    # A ratio, because illumination is multiplicative; clipped in dark areas, where it is noise.
    return np.asarray(cv2.divide(small, np.maximum(wide, 8), scale=110.0), dtype=np.uint8)


def _corners(picture: Picture, leave_out: list[Array]) -> npt.NDArray[np.float32]:
    mask = np.full(picture.shape, 255, np.uint8)
    edge = HALF_PATCH_PX + 1
    mask[:edge], mask[-edge:], mask[:, :edge], mask[:, -edge:] = 0, 0, 0, 0
    for outline in leave_out:
        cv2.fillPoly(mask, [np.rint(outline).astype(np.int32)], 0)
    found = cv2.goodFeaturesToTrack(picture, MAX_PATCHES, 0.02, 12.0, mask=mask, blockSize=5)
    return np.empty((0, 2), np.float32) if found is None else found[:, 0].astype(np.float32)


def _patch_correlation(before: Picture, now: Picture, retained: Array, found: Array) -> float:
    """Return the normalised cross-correlation of a patch, -1 to 1; -1 if it left the image."""
    size = (2 * HALF_PATCH_PX + 1, 2 * HALF_PATCH_PX + 1)
    height, width = now.shape
    inside = (
        HALF_PATCH_PX <= found[0] < width - HALF_PATCH_PX
        and HALF_PATCH_PX <= found[1] < height - HALF_PATCH_PX
    )
    if not inside:
        return -1.0
    one = cv2.getRectSubPix(before, size, (float(retained[0]), float(retained[1])))
    other = cv2.getRectSubPix(now, size, (float(found[0]), float(found[1])))
    return float(cv2.matchTemplate(one, other, cv2.TM_CCOEFF_NORMED)[0, 0])
