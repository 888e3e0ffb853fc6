"""Time of search and step by resolution and by number of markers, as ratios image by image."""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from tests.benchmarks.limits.evaluation import Evaluation, claim_of, evaluate
from tests.benchmarks.limits.finders import tracker_of, warm
from tests.benchmarks.limits.peers import Peer
from tests.benchmarks.scenes.faces import ANVIL, CODE, FACES, ORBIT, SAIL
from tests.benchmarks.scenes.hand import RATE_HZ, SPEEDS, hand_scenes
from tests.benchmarks.scenes.placement import crowded_scene, empty_scene
from tests.benchmarks.scenes.rigs import RIG_A, RIG_B, RIG_HD, RIG_VGA, Rig
from tests.benchmarks.scenes.scene import Scene, image_of

RIGS_BY_SIZE = (RIG_VGA, RIG_A, RIG_HD, RIG_B)
FOUR = (SAIL, ORBIT, CODE, ANVIL)
# Known markers, and markers in view.
LOADS = ((1, 1), (1, 0), (4, 1), (4, 4))
# Until all is found, and some more: with a marker out of view, as many as the parts of an idle search.
STEPS_OF_A_SCENE, IDLE_STEPS_OF_A_SCENE = 6, 17


@dataclass(slots=True)
class PaceRun:
    """Times in ms of the same images, one thread.

    Attributes:
        rig: whose images.
        known, in_view: markers.
        search_ms, step_ms: of the tracker; step after a first image in which it found what is there.
        peers_ms: by name, of the images that were searched.
        by_step_ms: of the first peer, of the images that were stepped.
    """

    rig: Rig
    known: int
    in_view: int
    search_ms: list[float] = field(default_factory=list)
    step_ms: list[float] = field(default_factory=list)
    peers_ms: dict[str, list[float]] = field(default_factory=dict)
    by_step_ms: list[float] = field(default_factory=list)


def elapsed_ms(work: Callable[[], object]) -> float:
    """Return the duration of a call."""
    started = time.perf_counter()
    work()
    return (time.perf_counter() - started) * 1e3


def measure_pace(peers: Sequence[Peer], *, count: int, seed: int) -> list[PaceRun]:
    """Measure every resolution with every load, `count` scenes each; peers and tracker alternate."""
    runs = []
    for rig in RIGS_BY_SIZE:
        warm(rig, SAIL)
        for known, in_view in LOADS:
            run = PaceRun(rig=rig, known=known, in_view=in_view, peers_ms={peer.name: [] for peer in peers})
            for number in range(count):
                own = seed + number
                scene = (
                    crowded_scene(rig, FOUR[:in_view], seed=own) if in_view else empty_scene(rig, seed=own)
                )
                _pace_of(run, scene, peers)
            runs.append(run)
    return runs


def _pace_of(run: PaceRun, scene: Scene, peers: Sequence[Peer]) -> None:
    tracker = tracker_of(run.rig, FOUR[: run.known])
    image = image_of(scene)
    for peer in peers:
        run.peers_ms[peer.name].append(elapsed_ms(partial(peer.detect, image)))
    run.search_ms.append(elapsed_ms(partial(tracker.search, image)))
    tracker.step(image, captured_at_s=0.0)
    for number in range(1, IDLE_STEPS_OF_A_SCENE if run.in_view < run.known else STEPS_OF_A_SCENE):
        image = image_of(replace(scene, noise_seed=(*scene.noise_seed, number)))
        run.by_step_ms.append(elapsed_ms(partial(peers[0].detect, image)))
        run.step_ms.append(elapsed_ms(partial(tracker.step, image, captured_at_s=number / RATE_HZ)))


@dataclass(slots=True)
class HandRun:
    """A moving marker, tracked by `Tracker.step` from the second image on.

    Attributes:
        rig, speed: by what camera, and how fast.
        stepped: image by image.
        ratios: time of the step by that of the first peer in the same image.
    """

    rig: str
    speed: str
    stepped: list[Evaluation] = field(default_factory=list)
    ratios: list[float] = field(default_factory=list)


def measure_hands(rig: Rig, peers: Sequence[Peer], *, count: int, seed: int) -> Iterator[HandRun]:
    """Measure each speed with each face, `count` images in all."""
    for speed in SPEEDS:
        run = HandRun(rig=rig.name, speed=speed)
        for nth, face in enumerate(FACES):
            tracker = tracker_of(rig, [face])
            scenes = hand_scenes(rig, face, speed, seed=seed + nth, count=count // len(FACES) + 1)
            for number, (at_s, scene) in enumerate(scenes):
                image = image_of(scene)
                started = time.perf_counter()
                sighting = tracker.step(image, captured_at_s=at_s)[face.name]
                step_ms = (time.perf_counter() - started) * 1e3
                if number:
                    run.ratios.append(step_ms / elapsed_ms(partial(peers[0].detect, image)))
                    run.stepped.append(evaluate(scene, claim_of(sighting)))
        yield run
