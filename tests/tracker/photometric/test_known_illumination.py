"""Reuse of the illumination of one image for the next ones."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import Image8, Print, camera_of, code_model, facing_at_px, rendered
from tracker.geometry import Camera, Marker, Rigid
from tracker.photometric import KnownIllumination, RefinedPose, refine_poses, textures_of
from tracker.photometric.illumination import MAX_IMAGES
from tracker.pose import flipped_pose

CAMERA, MODEL = camera_of(), code_model()
TEXTURES = textures_of(MODEL.square)
POSE = facing_at_px(CAMERA, (330.0, 220.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)


def half_in_shadow(edge_px: float) -> Image8:
    image = rendered(CAMERA, [Print(picture=MODEL.image, pose=POSE)]).astype(np.float64)
    illumination = 1.0 - 0.6 / (1.0 + np.exp(-(np.arange(image.shape[1]) - edge_px) / 2.5))
    return np.asarray(np.round(image * illumination), dtype=np.uint8)


def fits(
    image: Image8, known: KnownIllumination | None, starts: tuple[Rigid[Camera, Marker], ...] = (POSE,)
) -> list[RefinedPose]:
    return refine_poses(
        image,
        CAMERA.lens,
        TEXTURES,
        list(starts),
        side_mm=MODEL.side_mm,
        side_px=60.0,
        noise_grey=1.5,
        known=known,
    )


def known_at(edge_px: float) -> KnownIllumination:
    (found,) = fits(half_in_shadow(edge_px), None)
    assert found.illumination is not None
    return found.illumination


def off_px(found: RefinedPose) -> float:
    here, there = (one.move_points(MODEL.corners_mm) for one in (POSE, found.camera_from_marker))
    return float(np.abs(CAMERA.px_from_camera(here) - CAMERA.px_from_camera(there)).max())


def test_a_moving_shadow_is_tracked() -> None:
    known = known_at(330.0)
    assert known.images == 0
    (found,) = fits(half_in_shadow(332.0), known)
    assert found.illumination is not None
    assert (found.illumination.illumination, found.illumination.images) == (known.illumination, 1)
    assert off_px(found) < 0.05


def test_known_illumination_with_larger_residuals_is_discarded() -> None:
    known = known_at(330.0)
    (found,) = fits(half_in_shadow(330.0), replace(known, residual_sd_grey=0.5 * known.residual_sd_grey))
    assert found.illumination is not None
    assert found.illumination.images == 0


def test_known_illumination_expires_after_some_images() -> None:
    (found,) = fits(half_in_shadow(1500.0), replace(known_at(330.0), images=MAX_IMAGES))
    assert found.illumination is None


@pytest.mark.parametrize("images", [0, 5])
def test_known_illumination_favours_neither_of_two_poses(images: int) -> None:
    known = replace(known_at(330.0), images=images)
    starts = (POSE, flipped_pose(POSE))
    anew, knowing = (fits(half_in_shadow(330.0), one, starts) for one in (None, known))
    assert [one.robust_chi2 for one in knowing] == [one.robust_chi2 for one in anew]
