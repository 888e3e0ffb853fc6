"""Select views of a moving board for a camera calibration, and report unmet requirements."""

from dataclasses import dataclass
from enum import StrEnum
from math import floor, hypot, log

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

CELLS_WH = (6, 4)
# Typical lens; used only for tilts and the similarity of views, which tolerate the error.
NOMINAL_FOCAL_BY_WIDTH = 1.2
# Differences at which two views count as different: in position, tilt and size.
APART_BY_WIDTH, APART_TILT_DEG, APART_LOG_SIZE = 0.15, 8.0, 0.2
# Maximum time between two images that are compared for motion.
STILL_WITHIN_S = 2.5
MIN_POINTS = 6


class ViewVerdict(StrEnum):
    """Whether a view of the board was accepted, or the reason why not."""

    TAKEN = "taken"
    TOO_FEW_POINTS = "too_few_points"  # too little of the board is seen
    FIRST_SIGHT = "first_sight"  # no earlier image to measure the motion against
    MOVING = "moving"  # motion blur
    NOTHING_NEW = "nothing_new"  # similar to an accepted view


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardCollectorSettings:
    """Acceptance limits of views, and the required amounts.

    Attributes:
        max_speed_px_s: maximum speed of the board's points in an image of 1280 px width; scaled with the
            width.
        max_moved_px: maximum motion between two images.
        min_views: required number of views.
        min_coverage_ratio: required share of the image covered by the board.
        min_tilt_deg: required tilt to every side.
    """

    max_speed_px_s: float = 25.0
    max_moved_px: float = 4.0
    min_views: int = 12
    min_coverage_ratio: float = 0.75
    min_tilt_deg: float = 20.0


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardCollectorProgress:
    """Progress of a board collection.

    Attributes:
        views: number of accepted views.
        covered: (rows, columns) bool, the parts of the image covered by the board.
        tilt_deg: minimum and maximum tilt about the horizontal axis (positive: upper edge away from the
            camera), then about the vertical axis (positive: left edge away); zeros before the first view.
        missing: instructions; empty when the requirements are met.
    """

    views: int
    covered: npt.NDArray[np.bool_]
    tilt_deg: tuple[float, float, float, float]
    missing: tuple[str, ...]

    @property
    def coverage_ratio(self) -> float:
        """Return the share of the image covered by the board."""
        return float(self.covered.mean())


@dataclass(frozen=True, slots=True, kw_only=True)
class _View:
    """Features by which views are compared."""

    centre_px: Array
    tilt_deg: tuple[float, float]
    log_size: float
    cells: npt.NDArray[np.bool_]


class BoardCollector:
    """Accepts or rejects views of a board for a calibration. Mutable.

    Args:
        size_wh_px: of the images.
        settings: acceptance limits and required amounts.
    """

    def __init__(self, size_wh_px: tuple[int, int], settings: BoardCollectorSettings | None = None) -> None:
        self.size_wh_px = size_wh_px
        self.settings = settings or BoardCollectorSettings()
        self._taken: list[_View] = []
        self._before: tuple[float, dict[int, Array]] | None = None

    def offer(
        self,
        *,
        ids: npt.NDArray[np.int64],
        object_points_mm: Array,
        image_points_px: Array,
        captured_at_s: float,
    ) -> ViewVerdict:
        """Accept a view if it is sharp and new; return the verdict.

        Args:
            ids: (n,) which points of the board were seen.
            object_points_mm: (n, 3), on the board.
            image_points_px: (n, 2).
            captured_at_s: monotonic time of the image.
        """
        if len(ids) < MIN_POINTS:
            return ViewVerdict.TOO_FEW_POINTS
        moved = self._moved(ids, image_points_px, captured_at_s)
        if moved is None:
            return ViewVerdict.FIRST_SIGHT
        moved_px, since_s = moved
        wider = max(1.0, self.size_wh_px[0] / 1280.0)
        # Two images far apart in time do not determine the speed, so the board must not have moved.
        if moved_px > wider * min(self.settings.max_speed_px_s * since_s, self.settings.max_moved_px):
            return ViewVerdict.MOVING
        view = self._view(object_points_mm, image_points_px)
        if not self._new(view):
            return ViewVerdict.NOTHING_NEW
        self._taken.append(view)
        return ViewVerdict.TAKEN

    def add(self, object_points_mm: Array, image_points_px: Array) -> None:
        """Add a view without a test: points (n, 3) of the board and (n, 2) px."""
        self._taken.append(self._view(object_points_mm, image_points_px))

    def reset_motion(self) -> None:
        """Discard the last image, because the board was not seen."""
        self._before = None

    @property
    def progress(self) -> BoardCollectorProgress:
        """Return the progress and the unmet requirements."""
        covered = self._covered()
        tilts = np.array([view.tilt_deg for view in self._taken]).reshape(-1, 2)
        min_tilt = tilts.min(axis=0) if len(tilts) else np.zeros(2)
        max_tilt = tilts.max(axis=0) if len(tilts) else np.zeros(2)
        return BoardCollectorProgress(
            views=len(self._taken),
            covered=covered,
            tilt_deg=(float(min_tilt[0]), float(max_tilt[0]), float(min_tilt[1]), float(max_tilt[1])),
            missing=tuple(self._missing(covered, min_tilt, max_tilt)),
        )

    def _moved(
        self, ids: npt.NDArray[np.int64], image_points_px: Array, captured_at_s: float
    ) -> tuple[float, float] | None:
        """Return the motion of the points since the last image [px] and its time [s]; None without one."""
        now = {int(point): px for point, px in zip(ids, image_points_px, strict=True)}
        before, self._before = self._before, (captured_at_s, now)
        if before is None or not 0.0 < captured_at_s - before[0] <= STILL_WITHIN_S:
            return None
        moved_px = [hypot(*(px - before[1][point])) for point, px in now.items() if point in before[1]]
        if len(moved_px) < MIN_POINTS:
            return None
        # A high quantile, because a board that is tilted in place moves only at its border.
        return float(np.quantile(moved_px, 0.9)), captured_at_s - before[0]

    def _view(self, object_points_mm: Array, image_points_px: Array) -> _View:
        width, height = self.size_wh_px
        spread = np.linalg.eigvalsh(np.cov(image_points_px.T))
        columns, rows = CELLS_WH
        cells = np.zeros((rows, columns), dtype=np.bool_)
        column = np.clip((image_points_px[:, 0] * columns / width).astype(int), 0, columns - 1)
        row = np.clip((image_points_px[:, 1] * rows / height).astype(int), 0, rows - 1)
        cells[row, column] = True
        return _View(
            centre_px=np.asarray(image_points_px.mean(axis=0)),
            tilt_deg=self._tilt_deg(object_points_mm, image_points_px),
            log_size=0.25 * log(max(float(spread[0] * spread[1]), 1e-9)),
            cells=cells,
        )

    def _tilt_deg(self, object_points_mm: Array, image_points_px: Array) -> tuple[float, float]:
        """Return the tilts (upper edge away, left edge away) of the board for a typical lens."""
        width, height = self.size_wh_px
        focal = NOMINAL_FOCAL_BY_WIDTH * width
        matrix = np.array([[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1.0]])
        found, rotation_vector, _ = cv2.solvePnP(
            object_points_mm, image_points_px, matrix, np.zeros(5), flags=cv2.SOLVEPNP_IPPE
        )
        if not found:
            return 0.0, 0.0
        normal = cv2.Rodrigues(rotation_vector)[0][:, 2]
        normal = normal * np.sign(normal[2] or 1.0)
        lean, turned = np.degrees(np.arcsin(np.clip(normal[[1, 0]], -1.0, 1.0)))
        return float(lean), float(turned)

    def _new(self, view: _View) -> bool:
        if (view.cells & ~self._covered()).sum() >= 2:
            return True
        width = self.size_wh_px[0]
        return all(
            hypot(
                hypot(*(view.centre_px - one.centre_px)) / (APART_BY_WIDTH * width),
                hypot(view.tilt_deg[0] - one.tilt_deg[0], view.tilt_deg[1] - one.tilt_deg[1])
                / APART_TILT_DEG,
                (view.log_size - one.log_size) / APART_LOG_SIZE,
            )
            > 1.0
            for one in self._taken
        )

    def _covered(self) -> npt.NDArray[np.bool_]:
        columns, rows = CELLS_WH
        covered = np.zeros((rows, columns), dtype=np.bool_)
        for view in self._taken:
            covered |= view.cells
        return covered

    def _missing(self, covered: npt.NDArray[np.bool_], min_tilt: Array, max_tilt: Array) -> list[str]:
        wanted = self.settings
        missing = []
        open_corners = [
            name
            for name, seen in (
                ("top left", covered[0, 0]),
                ("top right", covered[0, -1]),
                ("bottom left", covered[-1, 0]),
                ("bottom right", covered[-1, -1]),
            )
            if not seen
        ]
        if open_corners:
            missing.append(f"Hold the board into the {', '.join(open_corners)} of the image.")
        elif covered.mean() < wanted.min_coverage_ratio:
            missing.append(
                f"The board was in {covered.mean():.0%} of the image, needed "
                f"{wanted.min_coverage_ratio:.0%}: move it along the rim."
            )
        ways = (
            ("its upper edge away from you", max_tilt[0]),
            ("its upper edge towards you", -min_tilt[0]),
            ("its left edge away from you", max_tilt[1]),
            ("its right edge away from you", -min_tilt[1]),
        )
        missing += [
            f"Tilt the board by {wanted.min_tilt_deg:g} degrees or more, {way} "
            f"({floor(max(float(reached), 0.0))} so far)."
            for way, reached in ways
            if reached < wanted.min_tilt_deg
        ]
        if not missing and len(self._taken) < wanted.min_views:
            missing.append(
                f"{len(self._taken)} of {wanted.min_views} views: hold it still in more places and tilts."
            )
        return missing
