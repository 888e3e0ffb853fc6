"""Acceptance of candidates as the marker where edges alone are inconclusive."""

import numpy as np
import pytest

from tests.tracker.scenes import (
    NEIGHBOURS,
    SIDE_MM,
    Image8,
    Print,
    camera_of,
    code_image,
    code_model,
    corners_px_of,
    facing_at_px,
    motion_blurred,
    rendered,
)
from tracker import Seen, Sighting
from tracker.edges import edgels_of, gradient_of
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import ScoreSettings
from tracker.photometric import textures_of
from tracker.pose import (
    ImageContext,
    OccurrenceContext,
    occurrence_near,
    pose_from_corners,
    verify_occurrence,
    with_target_coverage,
)

CAMERA = camera_of((200, 160), focal_px=400.0)
MODEL = code_model()


def _accepted(image: Image8, pose: Rigid[Camera, Marker]) -> Sighting:
    """Results for a candidate whose corners are up to a pixel off."""
    corners = corners_px_of(CAMERA, pose) + np.array([[0.8, -0.5], [-0.6, 0.4], [0.3, 0.9], [-0.7, -0.6]])
    start = pose_from_corners(CAMERA, corners, side_mm=SIDE_MM)
    assert start is not None
    gradient = gradient_of(image)
    found = occurrence_near(CAMERA, MODEL, gradient, start, first_reach_px=2.5)
    assert found is not None
    found = with_target_coverage(CAMERA, MODEL, gradient, edgels_of(gradient), found)
    scene = OccurrenceContext(
        camera=CAMERA,
        model=MODEL,
        pixels=ImageContext(image=image, noise_grey=1.5, textures={MODEL.name: textures_of(MODEL.square)}),
        window=image,
        gradient=gradient,
        settings=ScoreSettings(),
        expected=None,
    )
    return verify_occurrence(scene, found)


@pytest.mark.parametrize("from_deg", [10, 55, 100, 145])
def test_a_marker_smeared_over_a_quarter_of_its_side_is_seen_and_where_it_is(from_deg: float) -> None:
    pose = facing_at_px(CAMERA, (100.3, 80.7), 30.0, tilt_deg=20, about_deg=40, roll_deg=15)
    image = motion_blurred(rendered(CAMERA, [Print(picture=code_image(), pose=pose)]), 8.0, from_deg)
    sighting = _accepted(image, pose)
    assert isinstance(sighting, Seen), sighting
    # Its edges are detected up to three pixels off.
    off = corners_px_of(CAMERA, sighting.camera_from_marker) - corners_px_of(CAMERA, pose)
    assert float(np.abs(off).max()) < 1.0
    assert float(np.abs(sighting.corners_px - corners_px_of(CAMERA, pose)).max()) < 1.0


@pytest.mark.parametrize("field", range(9))
def test_a_smeared_look_alike_is_not_seen(field: int) -> None:
    pose = facing_at_px(CAMERA, (100.3, 80.7), 30.0, tilt_deg=20, about_deg=40, roll_deg=15)
    image = motion_blurred(
        rendered(CAMERA, [Print(picture=code_image(NEIGHBOURS[field]), pose=pose)]), 8.0, 40.0 * field
    )
    assert not isinstance(_accepted(image, pose), Seen)
