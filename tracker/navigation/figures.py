"""The displayed figures of a drill: rounded first, then compared with their limits.

The displayed digits decide. Where an error is dangerous, rounding is conservative: distance to the wall and
remaining depth are rounded down, probabilities and uncertainties up. An alarm is therefore never later than
with the exact number.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_UP, Decimal
from enum import StrEnum
from math import isfinite, nan

from tracker.navigation.clearance import NearestWall, WallProximity, WallSource
from tracker.navigation.deviation import Deviation
from tracker.navigation.uncertainty import DrillAnalysis
from tracker.plan import Channel

# A tip farther than this from the channel's axis is not in this pedicle, at any depth.
MAX_BESIDE_MM = 30.0
# 95 % of a normal distribution lie within +-1.96 standard deviations.
NORMAL_95 = 1.96
# 0.3 is stored as 0.29999999999999998; an error of the last binary digit must not change the decimal.
ROUNDING_ERROR = 1e-9
# Larger floats have no reliable decimals.
MAX_ROUNDED = 1e15


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillLimits:
    """Limits that are not part of a plan.

    Attributes:
        warning_distance_mm: a smaller clearance of the drill is a warning.
        breach_ratio: maximum probability of a breach, of the drill now or 2 mm deeper, or of the screw at its
            end.
    """

    warning_distance_mm: float = 1.0
    breach_ratio: float = 0.05


class FigureName(StrEnum):
    """Names of the figures that determine the verdict."""

    ENTRY = "entry"  # mm, offset of the drill's line at the entry point
    ANGLE = "angle"  # deg, between drill and channel
    DEPTH = "depth"  # mm, of the tip past the entry plane; its limit is the planned depth
    TO_GO = "to_go"  # mm, to the planned depth
    WALL = "wall"  # mm, clearance between the drill's cylinder and the nearest wall
    RISK = "risk"  # %, probability that the drill is through a wall, now or 2 mm further
    END = "end"  # %, probability that the screw would be through a wall at the planned depth
    ERROR = "error"  # mm, 95 % uncertainty of the drill's line, from marker, registration and tool together


class Status(StrEnum):
    """Result of comparing a figure with its limit."""

    WITHIN = "within"
    OVER = "over"  # a limit is exceeded
    THROUGH = "through"  # past the wall, or past the planned depth
    UNLIMITED = "unlimited"  # the limit is not known
    OUTSIDE = "outside"  # the drill is outside the bone, or beside this pedicle: the figure does not apply


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """One displayed number.

    Attributes:
        value: rounded; infinite if the drill lies across the channel, NaN if the figure does not exist.
        limit: rounded conservatively; NaN if there is none.
        error_95: half width of the 95 % interval of `value`; NaN if not known.
        status: comparison of the two rounded numbers.
    """

    value: float
    limit: float = nan
    error_95: float = nan
    status: Status = Status.UNLIMITED


def drill_figures(
    deviation: Deviation, analysis: DrillAnalysis | None, channel: Channel, limits: DrillLimits
) -> Mapping[FigureName, Figure]:
    """Compute all figures of a drill in one image and compare them with their limits.

    Args:
        deviation: of the drill from the channel.
        analysis: clearance and uncertainty; None if no pedicle is known.
        channel: the planned channel.
        limits: those that are not part of a plan.
    """
    is_beside = deviation.tip_offset_mm > channel.radius_mm + MAX_BESIDE_MM
    to_go = _to_go(deviation.remaining_mm, is_beside=is_beside)
    depth = _depth(deviation, to_go, rounded(channel.length_mm))
    if analysis is None:
        missing = (FigureName.WALL, FigureName.RISK, FigureName.END, FigureName.ERROR)
        return {
            FigureName.ENTRY: Figure(value=rounded(deviation.entry_offset_mm)),
            FigureName.ANGLE: Figure(value=rounded(deviation.angle_deg)),
            FigureName.DEPTH: depth,
            FigureName.TO_GO: to_go,
            **dict.fromkeys(missing, Figure(value=nan)),
        }
    certain, spread, clearance = analysis.certain, analysis.spread, analysis.clearance
    depth_error_95 = rounded_up(NORMAL_95 * spread.sd_depth_mm, decimals=2)
    return {
        FigureName.ENTRY: _at_most(
            rounded(deviation.entry_offset_mm),
            rounded_down(certain.tolerance_mm),
            error_95=rounded_up(certain.entry_95_mm, decimals=2),
        ),
        FigureName.ANGLE: _at_most(
            rounded(deviation.angle_deg),
            rounded_down(certain.tolerance_deg),
            error_95=rounded_up(spread.cone_95_deg, decimals=2),
        ),
        FigureName.DEPTH: replace(depth, error_95=depth_error_95),
        FigureName.TO_GO: to_go,
        FigureName.WALL: _wall(clearance.now, limits.warning_distance_mm, sd_mm=analysis.now.sd_mm),
        FigureName.RISK: _risk(analysis, limits.breach_ratio),
        FigureName.END: _end(analysis, limits.breach_ratio, is_beside=is_beside),
        FigureName.ERROR: _at_most(
            rounded_up(max(certain.entry_95_mm, certain.isthmus_95_mm), decimals=2),
            rounded_down(certain.tolerance_mm, decimals=2),
        ),
    }


def _to_go(remaining_mm: float, *, is_beside: bool) -> Figure:
    value = rounded_down(remaining_mm)
    status = Status.OUTSIDE if is_beside else Status.THROUGH if value < 0.0 else Status.WITHIN
    return Figure(value=value, limit=0.0, status=status)


def _depth(deviation: Deviation, to_go: Figure, length_mm: float) -> Figure:
    """Return the depth that adds with what is to go to the displayed length.

    Rounded for itself, it would read 21.9 of 47.0 mm with 25.0 mm to go. What is to go is rounded down, so
    that the depth is rounded up.
    """
    shown_mm = rounded(length_mm - to_go.value) if isfinite(to_go.value) else rounded(deviation.depth_mm)
    return Figure(value=shown_mm, limit=length_mm, status=to_go.status)


def _wall(now: WallProximity, warning_distance_mm: float, *, sd_mm: float) -> Figure:
    limit = rounded_up(warning_distance_mm)
    if not isinstance(now, NearestWall):
        return Figure(value=nan, limit=limit, status=Status.OUTSIDE)
    value = rounded_down(now.clearance_mm)
    # NaN is not WITHIN.
    status = Status.THROUGH if value < 0.0 else Status.WITHIN if value >= limit else Status.OVER
    return Figure(value=value, limit=limit, error_95=rounded_up(NORMAL_95 * sd_mm, decimals=2), status=status)


def _risk(analysis: DrillAnalysis, breach_ratio: float) -> Figure:
    limit, clearance = _limit_percent(breach_ratio), analysis.clearance
    if not any(isinstance(one, NearestWall) for one in (clearance.now, clearance.lookahead)):
        # Without a wall, 0 % would be said of a drill in another pedicle, too.
        return Figure(value=nan, limit=limit, status=Status.OUTSIDE)
    return _at_most(_percent(max(analysis.now.through_ratio, analysis.lookahead.through_ratio)), limit)


def _end(analysis: DrillAnalysis, breach_ratio: float, *, is_beside: bool) -> Figure:
    if analysis.clearance.against is WallSource.CHANNEL:
        # The planned cylinder is not bone: a screw of the same size cannot breach it.
        return Figure(value=nan)
    limit = _limit_percent(breach_ratio)
    if is_beside or not isinstance(analysis.clearance.at_end, NearestWall):
        # An axis that misses the pedicle breaches no wall but is no valid path either.
        return Figure(value=nan, limit=limit, status=Status.OVER)
    return _at_most(_percent(analysis.at_end.through_ratio), limit)


def _at_most(value: float, limit: float, *, error_95: float = nan) -> Figure:
    # Infinity and NaN are over the limit.
    status = Status.WITHIN if value <= limit else Status.OVER
    return Figure(value=value, limit=limit, error_95=error_95, status=status)


def _percent(ratio: float) -> float:
    return rounded_up(100.0 * ratio, decimals=0)


def _limit_percent(ratio: float) -> float:
    return rounded_down(100.0 * ratio, decimals=0)


def rounded(value: float, *, decimals: int = 1) -> float:
    """Round to a number of decimals, half away from zero, on the exact binary value.

    `Number.prototype.toFixed` in a browser rounds in the same way, so both display the same digits.
    """
    return _quantised(value, decimals, ROUND_HALF_UP)


def rounded_down(value: float, *, decimals: int = 1) -> float:
    """Round down to a number of decimals; a value within 1e-9 of a rounded one is taken as exact."""
    return _quantised(value + ROUNDING_ERROR, decimals, ROUND_FLOOR)


def rounded_up(value: float, *, decimals: int = 1) -> float:
    """Round up to a number of decimals; a value within 1e-9 of a rounded one is taken as exact."""
    return _quantised(value - ROUNDING_ERROR, decimals, ROUND_CEILING)


def _quantised(value: float, decimals: int, rounding: str) -> float:
    # Decimal raises for more digits than its context has.
    if not isfinite(value) or abs(value) > MAX_ROUNDED:
        return value
    # Adding zero turns -0.0 into 0.0.
    return float(Decimal(value).quantize(Decimal(1).scaleb(-decimals), rounding=rounding)) + 0.0
