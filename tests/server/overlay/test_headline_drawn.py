"""The headline has a shape and a colour for each tone, and is green only on path."""

from collections.abc import Callable

import numpy as np
import pytest

from server.overlay import draw_overlay, panel_of
from server.overlay.headline import COLOURS, draw_headline
from server.overlay.primitives import GREEN, Image
from server.texts import LANGUAGES, Headline, Tone
from server.texts.language import NO_TEXT
from tracker.navigation import NavigationSnapshot, Status

SnapshotOf = Callable[..., NavigationSnapshot]
ON_THE_AXIS = {"tip_in_vertebra_mm": (0.0, 0.0, 12.0), "tilt_rad": 0.0}
SIZES = [(1280, 720), (1920, 1080), (3840, 2160), (720, 1280)]


def grey(size_wh_px: tuple[int, int] = (1280, 720)) -> Image:
    return np.full((size_wh_px[1], size_wh_px[0], 3), 110, np.uint8)


def is_green(image: Image) -> bool:
    return bool((np.abs(image.astype(int) - np.array(GREEN)).max(axis=2) < 30).any())


def test_green_is_only_for_a_drill_that_is_surely_on_its_way(snapshot_of: SnapshotOf) -> None:
    size = (1280, 720)
    assert is_green(draw_overlay(grey(), snapshot_of(size_wh_px=size, **ON_THE_AXIS)))
    for theatre in ({**ON_THE_AXIS, "pose_variance": 1.0}, {}, {"tilt_rad": 0.3}, {"seen": False}):
        assert not is_green(draw_overlay(grey(), snapshot_of(size_wh_px=size, **theatre)))


def test_a_figure_over_its_limit_has_the_colour_of_the_headline(snapshot_of: SnapshotOf) -> None:
    tilted = {"tilt_rad": 0.16, "tip_in_vertebra_mm": (0.0, 0.0, 0.0)}
    readings = panel_of(snapshot_of(**tilted)).readings
    assert [reading.status for reading in readings][:2] == [Status.WITHIN, Status.OVER]


def _drawn(tone: Tone) -> Image:
    image = grey((300, 120))
    same = dict.fromkeys(LANGUAGES, "SAME")
    headline = Headline(verdict=None, tone=tone, title=same, detail=NO_TEXT, event=NO_TEXT)
    draw_headline(image, headline, "en", left_px=10, bottom_px=100, scale=1.0)
    return image


def test_without_colour_the_shapes_still_differ() -> None:
    inked = [_drawn(tone)[48:100, 10:58].min(axis=2) > 60 for tone in Tone]
    for index, shape in enumerate(inked):
        for other in inked[index + 1 :]:
            assert (shape != other).mean() > 0.03


def test_only_one_tone_is_green() -> None:
    assert {tone for tone, colour in COLOURS.items() if colour == GREEN} == {Tone.GOOD}


@pytest.mark.parametrize("size", SIZES)
def test_all_of_it_has_its_place_in_the_picture(snapshot_of: SnapshotOf, size: tuple[int, int]) -> None:
    worst = snapshot_of(size_wh_px=size, tip_in_vertebra_mm=(20.0, 0.0, -99.0), tilt_rad=1.5)
    scale = min(size[1] / 720.0, size[0] / 880.0)
    drawn = draw_overlay(grey(size), worst)
    # The stack on the left overlaps neither the small print above it nor the lower border.
    height = size[1]
    changed = (drawn != 110).any(axis=2)[:, round(20 * scale) : round(60 * scale)].any(axis=1)
    rows = np.flatnonzero(changed)
    small_print, stack = rows[rows < 42 * scale], rows[rows >= 42 * scale]
    assert len(small_print) > 0
    assert stack[0] > 45 * scale
    assert stack[-1] < height - 15 * scale
