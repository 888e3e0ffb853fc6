"""Small images with one marker, and the tracker's confidence in wrong poses."""

from collections.abc import Callable, Iterable, Iterator, Mapping

import numpy as np
import numpy.typing as npt

from tests.benchmarks.limits.evaluation import Evaluation, Outcome, claim_of, evaluate
from tests.benchmarks.scenes.faces import FACES, Face
from tests.benchmarks.scenes.placement import posed
from tests.benchmarks.scenes.rigs import Rig
from tests.benchmarks.scenes.scene import Pose, Scene
from tracker import Sighting, Tracker

RIG = Rig(name="small image", size_wh_px=(448, 336), focal_px=1028.0, depth_mm=(300.0, 1600.0))
SIDES_PX = (16.0, 20.0, 24.0, 27.0, 32.0, 40.0, 60.0, 80.0)
COVER_GREYS = (15, 50, 110, 175, 205)

Image = npt.NDArray[np.uint8]
Shown = Iterator[tuple[Scene, Sighting]]
Trackers = Mapping[str, Tracker]


def trackers_by_face() -> Trackers:
    return {face.name: Tracker(camera=RIG.camera, models=[face.model]) for face in FACES}


def pose_of(random: np.random.Generator, side_px: float, tilt_deg: tuple[float, float]) -> Pose:
    """A pose anywhere in the image with all of its paper visible, about this wide."""
    edge = 1.1 * side_px + 15.0
    at_px = random.uniform([edge, edge], np.array(RIG.size_wh_px) - edge)
    return posed(
        RIG.sight_through(at_px) * RIG.focal_px * 25.0 / side_px,
        tilt_deg=random.uniform(*tilt_deg),
        about_deg=random.uniform(0.0, 360.0),
        roll_deg=random.uniform(-180.0, 180.0),
    )


def judged_by_seed(
    shown: Callable[[int, Face, Trackers], Shown], seeds: Iterable[int], trackers: Trackers
) -> list[tuple[int, Evaluation]]:
    """Evaluation of each image with its scene's seed; fails for a wrong claim."""
    found = []
    for seed in seeds:
        for scene, sighting in shown(seed, FACES[seed % len(FACES)], trackers):
            one = evaluate(scene, claim_of(sighting))
            assert one.outcome is not Outcome.WRONG
            found.append((seed, one))
    return found


def worst_by_seed(found: list[tuple[int, Evaluation]], *, over_sd2: float) -> dict[int, float]:
    """The largest squared error in units of the stated one, by seed, if it exceeds this."""
    worst: dict[int, float] = {}
    for seed, one in found:
        worst[seed] = max(worst.get(seed, 0.0), *one.mahalanobis_squared, 0.0)
    return {seed: sd2 for seed, sd2 in worst.items() if sd2 > over_sd2}
