"""Patient reference and events (moves, occlusions, a jump): images and ground truth agree."""

import math
from functools import lru_cache

import numpy as np
import pytest

from tests.tracker.rehearsal.stills import STILLS
from tracker.errors import InvalidInput
from tracker.geometry import angle_between_deg
from tracker.pipeline import Tracker
from tracker.pose import Seen, Sighting
from tracker.rehearsal import Event, EventKind, Renderer, Scene, Skill, Theatre, TheatreSettings
from tracker.rehearsal.marker_images import drill_marker_image, reference_marker_image

SIZE = (960, 540)
AT_S = 20.0


@lru_cache(maxsize=8)
def eventful(*events: Event) -> tuple[Theatre, Renderer]:
    settings = TheatreSettings(seed=1, size_wh_px=SIZE, skill=Skill.GOOD, reference=True, events=events)
    theatre = Theatre(settings)
    renderer = theatre.renderer(store=STILLS)
    assert isinstance(renderer, Renderer)
    return theatre, renderer


def found(theatre: Theatre, renderer: Renderer, at_s: float) -> dict[str, Sighting]:
    assert theatre.reference is not None
    tracker = Tracker(camera=theatre.camera, models=[theatre.marker, theatre.reference])
    return dict(tracker.search(renderer.image_at(at_s)))


@pytest.mark.parametrize("seed", range(1, 5))
def test_the_reference_is_seen_obliquely_and_unoccluded(seed: int) -> None:
    theatre = Theatre(TheatreSettings(seed=seed, reference=True))
    truth = theatre.truth_at(AT_S)
    pose = truth.camera_from_reference
    assert pose is not None
    assert truth.reference_in_view
    assert 15.0 < angle_between_deg(pose.rotation[:, 2], -pose.translation_mm) < 45.0
    assert theatre.reference is not None
    assert (theatre.reference.name, theatre.reference.side_mm) == ("reference", 30.0)
    back = truth.camera_from_vertebra @ theatre.reference_from_vertebra.inverse
    np.testing.assert_allclose(back.matrix, pose.matrix, atol=1e-9)
    middle = theatre.camera.px_from_camera(pose.translation_mm)[0]
    bone = theatre.camera.px_from_camera(truth.camera_from_vertebra.move_points(theatre.surface.vertices_mm))
    assert np.linalg.norm(bone - middle, axis=1).min() > 60.0


def test_without_a_reference_there_is_none_anywhere() -> None:
    theatre = Theatre(TheatreSettings())
    truth = theatre.truth_at(AT_S)
    assert theatre.reference is None
    assert truth.camera_from_reference is None
    assert not truth.reference_in_view


def test_the_two_markers_look_nothing_like_each_other() -> None:
    drill = drill_marker_image(100).astype(np.float64)
    for face in (reference_marker_image(100), reference_marker_image(100)[:, ::-1]):
        for turns in range(4):
            assert np.corrcoef(drill.ravel(), np.rot90(face, turns).ravel())[0, 1] < 0.75


@pytest.mark.parametrize("kind", [None, EventKind.CAMERA_MOVES, EventKind.PATIENT_MOVES])
def test_both_markers_are_found_where_the_truth_has_them(kind: EventKind | None) -> None:
    events = () if kind is None else (Event(kind=kind, at_s=10.0),)
    theatre, renderer = eventful(*events)
    truth = theatre.truth_at(AT_S)
    sightings = found(theatre, renderer, AT_S)
    for name, true in (("drill", truth.camera_from_marker), ("reference", truth.camera_from_reference)):
        seen = sightings[name]
        assert isinstance(seen, Seen)
        assert true is not None
        assert np.linalg.norm(seen.camera_from_marker.translation_mm - true.translation_mm) < 1.0
        assert np.abs(seen.camera_from_marker.rotation - true.rotation).max() < 0.02


def test_a_bumped_camera_sees_everything_elsewhere_and_the_patient_has_not_moved() -> None:
    theatre, renderer = eventful(Event(kind=EventKind.CAMERA_MOVES, at_s=10.0))
    before, after = theatre.truth_at(9.99), theatre.truth_at(10.0)
    np.testing.assert_array_equal(before.camera_from_vertebra.matrix, theatre.camera_from_vertebra.matrix)
    moved = before.camera_from_vertebra.inverse @ after.camera_from_vertebra
    assert np.linalg.norm(moved.translation_mm) == pytest.approx(12.0)
    np.testing.assert_allclose(after.camera_from_room.matrix, after.camera_from_vertebra.matrix)
    corner = np.s_[20:200, 20:200]
    changed = np.abs(renderer.image_at(9.99).astype(float) - renderer.image_at(10.0))
    assert changed[corner].mean() > 2.0, "the room moves in the picture, too"


def test_a_patient_moves_while_the_room_is_static() -> None:
    theatre, renderer = eventful(Event(kind=EventKind.PATIENT_MOVES, at_s=10.0, lasts_s=15.0))
    before, after, later = (theatre.truth_at(at_s) for at_s in (9.99, 10.0, 25.0))
    np.testing.assert_array_equal(before.camera_from_room.matrix, after.camera_from_room.matrix)
    for truth in (before, after, later):
        assert truth.camera_from_reference is not None
        fixed = truth.camera_from_reference.inverse @ truth.camera_from_vertebra
        np.testing.assert_allclose(fixed.matrix, theatre.reference_from_vertebra.matrix, atol=1e-9)
    moved = before.camera_from_vertebra.inverse @ after.camera_from_vertebra
    assert np.linalg.norm(moved.translation_mm) > 8.0
    np.testing.assert_array_equal(later.camera_from_vertebra.matrix, before.camera_from_vertebra.matrix)
    changed = np.abs(renderer.image_at(9.99).astype(float) - renderer.image_at(10.0))
    assert changed[20:150, 20:150].mean() < 2.0


@pytest.mark.parametrize(
    ("kind", "hidden"), [(EventKind.DRILL_HIDDEN, "drill"), (EventKind.REFERENCE_HIDDEN, "reference")]
)
def test_a_cloth_occludes_one_marker_and_not_the_other(kind: EventKind, hidden: str) -> None:
    theatre, renderer = eventful(Event(kind=kind, at_s=10.0))
    truth, sightings = theatre.truth_at(AT_S), found(theatre, renderer, AT_S)
    in_view = {"drill": truth.marker_in_view, "reference": truth.reference_in_view}
    for name, sighting in sightings.items():
        assert isinstance(sighting, Seen) is in_view[name] is (name != hidden)


def test_the_drill_jumps_and_comes_back() -> None:
    jump = Event(kind=EventKind.DRILL_JUMPS, at_s=10.0, lasts_s=1.0, size_mm=9.0)
    theatre, still = Theatre(TheatreSettings(events=(jump,))), Theatre(TheatreSettings())
    for at_s, jump_mm in ((9.99, 0.0), (10.5, 9.0), (11.0, 0.0)):
        here, there = theatre.truth_at(at_s).camera_from_tool, still.truth_at(at_s).camera_from_tool
        assert np.linalg.norm(here.translation_mm - there.translation_mm) == pytest.approx(jump_mm, abs=1e-9)


def test_events_begin_and_end_on_schedule() -> None:
    once = Event(kind=EventKind.DRILL_HIDDEN, at_s=5.0, lasts_s=2.0)
    assert [once.is_on(at_s) for at_s in (4.9, 5.0, 6.9, 7.0, 25.0)] == [False, True, True, False, False]
    again = Event(kind=EventKind.DRILL_HIDDEN, at_s=5.0, lasts_s=2.0, every_s=10.0)
    assert [again.is_on(at_s) for at_s in (4.0, 5.5, 8.0, 16.0, 18.0)] == [False, True, False, True, False]
    assert again.over_at_s(16.0) == 17.0
    assert math.isinf(Event(kind=EventKind.CAMERA_STOPS, at_s=1.0).over_at_s(3.0))


@pytest.mark.parametrize(
    ("key", "value"), [("at_s", -1.0), ("lasts_s", 0.0), ("size_mm", 1e3), ("size_deg", float("nan"))]
)
def test_an_event_out_of_range_is_rejected_by_name(key: str, value: float) -> None:
    with pytest.raises(InvalidInput) as caught:
        Event(**{"kind": EventKind.CAMERA_MOVES, "at_s": 1.0, key: value})  # pyrefly: ignore[bad-argument-type]  # wrong on purpose
    assert caught.value.code == "REHEARSAL_SETTING_INVALID"
    assert key in caught.value.message


def test_another_scene_of_the_same_theatre_reuses_the_static_background() -> None:
    settings = TheatreSettings(seed=5, size_wh_px=(320, 180), reference=True)
    first = Theatre(settings).renderer()
    sweep = Theatre(TheatreSettings(seed=5, size_wh_px=(320, 180), reference=True, scene=Scene.SWEEP))
    taken = sweep.renderer(after=first)
    assert taken.backdrops is first.backdrops
    np.testing.assert_array_equal(taken.image_at(3.0), sweep.renderer().image_at(3.0))
    other = Theatre(TheatreSettings(seed=6, size_wh_px=(320, 180))).renderer(after=first)
    assert other.backdrops is not first.backdrops
