"""Reject point sets that determine no rigid transform."""

import numpy as np
import scipy

from tracker.errors import RegistrationError
from tracker.geometry import Array
from tracker.registration.points.pairs import PointPairs
from tracker.registration.points.settings import PointSettings

MIN_POINTS = 3
# A larger ratio of the scales means different units, not a landmark error.
MAX_SCALE = 2.0
SPREAD_REMEDY = "Add a landmark that lies well beside that line, such as a transverse process, and fit again."
UNITS = ((1000.0, "metres"), (10.0, "centimetres"), (25.4, "inches"))


def reject_unfit(pairs: PointPairs, settings: PointSettings) -> None:
    """Reject points that determine no rigid transform, before fitting.

    Raises:
        RegistrationError: POINTS_TOO_FEW, POINTS_UNIT_SUSPECT, POINTS_COINCIDENT or POINTS_COLLINEAR.
    """
    if len(pairs) < MIN_POINTS:
        raise RegistrationError(
            "POINTS_TOO_FEW",
            f"there are {len(pairs)} pairs of points, needed {MIN_POINTS}",
            "Touch at least three landmarks that are not collinear; four or more reveal a gross error.",
            {"points": len(pairs), "needed": MIN_POINTS},
        )
    _reject_units(pairs)
    for points, which in ((pairs.fixed_mm, "on the CT"), (pairs.moving_mm, "as touched")):
        _reject_coincident(points, which, pairs.labels, settings.min_apart_mm)
    for points, which in ((pairs.fixed_mm, "on the CT"), (pairs.moving_mm, "as touched")):
        _reject_line(points, which, settings)


def scale_ratio(pairs: PointPairs) -> float:
    """Return the size of the points on the CT relative to their size as captured."""
    fixed, moving = _spread_mm(pairs.fixed_mm), _spread_mm(pairs.moving_mm)
    return fixed / moving if moving > 0.0 else np.inf


def _spread_mm(points: Array) -> float:
    return float(np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean()))


def _reject_units(pairs: PointPairs) -> None:
    fixed, moving = _spread_mm(pairs.fixed_mm), _spread_mm(pairs.moving_mm)
    minimum, maximum = min(fixed, moving), max(fixed, moving)
    if minimum <= 0.0 or maximum <= MAX_SCALE * minimum:
        return
    which = "on the CT" if fixed < moving else "as touched"
    likely = [name for factor, name in UNITS if 0.8 < maximum / minimum / factor < 1.25]
    guess = f": those {which} seem to be in {likely[0]}" if likely else ""
    raise RegistrationError(
        "POINTS_UNIT_SUSPECT",
        f"the points spread over {fixed:.4g} mm on the CT and over {moving:.4g} mm as touched, "
        f"{maximum / minimum:.4g} times as much{guess}",
        "Give both in millimetres, and check that both files are of the same landmarks.",
        {
            "fixed_spread_mm": fixed,
            "moving_spread_mm": moving,
            "size_ratio": maximum / minimum,
            "unit_guess": guess,
        },
    )


def _reject_coincident(points: Array, which: str, labels: tuple[str, ...], min_mm: float) -> None:
    distances, others = scipy.spatial.KDTree(points).query(points, k=2)
    first = int(np.argmin(distances[:, 1]))
    # Of coincident points, either may be returned as the nearest.
    second = int(others[first, 1] if others[first, 1] != first else others[first, 0])
    first, second = min(first, second), max(first, second)
    nearest = float(np.linalg.norm(points[first] - points[second]))
    if nearest >= min_mm:
        return
    hint = ""
    if _spread_mm(points) < min_mm:
        hint = f"; all of them lie within {2.0 * _spread_mm(points):.3g} mm, as if in metres"
    raise RegistrationError(
        "POINTS_COINCIDENT",
        f"points {labels[first]} and {labels[second]} are {nearest:.2f} mm apart {which}, "
        f"needed {min_mm:g} mm{hint}",
        "Exclude one of them, or touch it again.",
        {
            "points": [labels[first], labels[second]],
            "apart_mm": nearest,
            "needed_mm": min_mm,
            "extent_mm": 2.0 * _spread_mm(points),
            "points_where": which,
            "spread_hint": hint,
        },
    )


def _reject_line(points: Array, which: str, settings: PointSettings) -> None:
    extents = np.linalg.svd(points - points.mean(axis=0), compute_uv=False) / np.sqrt(len(points))
    ratio = float(extents[1] / extents[0])
    # The rotation about the line is determined by the distances of the points from it and their number.
    beside_mm = float(np.hypot(extents[1], extents[2]) * np.sqrt(len(points)))
    sd_deg = np.inf
    if beside_mm > 0.0:
        sd_deg = float(np.degrees(settings.min_fle_mm / np.sqrt(3.0) / beside_mm))
    if ratio >= settings.min_spread_ratio and sd_deg <= settings.max_rotation_sd_deg:
        return
    raise RegistrationError(
        "POINTS_COLLINEAR",
        f"the points are nearly a line {which}: they reach {extents[0]:.1f} mm along it and only "
        f"{extents[1]:.2f} mm beside it (RMS), so that the rotation about that line is ambiguous "
        f"(known to {min(sd_deg, 180.0):.0f} deg, allowed {settings.max_rotation_sd_deg:g} deg; "
        f"needed beside it {settings.min_spread_ratio * extents[0]:.2f} mm at least)",
        SPREAD_REMEDY,
        {
            "along_mm": float(extents[0]),
            "beside_mm": float(extents[1]),
            "turn_sd_deg": min(sd_deg, 180.0),
            "allowed_deg": settings.max_rotation_sd_deg,
            "points_where": which,
            "needed_mm": float(settings.min_spread_ratio * extents[0]),
        },
    )
