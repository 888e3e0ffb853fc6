"""Tracking under occlusion, highlights and fast motion; `make benchmark` measures the rates."""

import pytest

from tests.benchmarks.limits.conditions_run import measure_tracking
from tests.benchmarks.limits.evaluation import Outcome, claim_of, evaluate
from tests.benchmarks.limits.finders import tracker_of
from tests.benchmarks.scenes.conditions import conditions_of
from tests.benchmarks.scenes.faces import FACES
from tests.benchmarks.scenes.hand import hand_scenes
from tests.benchmarks.scenes.placement import random_scene
from tests.benchmarks.scenes.rigs import RIGS
from tests.benchmarks.scenes.scene import image_of
from tests.tracker.levels import SEED

CONDITIONS = (("A", "cover30"), ("A", "glare1.6"), ("A", "shadow0.8"), ("B", "cover30"))
# Images of a hand at 300 mm/s.
IMAGES_OF_A_HAND = 20


@pytest.mark.parametrize(("rig", "condition"), CONDITIONS, ids=map(" ".join, CONDITIONS))
def test_a_marker_that_was_found_is_kept(rig: str, condition: str) -> None:
    harder = conditions_of(RIGS[rig])[condition]
    images = measure_tracking(RIGS[rig], harder, sequences=1, seed=SEED)
    assert [one.outcome for one in images] == [Outcome.CORRECT] * len(images)


def test_a_marker_under_a_finger_is_found_where_others_are_looked_for_too() -> None:
    for number, face in enumerate(FACES):
        scene = random_scene(RIGS["A"], face, conditions_of(RIGS["A"])["cover20"], seed=800 + number)
        sightings = tracker_of(RIGS["A"], FACES).step(image_of(scene), captured_at_s=0.0)
        assert evaluate(scene, claim_of(sightings[face.name])).outcome is Outcome.CORRECT


def test_a_fast_hand_is_followed() -> None:
    face = FACES[0]
    tracker = tracker_of(RIGS["A"], [face])
    for at_s, scene in hand_scenes(RIGS["A"], face, "fast", seed=SEED, count=IMAGES_OF_A_HAND):
        sighting = tracker.step(image_of(scene), captured_at_s=at_s)[face.name]
        assert evaluate(scene, claim_of(sighting)).outcome is Outcome.CORRECT
