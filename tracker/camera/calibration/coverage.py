"""Image coverage of the calibration views, and warnings about what they determine poorly."""

from collections.abc import Sequence

import cv2
import numpy as np

from tracker.camera.calibration.report import (
    Coverage,
    ModelChoice,
    ParameterEstimate,
    ViewReport,
)
from tracker.errors import Remark
from tracker.geometry import Array

GRID = (8, 6)
FEW_VIEWS = 8
LITTLE_TILT_DEG = 15.0
ONE_DISTANCE_RATIO = 1.15
MIN_CORNER_REACH_RATIO = 0.7
MAX_FOCAL_SD_WARNING_RATIO, MAX_MIDDLE_SD_WARNING_RATIO = 0.01, 0.01
MANY_OUT_RATIO = 0.25
CORNERS = ("top left", "top right", "bottom right", "bottom left")
MORE_VIEWS = "Take 10 to 20 views; a few views determine the lens poorly."


def coverage_of(points_px: Array, size_wh_px: tuple[int, int]) -> Coverage:
    """Return the coverage of the image by the points (n, 2) of all views."""
    size = np.array(size_wh_px, dtype=np.float64)
    cells = np.clip((points_px / size * GRID).astype(int), 0, np.array(GRID) - 1)
    hull = cv2.convexHull(points_px.astype(np.float32))
    middle = (size - 1.0) / 2.0
    reach = []
    for corner in np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * middle:
        along = (points_px - middle) @ corner / float(corner @ corner)
        aside = np.abs((points_px - middle) @ np.array([-corner[1], corner[0]])) / float(corner @ corner)
        # Points within 30 degrees of the direction to a corner count for it.
        near = along[aside <= np.tan(np.pi / 6) * along]
        reach.append(float(np.clip(near.max(initial=0.0), 0.0, 1.0)))
    return Coverage(
        cells_ratio=len(np.unique(cells, axis=0)) / (GRID[0] * GRID[1]),
        hull_ratio=float(cv2.contourArea(hull) / (size[0] * size[1])),
        corner_reach_ratios=(reach[0], reach[1], reach[2], reach[3]),
    )


def warnings_of(
    views: Sequence[ViewReport],
    parameters: Sequence[ParameterEstimate],
    coverage: Coverage,
    choice: ModelChoice,
    size_wh_px: tuple[int, int],
) -> tuple[Remark, ...]:
    """Return warnings about what these views determine poorly."""
    used = [view for view in views if view.used]
    reported: list[Remark] = []
    if len(used) < FEW_VIEWS:
        reported.append(
            Remark(
                code="FEW_VIEWS",
                message=f"{len(used)} views are used, advised are {FEW_VIEWS} and more",
                remedy=MORE_VIEWS,
                context={"used": len(used), "advised": FEW_VIEWS},
            )
        )
    out = len(views) - len(used)
    if out > MANY_OUT_RATIO * len(views):
        reported.append(
            Remark(
                code="MANY_VIEWS_OUT",
                message=f"{out} of {len(views)} views are not used",
                remedy="Read the reasons: columns and rows of the board, blur, a bent board.",
                context={"out": out, "views": len(views)},
            )
        )
    widest = widest_tilt_deg(used)
    if widest < LITTLE_TILT_DEG:
        reported.append(
            Remark(
                code="LITTLE_TILT",
                message=f"the board's directions differ by {widest:.1f} deg at most, advised are "
                f"{LITTLE_TILT_DEG:g} deg",
                remedy="Add views with the board tilted by 20 to 45 deg: else focal length is mixed with "
                "distance.",
                context={"tilt_deg": widest, "advised_deg": LITTLE_TILT_DEG},
            )
        )
    distances = [view.distance_mm for view in used]
    if max(distances) < ONE_DISTANCE_RATIO * min(distances):
        reported.append(
            Remark(
                code="ONE_DISTANCE",
                message=f"the board is always {min(distances):.0f} to {max(distances):.0f} mm away",
                remedy="Add views from nearer and farther, over the distances at which you will work.",
                context={"min_mm": min(distances), "max_mm": max(distances)},
            )
        )
    reported += _uncovered(coverage)
    reported += _unsure(parameters, size_wh_px)
    if not choice.held_out_rms_px:
        reported.append(
            Remark(
                code="MODEL_NOT_TRIED",
                message=f"lens model: {choice.reason}",
                remedy=MORE_VIEWS,
                context={"model_reason": choice.reason},
            )
        )
    return tuple(reported)


def _uncovered(coverage: Coverage) -> list[Remark]:
    reaches = zip(CORNERS, coverage.corner_reach_ratios, strict=True)
    low = ", ".join(name for name, reach in reaches if reach < MIN_CORNER_REACH_RATIO)
    if not low:
        return []
    reach_percent, advised_percent = 100 * min(coverage.corner_reach_ratios), 100 * MIN_CORNER_REACH_RATIO
    return [
        Remark(
            code="CORNERS_UNCOVERED",
            message=f"towards the image's {low} corner points reach {reach_percent:.0f} % of the way, "
            f"advised are {advised_percent:.0f} %",
            remedy="Add views with the board there: beyond its points the lens is extrapolated.",
            context={
                "uncovered_corners": low,
                "reach_percent": reach_percent,
                "advised_percent": advised_percent,
            },
        )
    ]


def _unsure(parameters: Sequence[ParameterEstimate], size_wh_px: tuple[int, int]) -> list[Remark]:
    reported = []
    for one in parameters:
        limit = {
            "f": MAX_FOCAL_SD_WARNING_RATIO * one.value,
            "c": MAX_MIDDLE_SD_WARNING_RATIO * max(size_wh_px),
        }.get(one.name[0])
        if limit is not None and one.sd > limit:
            reported.append(
                Remark(
                    code="FOCAL_LENGTH_UNCERTAIN" if one.name[0] == "f" else "PRINCIPAL_POINT_UNCERTAIN",
                    message=f"{one.name} is {one.value:.1f} px with a standard deviation of {one.sd:.1f} px, "
                    f"advised is {limit:.1f} px",
                    remedy="Add views with the board tilted in other directions and filling the image.",
                    context={
                        "parameter": one.name,
                        "value": one.value,
                        "sd_px": one.sd,
                        "advised_px": limit,
                    },
                )
            )
    return reported


def widest_tilt_deg(views: Sequence[ViewReport]) -> float:
    """Return the largest angle between the board's normals in two views."""
    if len(views) < 2:
        return 0.0
    normals = np.array([view.camera_from_pattern.rotation[:, 2] for view in views])
    return float(np.degrees(np.arccos(np.clip(normals @ normals.T, -1.0, 1.0).min())))
