"""Requirements on a sweep before the fit, and on a fit before its use."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceSettings:
    """Settings of the fit of a sweep.

    Attributes:
        min_points: minimum number of different points.
        min_sd_mm: best possible agreement of tip and CT on the surface of the bone; a lower bound of the
            noise.
        correlation_length_mm: points closer than this have correlated errors and count as one.
        landmark_sd_mm: sd of a landmark along each axis, if landmarks are used without covariances.
        max_start_off_mm: maximum median distance from the surface at the start.
        min_used_ratio: minimum share of inliers.
        max_slide_sd_mm: maximum uncertainty of each motion mode, in mm at the target's lever.
        start_shift_mm, start_rotation_deg: offsets of the other starts.
        max_apart_mm: two fits closer than this at the target are the same.
        tip_radius_mm: radius of a ball at the tip, whose centre is tracked.
    """

    min_points: int = 12
    min_sd_mm: float = 0.3
    correlation_length_mm: float = 1.5
    landmark_sd_mm: float = 1.0
    max_start_off_mm: float = 10.0
    min_used_ratio: float = 0.6
    max_slide_sd_mm: float = 1.0
    start_shift_mm: float = 4.0
    start_rotation_deg: float = 8.0
    max_apart_mm: float = 1.5
    tip_radius_mm: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceGate:
    """Requirements on a surface-based registration before its use.

    Attributes:
        max_rms_mm: maximum RMS distance of the inliers.
        max_tre_mm: maximum stated TRE (3-D RMS) at each target.
        max_moved_mm: maximum distance of the fit from its start, at the centroid of the sweep.
    """

    max_rms_mm: float = 1.0
    max_tre_mm: float = 2.0
    max_moved_mm: float = 10.0
