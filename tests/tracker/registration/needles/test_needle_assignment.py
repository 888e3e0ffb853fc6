"""Assignment of needle candidates by plan and ruler."""

import dataclasses

import numpy as np
import pytest

from tracker.geometry import Array
from tracker.plan import Landmark
from tracker.registration.needles import DetectedNeedle, needle_from_clicks, planned_at_landmarks
from tracker.registration.needles.assignment import rank_assignments
from tracker.rehearsal import Theatre, TheatreSettings
from tracker.verification.user_errors import measure_by_ruler, needle_entries

THEATRE = Theatre(TheatreSettings(seed=4))
# Well apart on both sides, so that no other naming looks alike.
UP_MM = np.array([0.0, 42.0, 0.0])
POINTS = np.array([[-32.0, 30.0, 0.0], [32.0, 30.0, 0.0], [0.0, 50.0, -6.0]])


def found(entry_px: Array, head_px: Array) -> DetectedNeedle:
    seen = needle_from_clicks(entry_px, head_px, sd_px=0.5, entry_is_seen=False)
    seen = dataclasses.replace(seen, width_px=4.0)
    return DetectedNeedle(seen=seen, score_ratio=0.8, has_head=True, complete_ratio=1.0, bend_px=0.1)


def needles_at(points: Array) -> list[DetectedNeedle]:
    pose, camera = THEATRE.camera_from_vertebra, THEATRE.camera
    out = []
    for point in points:
        ends = camera.px_from_camera(pose.move_points(np.stack([point, point + UP_MM])))
        out.append(found(ends[0], ends[1]))
    return out


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_needles_are_distinguished_from_each_other_and_from_what_lies_about(seed: int) -> None:
    random = np.random.default_rng(seed)
    clutter = [found(at, at + random.normal(0.0, 50.0, 2)) for at in random.uniform(100.0, 620.0, (6, 2))]
    candidates = [*clutter[:3], *needles_at(POINTS), *clutter[3:]]
    places = planned_at_landmarks([Landmark(name=str(n), point_lps_mm=at) for n, at in enumerate(POINTS)])
    measured = measure_by_ruler(THEATRE, POINTS.mean(axis=0), random)
    namings = rank_assignments(candidates, places, THEATRE.camera, measured)
    assert namings[0][1] == (3, 4, 5)
    assert namings[1][0] - namings[0][0] > 6.0
    assert [cost for cost, _ in namings] == sorted(cost for cost, _ in namings)


def test_needles_that_stand_alike_are_named_in_both_ways_with_nearly_the_same_cost() -> None:
    entries = needle_entries(THEATRE.needles)
    # Two on one line of sight, and the third well beside: which of the two is in front is not seen.
    sight = THEATRE.camera_from_vertebra.inverse.translation_mm - entries[2]
    behind = entries[2] - 12.0 * sight / np.linalg.norm(sight)
    points = np.stack([behind, entries[2] + np.array([32.0, -12.0, 0.0]), entries[2]])
    places = planned_at_landmarks([Landmark(name=str(n), point_lps_mm=at) for n, at in enumerate(points)])
    measured = measure_by_ruler(THEATRE, points.mean(axis=0), np.random.default_rng(1))
    namings = rank_assignments(needles_at(points), places, THEATRE.camera, measured)
    assert {namings[0][1], namings[1][1]} == {(0, 1, 2), (2, 1, 0)}
    assert namings[1][0] - namings[0][0] < 6.0


def test_more_candidates_than_there_is_time_for_keep_the_likeliest() -> None:
    points = np.vstack([POINTS, POINTS + np.array([0.0, -5.0, 20.0])])
    candidates = [*needles_at(points), *needles_at(points + 3.0), *needles_at(points - 3.0)]
    places = planned_at_landmarks([Landmark(name=str(n), point_lps_mm=at) for n, at in enumerate(points)])
    measured = measure_by_ruler(THEATRE, points.mean(axis=0), np.random.default_rng(1))
    namings = rank_assignments(candidates, places, THEATRE.camera, measured)
    assert namings[0][1] == (0, 1, 2, 3, 4, 5)
