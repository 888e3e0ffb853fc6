"""Flickering lamps, distinguished from all other changes of an image."""

from collections.abc import Callable, Sequence
from functools import cache, partial

import numpy as np
import pytest

from tests.tracker.camera.lamps import lit
from tracker.camera.flicker import (
    FlickerMonitor,
    FlickerState,
    FlickerVerdict,
    brightness_grid,
    detect_flicker,
)
from tracker.geometry import Array
from tracker.rehearsal import Scene, Theatre, TheatreSettings

SIZE_WH_PX, WINDOW_S = (256, 192), 4.3
Image = np.ndarray
Change = Callable[[Image, float], Image]


@cache
def _film(scene: Scene, rate_hz: float) -> tuple[tuple[float, Image], ...]:
    renderer = Theatre(TheatreSettings(size_wh_px=SIZE_WH_PX, scene=scene)).renderer()
    times_s = np.arange(0.0, WINDOW_S, 1.0 / rate_hz)
    return tuple((float(at_s), renderer.image_at(float(at_s))) for at_s in times_s)


def _judged(film: Sequence[tuple[float, Image]], change: Change) -> FlickerVerdict:
    return detect_flicker(
        [at_s for at_s, _ in film], [brightness_grid(change(image, at_s)) for at_s, image in film]
    )


@pytest.mark.parametrize(("mains_hz", "rate_hz"), [(50.1, 30.0), (59.9, 25.0)])
@pytest.mark.parametrize("readout_s", [0.0, 0.016])
@pytest.mark.parametrize("depth_ratio", [0.015, 0.2])
def test_flicker_is_reported_with_its_mains_and_depth_while_the_scene_moves(
    mains_hz: float, rate_hz: float, readout_s: float, depth_ratio: float
) -> None:
    verdict = _judged(
        _film(Scene.OPERATION, rate_hz),
        lambda image, at_s: lit(
            image, at_s, light_hz=2.0 * mains_hz, depth_ratio=depth_ratio, readout_s=readout_s
        ),
    )
    assert verdict.flicker is not None
    assert verdict.flicker.mains_hz == (round(mains_hz / 10) * 10,)
    assert verdict.flicker.depth_ratio == pytest.approx(depth_ratio, rel=0.1)


def _unchanged(image: Image, at_s: float) -> Image:
    del at_s
    return image


def _stepped(image: Image, at_s: float) -> Image:
    """Automatic exposure: three steps of a tenth to a third."""
    gain = 1.0 + 0.1 * (at_s > 0.9) - 0.3 * (at_s > 2.1) + 0.15 * (at_s > 3.4)
    return np.asarray(np.clip(image * gain, 0, 255), dtype=np.uint8)


def _hunting(image: Image, at_s: float) -> Image:
    """Automatic exposure that oscillates about its target."""
    return np.asarray(np.clip(image * (1.0 + 0.1 * np.sin(2.0 * np.pi * 2.2 * at_s)), 0, 255), dtype=np.uint8)


def _clouded(image: Image, at_s: float) -> Image:
    """Clouds in front of the sun: the whole image varies slowly."""
    return np.asarray(
        np.clip(image * (0.8 + 0.15 * np.sin(2.0 * np.pi * 0.5 * at_s)), 0, 255), dtype=np.uint8
    )


def _jittering(image: Image, at_s: float) -> Image:
    """A gain that varies slightly from image to image."""
    gain = 1.0 + 0.03 * np.random.default_rng(round(at_s * 1e4)).standard_normal()
    return np.asarray(np.clip(image * gain, 0, 255), dtype=np.uint8)


def _unevenly_lit(image: Image, at_s: float) -> Image:
    """A static gradient of light: from half to full over the rows, with bands in it."""
    del at_s
    rows = np.arange(len(image)) / len(image)
    return (image * (0.5 + 0.4 * rows + 0.1 * np.sin(2.0 * np.pi * 1.6 * rows))[:, None, None]).astype(
        np.uint8
    )


def _trembling(image: Image, at_s: float) -> Image:
    """A tremor at exactly the beat of 50 Hz mains with 30 images/s, with a bright object."""
    shown = image.copy()
    left = 100 + round(12.0 * np.sin(2.0 * np.pi * 10.0 * at_s))
    shown[40:200, left : left + 90] = np.minimum(shown[40:200, left : left + 90].astype(int) + 90, 255)
    return shown


@pytest.mark.parametrize("scene", [Scene.OPERATION, Scene.BOARD])
@pytest.mark.parametrize(
    "change", [_unchanged, _stepped, _hunting, _clouded, _jittering, _unevenly_lit, _trembling]
)
def test_nothing_else_that_changes_an_image_is_taken_for_a_lamp(scene: Scene, change: Change) -> None:
    assert _judged(_film(scene, 30.0), change).flicker is None


def test_a_quiet_scene_under_even_light_is_said_to_be_steady() -> None:
    assert _judged(_film(Scene.OPERATION, 30.0), _unchanged).state is FlickerState.STEADY


def test_bands_that_stand_still_are_not_reported() -> None:
    for rate_hz, light_hz in ((30.0, 120.0), (25.0, 100.0)):
        verdict = _judged(
            _film(Scene.OPERATION, rate_hz),
            partial(lit, light_hz=light_hz, depth_ratio=0.2, readout_s=0.016),
        )
        assert verdict.flicker is None


def _grey(level: float, at_s: float, depth_ratio: float) -> Image:
    image = np.full((240, 320), level) * (1.0 + depth_ratio * np.cos(2.0 * np.pi * 100.0 * at_s))
    return np.asarray(np.clip(image, 0, 255), dtype=np.uint8)


def test_where_the_rate_cannot_tell_the_mains_both_are_named() -> None:
    # At 27.5 images/s, light at 100 Hz and at 120 Hz has the same beat, 10 Hz up and down.
    times_s = np.arange(0.0, WINDOW_S, 1.0 / 27.5)
    verdict = detect_flicker(list(times_s), [brightness_grid(_grey(120.0, at_s, 0.1)) for at_s in times_s])
    assert verdict.flicker is not None
    assert verdict.flicker.mains_hz == (50, 60)


@pytest.mark.parametrize("level", [2.0, 255.0])
def test_black_and_full_images_say_nothing(level: float) -> None:
    times_s = np.arange(0.0, WINDOW_S, 1.0 / 30.0)
    verdict = detect_flicker(list(times_s), [brightness_grid(_grey(level, at_s, 0.0)) for at_s in times_s])
    assert verdict.state is FlickerState.UNSURE


def test_too_small_an_image_gives_no_result() -> None:
    means: list[Array] = [brightness_grid(np.full((20, 20), 100, np.uint8))] * 130
    assert detect_flicker([number / 30.0 for number in range(130)], means).state is FlickerState.UNSURE


def test_a_monitor_tells_flicker_until_light_is_seen_steady() -> None:
    monitor = FlickerMonitor(rest_s=1.0)

    def shown(from_s: float, depth_ratio: float, level: float = 120.0) -> bool:
        for at_s in np.arange(from_s, from_s + 11.0, 1.0 / 30.0):
            monitor.take(_grey(level, at_s, depth_ratio), float(at_s))
        return monitor.flicker is not None

    assert not shown(0.0, 0.0)
    assert shown(11.0, 0.05)
    # Without evidence nothing is ruled out.
    assert shown(22.0, 0.0, level=3.0)
    assert not shown(33.0, 0.0)
