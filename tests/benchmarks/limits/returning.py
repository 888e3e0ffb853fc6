"""Number of images until `Tracker.step` finds a marker that comes back into view."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from tests.benchmarks.limits.evaluation import Evaluation, claim_of, evaluate
from tests.benchmarks.limits.finders import tracker_of
from tests.benchmarks.scenes.conditions import conditions_of
from tests.benchmarks.scenes.faces import FACES
from tests.benchmarks.scenes.hand import RATE_HZ
from tests.benchmarks.scenes.placement import empty_scene, random_scene
from tests.benchmarks.scenes.rigs import Rig
from tests.benchmarks.scenes.scene import image_of

CONDITIONS = ("base", "cover10", "hard1", "hard2")
# Images without the marker, of the first scene and of the others in turn, so that any search phase occurs.
MIN_EMPTY_IMAGES, PHASES = 2, 16
MAX_IMAGES = 32


@dataclass(slots=True)
class ReturnRun:
    """A marker that comes back, held still, in scenes of one condition.

    Attributes:
        rig, condition: names.
        images: for each scene the number of images until it was seen, 1 for the first one; more than
            `MAX_IMAGES` if it was not.
        claims: the first sighting in each scene with one.
    """

    rig: str
    condition: str
    images: list[int] = field(default_factory=list)
    claims: list[Evaluation] = field(default_factory=list)


def measure_returns(
    rig: Rig, *, count: int, seed: int, conditions: Sequence[str] = CONDITIONS
) -> Iterator[ReturnRun]:
    """Measure `count` scenes of each condition."""
    for name in conditions:
        run = ReturnRun(rig=rig.name, condition=name)
        for number in range(count):
            _measure_return(run, rig, number, seed=seed + number)
        yield run


def _measure_return(run: ReturnRun, rig: Rig, number: int, *, seed: int) -> None:
    face = FACES[number % len(FACES)]
    there = random_scene(rig, face, conditions_of(rig)[run.condition], seed=seed)
    away = empty_scene(rig, seed=seed)
    tracker = tracker_of(there.rig, [face])
    empty_images = MIN_EMPTY_IMAGES + number % PHASES
    for image_number in range(empty_images + MAX_IMAGES):
        scene = away if image_number < empty_images else there
        image = image_of(replace(scene, noise_seed=(*scene.noise_seed, image_number)))
        claim = claim_of(tracker.step(image, captured_at_s=image_number / RATE_HZ)[face.name])
        if claim is not None and scene is there:
            run.images.append(image_number - empty_images + 1)
            run.claims.append(evaluate(there, claim))
            return
    run.images.append(MAX_IMAGES + 1)
