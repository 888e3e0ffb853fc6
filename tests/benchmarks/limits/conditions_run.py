"""Measurement of every condition: search, tracking, other detectors, and the Cramer-Rao bound."""

import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from tests.benchmarks.limits.evaluation import Evaluation, Outcome, claim_of, evaluate
from tests.benchmarks.limits.finders import Searchers, tracker_of
from tests.benchmarks.limits.peers import Peer
from tests.benchmarks.scenes.bound import Bound, bound_of
from tests.benchmarks.scenes.conditions import BASE, Condition
from tests.benchmarks.scenes.faces import FACES
from tests.benchmarks.scenes.hand import hand_scenes
from tests.benchmarks.scenes.placement import empty_scene, random_scene
from tests.benchmarks.scenes.rigs import Rig
from tests.benchmarks.scenes.scene import image_of

# A sequence begins with two undisturbed images, then the condition begins.
UNDISTURBED_IMAGES, DISTURBED_IMAGES = 2, 4
SCENES_FOR_A_SEQUENCE = 4
MAX_BOUNDS = 12


@dataclass(slots=True)
class ConditionRun:
    """All results of one camera in one condition.

    Attributes:
        searched: by `Tracker.search`, one for each scene.
        faces: name of the marker of each scene.
        bounds: of the first scenes; none where the image model of the bound does not hold.
        stepped: by `Tracker.step`, the images after the condition has set in.
        peers: by name, one for each scene, with their own markers at the same poses.
    """

    rig: str
    condition: str
    searched: list[Evaluation] = field(default_factory=list)
    faces: list[str] = field(default_factory=list)
    bounds: list[Bound] = field(default_factory=list)
    stepped: list[Evaluation] = field(default_factory=list)
    peers: dict[str, list[Evaluation]] = field(default_factory=dict)

    @property
    def of_bound(self) -> list[float]:
        """Return the tip errors of correct claims, divided by the bound of the same scene."""
        return [
            one.errors["tip_mm"] / bound.tip_mm
            for one, bound in zip(self.searched, self.bounds, strict=False)
            if one.outcome is Outcome.CORRECT
        ]


def measure_condition(
    rig: Rig,
    condition: Condition,
    *,
    peers: Sequence[Peer],
    searchers: Searchers,
    count: int,
    seed: int,
    with_tracking: bool = True,
    max_bounds: int = MAX_BOUNDS,
) -> ConditionRun:
    """Measure `count` scenes, with alternating faces."""
    run = ConditionRun(rig=rig.name, condition=condition.name, peers={peer.name: [] for peer in peers})
    for number in range(count):
        face = FACES[number % len(FACES)]
        scene = random_scene(rig, face, condition, seed=seed + number)
        run.faces.append(face.name)
        run.searched.append(evaluate(scene, searchers.claim(scene)))
        if number < max_bounds and has_bound(condition):
            run.bounds.append(bound_of(scene))
        for peer in peers:
            own = random_scene(rig, peer.face, condition, seed=seed + number)
            run.peers[peer.name].append(evaluate(own, peer.search(own.rig, image_of(own))))
    if with_tracking and can_begin_while_tracking(condition):
        sequences = max(1, count // SCENES_FOR_A_SEQUENCE)
        run.stepped = measure_tracking(rig, condition, sequences=sequences, seed=seed)
    return run


def has_bound(condition: Condition) -> bool:
    """Return whether the bound's linear camera model applies."""
    return condition.gamma == BASE.gamma


def can_begin_while_tracking(condition: Condition) -> bool:
    """Return whether the condition can begin during tracking; lens, gamma and tilt cannot."""
    return condition.tilt_deg == BASE.tilt_deg and not condition.has_bent_lens and has_bound(condition)


def measure_tracking(rig: Rig, condition: Condition, *, sequences: int, seed: int) -> list[Evaluation]:
    """Return the results of `Tracker.step` after the condition has begun.

    A hand that is still, because the condition brings its own motion. Each condition has poses of its own,
    because a sequence looks at one pose alone.
    """
    own = seed + zlib.crc32(condition.name.encode()) % 10_000
    return [one for nth in range(sequences) for one in _tracked(rig, condition, own, nth)]


def _tracked(rig: Rig, condition: Condition, seed: int, nth: int) -> Iterator[Evaluation]:
    face = FACES[nth % len(FACES)]
    tracker = tracker_of(rig, [face])
    scenes = hand_scenes(
        rig,
        face,
        "still",
        seed=seed + nth,
        count=UNDISTURBED_IMAGES + DISTURBED_IMAGES,
        condition=condition,
        undisturbed_images=UNDISTURBED_IMAGES,
    )
    for number, (at_s, scene) in enumerate(scenes):
        sighting = tracker.step(image_of(scene), captured_at_s=at_s)[face.name]
        if number >= UNDISTURBED_IMAGES:
            yield evaluate(scene, claim_of(sighting))


def measure_empty(rig: Rig, *, peers: Sequence[Peer], count: int, seed: int) -> dict[str, list[Evaluation]]:
    """Search images without a marker; the tracker searches for all faces at once."""
    tracker = tracker_of(rig, FACES)
    found: dict[str, list[Evaluation]] = {"coaxial": [], **{peer.name: [] for peer in peers}}
    for number in range(count):
        scene = empty_scene(rig, seed=seed + number)
        image = image_of(scene)
        found["coaxial"] += [evaluate(scene, claim_of(one)) for one in tracker.search(image).values()]
        for peer in peers:
            found[peer.name].append(evaluate(scene, peer.search(rig, image)))
    return found
