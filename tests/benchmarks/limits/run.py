"""All measurements of one run, in order."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import cv2

from tests.benchmarks.limits.conditions_run import ConditionRun, measure_condition, measure_empty
from tests.benchmarks.limits.evaluation import Evaluation
from tests.benchmarks.limits.finders import Searchers, warm
from tests.benchmarks.limits.first_image import FirstImage, measure_first_images
from tests.benchmarks.limits.pace import HandRun, PaceRun, measure_hands, measure_pace
from tests.benchmarks.limits.peers import Peer, peers
from tests.benchmarks.limits.returning import ReturnRun, measure_returns
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.scenes.conditions import Condition, conditions_of
from tests.benchmarks.scenes.faces import SAIL
from tests.benchmarks.scenes.rigs import RIGS, Rig
from tracker.errors import InvalidInput


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitsRun:
    """Results of a run; what was not requested is empty.

    Attributes:
        peers: names of the other finders that took part.
        conditions: by camera, then by condition.
        empty: by camera, then by finder: the images without a marker.
    """

    peers: Sequence[str]
    conditions: dict[str, list[ConditionRun]]
    hands: list[HandRun]
    paces: list[PaceRun]
    returns: list[ReturnRun]
    empty: dict[str, dict[str, list[Evaluation]]]
    first_images: list[FirstImage]


def measure(options: BenchmarkOptions) -> LimitsRun:
    """Measure everything, or the named conditions alone.

    Raises:
        InvalidInput: BENCHMARK_CONDITION_UNKNOWN, BENCHMARK_RIG_UNKNOWN.
    """
    chosen = {rig.name: _selected_conditions(options, rig) for rig in _rigs(options)}
    others, searchers, is_complete = peers(), Searchers(), not options.conditions
    with one_thread():
        for name in chosen:
            warm(RIGS[name], SAIL)
        conditions = {
            name: [_measure_logged(options, RIGS[name], one, others, searchers) for one in some]
            for name, some in chosen.items()
        }
        hands = [
            run
            for name in chosen
            if is_complete
            for run in measure_hands(RIGS[name], others, count=5 * options.images, seed=options.seed)
        ]
        paces = measure_pace(others, count=options.images, seed=options.seed) if is_complete else []
        returns = [
            run
            for name in chosen
            if is_complete
            for run in measure_returns(RIGS[name], count=options.images, seed=options.seed)
        ]
        empty = {
            name: measure_empty(RIGS[name], peers=others, count=2 * options.images, seed=options.seed)
            for name in chosen
            if is_complete
        }
        first_images = measure_first_images(options.rigs) if is_complete else []
    return LimitsRun(
        peers=[peer.name for peer in others],
        conditions=conditions,
        hands=hands,
        paces=paces,
        returns=returns,
        empty=empty,
        first_images=first_images,
    )


@contextmanager
def one_thread() -> Iterator[None]:
    """Run OpenCV with one thread, so that ratios compare work and not cores."""
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        yield
    finally:
        cv2.setNumThreads(threads)


def _measure_logged(
    options: BenchmarkOptions, rig: Rig, condition: Condition, others: Sequence[Peer], searchers: Searchers
) -> ConditionRun:
    """Measure a condition, and log its name to standard error: all of them take minutes."""
    sys.stderr.write(f"limits: {rig.name} {condition.name}\n")
    return measure_condition(
        rig, condition, peers=others, searchers=searchers, count=options.images, seed=options.seed
    )


def _rigs(options: BenchmarkOptions) -> list[Rig]:
    unknown = sorted(set(options.rigs) - set(RIGS))
    if unknown or not options.rigs:
        raise InvalidInput(
            "BENCHMARK_RIG_UNKNOWN",
            f"no such cameras: {', '.join(unknown) or 'none named'}",
            f"Name some of {', '.join(RIGS)}, as in --rigs AB.",
        )
    return [RIGS[name] for name in dict.fromkeys(options.rigs)]


def _selected_conditions(options: BenchmarkOptions, rig: Rig) -> list[Condition]:
    """Return the requested conditions of this camera; blur and motion steps differ by camera."""
    known = conditions_of(rig)
    everywhere = {name for one in RIGS.values() for name in conditions_of(one)}
    unknown = [name for name in options.conditions if name not in everywhere]
    if unknown:
        raise InvalidInput(
            "BENCHMARK_CONDITION_UNKNOWN",
            f"no such conditions: {', '.join(unknown)}",
            f"Name some of {', '.join(sorted(everywhere))}.",
        )
    return [known[name] for name in options.conditions or known if name in known]
