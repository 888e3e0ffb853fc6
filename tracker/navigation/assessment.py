"""The figures of a drill with their limits, and the verdict that follows from them and from nothing else.

A figure is rounded before it is compared with its limit, so the digits on the screen are the digits that
decide. Where being wrong is dangerous the rounding is towards danger: bone to the wall and depth to go are
rounded down, probabilities and uncertainties up. An alarm is therefore never later than the exact number.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_UP, Decimal
from enum import StrEnum
from math import hypot, inf, isfinite, nan

from tracker.navigation.certainty import Judged
from tracker.navigation.clearance import Closest, MeasuredAgainst, Nearest
from tracker.navigation.deviation import Deviation
from tracker.navigation.directions import Wall
from tracker.plan import Channel

# A tip farther than this from the channel's axis is not in this pedicle, however deep it is.
BESIDE_MM = 30.0
# The second component of a correction is stated from this share of the first one on.
MIN_SECOND_RATIO = 0.5
# A slice shows an angle larger than it is: by this factor for a channel that is inclined by 45 degrees.
MAX_IN_SLICES = 1.5
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


class Verdict(StrEnum):
    """What the figures of one image say of the drill, the most severe first."""

    THROUGH_WALL = "through_wall"  # a part of the drill is through the wall
    TOO_DEEP = "too_deep"  # the tip is past the planned depth
    UNCERTAIN = "uncertain"  # the 95 % uncertainty is larger than what the pedicle leaves
    BREACH_LIKELY = "breach_likely"  # the probability of a breach, now or 2 mm further, is over its limit
    NEAR_WALL = "near_wall"  # less bone is left than the warning distance
    CORRECT_ENTRY = "correct_entry"  # the entry offset is over its limit
    CORRECT_ANGLE = "correct_angle"  # the angle is over its limit
    CORRECT_END = "correct_end"  # entry and angle are within limits, and the screw would still breach
    NOT_ASSESSED = "not_assessed"  # no pedicle is known to assess the drill against
    ON_PATH = "on_path"  # every figure is within its limit

    @property
    def severity(self) -> int:
        """Larger is worse; 0 for `ON_PATH`."""
        return len(_BY_SEVERITY) - 1 - _BY_SEVERITY.index(self)


_BY_SEVERITY = list(Verdict)


class Direction(StrEnum):
    """Where to move or to aim, in the patient's directions."""

    MEDIAL = "medial"
    LATERAL = "lateral"
    CRANIAL = "cranial"
    CAUDAL = "caudal"
    POSTERIOR = "posterior"


AWAY_FROM: Mapping[Wall, Direction] = {
    Wall.MEDIAL: Direction.LATERAL,
    Wall.LATERAL: Direction.MEDIAL,
    Wall.CRANIAL: Direction.CAUDAL,
    Wall.CAUDAL: Direction.CRANIAL,
    Wall.ANTERIOR: Direction.POSTERIOR,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Correction:
    """One component of a correction.

    Attributes:
        amount: mm for an offset, deg for an angle; rounded as the figures are.
        towards: where to.
    """

    amount: float
    towards: Direction


@dataclass(frozen=True, slots=True, kw_only=True)
class Assessment:
    """All figures of a drill, and their verdict.

    Attributes:
        verdict: the most severe that the figures give.
        figures: each of them.
        corrections: of an entry or an angle that is over its limit, the larger component first: for the
            entry where the drill's line must move to, for the angle where the drill must point to.
            Away from the wall, without an amount (NaN), where a wall is near or would be breached.
        wall: the nearest wall; None while the drill is outside the bone.
        end_wall: the wall that the screw would come nearest to; None where it misses the pedicle.
        against: what the wall was measured against; None where none is known.
    """

    verdict: Verdict
    figures: Mapping[FigureName, Figure]
    corrections: tuple[Correction, ...] = ()
    wall: Wall | None = None
    end_wall: Wall | None = None
    against: MeasuredAgainst | None = None

    @property
    def rank(self) -> tuple[float, float]:
        """Orders the drills of one image: larger is more severe, and of equal ones nearer to its wall."""
        wall_mm = self.figures[FigureName.WALL].value
        return self.verdict.severity, -wall_mm if isfinite(wall_mm) else -inf


def assess(deviation: Deviation, judged: Judged | None, channel: Channel, limits: DrillLimits) -> Assessment:
    """The figures of one drill in one image with their limits, and the verdict.

    Args:
        deviation: of the drill from the channel.
        judged: clearance and uncertainty; None where no pedicle is known. Nothing has a limit then but the
            depth.
        channel: the plan.
        limits: those that no plan contains.
    """
    figures = _figures(deviation, judged, channel, limits)
    if judged is None:
        is_deep = figures[FigureName.TO_GO].status is Status.THROUGH
        return Assessment(verdict=Verdict.TOO_DEEP if is_deep else Verdict.NOT_ASSESSED, figures=figures)
    clearance = judged.clearance
    wall, end_wall = _wall_of(clearance.now), _wall_of(clearance.at_end)
    verdict = _verdict(figures)
    return Assessment(
        verdict=verdict,
        figures=figures,
        corrections=_corrections(
            verdict, deviation, wall if wall is not None else _wall_of(clearance.soon), end_wall
        ),
        wall=wall,
        end_wall=end_wall,
        against=clearance.against,
    )


def _figures(
    deviation: Deviation, judged: Judged | None, channel: Channel, limits: DrillLimits
) -> Mapping[FigureName, Figure]:
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
    status = Status.THROUGH if value < 0.0 else Status.OVER if value < limit else Status.WITHIN
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


def _verdict(figures: Mapping[FigureName, Figure]) -> Verdict:
    def status(name: FigureName) -> Status:
        return figures[name].status

    if status(FigureName.WALL) is Status.THROUGH:
        return Verdict.THROUGH_WALL
    if status(FigureName.TO_GO) is Status.THROUGH:
        return Verdict.TOO_DEEP
    error = figures[FigureName.ERROR]
    # Across the channel a drill's line meets no plane of it: that is no uncertainty, and its angle says so.
    if error.status is Status.OVER and isfinite(error.value):
        return Verdict.UNCERTAIN
    for name, verdict in (
        (FigureName.RISK, Verdict.BREACH_LIKELY),
        (FigureName.WALL, Verdict.NEAR_WALL),
    ):
        if status(name) is Status.OVER:
            return verdict
    if (worse := _worse_of(figures)) is not None:
        return worse
    return Verdict.CORRECT_END if status(FigureName.END) is Status.OVER else Verdict.ON_PATH


def _worse_of(figures: Mapping[FigureName, Figure]) -> Verdict | None:
    """Of entry and angle the one that exceeds its limit by the larger factor; None where neither does."""
    entry, angle = figures[FigureName.ENTRY], figures[FigureName.ANGLE]
    over = {
        verdict: figure.value / max(figure.limit, 0.1)
        for verdict, figure in ((Verdict.CORRECT_ENTRY, entry), (Verdict.CORRECT_ANGLE, angle))
        if figure.status is Status.OVER
    }
    # Across the channel a drill has no entry offset; its angle says what to do.
    if Verdict.CORRECT_ANGLE in over and not isfinite(entry.value):
        return Verdict.CORRECT_ANGLE
    return max(over, key=lambda verdict: over[verdict], default=None)


def _corrections(
    verdict: Verdict, deviation: Deviation, wall: Wall | None, end_wall: Wall | None
) -> tuple[Correction, ...]:
    if verdict is Verdict.CORRECT_ENTRY:
        return _components(
            (deviation.entry_lateral_mm, Direction.MEDIAL, Direction.LATERAL),
            (deviation.entry_cranial_mm, Direction.CAUDAL, Direction.CRANIAL),
        )
    if verdict is Verdict.CORRECT_ANGLE:
        # A drill far off the channel has angles in the slices that do not show the way back to it.
        in_slices_deg = hypot(deviation.transverse_deg, deviation.sagittal_deg)
        if in_slices_deg > MAX_IN_SLICES * deviation.angle_deg:
            return ()
        return _components(
            (deviation.transverse_deg, Direction.LATERAL, Direction.MEDIAL),
            (deviation.sagittal_deg, Direction.CAUDAL, Direction.CRANIAL),
        )
    nearest = end_wall if verdict is Verdict.CORRECT_END else wall
    if nearest is not None and verdict in (
        Verdict.THROUGH_WALL,
        Verdict.BREACH_LIKELY,
        Verdict.NEAR_WALL,
        Verdict.CORRECT_END,
    ):
        return (Correction(amount=nan, towards=AWAY_FROM[nearest]),)
    return ()


def _components(*parts: tuple[float, Direction, Direction]) -> tuple[Correction, ...]:
    """Steps against errors, each with where to go when it is positive and when it is negative."""
    corrections = sorted(
        (
            Correction(amount=rounded(abs(error)), towards=positive if error > 0.0 else negative)
            for error, positive, negative in parts
            if isfinite(error)
        ),
        key=lambda correction: -correction.amount,
    )
    return tuple(
        correction
        for correction in corrections
        if correction.amount >= max(MIN_SECOND_RATIO * corrections[0].amount, 0.1)
    )


def _wall_of(closest: Closest) -> Wall | None:
    return closest.wall if isinstance(closest, Nearest) else None


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
