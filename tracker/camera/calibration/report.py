"""Result of a camera calibration, with its uncertainty and warnings."""

from dataclasses import dataclass

import numpy as np

from tracker.camera.model import CameraModel
from tracker.errors import Remark
from tracker.geometry import Array, Camera, Pattern, Rigid


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterEstimate:
    """Estimate of one camera parameter with its uncertainty.

    Attributes:
        name: fx fy cx cy k1 k2 p1 p2 k3 k4 k5 k6.
        value: focal lengths and principal point in px, the lens without unit.
        sd: standard deviation, of the same unit.
        low_95, high_95: 95 % confidence interval (Student's t with `degrees_of_freedom`).
        degrees_of_freedom: of the standard deviation.
    """

    name: str
    value: float
    sd: float
    low_95: float
    high_95: float
    degrees_of_freedom: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewReport:
    """Report of one view.

    Attributes:
        name: as the caller named it.
        used: whether the calibration uses it.
        reason: why it is not used, with numbers, or an empty string.
        rms_px: RMS reprojection error; for a view that is not used, at its best pose, and NaN without a pose.
        points: number of detected points.
        dropped_points: number of outlier points among them.
        tilt_deg: between the board's face and the image plane.
        distance_mm: distance from the camera to the centre of the detected points.
        camera_from_pattern: the board's pose; identity where there is none.
        image_points_px: (n, 2), detected points, corrected for the bias of tilted dots.
        residuals_px: (n, 2), observed minus projected, of the inlier points.
    """

    name: str
    used: bool
    reason: str
    rms_px: float
    points: int
    dropped_points: int
    tilt_deg: float
    distance_mm: float
    camera_from_pattern: Rigid[Camera, Pattern]
    image_points_px: Array
    residuals_px: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Coverage:
    """Image coverage of the points.

    Attributes:
        cells_ratio: ratio of the image's cells (8 x 6) that contain a point.
        hull_ratio: area of the convex hull of the points, as a ratio of the image's area.
        corner_reach_ratios: largest distance of points from the centre towards the top left, top right,
            bottom right and bottom left corner, as a ratio of the corner's distance.
    """

    cells_ratio: float
    hull_ratio: float
    corner_reach_ratios: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelChoice:
    """The selected lens model, with its cross-validation errors.

    Attributes:
        coefficients: 4, 5 or 8.
        held_out_rms_px: RMS on held-out views by number of coefficients; empty with too few views.
        reason: a sentence, without full stop.
    """

    coefficients: int
    held_out_rms_px: tuple[tuple[int, float], ...]
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationReport:
    """A calibrated camera with its report.

    Attributes:
        camera: the result.
        rms_px: RMS reprojection error over all views used.
        noise_px: standard deviation of one coordinate of one point.
        is_noise_correlated: whether errors of neighbouring points, or within a view, are correlated (a bent
            board, blur); the standard deviations then come from a jackknife over the views.
        parameters: each estimated number.
        covariance: (n, n) of `parameters`, in their order.
        views: all of them, in the order given.
        coverage: of the image.
        choice: of the lens model.
        warnings: poorly determined parameters.
    """

    camera: CameraModel
    rms_px: float
    noise_px: float
    is_noise_correlated: bool
    parameters: tuple[ParameterEstimate, ...]
    covariance: Array
    views: tuple[ViewReport, ...]
    coverage: Coverage
    choice: ModelChoice
    warnings: tuple[Remark, ...]

    def parameter(self, name: str) -> ParameterEstimate:
        """Return the estimate of this name."""
        return next(one for one in self.parameters if one.name == name)

    @property
    def views_used(self) -> int:
        """Return the number of views in use."""
        return sum(view.used for view in self.views)

    @property
    def pixel_aspect_ratio(self) -> float:
        """Return fy / fx: above 1 where pixels are wider than high."""
        return float(self.camera.matrix[1, 1] / self.camera.matrix[0, 0])


def rms(residuals_px: Array) -> float:
    """Return the RMS length of residuals (n, 2); NaN for none."""
    return float(np.sqrt((residuals_px**2).sum(axis=1).mean())) if len(residuals_px) else float("nan")
