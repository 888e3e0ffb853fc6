"""Registration with three needles: within its stated error, or rejected."""

import dataclasses

import numpy as np
import pytest

from tests.tracker.registration.needles.needle_scenes import (
    CAMERA,
    ENTRIES,
    OPEN,
    Seen,
    misfit,
    registered,
    scene,
)
from tracker.errors import InvalidInput, NavigationError, RegistrationError
from tracker.plan import SliceLine
from tracker.plan.reference_slice import ReferenceSlice
from tracker.registration import AnchoredTo, Method
from tracker.registration.needles import (
    RulerMeasurement,
    ViewPrior,
    needle_from_clicks,
    planned_on_lines,
    register_needles,
    view_prior_from_ruler,
)

# `python -m tests.benchmarks.drawn_coverage` has more, and shares with confidence bounds.
SCENES = 12


@pytest.mark.parametrize(
    ("entry_is_seen", "touched"),
    [
        pytest.param(True, 0, id="entries-seen"),
        pytest.param(False, 0, id="entries-hidden"),
        pytest.param(True, 1, id="one-entry-touched"),
    ],
)
def test_the_stated_covariance_holds_the_truth(*, entry_is_seen: bool, touched: int) -> None:
    scenes = [scene(seed, entry_is_seen=entry_is_seen, touched=touched) for seed in range(SCENES)]
    off = np.array([misfit(registered(one, OPEN), one) for one in scenes])
    # Chi-square of 6 degrees of freedom: its mean over the scenes, within three standard errors.
    assert 6.0 - 3.0 * np.sqrt(12.0 / SCENES) < off.mean() < 6.0 + 3.0 * np.sqrt(12.0 / SCENES)


def test_depth_is_said_to_be_the_rulers_until_the_tip_tells_it() -> None:
    ruled, touched = registered(scene(3)), registered(scene(3, touched=1))
    assert ruled.observability.depth.is_weak
    assert 8.0 < ruled.observability.depth.sd <= 10.0
    assert "it hardly shows depth along the view ±" in ruled.observability.summary
    assert ruled.observability.across.sd < 1.0
    assert touched.observability.depth.sd < 1.2
    lines = registered(scene(3, entry_is_seen=False))
    assert lines.observability.across.sd > 1.5 * ruled.observability.across.sd
    assert lines.observability.tilt.sd > ruled.observability.tilt.sd


def test_a_registration_by_needles_is_fixed_to_the_camera_and_tells_each_needles_residual() -> None:
    fit = registered(scene(5))
    assert fit.registration.method is Method.NEEDLES
    assert fit.registration.anchored_to is AnchoredTo.CAMERA
    assert [one.name for one in fit.residuals] == [one.name for one in scene(5).places]
    for one in fit.residuals:
        assert 0.0 < one.offset_px < 6.0
        assert one.offset_mm == pytest.approx(one.offset_px / 1400 * 670, rel=0.5)
        assert one.lean_deg < 60.0


def rejected(given: Seen) -> NavigationError:
    with pytest.raises(NavigationError) as caught:
        registered(given)
    assert caught.value.remedy.endswith(".")
    return caught.value


def test_two_needles_marked_for_each_other_are_rejected() -> None:
    for seed in range(8):
        given = scene(seed)
        first, second, third = given.seen
        error = rejected(dataclasses.replace(given, seen=(third, second, first)))
        assert error.code == "NEEDLES_SWAPPED"
        assert given.places[0].name in error.message
        assert given.places[1].name not in error.message


def test_a_ruler_that_the_touched_point_contradicts_is_named() -> None:
    given = scene(2, touched=1)
    wrong = dataclasses.replace(given.view, distance_mm=given.view.distance_mm + 120.0)
    error = rejected(dataclasses.replace(given, view=wrong))
    assert error.code == "NEEDLES_DISAGREE"
    assert "the camera's distance" in error.message


def moved(given: Seen, entries: object) -> Seen:
    points = np.asarray(entries, dtype=np.float64)
    places = tuple(
        dataclasses.replace(place, point_lps_mm=point)
        for place, point in zip(given.places, points, strict=True)
    )
    return dataclasses.replace(given, places=places)


@pytest.mark.parametrize(
    ("given", "code"),
    [
        pytest.param(
            dataclasses.replace(scene(1), places=scene(1).places[:2], seen=scene(1).seen[:2]),
            "NEEDLES_TOO_FEW",
            id="two",
        ),
        pytest.param(
            dataclasses.replace(scene(1), seen=scene(1).seen[:2]), "NEEDLES_UNPAIRED", id="unpaired"
        ),
        pytest.param(
            moved(scene(1), [ENTRIES[0], ENTRIES[1], ENTRIES[1] + 3.0 / np.sqrt(3.0)]),
            "NEEDLES_TOO_CLOSE",
            id="close",
        ),
        pytest.param(
            moved(scene(1), [ENTRIES[0], 0.5 * (ENTRIES[0] + ENTRIES[1]) + [0, 0, 2.0], ENTRIES[1]]),
            "NEEDLES_COLLINEAR",
            id="in-a-row",
        ),
        pytest.param(
            dataclasses.replace(scene(1), places=(scene(1).places[0],) * 3), "NEEDLE_TWICE", id="one-thrice"
        ),
    ],
)
def test_needles_that_hold_no_vertebra_are_rejected_with_numbers(given: Seen, code: str) -> None:
    assert rejected(given).code == code


def test_two_poses_that_explain_the_needles_alike_are_reported() -> None:
    """Three needles seen from straight above, far away, with a ruler that does not determine the tilt."""
    flat = np.array([[-20.0, 30.0, 15.0], [0.0, 30.0, -20.0], [20.0, 30.0, 12.0]])
    codes = set()
    for seed in range(4):
        given = scene(seed, entries=flat)
        loose = ViewPrior(
            rotation=given.camera_from_vertebra.rotation,
            rotation_covariance=1.0 * np.eye(3),
            distance_mm=given.view.distance_mm,
            distance_sd_mm=10.0,
        )
        try:
            registered(dataclasses.replace(given, view=loose))
        except RegistrationError as error:
            codes.add(error.code)
    assert codes == {"NEEDLES_AMBIGUOUS"}


def reference(apart_mm: float) -> ReferenceSlice:
    lines = tuple(
        SliceLine(
            name=name,
            ends_lps_mm=np.array([[x, -20.0, 0.0], [x, 90.0, 0.0]]),
            ends_px=np.zeros((2, 2)),
        )
        for name, x in (("middle", 0.0), ("left", apart_mm), ("right", -apart_mm))
    )
    return ReferenceSlice(slice_index=0, apart_mm=apart_mm, lines=lines, paths=())


def test_the_papers_lines_alone_leave_the_depth_along_the_needles_open() -> None:
    """Needles on the slice's three lines, entries unknown: the stated error is large and covers the truth."""
    places = planned_on_lines(reference(18.0))
    assert [one.name for one in places] == ["middle", "left", "right"]
    given = scene(4, entry_is_seen=False)
    pose = given.camera_from_vertebra
    seen = []
    for place in places:
        head_mm = place.point_lps_mm + np.array([0.0, 38.0, 0.0])
        ends = pose.move_points(np.stack([place.point_lps_mm, head_mm]))
        px = CAMERA.px_from_camera(ends)
        seen.append(needle_from_clicks(px[0], px[1], entry_is_seen=False))
    middle = pose.move_points(np.mean([one.point_lps_mm for one in places], axis=0))
    view = dataclasses.replace(given.view, distance_mm=float(np.linalg.norm(middle)))
    fit = register_needles(places, seen, CAMERA, view)
    upright = fit.registration.anchor_from_vertebra.rotate_directions([0.0, 1.0, 0.0])
    at = fit.registration.point_covariance_mm2(places[0].point_lps_mm)
    assert np.sqrt(upright @ at @ upright) > 5.0
    assert misfit(fit, dataclasses.replace(given, places=places)) < 12.59


@pytest.mark.parametrize(
    "measured",
    [
        pytest.param(RulerMeasurement(vertical_mm=-1.0, horizontal_mm=600.0), id="below-the-patient"),
        pytest.param(RulerMeasurement(vertical_mm=600.0, horizontal_mm=0.0), id="straight-above"),
        pytest.param(RulerMeasurement(vertical_mm=float("nan"), horizontal_mm=600.0), id="not-measured"),
        pytest.param(RulerMeasurement(vertical_mm=400, horizontal_mm=400, ruler_sd_mm=0.0), id="too-sure"),
    ],
)
def test_a_ruler_that_tells_no_view_is_rejected(measured: RulerMeasurement) -> None:
    with pytest.raises(InvalidInput):
        view_prior_from_ruler(measured, CAMERA, (640.0, 360.0))


def test_the_ruler_gives_the_view_of_a_camera_at_the_feet_and_at_the_head() -> None:
    feet = view_prior_from_ruler(
        RulerMeasurement(vertical_mm=590.0, horizontal_mm=626.0), CAMERA, (640.0, 360.0)
    )
    assert feet.distance_mm == pytest.approx(860.2, abs=0.1)
    # The patient's left is on the left, the head is away from the camera and up in the image.
    left, back, head = feet.rotation.T
    assert left == pytest.approx([-1.0, 0.0, 0.0], abs=1e-3) or left == pytest.approx([1.0, 0, 0], abs=1e-3)
    assert back[1] < -0.7
    assert head[2] > 0.7
    assert np.linalg.det(feet.rotation) == pytest.approx(1.0)
