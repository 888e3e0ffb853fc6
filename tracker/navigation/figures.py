"""The figures of a drill as they are shown: rounded, and compared with their limits after that.

The digits on the screen are the digits that decide. Where being wrong is dangerous the rounding is towards
danger: bone to the wall and depth to go are rounded down, probabilities and uncertainties up. An alarm is
therefore never later than the exact number.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_UP, Decimal
from enum import StrEnum
from math import isfinite, nan

from tracker.navigation.certainty import Judged
from tracker.navigation.clearance import Closest, MeasuredAgainst, Nearest
from tracker.navigation.deviation import Deviation
from tracker.plan import Channel

# A tip farther than this from the channel's axis is not in this pedicle, however deep it is.
BESIDE_MM = 30.0
# Of a normal distribution within +- 1.96 standard deviations lie 95 %.
NORMAL_95 = 1.96
# 0.3 is stored as 0.29999999999999998: an error of the last binary digit must not cost a tenth.
ROUNDING_ERROR = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillLimits:
    """The limits that no plan contains.

    Attributes:
        warning_distance_mm: less bone than this beside the drill is a warning.
        breach_ratio: probability of a breach: of the drill now or 2 mm further, or of the screw at the end.
    """

    warning_distance_mm: float = 1.0
    breach_ratio: float = 0.05


class FigureName(StrEnum):
    """The numbers that a verdict is made from."""

    ENTRY = "entry"  # mm, offset of the drill's line at the entry point
    ANGLE = "angle"  # deg, between drill and channel
    DEPTH = "depth"  # mm, of the tip past the entry plane; its limit is the planned depth
    TO_GO = "to_go"  # mm, to the planned depth
    WALL = "wall"  # mm, clearance between the drill's cylinder and the nearest wall
    RISK = "risk"  # %, probability that the drill is through a wall, now or 2 mm further
    END = "end"  # %, probability that the screw would be through a wall at the planned depth
    ERROR = "error"  # mm, 95 % uncertainty of the drill's line, from marker, registration and tool together


class Status(StrEnum):
    """How a figure compares with its limit."""

    WITHIN = "within"
    OVER = "over"  # a limit is exceeded
    THROUGH = "through"  # past the wall, or past the planned depth
    UNLIMITED = "unlimited"  # nothing is known to compare it with
    OUTSIDE = "outside"  # the drill is outside the bone, or beside this pedicle: the figure does not apply


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """One number as it is shown.

    Attributes:
        value: rounded; infinite where the drill lies across the channel, NaN where the figure does not exist.
        limit: rounded towards safety; NaN where there is none.
        error_95: half width of the 95 % interval of `value`; NaN where it is not known.
        status: the comparison of the two rounded numbers.
    """

    value: float
    limit: float = nan
    error_95: float = nan
    status: Status = Status.UNLIMITED


def figures_of(
    deviation: Deviation, judged: Judged | None, channel: Channel, limits: DrillLimits
) -> Mapping[FigureName, Figure]:
    """All figures of a drill in one image with their limits.

    Args:
        deviation: of the drill from the channel.
        judged: clearance and uncertainty; None where no pedicle is known.
        channel: the plan.
        limits: those that no plan contains.
    """
    is_beside = deviation.tip_offset_mm > channel.radius_mm + BESIDE_MM
    to_go = _to_go(deviation.remaining_mm, is_beside=is_beside)
    depth = Figure(value=rounded(deviation.depth_mm), limit=rounded(channel.length_mm), status=to_go.status)
    if judged is None:
        missing = (FigureName.WALL, FigureName.RISK, FigureName.END, FigureName.ERROR)
        return {
            FigureName.ENTRY: Figure(value=rounded(deviation.entry_offset_mm)),
            FigureName.ANGLE: Figure(value=rounded(deviation.angle_deg)),
            FigureName.DEPTH: depth,
            FigureName.TO_GO: to_go,
            **dict.fromkeys(missing, Figure(value=nan)),
        }
    certain, spread, clearance = judged.certain, judged.spread, judged.clearance
    risk_ratio = max(judged.now.through_ratio, judged.soon.through_ratio)
    depth_error_95 = rounded_up(NORMAL_95 * spread.sd_depth_mm, decimals=2)
    return {
        FigureName.ENTRY: _at_most(
            rounded(deviation.entry_offset_mm),
            rounded_down(certain.room_mm),
            error_95=rounded_up(certain.entry_95_mm, decimals=2),
        ),
        FigureName.ANGLE: _at_most(
            rounded(deviation.angle_deg),
            rounded_down(certain.room_deg),
            error_95=rounded_up(spread.cone_95_deg, decimals=2),
        ),
        FigureName.DEPTH: replace(depth, error_95=depth_error_95),
        FigureName.TO_GO: to_go,
        FigureName.WALL: _wall(clearance.now, limits.warning_distance_mm, sd_mm=judged.now.sd_mm),
        FigureName.RISK: _at_most(_percent(risk_ratio), _limit_percent(limits.breach_ratio)),
        FigureName.END: _end(judged, limits.breach_ratio),
        FigureName.ERROR: _at_most(
            rounded_up(max(certain.entry_95_mm, certain.isthmus_95_mm), decimals=2),
            rounded_down(certain.room_mm, decimals=2),
        ),
    }


def _to_go(remaining_mm: float, *, is_beside: bool) -> Figure:
    value = rounded_down(remaining_mm)
    status = Status.OUTSIDE if is_beside else Status.THROUGH if value < 0.0 else Status.WITHIN
    return Figure(value=value, limit=0.0, status=status)


def _wall(now: Closest, warning_distance_mm: float, *, sd_mm: float) -> Figure:
    limit = rounded_up(warning_distance_mm)
    if not isinstance(now, Nearest):
        return Figure(value=nan, limit=limit, status=Status.OUTSIDE)
    value = rounded_down(now.clearance_mm)
    # A value that is no number is not within.
    status = Status.THROUGH if value < 0.0 else Status.WITHIN if value >= limit else Status.OVER
    return Figure(value=value, limit=limit, error_95=rounded_up(NORMAL_95 * sd_mm, decimals=2), status=status)


def _end(judged: Judged, breach_ratio: float) -> Figure:
    if judged.clearance.against is MeasuredAgainst.CHANNEL:
        # A planned cylinder is no bone that a screw of that very size could breach.
        return Figure(value=nan)
    limit = _limit_percent(breach_ratio)
    if not isinstance(judged.clearance.at_end, Nearest):
        # A line that comes nowhere near the pedicle breaches no wall, and is no way into it.
        return Figure(value=nan, limit=limit, status=Status.OVER)
    return _at_most(_percent(judged.at_end.through_ratio), limit)


def _at_most(value: float, limit: float, *, error_95: float = nan) -> Figure:
    # Also an infinite value, and one that is no number.
    status = Status.WITHIN if value <= limit else Status.OVER
    return Figure(value=value, limit=limit, error_95=error_95, status=status)


def _percent(ratio: float) -> float:
    return rounded_up(100.0 * ratio, decimals=0)


def _limit_percent(ratio: float) -> float:
    return rounded_down(100.0 * ratio, decimals=0)


def rounded(value: float, *, decimals: int = 1) -> float:
    """The nearest number with so many decimals, half away from zero, on the exact binary value.

    `Number.prototype.toFixed` of a browser rounds in the same way, so both show the same digits.
    """
    return _quantised(value, decimals, ROUND_HALF_UP)


def rounded_down(value: float, *, decimals: int = 1) -> float:
    """The next smaller number with so many decimals; what is within 1e-9 of one is that one."""
    return _quantised(value + ROUNDING_ERROR, decimals, ROUND_FLOOR)


def rounded_up(value: float, *, decimals: int = 1) -> float:
    """The next larger number with so many decimals; what is within 1e-9 of one is that one."""
    return _quantised(value - ROUNDING_ERROR, decimals, ROUND_CEILING)


def _quantised(value: float, decimals: int, rounding: str) -> float:
    if not isfinite(value):
        return value
    # Plus zero: a rounded -0.04 is 0, not -0.
    return float(Decimal(value).quantize(Decimal(1).scaleb(-decimals), rounding=rounding)) + 0.0
