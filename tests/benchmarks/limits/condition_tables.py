"""Tables by condition: detection, tracking, accuracy, and coverage of the stated covariance."""

from collections.abc import Callable, Iterable, Sequence
from functools import partial

from tests.benchmarks.figures import interval
from tests.benchmarks.limits import goals
from tests.benchmarks.limits.conditions_run import ConditionRun
from tests.benchmarks.limits.evaluation import COVERED, Evaluation, Outcome
from tests.benchmarks.limits.peers import APRILTAG_ABSENT
from tests.benchmarks.limits.run import LimitsRun
from tests.benchmarks.scenes.bound import PARAMETERS
from tests.benchmarks.tables import NOTHING, Table, median, number, pair

PEERS = ("cv2.aruco", "AprilTag")
# One of twenty, in standard deviations.
TWO_SD = 1.96


def condition_tables(run: LimitsRun) -> list[Table]:
    """Return all tables by condition."""
    tables = []
    for rig, some in run.conditions.items():
        tables += [_found_table(rig, some, run), _tip_table(rig, some, run)]
    return [*tables, _parameter_table(run), _coverage_table(run), _face_table(run)]


def right(judgements: Iterable[Evaluation]) -> int:
    """Return the number of correct claims."""
    return sum(one.outcome is Outcome.CORRECT for one in judgements)


def wrong(judgements: Iterable[Evaluation]) -> int:
    """Return the number of false claims."""
    return sum(one.outcome is Outcome.WRONG for one in judgements)


def errors(judgements: Iterable[Evaluation], parameter: str) -> list[float]:
    """Return the error sizes of the correct claims."""
    return [one.errors[parameter] for one in judgements if one.outcome is Outcome.CORRECT]


def of(part: int, judgements: Sequence[Evaluation]) -> str:
    """Format a proportion with three digits; a dash for zero images."""
    return f"{part / len(judgements):.3f}" if judgements else NOTHING


def _found_table(rig: str, some: Sequence[ConditionRun], run: LimitsRun) -> Table:
    rows = [
        [
            one.condition,
            str(len(one.searched)),
            of(right(one.searched), one.searched),
            _goal(goals.FOUND[rig].get(one.condition)),
            *(_peer(run, one, name, lambda judgements: of(right(judgements), judgements)) for name in PEERS),
            str(len(one.stepped)) if one.stepped else NOTHING,
            of(right(one.stepped), one.stepped),
            _goal(goals.TRACKED.get(one.condition)),
            str(wrong(one.searched) + wrong(one.stepped)),
            " / ".join(_peer(run, one, name, lambda judgements: str(wrong(judgements))) for name in PEERS),
            str(sum(evaluate.is_mirrored for evaluate in (*one.searched, *one.stepped))),
        ]
        for one in some
    ]
    return Table(
        title=f"Found, camera {rig}",
        columns=[
            "condition",
            "n",
            "found by search",
            "goal",
            *PEERS,
            "n tracked",
            "tracked by step",
            "goal",
            "wrong",
            "wrong, peers",
            "mirrored",
        ],
        rows=rows,
    )


def _tip_table(rig: str, some: Sequence[ConditionRun], run: LimitsRun) -> Table:
    rows = [
        [
            one.condition,
            str(right(one.searched)),
            pair(errors(one.searched, "tip_mm"), 95.0, 3),
            number(median(bound.tip_mm for bound in one.bounds), 3),
            f"{number(median(one.of_bound))} ({len(one.of_bound)})" if one.of_bound else NOTHING,
            _tip_goal(rig, one.condition),
            *(_peer(run, one, name, _tip) for name in PEERS),
            pair(errors(one.stepped, "tip_mm"), 95.0, 3),
        ]
        for one in some
    ]
    return Table(
        title=f"Error of the tip in mm, 120 mm from the marker, camera {rig}: median / 95th percentile",
        columns=[
            "condition",
            "n found",
            "search",
            "bound, median",
            "search by bound (n)",
            "goal",
            *PEERS,
            "step",
        ],
        rows=rows,
    )


def _tip_goal(rig: str, condition: str) -> str:
    if condition == "gamma2.2":
        return f"{goals.GAMMA_TIP_MM[rig]:g} mm"
    return _goal(goals.TIP_OF_BOUND.get(condition))


def _parameter_table(run: LimitsRun) -> Table:
    bases = [one for some in run.conditions.values() for one in some if one.condition == "base"]
    rows = [
        [
            f"{one.rig} {parameter.replace('_', ' ')}",
            pair(errors(one.searched, parameter), 95.0, 4),
            number(median(getattr(bound, parameter) for bound in one.bounds), 4),
            *(_peer(run, one, name, partial(_sizes, parameter=parameter)) for name in PEERS),
        ]
        for one in bases
        for parameter in PARAMETERS
    ]
    return Table(
        title="Errors by parameter at base: median / 95th percentile",
        columns=["camera, parameter", "search", "bound, median", *PEERS],
        rows=rows,
    )


def _coverage_table(run: LimitsRun) -> Table:
    rows = [
        [f"{rig} {name}", str(len(some)), *coverage(some)]
        for rig in run.conditions
        for name, some in coverage_groups(run, rig)
    ]
    return Table(
        title="Errors inside their stated 95 % ellipsoid",
        columns=["camera, condition", "n", *COVERED],
        rows=rows,
        note=f"Goal {goals.COVERED[0]:g} to {goals.COVERED[1]:g}; in brackets where the true share lies in "
        "19 of 20 such runs, if images were independent, which those of a sequence (step, hands) are not.",
    )


def coverage_groups(run: LimitsRun, rig: str) -> list[tuple[str, list[Evaluation]]]:
    """Return the claims with a covariance: by kind of condition, of all searches, steps and hands."""
    some, by_kind = run.conditions[rig], dict[str, list[Evaluation]]()
    for one in some:
        by_kind.setdefault(_kind(one.condition), []).extend(one.searched)
    groups = list(by_kind.items())
    groups += [
        ("all, search", [each for one in some for each in one.searched]),
        ("all, step", [each for one in some for each in one.stepped]),
        ("hands", [each for one in run.hands if one.rig == rig for each in one.stepped]),
    ]
    return [(name, stated(judgements)) for name, judgements in groups if stated(judgements)]


def _kind(condition: str) -> str:
    """Return the condition without its step: "noise" of "noise16"."""
    return condition.rstrip("0123456789.-")


def stated(judgements: Iterable[Evaluation]) -> list[Evaluation]:
    """Return the correct claims with a covariance."""
    return [one for one in judgements if one.covered]


def coverage(judgements: Iterable[Evaluation]) -> list[str]:
    """Return the coverage of translation, rotation and tip, with its interval."""
    some, texts = stated(judgements), []
    for number_of in range(len(COVERED)):
        inside = sum(one.covered[number_of] for one in some)
        low, high = interval(inside, len(some), TWO_SD)
        texts.append(f"{inside / len(some):.3f} ({low:.2f}-{high:.2f})")
    return texts


def _face_table(run: LimitsRun) -> Table:
    rows = []
    for rig, some in run.conditions.items():
        for face in sorted({name for one in some for name in one.faces}):
            pairs = [
                (one, number_of) for one in some for number_of, name in enumerate(one.faces) if name == face
            ]
            own = [one.searched[number_of] for one, number_of in pairs]
            by_bound = [
                one.searched[number_of].errors["tip_mm"] / one.bounds[number_of].tip_mm
                for one, number_of in pairs
                if number_of < len(one.bounds) and one.searched[number_of].outcome is Outcome.CORRECT
            ]
            mirrored = sum(one.is_mirrored for one in own)
            rows.append(
                [
                    f"{rig} {face}",
                    str(len(own)),
                    of(right(own), own),
                    f"{number(median(by_bound))} ({len(by_bound)})",
                    str(wrong(own)),
                    str(mirrored),
                ]
            )
    return Table(
        title="By marker, all conditions, search",
        columns=["camera, marker", "n", "found", "tip by bound, median (n)", "wrong", "mirrored"],
        rows=rows,
    )


def _goal(value: float | None) -> str:
    return NOTHING if value is None else f"{value:g}"


def _tip(judgements: Sequence[Evaluation]) -> str:
    return pair(errors(judgements, "tip_mm"), 95.0, 2)


def _sizes(judgements: Sequence[Evaluation], parameter: str) -> str:
    return pair(errors(judgements, parameter), 95.0, 4)


def _peer(run: LimitsRun, one: ConditionRun, name: str, text: Callable[[Sequence[Evaluation]], str]) -> str:
    """Format a peer's column, or that the peer is not installed."""
    return text(one.peers[name]) if name in run.peers else APRILTAG_ABSENT
