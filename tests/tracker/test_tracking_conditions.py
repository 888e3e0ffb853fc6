"""Tracking under occlusion, highlights and fast motion, among similar shapes."""

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
from tests.tracker.levels import SEED, Level

# By step, after the condition has set in.
TRACKED = {
    ("A", "cover10"): Level(0.99, 0.99),
    ("A", "cover30"): Level(0.99, 0.99),
    ("A", "glare1.6"): Level(0.99, 0.99),
    ("A", "shadow0.8"): Level(0.99, 0.99),
    ("B", "cover30"): Level(0.99, 0.99),
    ("B", "glare1.6"): Level(0.99, 0.99),
}
SEQUENCES = 6
# By step, a hand at 300 mm/s.
FOUND_IN_FAST_HAND, IMAGES_OF_A_HAND = Level(0.99, 0.99), 20
COVERED_AMONG_OTHERS = 12


@pytest.mark.parametrize(("rig", "condition"), TRACKED, ids=map(" ".join, TRACKED))
def test_a_marker_that_was_found_is_kept(rig: str, condition: str) -> None:
    harder = conditions_of(RIGS[rig])[condition]
    images = measure_tracking(RIGS[rig], harder, sequences=SEQUENCES, seed=SEED)
    assert [one for one in images if one.outcome is Outcome.WRONG] == []
    found = sum(one.outcome is Outcome.CORRECT for one in images)
    assert found >= TRACKED[rig, condition].asserted * len(images)


def test_a_marker_under_a_finger_is_found_where_others_are_looked_for_too() -> None:
    found = []
    for number in range(COVERED_AMONG_OTHERS):
        face = FACES[number % len(FACES)]
        scene = random_scene(RIGS["A"], face, conditions_of(RIGS["A"])["cover20"], seed=800 + number)
        sightings = tracker_of(RIGS["A"], FACES).step(image_of(scene), captured_at_s=0.0)
        found.append(evaluate(scene, claim_of(sightings[face.name])).outcome is Outcome.CORRECT)
    assert sum(found) >= COVERED_AMONG_OTHERS - 1


def test_a_fast_hand_is_followed() -> None:
    images = []
    for nth, face in enumerate(FACES):
        tracker = tracker_of(RIGS["A"], [face])
        for at_s, scene in hand_scenes(RIGS["A"], face, "fast", seed=SEED + nth, count=IMAGES_OF_A_HAND):
            sighting = tracker.step(image_of(scene), captured_at_s=at_s)[face.name]
            images.append(evaluate(scene, claim_of(sighting)))
    assert [one for one in images if one.outcome is Outcome.WRONG] == []
    found = sum(one.outcome is Outcome.CORRECT for one in images)
    assert found >= FOUND_IN_FAST_HAND.asserted * len(images)
