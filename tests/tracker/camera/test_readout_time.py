"""The readout time of a rolling shutter, measured with a shaken board."""

from typing import Any

import numpy as np
import pytest

from tests.tracker.camera.moving_board import BOARD, CAMERA, Motion, drifting, image_at, seen_views, shaken
from tracker.camera.detection import BoardView, find_board
from tracker.camera.readout_time import ReadoutEstimate, TimedView, estimate_readout
from tracker.errors import CalibrationError

SIDEWAYS, BOTH = shaken(sideways_mm=25.0), shaken(sideways_mm=20.0, upwards_mm=15.0)
UPWARDS, TURNED = shaken(upwards_mm=20.0), shaken(rotation_deg=15.0)


def estimated(motion: Motion, readout_s: float, *, seed: int = 1) -> ReadoutEstimate:
    return estimate_readout(seen_views(motion, readout_s=readout_s, seed=seed, images=20), CAMERA)


@pytest.mark.parametrize(
    "motion", [SIDEWAYS, UPWARDS, BOTH, TURNED], ids=["sideways", "up", "both", "turned"]
)
@pytest.mark.parametrize("readout_s", [0.0, 0.016])
def test_any_quick_motion_shows_the_readout_within_its_stated_spread(
    motion: Motion, readout_s: float
) -> None:
    found = estimated(motion, readout_s)
    assert abs(found.readout_ms - 1000.0 * readout_s) < 3.0 * found.sd_ms
    assert found.sd_ms < 0.4
    assert found.rms_px == pytest.approx(0.1, rel=0.1)


def test_a_global_shutter_is_tracked_as_one() -> None:
    found = estimated(BOTH, 0.0)
    assert abs(found.readout_ms) < 2.0 * found.sd_ms
    assert found.used_ms == 0.0
    assert estimated(BOTH, 0.03).used_ms == pytest.approx(30.0, abs=1.0)


def test_the_stated_spread_is_that_of_many_measurements() -> None:
    found = [estimated(UPWARDS, 0.0, seed=seed) for seed in range(4)]
    off_sd = [one.readout_ms / one.sd_ms for one in found]
    assert 0.3 < float(np.sqrt(np.mean(np.square(off_sd)))) < 1.8


def test_from_rendered_images_of_a_rolling_shutter_the_readout_is_found() -> None:
    views = []
    for number in range(16):
        at_s = number / 30.0
        found = find_board(image_at(SIDEWAYS, at_s, readout_s=0.02), BOARD)
        if isinstance(found, BoardView):
            views.append(TimedView(at_s=at_s, view=found))
    estimate = estimate_readout(views, CAMERA)
    assert abs(estimate.readout_ms - 20.0) < 3.0 * estimate.sd_ms
    assert estimate.sd_ms < 0.6


@pytest.mark.parametrize(
    ("motion", "seen", "code", "says"),
    [
        (SIDEWAYS, {"images": 10}, "READOUT_TOO_FEW_IMAGES", "8 images"),
        (SIDEWAYS, {"images": 45, "rate_hz": 5.0}, "READOUT_TOO_FEW_IMAGES", "0 images"),
        (shaken(sideways_mm=2.0), {}, "READOUT_TOO_SLOW", "150 px/s"),
        (drifting(90.0), {}, "READOUT_ONE_WAY", "one way in 0 images"),
        (SIDEWAYS, {"noise_px": 2.5}, "READOUT_UNOBSERVABLE", "allowed 1.0 ms"),
        (SIDEWAYS, {"readout_s": 0.05}, "READOUT_IMPOSSIBLE", "33.3 ms"),
        (SIDEWAYS, {"readout_s": -0.016}, "READOUT_IMPOSSIBLE", "between 0 and the"),
    ],
    ids=["few", "far apart", "slow", "one way", "noisy", "too long", "from below"],
)
def test_what_does_not_determine_it_is_rejected_with_numbers(
    motion: Motion, seen: dict[str, Any], code: str, says: str
) -> None:
    usual: dict[str, Any] = {"readout_s": 0.016, "images": 18}
    views = seen_views(motion, **(usual | seen))
    with pytest.raises(CalibrationError) as caught:
        estimate_readout(views, CAMERA)
    assert caught.value.code == code
    assert says in caught.value.message
    assert caught.value.remedy


def test_a_mistaken_view_is_left_out() -> None:
    views = seen_views(BOTH, readout_s=0.016, images=20)
    px = views[12].view.image_points_px.copy()
    px[::3] += 4.0
    points = views[12].view.object_points_mm
    mistaken = BoardView(ids=views[12].view.ids, object_points_mm=points, image_points_px=px)
    views[12] = TimedView(at_s=views[12].at_s, view=mistaken)
    found = estimate_readout(views, CAMERA)
    assert abs(found.readout_ms - 16.0) < 3.0 * found.sd_ms
    assert found.rms_px < 0.15


def test_times_that_jitter_widen_the_stated_spread() -> None:
    for seed in (0, 1, 3):
        views = seen_views(BOTH, readout_s=0.016, seed=seed, images=20)
        late_s = 0.003 * np.random.default_rng(seed).standard_normal(len(views))
        late = [TimedView(at_s=one.at_s + by, view=one.view) for one, by in zip(views, late_s, strict=True)]
        found = estimate_readout(late, CAMERA)
        assert abs(found.readout_ms - 16.0) < 3.0 * found.sd_ms
        assert found.sd_ms > 0.2


@pytest.mark.parametrize("readout_s", [0.0, 0.016])
def test_a_bent_board_widens_the_stated_spread_and_stays_within_it(readout_s: float) -> None:
    found = estimate_readout(seen_views(BOTH, readout_s=readout_s, images=20, bow_mm=1.5), CAMERA)
    assert abs(found.readout_ms - 1000.0 * readout_s) < 3.0 * found.sd_ms
    assert found.sd_ms > estimated(BOTH, readout_s).sd_ms
