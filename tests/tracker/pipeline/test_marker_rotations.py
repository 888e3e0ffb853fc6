"""A marker with near quarter-turn symmetry, where a highlight makes its rotation ambiguous."""

from dataclasses import replace

import numpy as np
import pytest

from tests.benchmarks.limits.evaluation import Outcome, claim_of, evaluate
from tests.benchmarks.limits.finders import tracker_of
from tests.benchmarks.scenes.conditions import BASE, conditions_of
from tests.benchmarks.scenes.faces import Face, circle
from tests.benchmarks.scenes.placement import random_scene
from tests.benchmarks.scenes.rigs import RIGS
from tests.benchmarks.scenes.scene import image_of
from tests.tracker.scenes import seen
from tracker.pipeline.fitter import Fitter
from tracker.pose import Unseen, UnseenReason, differ_by_rotation

RINGS = Face(
    name="rings",
    white=(circle(0.5, 0.5, 0.40), circle(0.5, 0.5, 0.12)),
    black=(circle(0.54, 0.47, 0.27),),
)
MOONS = Face(
    name="moons",
    white=(circle(0.5, 0.5, 0.40), circle(0.53, 0.5, 0.20)),
    black=(circle(0.52, 0.49, 0.30),),
)


# Each was claimed with another corner first.
ONCE_TURNED = (*((RINGS, seed) for seed in (22, 61)), *((MOONS, seed) for seed in (102, 1053)))


@pytest.mark.parametrize(("face", "seed"), ONCE_TURNED)
def test_a_highlight_does_not_turn_a_marker_that_is_nearly_its_own_turn(face: Face, seed: int) -> None:
    tracker = tracker_of(RIGS["A"], [face])
    glared, plain = (
        random_scene(RIGS["A"], face, condition, seed=seed)
        for condition in (conditions_of(RIGS["A"])["glare1.6"], BASE)
    )
    claims = [claim_of(tracker.search(image_of(scene))[face.name]) for scene in (glared, plain)]
    assert evaluate(glared, claims[0]).outcome is not Outcome.WRONG
    assert evaluate(plain, claims[1]).outcome is Outcome.CORRECT


def test_where_two_ways_up_explain_it_none_is_claimed(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, tracker = random_scene(RIGS["A"], RINGS, seed=1), tracker_of(RIGS["A"], [RINGS])
    image = image_of(scene)
    certain = seen(tracker.search(image)["rings"])
    one = replace(certain, score_ratio=0.6, target_score_ratio=0.9)
    other = replace(one, corners_px=np.roll(one.corners_px, 1, axis=0), score_ratio=0.7)
    for both in ((one, other), (other, one)):
        monkeypatch.setattr(Fitter, "fit_candidates", lambda *_, both=both, **_more: iter(both))
        sighting = tracker.search(image)["rings"]
        assert isinstance(sighting, Unseen)
        assert (sighting.reason, sighting.best_score_ratio) == (UnseenReason.SHAPE_DIFFERS, 0.7)
    monkeypatch.setattr(Fitter, "fit_candidates", lambda *_, **_more: iter((other, certain)))
    assert tracker.search(image)["rings"] is certain


def test_two_are_turned_in_one_square_only() -> None:
    scene = random_scene(RIGS["A"], RINGS, seed=1)
    one = seen(tracker_of(RIGS["A"], [RINGS]).search(image_of(scene))["rings"])
    for quarters in (1, 2, 3):
        assert differ_by_rotation(one, replace(one, corners_px=np.roll(one.corners_px, quarters, axis=0)))
    assert not differ_by_rotation(one, replace(one, corners_px=one.corners_px + 2.0))
    middle = one.corners_px.mean(axis=0)
    wider = middle + 1.4 * (np.roll(one.corners_px, 1, axis=0) - middle)
    assert not differ_by_rotation(one, replace(one, corners_px=wider)), (
        "what is in another square says nothing of it"
    )
    assert not differ_by_rotation(one, replace(one, corners_px=np.roll(one.corners_px, 1, axis=0) + 20.0))
    assert not differ_by_rotation(one, Unseen(reason=UnseenReason.NO_CANDIDATE))
