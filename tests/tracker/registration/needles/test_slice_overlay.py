"""The slice over the video: manual changes, and the resulting pose."""

import numpy as np
import pytest

from tests.tracker.registration.needles.needle_scenes import CAMERA, scene
from tests.tracker.registration.needles.test_register_needles import reference
from tracker.errors import InvalidInput
from tracker.geometry import angle_between_deg
from tracker.registration.needles import (
    SliceOverlay,
    first_overlay,
    image_from_slice,
    needles_from_overlay,
    overlay_of_pose,
    overlay_residuals,
    pose_of_overlay,
    register_needles,
)

OVERLAY = SliceOverlay(shift_px=np.array([600.0, 400.0]), rotation_deg=10.0, scale_px_per_mm=2.0)


def test_hands_move_turn_scale_and_fade_about_the_point_under_the_finger() -> None:
    assert OVERLAY.moved((5.0, -3.0)).shift_px == pytest.approx([605.0, 397.0])
    # A quarter turn clockwise brings what is right of the finger below it.
    turned = OVERLAY.turned(90.0, (500.0, 400.0))
    assert turned.shift_px == pytest.approx([500.0, 500.0])
    assert turned.rotation_deg == pytest.approx(100.0)
    assert OVERLAY.turned(180.0, (600.0, 400.0)).rotation_deg == pytest.approx(-170.0)
    scaled = OVERLAY.scaled(1.5, (500.0, 400.0))
    assert scaled.shift_px == pytest.approx([650.0, 400.0])
    assert scaled.scale_px_per_mm == pytest.approx(3.0)
    assert OVERLAY.faded(0.2).fade_ratio == 0.2


@pytest.mark.parametrize("wrong", [{"fade_ratio": 1.2}, {"scale_px_per_mm": 0.0}, {"rotation_deg": np.nan}])
def test_an_overlay_that_cannot_be_is_rejected(wrong: dict[str, float]) -> None:
    values = {"rotation_deg": 0.0, "scale_px_per_mm": 2.0, **wrong}
    with pytest.raises(InvalidInput, match="px/mm"):
        SliceOverlay(shift_px=np.zeros(2), **values)


def test_an_overlay_is_a_pose_and_back() -> None:
    given = scene(6)
    pose = pose_of_overlay(OVERLAY, given.places, CAMERA, given.view)
    again = overlay_of_pose(pose, given.places, CAMERA, given.view)
    assert again.shift_px == pytest.approx(OVERLAY.shift_px, abs=1e-6)
    assert again.rotation_deg == pytest.approx(10.0, abs=1e-6)
    assert again.scale_px_per_mm == pytest.approx(2.0, rel=1e-6)
    assert np.linalg.norm(pose.move_points(np.mean([p.point_lps_mm for p in given.places], axis=0))) == (
        pytest.approx(700.0)
    )
    # Clockwise in the image: what was up is now to the right.
    straight = pose_of_overlay(OVERLAY.turned(-10.0, OVERLAY.shift_px), given.places, CAMERA, given.view)
    up, leaned = straight.rotate_directions([0.0, 1.0, 0.0]), pose.rotate_directions([0.0, 1.0, 0.0])
    assert leaned[0] > up[0]
    assert 5.0 < angle_between_deg(up, leaned) <= 10.0


def test_lines_laid_over_the_needles_register_as_well_as_the_ruler_knows_the_tilt() -> None:
    given = scene(7, entry_is_seen=False)
    truth = given.camera_from_vertebra
    overlay = overlay_of_pose(truth, given.places, CAMERA, given.view)
    pose = pose_of_overlay(overlay, given.places, CAMERA, given.view)
    assert all(one.rms_mm < 12.0 for one in overlay_residuals(pose, given.places, given.seen, CAMERA))
    fit = register_needles(
        given.places, needles_from_overlay(pose, given.places, CAMERA), CAMERA, given.view, order_is_sure=True
    )
    assert fit.observability.depth.is_weak
    assert fit.observability.tilt.sd > 3.0
    middle = np.mean([one.point_lps_mm for one in given.places], axis=0)
    off = fit.registration.anchor_from_vertebra.move_points(middle) - truth.move_points(middle)
    spread = fit.registration.point_covariance_mm2(middle)
    assert off @ np.linalg.solve(spread, off) < 11.3


def test_residuals_tell_pixels_and_millimetres_at_the_needle() -> None:
    given = scene(8)
    pose = pose_of_overlay(OVERLAY, given.places, CAMERA, given.view)
    under = needles_from_overlay(pose, given.places, CAMERA)
    for one in overlay_residuals(pose, given.places, under, CAMERA):
        assert one.rms_px < 0.2
    moved = pose_of_overlay(OVERLAY.moved((8.0, 0.0)), given.places, CAMERA, given.view)
    for one in overlay_residuals(moved, given.places, under, CAMERA):
        assert 4.0 < one.rms_px < 9.0
        assert one.rms_mm == pytest.approx(one.rms_px / 2.0, rel=0.15)


def test_the_slices_picture_lies_where_its_lines_are() -> None:
    given = scene(9)
    slices = reference(18.0)
    lines = tuple(
        type(line)(name=line.name, ends_lps_mm=line.ends_lps_mm, ends_px=line.ends_lps_mm[:, :2] * 2 + 200)
        for line in slices.lines
    )
    drawn = type(slices)(slice_index=0, apart_mm=18.0, lines=lines, paths=())
    overlay = first_overlay(given.places, CAMERA, given.view)
    pose = pose_of_overlay(overlay, given.places, CAMERA, given.view)
    matrix = image_from_slice(pose, drawn, CAMERA)
    middle = lines[0]
    at = np.column_stack([middle.ends_px, np.ones(2)]) @ matrix.T
    expected = CAMERA.px_from_camera(pose.move_points(middle.ends_lps_mm))
    assert at[:, :2] / at[:, 2:] == pytest.approx(expected, abs=1.5)
