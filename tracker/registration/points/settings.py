"""Requirements on points before the fit, and on a fit before its use."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class PointSettings:
    """Thresholds for rejecting points, and the minimum localisation error.

    Attributes:
        min_fle_mm: best possible localisation of a landmark on bone and CT (3-D RMS); a lower bound of the
            stated uncertainty, however small the residuals.
        min_apart_mm: minimum distance between two points.
        min_spread_ratio: minimum ratio of the second to the first extent of the points; below it they are
            collinear.
        max_rotation_sd_deg: maximum uncertainty of the rotation about the points' principal axis, for
            landmarks localised with `min_fle_mm`.
        max_accepted_fre_mm: an order with a smaller FRE is never rejected.
        min_improvement_ratio: by which factor another order or the mirror image must fit better to be
            preferred.
        max_left_out_mm: size of a gross error. A used point with a larger leave-one-out residual prevents the
            use of the fit. The covariance includes gross errors that the points do not exclude; infinity:
            none.
    """

    min_fle_mm: float = 0.5
    min_apart_mm: float = 1.0
    min_spread_ratio: float = 0.05
    max_rotation_sd_deg: float = 5.0
    max_accepted_fre_mm: float = 1.5
    min_improvement_ratio: float = 3.0
    max_left_out_mm: float = 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PointGate:
    """Requirements on a point-based registration before its use.

    Attributes:
        max_fre_mm: maximum FRE. It detects mistaken landmarks; it does not measure the accuracy at the
            target.
        max_tre_mm: maximum stated TRE (3-D RMS) at each target.
    """

    max_fre_mm: float = 1.5
    max_tre_mm: float = 2.0
