"""Whether the camera was moved, by what does not move: patches of the scene around the field of work.

Patches with corners are kept at the registration. Later each is looked for again; hands and instruments hide
some, light changes all, and only what a camera's motion explains (most of those in sight, all alike) counts.
"""

from dataclasses import dataclass
from enum import StrEnum

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Picture = npt.NDArray[np.uint8]

LOOKED_AT_PX = 480
MAX_PATCHES = 48
HALF_PATCH_PX = 7
WINDOW = (15, 15)
# Patches that correlate less are hidden, or not what they were.
MIN_ALIKE = 0.7
# Of a camera's motion: patches move as a shift, a turn and a scale have it, within this, and within this part
# of how far they move: what is nearer to a camera that is shifted moves more.
SPREAD_PX = 0.6
PARALLAX_RATIO = 0.2
MIN_PATCHES = 6


class SceneState(StrEnum):
    """What the fixed scene says of the camera."""

    STILL = "still"  # most patches are where they were
    MOVED = "moved"  # most patches in sight moved, and all alike
    UNSURE = "unsure"  # too few are in sight: covered, dark, or the camera looks elsewhere
    NO_TEXTURE = "no-texture"  # there was too little to hold on to from the beginning


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneSettings:
    """What counts as moved.

    Attributes:
        max_px: in pixels of the whole image; 0.7 milliradian for a usual lens; noise is a third.
        min_in_sight_ratio: with fewer of its patches in sight, the scene says nothing.
        confirmed_by: so many checks in a row must say "moved".
    """

    max_px: float = 1.0
    min_in_sight_ratio: float = 0.3
    confirmed_by: int = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneCheck:
    """What one look at the scene gave.

    Attributes:
        state: what it means.
        moved_px: median motion of the patches in sight, in pixels of the whole image.
        in_sight: how many patches were found again.
        patches: how many there are.
    """

    state: SceneState
    moved_px: float
    in_sight: int
    patches: int


class SceneWatch:
    """Watches the scene of one registration. Mutable: how often in a row it was found moved.

    About a millisecond a check: twice to five times a second is often enough.
    """

    def __init__(
        self, image: Picture, *, leave_out_px: tuple[Array, ...] = (), settings: SceneSettings | None = None
    ) -> None:
        """Keep the patches of a scene.

        Args:
            image: (h, w) grey, at the registration.
            leave_out_px: outlines (n, 2) within which nothing is fixed: the drill, with room around it.
            settings: what counts as moved.
        """
        self._settings = settings or SceneSettings()
        self._size = image.shape[:2]
        self._scale = min(1.0, LOOKED_AT_PX / max(self._size))
        self._picture = _evened(image, self._scale)
        self._points = _corners(self._picture, [self._scale * outline for outline in leave_out_px])
        self._moved = 0

    @property
    def max_px(self) -> float:
        """From which motion on it counts as moved."""
        return self._settings.max_px

    def check(self, image: Picture) -> SceneCheck:
        """Look for the patches in a later image (h, w) grey of the same size."""
        count = len(self._points)
        if count < MIN_PATCHES:
            return self._told(SceneState.NO_TEXTURE, 0.0, 0)
        if image.shape[:2] != self._size:
            return self._told(SceneState.UNSURE, 0.0, 0)
        picture = _evened(image, self._scale)
        found, in_sight = self._found(picture, self._points)
        if in_sight.sum() < 0.5 * count:
            # Further than patches are followed: shifted as a whole?
            shift, _ = cv2.phaseCorrelate(self._picture.astype(np.float64), picture.astype(np.float64))
            far, far_in_sight = self._found(picture, self._points + np.array(shift, dtype=np.float32))
            if far_in_sight.sum() > in_sight.sum():
                found, in_sight = far, far_in_sight
        moved_px, alike = self._motion(found[in_sight], self._points[in_sight])
        needed = max(MIN_PATCHES, self._settings.min_in_sight_ratio * count)
        if in_sight.sum() < needed or alike < 0.5:
            return self._told(SceneState.UNSURE, moved_px, int(in_sight.sum()))
        state = SceneState.MOVED if moved_px > self._settings.max_px else SceneState.STILL
        return self._told(state, moved_px, int(in_sight.sum()))

    def _told(self, state: SceneState, moved_px: float, in_sight: int) -> SceneCheck:
        self._moved = self._moved + 1 if state is SceneState.MOVED else 0
        if state is SceneState.MOVED and self._moved < self._settings.confirmed_by:
            state = SceneState.UNSURE
        return SceneCheck(state=state, moved_px=moved_px, in_sight=in_sight, patches=len(self._points))

    def _found(
        self, picture: Picture, guess: npt.NDArray[np.float32]
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.bool_]]:
        """Where the patches are now (n, 2), and which of them look as they did (n,)."""
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
            seen[n] = _alike(self._picture, picture, self._points[n], places[n]) >= MIN_ALIKE
        return places, seen

    def _motion(self, found: npt.NDArray[np.float32], kept: npt.NDArray[np.float32]) -> tuple[float, float]:
        """Median motion in pixels of the whole image, and the share of patches that move as one picture."""
        if len(found) < MIN_PATCHES:
            return 0.0, 0.0
        far_px = float(np.median(np.linalg.norm(found - kept, axis=1)))
        within_px = SPREAD_PX + PARALLAX_RATIO * far_px
        fitted, _ = cv2.estimateAffinePartial2D(kept, found, ransacReprojThreshold=within_px)
        if fitted is None or not np.isfinite(fitted).all():
            return 0.0, 0.0
        expected = kept @ fitted[:, :2].T + fitted[:, 2]
        alike = np.linalg.norm(expected - found, axis=1) < within_px
        moved = np.linalg.norm(expected - kept, axis=1)[alike]
        return (float(np.median(moved)) / self._scale if alike.any() else 0.0), float(alike.mean())


def _evened(image: Picture, scale: float) -> Picture:
    """Small, and without what light does: each place against its surroundings."""
    small = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    wide = cv2.blur(small, (31, 31))
    # The ratio, because a lamp multiplies; dark places are held back, where the ratio is noise.
    return np.asarray(cv2.divide(small, np.maximum(wide, 8), scale=110.0), dtype=np.uint8)


def _corners(picture: Picture, leave_out: list[Array]) -> npt.NDArray[np.float32]:
    mask = np.full(picture.shape, 255, np.uint8)
    edge = HALF_PATCH_PX + 1
    mask[:edge], mask[-edge:], mask[:, :edge], mask[:, -edge:] = 0, 0, 0, 0
    for outline in leave_out:
        cv2.fillPoly(mask, [np.rint(outline).astype(np.int32)], 0)
    found = cv2.goodFeaturesToTrack(picture, MAX_PATCHES, 0.02, 12.0, mask=mask, blockSize=5)
    return np.empty((0, 2), np.float32) if found is None else found[:, 0].astype(np.float32)


def _alike(before: Picture, now: Picture, kept: Array, found: Array) -> float:
    """How much a patch looks like it did, -1 to 1; -1 where it has left the picture."""
    size = (2 * HALF_PATCH_PX + 1, 2 * HALF_PATCH_PX + 1)
    height, width = now.shape
    inside = (
        HALF_PATCH_PX <= found[0] < width - HALF_PATCH_PX
        and HALF_PATCH_PX <= found[1] < height - HALF_PATCH_PX
    )
    if not inside:
        return -1.0
    one = cv2.getRectSubPix(before, size, (float(kept[0]), float(kept[1])))
    other = cv2.getRectSubPix(now, size, (float(found[0]), float(found[1])))
    return float(cv2.matchTemplate(one, other, cv2.TM_CCOEFF_NORMED)[0, 0])
