"""All measurements of one run, in order."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import cv2

from tests.benchmarks.asked import Asked
from tests.benchmarks.limits.conditions_run import ConditionRun, measure_condition, measure_empty
from tests.benchmarks.limits.finders import Searchers, warm
from tests.benchmarks.limits.first_image import FirstImage, measure_first_images
from tests.benchmarks.limits.judging import Judged
from tests.benchmarks.limits.pace import HandRun, PaceRun, measure_hands, measure_pace
from tests.benchmarks.limits.peers import Peer, peers
from tests.benchmarks.scenes.conditions import Condition, conditions_of
from tests.benchmarks.scenes.faces import SAIL
from tests.benchmarks.scenes.rigs import RIGS, Rig
from tracker.errors import InvalidInput


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitsRun:
    """What was measured; what was not asked for is empty.

    Attributes:
        peers: names of the other finders that took part.
        conditions: by camera, then by condition.
        empty: by camera, then by finder: the images without a marker.
    """

    peers: Sequence[str]
    conditions: dict[str, list[ConditionRun]]
    hands: list[HandRun]
    paces: list[PaceRun]
    empty: dict[str, dict[str, list[Judged]]]
    first_images: list[FirstImage]


def measure(asked: Asked) -> LimitsRun:
    """Everything, or the named conditions alone.

    Raises:
        InvalidInput: BENCHMARK_CONDITION_UNKNOWN, BENCHMARK_RIG_UNKNOWN.
    """
    chosen = {rig.name: _chosen(asked, rig) for rig in _rigs(asked)}
    others, searchers, is_whole = peers(), Searchers(), not asked.conditions
    with one_thread():
        for name in chosen:
            warm(RIGS[name], SAIL)
        conditions = {
            name: [_told(asked, RIGS[name], one, others, searchers) for one in some]
            for name, some in chosen.items()
        }
        hands = [
            run
            for name in chosen
            if is_whole
            for run in measure_hands(RIGS[name], others, count=5 * asked.images, seed=asked.seed)
        ]
        paces = measure_pace(others, count=asked.images, seed=asked.seed) if is_whole else []
        empty = {
            name: measure_empty(RIGS[name], peers=others, count=2 * asked.images, seed=asked.seed)
            for name in chosen
            if is_whole
        }
        first_images = measure_first_images(asked.rigs) if is_whole else []
    return LimitsRun(
        peers=[peer.name for peer in others],
        conditions=conditions,
        hands=hands,
        paces=paces,
        empty=empty,
        first_images=first_images,
    )


@contextmanager
def one_thread() -> Iterator[None]:
    """OpenCV with one thread, so that ratios compare work and not cores."""
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        yield
    finally:
        cv2.setNumThreads(threads)


def _told(
    asked: Asked, rig: Rig, condition: Condition, others: Sequence[Peer], searchers: Searchers
) -> ConditionRun:
    """A condition, said on standard error, because all of them take minutes."""
    sys.stderr.write(f"limits: {rig.name} {condition.name}\n")
    return measure_condition(
        rig, condition, peers=others, searchers=searchers, count=asked.images, seed=asked.seed
    )


def _rigs(asked: Asked) -> list[Rig]:
    unknown = sorted(set(asked.rigs) - set(RIGS))
    if unknown or not asked.rigs:
        raise InvalidInput(
            "BENCHMARK_RIG_UNKNOWN",
            f"no such cameras: {', '.join(unknown) or 'none named'}",
            f"Name some of {', '.join(RIGS)}, as in --rigs AB.",
        )
    return [RIGS[name] for name in dict.fromkeys(asked.rigs)]


def _chosen(asked: Asked, rig: Rig) -> list[Condition]:
    """The conditions of this camera that were asked for; blur and motion have other steps on another one."""
    known = conditions_of(rig)
    everywhere = {name for one in RIGS.values() for name in conditions_of(one)}
    unknown = [name for name in asked.conditions if name not in everywhere]
    if unknown:
        raise InvalidInput(
            "BENCHMARK_CONDITION_UNKNOWN",
            f"no such conditions: {', '.join(unknown)}",
            f"Name some of {', '.join(sorted(everywhere))}.",
        )
    return [known[name] for name in asked.conditions or known if name in known]
