"""Idle search: known markers that are out of view."""

from collections.abc import Callable

import cv2
import numpy as np
import pytest

from tests.tracker.pipeline.stepped import CAMERA, MODEL, image_of, off_px, pose_of, tracker_of
from tests.tracker.scenes import (
    NEIGHBOURS,
    OTHER,
    Image8,
    Print,
    cluttered,
    code_image,
    code_model,
    corners_px_of,
    rendered,
    seen,
)
from tracker import Seen, Tracker, Unseen
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import candidate_rounds, costly_candidates, four_sided_candidates
from tracker.pipeline.fitter import Fitter
from tracker.pipeline.idle_search import REFIT_IMAGES

ABSENT = ((1, 1, 0), (0, 1, 0), (1, 0, 0))
HERE = pose_of((130.0, 180.0))
# More images than all parts of a search take.
PATIENCE = 60


def _two(there: Rigid[Camera, Marker] | None, *, seed: int, here: Rigid[Camera, Marker] = HERE) -> Image8:
    prints = [Print(picture=code_image(), pose=here)]
    if there is not None:
        prints.append(Print(picture=code_image(OTHER), pose=there))
    return rendered(CAMERA, prints, seed=seed)


def _without_a_corner(image: Image8, pose: Rigid[Camera, Marker]) -> Image8:
    """A grey occluder on one corner: no dark region has four sides any more, so later rounds are needed."""
    corners = corners_px_of(CAMERA, pose)
    a, b, d = corners[0], corners[1], corners[3]
    patch = [a + 0.3 * (a - b), a + 0.3 * (b - a), a + 0.3 * (d - a), a + 0.3 * (a - d)]
    cv2.fillConvexPoly(image, np.rint(patch).astype(np.int32), (150.0,), cv2.LINE_AA)
    return image


def _tracker() -> Tracker:
    others = [code_model(OTHER, name="other"), code_model(ABSENT, name="absent")]
    return Tracker(camera=CAMERA, models=[MODEL, *others])


class _Counted:
    """Counts the search parts and fits of each image."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.quick, self.costly, self.complete, self.fits = [0], [0], [0], [0]
        fit_candidates = Fitter.fit_candidates

        def counted(count: list[int], compute: Callable[..., object]) -> Callable[..., object]:
            def call(*args: object, **named: object) -> object:
                count[-1] += 1
                return compute(*args, **named)

            return call

        for name, count, compute in (
            ("idle_search.four_sided_candidates", self.quick, four_sided_candidates),
            ("idle_search.costly_candidates", self.costly, costly_candidates),
            ("search.candidate_rounds", self.complete, candidate_rounds),
        ):
            monkeypatch.setattr(f"tracker.pipeline.{name}", counted(count, compute))
        monkeypatch.setattr(Fitter, "fit_candidates", counted(self.fits, fit_candidates))

    def next_image(self) -> None:
        for count in (self.quick, self.costly, self.complete, self.fits):
            count.append(0)


def test_without_a_marker_in_view_an_image_gets_one_part_of_a_search_and_one_fit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tracker = _tracker()
    counted = _Counted(monkeypatch)
    for k in range(17):
        image = rendered(CAMERA, [], background=cluttered(CAMERA, 3), seed=k)
        assert isinstance(tracker.step(image, captured_at_s=k / 30)["other"], Unseen)
        counted.next_image()
    assert counted.complete[:-1] == [1] + 16 * [0], (
        "nothing is known in the first image: it is searched whole"
    )
    assert counted.quick[1:-1] == 8 * [1, 0]
    assert counted.costly[1:-1] == 4 * [0, 0, 0, 1]
    assert counted.fits[0] > 1
    assert set(counted.fits[1:]) == {0, 1}


def test_while_another_is_tracked_an_image_in_eight_gets_a_costly_part_of_a_search(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tracker = _tracker()
    counted = _Counted(monkeypatch)
    for k in range(17):
        sightings = tracker.step(_two(None, seed=k), captured_at_s=k / 30)
        assert isinstance(sightings["code"], Seen)
        assert isinstance(sightings["other"], Unseen)
        counted.next_image()
    assert counted.complete[:-1] == [1] + 16 * [0]
    assert counted.quick[1:-1] == 8 * [1, 0]
    assert counted.costly[1:-1] == 2 * [*(7 * [0]), 1]


def test_after_a_gap_an_image_is_searched_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    tracker = _tracker()
    counted = _Counted(monkeypatch)
    for at_s in (0.0, 0.03, 3.0, 3.03, 1.0):
        tracker.step(_two(None, seed=0), captured_at_s=at_s)
        counted.next_image()
    assert counted.complete[:-1] == [1, 0, 1, 0, 1]


def test_a_look_alike_that_was_rejected_is_fitted_again_only_after_some_images(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tracker = tracker_of()
    counted = _Counted(monkeypatch)
    for k in range(2 * REFIT_IMAGES):
        image = image_of(pose_of(), fields=NEIGHBOURS[0], seed=k)
        assert isinstance(tracker.step(image, captured_at_s=k / 30)["code"], Unseen)
        counted.next_image()
    assert 1 < sum(counted.fits[1:]) < REFIT_IMAGES
    there = pose_of((330.0, 120.0))
    sighting = tracker.step(image_of(there, seed=99), captured_at_s=2 * REFIT_IMAGES / 30)["code"]
    following = tracker.step(image_of(there, seed=98), captured_at_s=(2 * REFIT_IMAGES + 1) / 30)["code"]
    assert off_px(seen(sighting if isinstance(sighting, Seen) else following), there) < 0.5


def test_no_score_of_an_image_before_is_reported_as_this_ones() -> None:
    tracker = _tracker()
    first = tracker.step(_two(None, seed=0), captured_at_s=0.0)["other"]
    assert isinstance(first, Unseen)
    assert first.best_score_ratio is not None
    for k in range(1, 9):
        said = tracker.step(_two(None, seed=k), captured_at_s=k / 30)["other"]
        assert isinstance(said, Unseen)
        assert (said.reason, said.best_score_ratio) == (first.reason, None)


def test_where_each_image_is_searched_whole_a_marker_is_found_as_soon_as_it_is_there() -> None:
    tracker = _tracker()
    for k in range(6):
        said = tracker.step(_two(None, seed=k), captured_at_s=k / 30, full_search=True)["other"]
        assert isinstance(said, Unseen)
        assert said.best_score_ratio is not None
    there = pose_of((260.0, 150.0))
    sightings = tracker.step(_two(there, seed=7), captured_at_s=0.2, full_search=True)
    assert {name for name, one in sightings.items() if isinstance(one, Seen)} == {"code", "other"}


def test_a_marker_that_comes_into_view_is_found_where_it_has_gone_meanwhile() -> None:
    tracker = _tracker()
    for k in range(4):
        tracker.step(_two(None, seed=k), captured_at_s=k / 30)
    for k in range(4, 4 + PATIENCE):
        there = pose_of((260.0 + 100.0 * np.sin(0.06 * k), 150.0 + 40.0 * np.cos(0.06 * k)), roll_deg=3.0 * k)
        image = _without_a_corner(_two(there, seed=k), there)
        sightings = tracker.step(image, captured_at_s=k / 30)
        assert seen(sightings["code"]).found_by == "track"
        if not isinstance(sightings["other"], Unseen):
            break
    assert k > 4, "the first round, in the image at hand, does not find it"
    assert off_px(seen(sightings["other"]), there) < 2.0
    following = tracker.step(_two(there, seed=99), captured_at_s=(k + 1) / 30)
    assert seen(following["other"]).found_by == "track"


def test_a_marker_that_jumps_by_a_side_is_found_again_in_the_same_image() -> None:
    tracker = _tracker()
    for k in range(2):
        tracker.step(_two(pose_of((330.0, 120.0)), seed=k), captured_at_s=k / 30)
    there = pose_of((362.0, 152.0), roll_deg=130.0)
    sightings = tracker.step(_without_a_corner(_two(there, seed=2), there), captured_at_s=2 / 30)
    assert seen(sightings["code"]).found_by == "track"
    assert seen(sightings["other"]).found_by == "search"
    assert off_px(seen(sightings["other"]), there) < 2.0


def test_when_the_last_one_is_lost_all_are_searched_for() -> None:
    tracker = _tracker()
    for k in range(3):
        tracker.step(_two(None, seed=k), captured_at_s=k / 30)
    there = pose_of((330.0, 120.0))
    image = rendered(CAMERA, [Print(picture=code_image(OTHER), pose=there)], seed=3)
    sightings = tracker.step(image, captured_at_s=3 / 30)
    assert isinstance(sightings["code"], Unseen)
    assert off_px(seen(sightings["other"]), there) < 0.3
