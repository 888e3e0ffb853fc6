"""Idle search: known markers out of view while another is tracked."""

from collections.abc import Iterator

import cv2
import numpy as np
import pytest

from tests.tracker.pipeline.stepped import CAMERA, MODEL, off_px, pose_of
from tests.tracker.scenes import (
    OTHER,
    Image8,
    Print,
    code_image,
    code_model,
    corners_px_of,
    rendered,
    seen,
)
from tracker import MarkerModel, Seen, Tracker, Unseen
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import Candidate, candidate_rounds
from tracker.marker.template_matching import Templates
from tracker.pipeline.fitter import Fitter
from tracker.pose import ImageContext

ABSENT = ((1, 1, 0), (0, 1, 0), (1, 0, 0))
HERE = pose_of((130.0, 180.0))
# As many images as the parts of two searches take: one that was under way, and one to be in time for.
PATIENCE = 60


def _two(there: Rigid[Camera, Marker] | None, *, seed: int, here: Rigid[Camera, Marker] = HERE) -> Image8:
    prints = [Print(picture=code_image(), pose=here)]
    if there is not None:
        prints.append(Print(picture=code_image(OTHER), pose=there))
    return rendered(CAMERA, prints, seed=seed)


def _without_a_corner(image: Image8, pose: Rigid[Camera, Marker]) -> Image8:
    """Something grey over one corner: no dark region has four sides any more, later rounds are needed."""
    corners = corners_px_of(CAMERA, pose)
    a, b, d = corners[0], corners[1], corners[3]
    patch = [a + 0.3 * (a - b), a + 0.3 * (b - a), a + 0.3 * (d - a), a + 0.3 * (a - d)]
    cv2.fillConvexPoly(image, np.rint(patch).astype(np.int32), (150.0,), cv2.LINE_AA)
    return image


def _tracker() -> Tracker:
    others = [code_model(OTHER, name="other"), code_model(ABSENT, name="absent")]
    return Tracker(camera=CAMERA, models=[MODEL, *others])


def test_what_is_out_of_view_costs_a_part_of_a_search_in_less_than_half_of_the_images(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rounds, looks = [0], [0]

    def counted(image: Image8, templates: Templates) -> Iterator[list[list[Candidate]]]:
        for candidates in candidate_rounds(image, templates):
            rounds[-1] += 1
            yield candidates

    looked = Fitter.fit_candidates

    def counted_look(
        fitter: Fitter, pixels: ImageContext, model: MarkerModel, candidates: list[Candidate], *, maximum: int
    ) -> Iterator[Seen | Unseen]:
        looks[-1] += 1
        return looked(fitter, pixels, model, candidates, maximum=maximum)

    tracker = _tracker()
    monkeypatch.setattr("tracker.pipeline.search.candidate_rounds", counted)
    monkeypatch.setattr(Fitter, "fit_candidates", counted_look)
    for k in range(14):
        sightings = tracker.step(_two(None, seed=k), captured_at_s=k / 30)
        assert isinstance(sightings["other"], Unseen)
        rounds.append(0)
        looks.append(0)
    assert rounds[0] > 3, "nothing is known yet: the whole of the first image is searched"
    assert 3 < sum(rounds[1:]) + sum(looks[1:]) < 7
    assert all(r + n <= 1 for r, n in zip(rounds[1:], looks[1:], strict=True))


def test_no_score_of_an_image_before_is_told_as_this_ones() -> None:
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


def test_an_image_that_is_searched_later_may_be_written_over(monkeypatch: pytest.MonkeyPatch) -> None:
    searched: list[tuple[Image8, Image8]] = []

    def watched(image: Image8, templates: Templates) -> Iterator[list[list[Candidate]]]:
        searched.append((image, image.copy()))
        return candidate_rounds(image, templates)

    tracker = _tracker()
    memory = _two(None, seed=0)
    tracker.step(memory, captured_at_s=0.0)
    monkeypatch.setattr("tracker.pipeline.search.candidate_rounds", watched)
    for k in range(1, 4):
        memory[:] = _two(None, seed=k)
        tracker.step(memory, captured_at_s=k / 30)
    for image, before in searched:
        np.testing.assert_array_equal(image, before)


def test_a_marker_that_jumps_while_another_is_tracked_is_found_again_in_the_same_image() -> None:
    tracker = _tracker()
    for k in range(2):
        tracker.step(_two(pose_of((330.0, 120.0)), seed=k), captured_at_s=k / 30)
    there = pose_of((360.0, 280.0), roll_deg=130.0)
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
