"""The light of an image serves the next ones, as long as it explains them as well."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import Image8, Print, camera_of, code_model, facing_at_px, rendered
from tracker.appearance import KnownLight, WholeFit, textures_of, whole_fits
from tracker.appearance.uneven import MAX_IMAGES
from tracker.geometry import Camera, Marker, Rigid
from tracker.pose import other_solution

CAMERA, MODEL = camera_of(), code_model()
TEXTURES = textures_of(MODEL.square)
POSE = facing_at_px(CAMERA, (330.0, 220.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)


def half_in_shadow(edge_px: float) -> Image8:
    image = rendered(CAMERA, [Print(picture=MODEL.image, pose=POSE)]).astype(np.float64)
    light = 1.0 - 0.6 / (1.0 + np.exp(-(np.arange(image.shape[1]) - edge_px) / 2.5))
    return np.asarray(np.round(image * light), dtype=np.uint8)


def fits(
    image: Image8, known: KnownLight | None, starts: tuple[Rigid[Camera, Marker], ...] = (POSE,)
) -> list[WholeFit]:
    return whole_fits(
        image,
        CAMERA.lens,
        TEXTURES,
        list(starts),
        side_mm=MODEL.side_mm,
        side_px=60.0,
        noise_grey=1.5,
        known=known,
    )


def known_at(edge_px: float) -> KnownLight:
    (found,) = fits(half_in_shadow(edge_px), None)
    assert found.light is not None
    return found.light


def off_px(found: WholeFit) -> float:
    here, there = (one.move_points(MODEL.corners_mm) for one in (POSE, found.camera_from_marker))
    return float(np.abs(CAMERA.px_from_camera(here) - CAMERA.px_from_camera(there)).max())


def test_a_shadow_that_moves_on_is_followed() -> None:
    known = known_at(330.0)
    assert known.images == 0
    (found,) = fits(half_in_shadow(332.0), known)
    assert found.light is not None
    assert (found.light.light, found.light.images) == (known.light, 1)
    assert off_px(found) < 0.05


def test_what_explains_less_than_it_did_is_asked_anew() -> None:
    known = known_at(330.0)
    (found,) = fits(half_in_shadow(330.0), replace(known, scale_grey=0.5 * known.scale_grey))
    assert found.light is not None
    assert found.light.images == 0


def test_after_some_images_it_is_asked_anew_and_may_be_even() -> None:
    (found,) = fits(half_in_shadow(1500.0), replace(known_at(330.0), images=MAX_IMAGES))
    assert found.light is None


@pytest.mark.parametrize("images", [0, 5])
def test_of_two_poses_the_known_light_speaks_for_none(images: int) -> None:
    known = replace(known_at(330.0), images=images)
    starts = (POSE, other_solution(POSE))
    anew, knowing = (fits(half_in_shadow(330.0), one, starts) for one in (None, known))
    assert [one.cost_sd2 for one in knowing] == [one.cost_sd2 for one in anew]
