"""Photometric verification: markers under blur, illumination and occlusion are accepted, others rejected."""

from collections.abc import Callable
from dataclasses import replace

import cv2
import numpy as np
import pytest

from tests.tracker.scenes import (
    NEIGHBOURS,
    Image8,
    Print,
    camera_of,
    code_image,
    code_model,
    corners_px_of,
    motion_blurred,
    rendered,
)
from tests.tracker.scenes import facing_at_px as placed
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.marker import MarkerModel, PhotometricFit, photometric_fit_of

CAMERA = camera_of((200, 160), focal_px=400.0)
MIDDLE = (100.3, 80.7)
Degraded = Callable[[Image8, float, float], Image8]


def _u_v() -> tuple[Array, Array]:
    v, u = np.mgrid[0:160, 0:200].astype(np.float64)
    return u - MIDDLE[0], v - MIDDLE[1]


def _in_shadow(image: Image8, side_px: float, from_deg: float) -> Image8:
    """Remove four fifths of the light beyond an edge across the square."""
    u, v = _u_v()
    across = u * np.cos(np.radians(from_deg)) + v * np.sin(np.radians(from_deg)) - 0.1 * side_px
    return np.asarray(np.rint(image * (1.0 - 0.8 / (1.0 + np.exp(-across / 1.5)))), dtype=np.uint8)


def _out_of_focus(image: Image8, side_px: float, _: float) -> Image8:
    return np.asarray(cv2.GaussianBlur(image, (0, 0), 0.06 * side_px), dtype=np.uint8)


def _motion_blurred(image: Image8, side_px: float, from_deg: float) -> Image8:
    """Blur by motion over a fifth of its side."""
    return motion_blurred(image, 0.2 * side_px, from_deg)


def _under_glare(image: Image8, side_px: float, from_deg: float) -> Image8:
    u, v = _u_v()
    u = u - 0.4 * side_px * np.cos(np.radians(from_deg))
    v = v - 0.4 * side_px * np.sin(np.radians(from_deg))
    light = 120.0 * np.exp(-0.5 * (u * u + v * v) / (0.5 * side_px) ** 2)
    return np.asarray(np.clip(np.rint(image + light), 0, 255), dtype=np.uint8)


def _covered(
    image: Image8, side_px: float, from_deg: float, *, beyond_ratio: float = 0.35, grey: int = 110
) -> Image8:
    """Occlude everything more than 0.35 of the side from the centre, on one side, with a grey."""
    u, v = _u_v()
    out = image.copy()
    across = u * np.cos(np.radians(from_deg)) + v * np.sin(np.radians(from_deg))
    out[across > beyond_ratio * side_px] = grey
    return out


DEGRADED = [_in_shadow, _out_of_focus, _motion_blurred, _under_glare]


def _explained(image: Image8, pose: Rigid[Camera, Marker], side_px: float) -> PhotometricFit | None:
    return photometric_fit_of(image, code_model().square, corners_px_of(CAMERA, pose), side_px=side_px)


@pytest.mark.parametrize("degraded", DEGRADED)
@pytest.mark.parametrize(("side_px", "from_deg"), [(28.0, 130), (45.0, 250)])
def test_a_marker_under_shadow_blur_or_glare_is_accepted(
    degraded: Degraded, side_px: float, from_deg: float
) -> None:
    pose = placed(CAMERA, MIDDLE, side_px, tilt_deg=20, about_deg=40, roll_deg=15)
    image = degraded(rendered(CAMERA, [Print(picture=code_image(), pose=pose)]), side_px, from_deg)
    found = _explained(image, pose, side_px)
    assert found is not None
    assert found.is_accepted, found
    assert float(np.abs(found.corners_px - corners_px_of(CAMERA, pose)).max()) < 0.03 * side_px


def test_most_occluded_markers_are_accepted() -> None:
    """Where ink continues under the occluder's edge, its inside may still be taken for another shape."""
    explained = 0
    for side_px in (28.0, 45.0):
        pose = placed(CAMERA, MIDDLE, side_px, tilt_deg=20, about_deg=40, roll_deg=15)
        plain = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
        for from_deg in (10, 130, 250):
            found = _explained(_covered(plain, side_px, from_deg), pose, side_px)
            explained += found is not None and found.is_accepted
    assert explained >= 5


# Each field once or twice, and each degradation three times.
@pytest.mark.parametrize(("degraded", "field"), [(DEGRADED[n % 4], n % 9) for n in range(12)])
def test_a_look_alike_that_differs_in_one_field_is_rejected(degraded: Degraded, field: int) -> None:
    pose = placed(CAMERA, MIDDLE, 30.0, tilt_deg=20, about_deg=40, roll_deg=15)
    image = degraded(
        rendered(CAMERA, [Print(picture=code_image(NEIGHBOURS[field]), pose=pose)]), 30.0, 40 * field
    )
    found = _explained(image, pose, 30.0)
    assert found is None or not found.is_accepted, found


@pytest.mark.parametrize("side_px", [14.0, 20.0, 27.0, 36.0])
@pytest.mark.parametrize("seed", range(2))
def test_a_frame_with_other_content_is_rejected(side_px: float, seed: int) -> None:
    random = np.random.default_rng([seed, 11])
    blobs = cv2.GaussianBlur(random.normal(size=(120, 120)), (0, 0), float(random.uniform(6, 20)))
    picture = np.where(blobs > np.median(blobs), 255, 0).astype(np.uint8)
    frame = int(random.integers(12, 34))
    for side in (np.s_[:frame], np.s_[-frame:], np.s_[:, :frame], np.s_[:, -frame:]):
        picture[side] = 0
    pose = placed(CAMERA, MIDDLE, side_px, tilt_deg=20, about_deg=40, roll_deg=15)
    plain = rendered(CAMERA, [Print(picture=picture, pose=pose)], seed=seed)
    for degraded in (_in_shadow, _out_of_focus, _under_glare, _covered):
        found = _explained(degraded(plain, side_px, 45 * seed), pose, side_px)
        assert found is None or not found.is_accepted, found


@pytest.mark.parametrize("grey", [15, 60, 110, 200])
def test_most_markers_are_accepted_under_an_occluder_of_any_grey(grey: int) -> None:
    """An occluder as dark as ink is invisible over ink, one as bright as paper over paper."""
    explained = 0
    for side_px in (28.0, 45.0):
        pose = placed(CAMERA, MIDDLE, side_px, tilt_deg=20, about_deg=40, roll_deg=15)
        plain = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
        for from_deg in (10, 130, 250):
            image = _covered(plain, side_px, from_deg, beyond_ratio=0.25, grey=grey)
            found = _explained(image, pose, side_px)
            explained += found is not None and found.is_accepted
    assert explained >= 4


def _dotted() -> Image8:
    """A disc in a frame with a dot beside its centre: without the dot it would be rotationally symmetric."""
    picture = np.zeros((400, 400), np.uint8)
    picture[50:350, 50:350] = 255
    cv2.circle(picture, (200, 200), 110, 0, -1)
    cv2.circle(picture, (235, 165), 45, 255, -1)
    return picture


@pytest.fixture(scope="module")
def dotted() -> MarkerModel:
    return MarkerModel.from_image(_dotted(), side_mm=25.0, name="dotted")


def _dazzling(image: Image8, side_px: float, from_deg: float) -> Image8:
    """Add a highlight four times as bright as paper, over a third of the square."""
    u, v = _u_v()
    u = u - 0.35 * side_px * np.cos(np.radians(from_deg))
    v = v - 0.35 * side_px * np.sin(np.radians(from_deg))
    light = 400.0 * np.exp(-0.5 * (u * u + v * v) / (0.25 * side_px) ** 2)
    return np.asarray(np.clip(np.rint(image + light), 0, 255), dtype=np.uint8)


@pytest.mark.parametrize("turns", [1, 2, 3])
@pytest.mark.parametrize("degraded", [_dazzling, _covered, _in_shadow])
def test_a_rotated_marker_is_rejected_under_glare_or_occlusion(
    degraded: Degraded, turns: int, dotted: MarkerModel
) -> None:
    pose = placed(CAMERA, MIDDLE, 45.0, tilt_deg=20, about_deg=40, roll_deg=15)
    plain = rendered(CAMERA, [Print(picture=_dotted(), pose=pose)])
    for from_deg in (0, 135, 270):
        image = degraded(plain, 45.0, from_deg)
        corners = np.roll(corners_px_of(CAMERA, pose), turns, axis=0)
        found = photometric_fit_of(image, dotted.square, corners, side_px=45.0)
        assert found is None or not found.is_accepted, (from_deg, found)


def test_the_outline_alone_is_not_accepted() -> None:
    """The outline is common to all squares."""
    pose = placed(CAMERA, MIDDLE, 45.0)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
    free = _explained(image, pose, 45.0)
    assert free is not None
    assert free.is_accepted
    assert not replace(free, inner_occluded_ratio=0.6).is_accepted
    u, v = _u_v()
    image[(np.abs(u) < 0.26 * 45.0) & (np.abs(v) < 0.7 * 45.0) & (v > -0.26 * 45.0)] = 120
    found = _explained(image, pose, 45.0)
    assert found is None or not found.is_accepted, found


def test_a_uniform_image_and_the_negative_are_rejected() -> None:
    pose = placed(CAMERA, MIDDLE, 40.0)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
    for other in (np.full_like(image, 128), 255 - image):
        found = _explained(other, pose, 40.0)
        assert found is None or not found.is_accepted


def test_occluded_points_are_reported() -> None:
    pose = placed(CAMERA, MIDDLE, 40.0)
    plain = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
    free, covered = _explained(plain, pose, 40.0), _explained(_covered(plain, 40.0, 0.0), pose, 40.0)
    assert free is not None
    assert covered is not None
    assert free.occluded_ratio < 0.02
    # Three twentieths of the square, and a field more all around that blur may reach.
    assert 0.12 < covered.occluded_ratio < 0.3
    # The placed face looks at the camera upright: what lies to the right in the image does so on the marker.
    points = np.array(
        [[0.45, 0.0], [0.45, 0.4], [0.55, -0.3], [0.2, 0.0], [-0.45, 0.0], [0.0, 0.45], [3.0, 0.0]]
    )
    assert covered.occludes(points).tolist() == [True, True, True, False, False, False, False]
    assert not free.occludes(points).any()
