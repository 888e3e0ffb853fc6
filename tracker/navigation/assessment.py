"""The verdict on a drill, computed from its figures and their limits only.

Headline, figures, alarms, overlay, wire messages and log all use this assessment; the web page compares
nothing. Presence of a condition is decided without hysteresis; only a present condition is described in the
present tense and gets an instruction. A drill outside the planned cylinder but within all limits is therefore
on path; a screw whose probability of breach at its end exceeds `alarms.breach_ratio` is not. An error over
its limit is `UNCERTAIN` if a better view could reduce it, and `SETUP_INSUFFICIENT` if even the minimum error
of the set-up exceeds the limit. The second is constant over all images, so a likely breach, which takes the
uncertainty into account, has precedence. `tests/server/texts/contradictions.py` states the rule;
`random_drilling.py` searches for violations.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import inf, isfinite, nan

from tracker.navigation.clearance import NearestWall, WallProximity, WallSource
from tracker.navigation.deviation import Deviation
from tracker.navigation.directions import Wall
from tracker.navigation.figures import (
    DrillLimits,
    Figure,
    FigureName,
    Status,
    drill_figures,
    rounded,
    rounded_up,
)
from tracker.navigation.uncertainty import DrillAnalysis
from tracker.plan import Channel

# The second component of a correction is stated above this ratio to the first one.
MIN_SECOND_RATIO = 0.5
# Above this angle a drill lies across the channel.
MAX_CORRECTED_DEG = 45.0


class Verdict(StrEnum):
    """Classification of the figures of one image, the most severe first."""

    THROUGH_WALL = "through_wall"  # a part of the drill is through the wall
    TOO_DEEP = "too_deep"  # the tip is past the planned depth
    UNCERTAIN = "uncertain"  # the 95 % uncertainty in this image exceeds the tolerance of the pedicle
    BREACH_LIKELY = "breach_likely"  # the probability of a breach, now or 2 mm further, is over its limit
    SETUP_INSUFFICIENT = "setup_insufficient"  # it does in every image with this registration and tool
    NEAR_WALL = "near_wall"  # the clearance is below the warning distance
    CORRECT_ENTRY = "correct_entry"  # the entry offset is over its limit
    CORRECT_ANGLE = "correct_angle"  # the angle is over its limit
    CORRECT_END = "correct_end"  # entry and angle are within limits, and the screw would still breach
    NOT_ASSESSED = "not_assessed"  # without a pedicle the drill cannot be assessed
    ON_PATH = "on_path"  # every figure is within its limit

    @property
    def severity(self) -> int:
        """Larger is worse; 0 for `ON_PATH`."""
        return len(_BY_SEVERITY) - 1 - _BY_SEVERITY.index(self)


_BY_SEVERITY = list(Verdict)


class Direction(StrEnum):
    """Direction of a correction, in anatomical terms."""

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
        towards: direction of the correction.
    """

    amount: float
    towards: Direction


@dataclass(frozen=True, slots=True, kw_only=True)
class Lag:
    """How far the displayed tip may lag behind the real one.

    Attributes:
        speed_mm_s: speed of the tip in the vertebra plus two standard deviations; 0 at rest, NaN if not yet
            known.
        latency_ms: 99th percentile of the delay from exposure to display; NaN if not measured.
        margin_mm: product of both, rounded up; to be added to the 95 % error. NaN if either is not known.
    """

    speed_mm_s: float
    latency_ms: float
    margin_mm: float

    @classmethod
    def of(cls, speed_mm_s: float, latency_ms: float | None) -> "Lag":
        """Return the lag of a tip that moves at this speed."""
        known_ms = nan if latency_ms is None else latency_ms
        # A tip at rest does not lag, whatever the latency.
        margin_mm = 0.0 if speed_mm_s == 0.0 else rounded_up(speed_mm_s * known_ms / 1000.0)
        return cls(speed_mm_s=rounded_up(speed_mm_s, decimals=0), latency_ms=known_ms, margin_mm=margin_mm)


@dataclass(frozen=True, slots=True, kw_only=True)
class Assessment:
    """All figures of a drill and their verdict.

    Attributes:
        verdict: the most severe one that the figures imply.
        figures: by name.
        corrections: for an entry offset or angle over its limit, the larger component first. For the entry:
            the direction in which the drill's axis must move. For the angle: the direction to which the drill
            must point. For a wall that is near or would be breached: away from it, without an amount (NaN).
        wall: the nearest wall; None while the drill is outside the bone.
        end_wall: the wall nearest to the screw at the planned depth; None if the screw misses the pedicle.
        against: what the wall distance was measured against; None if nothing is known.
        lag: of a moving tip; None if not computed. Independent of the verdict.
        min_error_95_mm: the minimum value of the figure ERROR with this registration and tool for a drill on
            the channel (`registration_check.check_setup`); NaN if not known.
    """

    verdict: Verdict
    figures: Mapping[FigureName, Figure]
    corrections: tuple[Correction, ...] = ()
    wall: Wall | None = None
    end_wall: Wall | None = None
    against: WallSource | None = None
    lag: Lag | None = None
    min_error_95_mm: float = nan

    @property
    def setup_suffices(self) -> bool:
        """Return False if no image can have an error within its limit with this registration and tool."""
        return not _is_out_of_reach(self.figures[FigureName.ERROR], self.min_error_95_mm)

    @property
    def rank(self) -> tuple[float, float]:
        """Return the sort key of the drills in one image: more severe first, then nearer to the wall."""
        wall_mm = self.figures[FigureName.WALL].value
        return self.verdict.severity, -wall_mm if isfinite(wall_mm) else -inf


def assess(
    deviation: Deviation,
    analysis: DrillAnalysis | None,
    channel: Channel,
    limits: DrillLimits,
    *,
    min_error_95_mm: float = nan,
) -> Assessment:
    """Compute the figures of one drill in one image, compare them with their limits, and return the verdict.

    Args:
        deviation: of the drill from the channel.
        analysis: clearance and uncertainty; None if no pedicle is known. Then only the depth has a limit.
        channel: the planned channel.
        limits: those that are not part of a plan.
        min_error_95_mm: see `Assessment`.
    """
    figures = drill_figures(deviation, analysis, channel, limits)
    if analysis is None:
        is_deep = figures[FigureName.TO_GO].status is Status.THROUGH
        return Assessment(verdict=Verdict.TOO_DEEP if is_deep else Verdict.NOT_ASSESSED, figures=figures)
    clearance = analysis.clearance
    wall, end_wall = _wall_of(clearance.now), _wall_of(clearance.at_end)
    verdict = _verdict(figures, min_error_95_mm)
    return Assessment(
        verdict=verdict,
        figures=figures,
        corrections=_corrections(
            verdict, deviation, wall if wall is not None else _wall_of(clearance.lookahead), end_wall
        ),
        wall=wall,
        end_wall=end_wall,
        against=clearance.against,
        min_error_95_mm=min_error_95_mm,
    )


def _verdict(figures: Mapping[FigureName, Figure], min_error_95_mm: float) -> Verdict:
    def status(name: FigureName) -> Status:
        return figures[name].status

    if status(FigureName.WALL) is Status.THROUGH:
        return Verdict.THROUGH_WALL
    if status(FigureName.TO_GO) is Status.THROUGH:
        return Verdict.TOO_DEEP
    error = figures[FigureName.ERROR]
    # An infinite error means a drill across the channel, not uncertainty: its angle gives the verdict.
    is_uncertain = error.status is Status.OVER and isfinite(error.value)
    is_insufficient = is_uncertain and _is_out_of_reach(error, min_error_95_mm)
    for is_present, verdict in (
        (is_uncertain and not is_insufficient, Verdict.UNCERTAIN),
        (status(FigureName.RISK) is Status.OVER, Verdict.BREACH_LIKELY),
        (is_insufficient, Verdict.SETUP_INSUFFICIENT),
        (status(FigureName.WALL) is Status.OVER, Verdict.NEAR_WALL),
    ):
        if is_present:
            return verdict
    if (worse := _worse_of(figures)) is not None:
        return worse
    return Verdict.CORRECT_END if status(FigureName.END) is Status.OVER else Verdict.ON_PATH


def _is_out_of_reach(error: Figure, min_error_95_mm: float) -> bool:
    # False for NaN: if the minimum error is not known, a better view may reduce the error.
    return min_error_95_mm > error.limit


def _worse_of(figures: Mapping[FigureName, Figure]) -> Verdict | None:
    """Return which of entry and angle exceeds its limit by the larger factor; None if neither does."""
    entry, angle = figures[FigureName.ENTRY], figures[FigureName.ANGLE]
    over = {
        verdict: figure.value / max(figure.limit, 0.1)
        for verdict, figure in ((Verdict.CORRECT_ENTRY, entry), (Verdict.CORRECT_ANGLE, angle))
        if figure.status is Status.OVER
    }
    # The axis of a drill across the channel intersects the entry plane far away or never, so the angle
    # decides.
    if Verdict.CORRECT_ANGLE in over and angle.value > MAX_CORRECTED_DEG:
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
        # A drill across the channel needs reorientation, not a correction by degrees.
        if deviation.angle_deg > MAX_CORRECTED_DEG:
            return ()
        return _components(
            (deviation.angle_medial_deg, Direction.LATERAL, Direction.MEDIAL),
            (deviation.angle_cranial_deg, Direction.CAUDAL, Direction.CRANIAL),
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
    """Return corrections of errors, each given with its direction for a positive and a negative error."""
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


def _wall_of(closest: WallProximity) -> Wall | None:
    return closest.wall if isinstance(closest, NearestWall) else None
